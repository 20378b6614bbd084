"""Posture blending: the posture between two, by the network or linearly."""

from stridewire_engine.blending.answering import answer, answer_many
from stridewire_engine.blending.blends import Blended, Pair, blend

__all__ = ["Blended", "Pair", "answer", "answer_many", "blend"]
"""`answer` and `answer_many` take queries, `blend` takes arrays."""
