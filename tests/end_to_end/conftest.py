"""The servers that these tests talk to."""

from serving import door, loop_thread, serve, small_library

__all__ = ["door", "loop_thread", "serve", "small_library"]
