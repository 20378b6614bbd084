"""Offline stitching: one natural motion out of several clips."""

from stridewire_engine.stitching.answering import answer, stitching
from stridewire_engine.stitching.checks import SHORTEST_S
from stridewire_engine.stitching.methods import method_names
from stridewire_engine.stitching.stitch import Stitching

__all__ = ["SHORTEST_S", "Stitching", "answer", "method_names", "stitching"]
"""`answer` takes queries, `stitching` takes clips."""
