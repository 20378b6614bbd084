"""Output: what a session's frames show of the tick's blocks, on the caller's skeleton, in its size.

Everything inside is of the reference skeleton's size. A character of another size lives in a world
that is as much smaller or larger: what a caller asks for is divided by the character's scale, what
it is shown is multiplied. So strides fit legs, and limbs keep their directions.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import Open, PoseFormat
from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.rigs.planting import Planting
from stridewire_engine.rigs.posing import Posing
from stridewire_engine.rigs.rig import Rig, RigError, rig_of
from stridewire_engine.runtime.roster import Roster
from stridewire_engine.runtime.tick import Block


class Shown(NamedTuple):
    """Blocks of one frame, float32, as in `Frame`."""

    root: Floats
    root_delta: Floats
    hips: Vectors
    rotations: Quaternions
    foot_targets: Vectors
    simulated_root: Floats


class Output:
    """Turns blocks into what one session shows.

    Args:
        opening: What the session asked for.
        library_skeleton: Skeleton of the blocks.

    Raises:
        InvalidRequestError: If the skeleton asked for cannot be posed as a human.
    """

    def __init__(self, opening: Open, library_skeleton: Skeleton) -> None:
        self._halves = opening.format is PoseFormat.F16
        self._posing: Posing | None = None
        skeleton = _as_sent(opening.output_skeleton) or library_skeleton
        rig = _rig("open.output_skeleton", skeleton)
        self.skeleton = rig.skeleton
        self._height = rig.height
        self._scale = 1.0
        if opening.output_skeleton is not None:
            self._posing = Posing(rig)
            self._scale = rig.scale
        self._ids: Indices = np.zeros(0, np.uint32)
        self._planting = Planting.fresh(0)

    def scale(self, height_m: float) -> float:
        """Return the size of a character in the reference's; of the skeleton's own for height 0.

        Args:
            height_m: Counted as it comes over the wire, in float32.
        """
        sent = float(np.float32(height_m))
        return self._scale * (sent / self._height if sent else 1.0)

    def show(self, block: Block, rows: slice, roster: Roster, dt: float) -> Shown:
        """Return what a frame shows.

        Args:
            block: Of the tick.
            rows: The session's.
            roster: The characters in those rows.
            dt: Seconds since the frame before.
        """
        shown = Shown(
            block.root[rows],
            block.root_delta[rows],
            block.hips[rows],
            block.rotations[rows],
            block.foot_targets[rows],
            block.simulated_root[rows],
        )
        if self._posing is not None:
            shown = self._posed(self._posing, shown, block.contacts[rows], roster, dt)
        elif not roster.of_one_size:
            shown = _sized(shown, roster.scales, roster.scales)
        return _as_halves(shown) if self._halves else shown

    def _posed(
        self,
        posing: Posing,
        shown: Shown,
        contacts: Flags,
        roster: Roster,
        dt: float,
    ) -> Shown:
        planting, scales = self._rows(roster.ids), roster.scales
        passed = np.full(len(roster), dt)
        posed = posing.pose(
            shown.hips,
            shown.rotations,
            shown.root,
            contacts[:, 1::2],
            shown.foot_targets,
            passed,
            planting,
        )
        own = (scales / self._scale).astype(np.float32)
        sized = _sized(shown._replace(hips=posed.hips, rotations=posed.rotations), scales, own)
        return sized._replace(foot_targets=sized.foot_targets + own[:, None, None] * posed.aside)

    def _rows(self, ids: Indices) -> Planting:
        """Return what the characters' feet remember; newcomers remember nothing."""
        if not np.array_equal(ids, self._ids):
            kept, self._planting = self._planting, Planting.fresh(len(ids))
            _, here, there = np.intersect1d(ids, self._ids, return_indices=True)
            self._planting.put(here, kept, there)
            self._ids = ids
        return self._planting


def _as_sent(skeleton: Skeleton | None) -> Skeleton | None:
    """Return a skeleton as it comes over the wire, so that frames in process are the same."""
    if skeleton is None:
        return None
    return replace(skeleton, offsets=skeleton.offsets.astype(np.float32))


def _rig(path: str, skeleton: Skeleton) -> Rig:
    try:
        return rig_of(skeleton)
    except RigError as error:
        raise InvalidRequestError.of(Violation(path, str(error))) from error


def _sized(shown: Shown, scales: Floats, own: Floats) -> Shown:
    """Bring a frame to size: the world by `scales`, the body by `own`, `(N,)` each."""
    world = np.asarray(scales, np.float32)[:, None]
    return Shown(
        np.concatenate([shown.root[:, :3] * world, shown.root[:, 3:]], axis=1),
        np.concatenate([shown.root_delta[:, :3] * world, shown.root_delta[:, 3:]], axis=1),
        shown.hips * np.asarray(own, np.float32)[:, None],
        shown.rotations,
        shown.foot_targets * world[..., None],
        np.concatenate([shown.simulated_root[:, :3] * world, shown.simulated_root[:, 3:]], axis=1),
    )


def _as_halves(shown: Shown) -> Shown:
    """Round what travels as half floats, so that it is the same over a wire and without one."""
    return shown._replace(
        root_delta=_rounded(shown.root_delta),
        hips=_rounded(shown.hips),
        rotations=_rounded(shown.rotations),
    )


def _rounded(values: Floats) -> Floats:
    return values.astype(np.float16).astype(np.float32)
