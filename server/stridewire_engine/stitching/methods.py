"""Methods: what hides the seams of which chains, and why another than was asked for."""

from typing import NamedTuple

import numpy as np

from stridewire._messages import StitchQuery
from stridewire.motion.array_types import Indices
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.networks.rmr import Refiner
from stridewire_engine.stitchers import STITCHERS
from stridewire_engine.stitching.chains import Chains
from stridewire_engine.stitching.plan import Plan
from stridewire_engine.stitching.refining import refine
from stridewire_engine.stitching.run import Guides

AUTO, REFINE = "auto", "refine"
_BEST_PLAIN = "stance"
_FAR = "dead-blend"


class Method(NamedTuple):
    """What hides seams."""

    name: str
    stitcher: str
    """Name of the live stitcher that runs."""
    reason: str = ""
    """Why, where it is not the one asked for."""


class Share(NamedTuple):
    """Chains that are worked on alike."""

    rows: Indices
    """Which of the chains."""
    method: Method
    guides: Guides | None = None


def method_names() -> tuple[str, ...]:
    """Return what can be asked for."""
    plain = tuple(s.name for s in STITCHERS if s.name not in (AUTO, REFINE))
    return (AUTO, *plain, REFINE)


def plants_feet(name: str) -> bool:
    """Tell whether what is asked for keeps feet where they stand."""
    return name in (AUTO, REFINE, _BEST_PLAIN)


def shares(plan: Plan, chains: Chains, query: StitchQuery, refiner: Refiner | None) -> list[Share]:
    """Return who works on which chains.

    Args:
        plan: The clips laid end to end.
        chains: Some of the plan's.
        query: Says what is asked for.
        refiner: The network; None where there is none.
    """
    everyone = np.arange(len(chains))
    if query.stitcher != REFINE:
        wanted = _BEST_PLAIN if query.stitcher == AUTO else query.stitcher
        return [Share(everyone, Method(wanted, wanted))]
    why = _why_not(plan, refiner)
    if why or refiner is None:
        return [Share(everyone, Method(_BEST_PLAIN, _BEST_PLAIN, why))]
    shift = max(round(query.shift * plan.frame_rate), 1)
    refined = refine(plan, chains, refiner, shift, query.passes)
    near = refined.distance <= refiner.furthest
    done = [Share(everyone[near], Method(REFINE, _BEST_PLAIN), refined.guides)]
    # feet must be planted all along an imposed path, whoever does it
    plain = _BEST_PLAIN if plan.imposed else _FAR
    for row in everyone[~near]:
        far = (
            f"unlike what the network was trained on: distance {refined.distance[row]:.1f}, "
            f"allowed {refiner.furthest:.1f}"
        )
        done.append(Share(everyone[row : row + 1], Method(plain, plain, far)))
    return [share for share in done if len(share.rows)]


def _why_not(plan: Plan, refiner: Refiner | None) -> str:
    """Return why the network cannot be asked, else nothing."""
    if refiner is None:
        return "this installation has no network for it"
    if plan.skeleton != REFERENCE:
        return "the network knows the reference skeleton only"
    if len(plan) < 60 or not len(plan.seams):
        return "too short for the network: less than a second"
    return ""
