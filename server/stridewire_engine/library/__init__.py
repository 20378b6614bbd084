"""A built library: clips on one skeleton as memory-mapped arrays, read-only, with a manifest."""

from stridewire_engine.library.library import Library
from stridewire_engine.library.manifest import ClipEntry, LibraryError, Manifest
from stridewire_engine.library.writing import write_library

__all__ = ["ClipEntry", "Library", "LibraryError", "Manifest", "write_library"]
