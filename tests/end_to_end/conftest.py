"""The servers that these tests talk to."""

from serving import loop_thread, serve, small_library

__all__ = ["loop_thread", "serve", "small_library"]
