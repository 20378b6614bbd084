"""Methods: which stitcher hides which seams, and why another one than was asked for."""

from typing import NamedTuple

from stridewire_engine.stitchers import STITCHERS, Stitcher
from stridewire_engine.stitching.chains import Chains
from stridewire_engine.stitching.plan import Plan

AUTO = "auto"
_BEST_PLAIN = "stance"


class Method(NamedTuple):
    """How chains are worked on."""

    stitcher: Stitcher
    reason: str = ""
    """Why, where it is not the one asked for."""


def method_names() -> tuple[str, ...]:
    """Return what can be asked for."""
    return (AUTO, *(stitcher.name for stitcher in STITCHERS))


def method(plan: Plan, chains: Chains, name: str) -> Method:
    """Return how chains are worked on that are to be worked on by the stitcher of a name."""
    wanted = _BEST_PLAIN if name == AUTO else name
    return Method(next(stitcher for stitcher in STITCHERS if stitcher.name == wanted))
