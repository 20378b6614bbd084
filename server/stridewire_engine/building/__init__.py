"""Building: from capture or generators to a library folder. Offline; may be slow and talkative."""

from stridewire_engine.building.build import FRAME_RATE, build_library
from stridewire_engine.building.opening import embedded_library, open_library

__all__ = ["FRAME_RATE", "build_library", "embedded_library", "open_library"]
