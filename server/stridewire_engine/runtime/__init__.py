"""The runtime: controls in, poses out. Nothing offline is imported here."""

from stridewire_engine.runtime.runtime import Runtime
from stridewire_engine.runtime.session import Session
from stridewire_engine.runtime.settings import TickSettings

__all__ = ["Runtime", "Session", "TickSettings"]
