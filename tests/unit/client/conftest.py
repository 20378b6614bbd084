"""The library that sessions in this process run on."""

from serving import small_library

__all__ = ["small_library"]
