"""Windows as the paper's network reads and writes them."""

from collections.abc import Callable

from stridewire.motion.array_types import Floats
from stridewire_engine.evaluation.seam_methods import Method, truth
from stridewire_engine.evaluation.seams import Poses, Windows, stitched
from stridewire_engine.networks.rmr.paper_poses import read, write
from stridewire_engine.stitchers import STITCHERS

_SPRING = next(stitcher for stitcher in STITCHERS if stitcher.name == "spring")


def sprung(windows: Windows) -> Floats:
    """Return what the network reads `(N, T, 191)`: clips under the path, springs over seams."""
    made = stitched(windows, _SPRING)
    return write(windows.root, windows.yaw, made.hips, made.rotations, windows.contacts)


def true(windows: Windows) -> Floats:
    """Return what it is to write `(N, T, 191)`: the take under its own path."""
    rows = windows.pairs.truth
    own, (root, yaw) = truth(windows), windows.takes.root_path(rows)
    return write(root, yaw, own.hips, own.rotations, windows.takes.contacts[rows])


def rewritten(refine: Callable[[Floats], Floats]) -> Method:
    """Return springs as a network writes them anew, under the path as it is; feet are not locked.

    Args:
        refine: From `(N, T, 191)` to `(N, T, 191)`.
    """
    return lambda windows: Poses(*read(refine(sprung(windows))))
