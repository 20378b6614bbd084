"""The interface of stitchers and the arrays that they keep for each character."""

from dataclasses import dataclass, fields
from typing import NamedTuple, Protocol

import numpy as np

from stridewire.motion.array_types import Flags, Floats, Indices, Quaternions, Vectors
from stridewire.motion.root_frame import turn_to_root, turn_to_world
from stridewire_engine.stitchers.columns import Columns, allocate, column
from stridewire_engine.stitchers.legs import Legs


class Motion(NamedTuple):
    """Poses relative to the root and how they change, for N characters."""

    hips: Vectors
    """`(N, 3)` metres."""
    rotations: Quaternions
    """`(N, J, 4)` local."""
    hips_velocity: Vectors
    """`(N, 3)` m/s."""
    angular_velocity: Vectors
    """`(N, J, 3)` rad/s in the parent's space."""
    toes: Vectors
    """`(N, 2, 3)` left and right toe, metres."""
    toes_velocity: Vectors
    """`(N, 2, 3)` m/s, without the root's."""

    def take(self, rows: Indices) -> "Motion":
        """Return some characters' motion."""
        return Motion(*(array[rows] for array in self))


class Roots(NamedTuple):
    """Where N characters are, float64."""

    position: Vectors
    """`(N, 3)`."""
    yaw: Floats
    """`(N,)`."""

    def take(self, rows: slice | Indices) -> "Roots":
        """Return some characters' roots."""
        return Roots(self.position[rows], self.yaw[rows])

    def to_world(self, local: Vectors) -> Vectors:
        """Return points `(N, K, 3)` of the roots' frames in the world."""
        return turn_to_world(local, self.yaw) + self.position[:, None]

    def to_root(self, world: Vectors) -> Vectors:
        """Return points `(N, K, 3)` of the world in the roots' frames."""
        return turn_to_root(world - self.position[:, None], self.yaw)


class LegsAhead(NamedTuple):
    """Where the clips' legs will be at K times ahead, in the frame of the root as it is now."""

    times: Floats
    """`(K,)` seconds, ascending."""
    hips: Vectors
    """`(N, K, 2, 3)` hip joints."""
    ankles: Vectors
    """`(N, K, 2, 3)`."""
    toes: Vectors
    """`(N, K, 2, 3)`."""
    contacts: Flags
    """`(N, K, 2)` whether the toes are planted."""

    def take(self, rows: slice | Indices) -> "LegsAhead":
        """Return some characters' legs."""
        return LegsAhead(
            self.times,
            self.hips[rows],
            self.ankles[rows],
            self.toes[rows],
            self.contacts[rows],
        )


class Guide(NamedTuple):
    """How feet are to go instead of as the clips' do, for N characters now; see `networks.rmr`.

    Who gives one also writes its contacts and offsets into the sample and the legs ahead, and at a
    jump adds the offset of the frame before to the toes of the clip that comes.
    """

    planted: Floats
    """`(N, 2)` share from 0, swinging, to 1, planted."""
    toe_offset: Vectors
    """`(N, 2, 3)` from the clips' toes to where swings lead, in the root's frame."""
    foot_turn: Vectors | None
    """`(N, 2, 3)` rotation vectors by which feet are turned, in the root's frame; None for none."""
    guided: Flags | None = None
    """`(N,)` who is guided, None for all; to others it says what their clips' labels say."""

    def take(self, rows: slice | Indices) -> "Guide":
        """Return some characters' guide."""
        turn, guided = self.foot_turn, self.guided
        return Guide(
            self.planted[rows],
            self.toe_offset[rows],
            None if turn is None else turn[rows],
            None if guided is None else guided[rows],
        )


class Sample(NamedTuple):
    """What the clips show now, and under which root, for N characters."""

    hips: Vectors
    """`(N, 3)` relative to the root."""
    rotations: Quaternions
    """`(N, J, 4)` local."""
    contacts: Flags
    """`(N, 2)` whether the toes are planted."""
    roots: Roots
    """Already moved."""
    begins: Flags
    """`(N,)` whether the character is new: nothing was shown before."""
    legs: Legs
    """Of the skeleton."""
    ahead: LegsAhead | None
    """For stitchers that look ahead."""
    guide: Guide | None = None
    """For stitchers that plant feet."""

    def take(self, rows: slice | Indices) -> "Sample":
        """Return some characters' sample."""
        return Sample(
            self.hips[rows],
            self.rotations[rows],
            self.contacts[rows],
            self.roots.take(rows),
            self.begins[rows],
            self.legs,
            None if self.ahead is None else self.ahead.take(rows),
            None if self.guide is None else self.guide.take(rows),
        )


@dataclass
class StitchState(Columns):
    """What stitchers keep for N characters; plain arrays, changed in place.

    The offsets always tell what is added to the sampled pose now and how it changes, whoever adds
    it, so that any stitcher can take over from any other.
    """

    offset_hips: Vectors = column(3)
    """`(N, 3)` offset of the hips, metres."""
    offset_hips_velocity: Vectors = column(3)
    """`(N, 3)` its rate of change."""
    offset_rotations: Vectors = column("J", 3)
    """`(N, J, 3)` offsets as scaled axes, turned after the sampled rotation, radians."""
    offset_angular_velocity: Vectors = column("J", 3)
    """`(N, J, 3)` rate of change of the scaled axes, rad/s."""
    stitch_time: Floats = column()
    """`(N,)` seconds since the last transition."""
    stitch_deficit: Floats = column()
    """`(N,)` seconds that interruptions have cost."""
    curve_value: Floats = column("1 + J")
    """`(N, 1 + J)` offsets of hips and joints along their axes, at the transition."""
    curve_speed: Floats = column("1 + J")
    """`(N, 1 + J)` their rate of change then."""
    curve_end: Floats = column("1 + J")
    """`(N, 1 + J)` seconds after which nothing is left of them."""
    curve_axis: Vectors = column("1 + J", 3)
    """`(N, 1 + J, 3)` unit."""
    dead_hips: Vectors = column(3)
    """`(N, 3)` as shown at the transition."""
    dead_rotations: Quaternions = column("J", 4)
    """`(N, J, 4)` as shown at the transition."""
    dead_velocity: Vectors = column("1 + J", 3)
    """`(N, 1 + J, 3)` of hips and joints then, m/s and rad/s."""
    dead_halflife: Vectors = column("1 + J", 3)
    """`(N, 1 + J, 3)` seconds, of each axis of the velocity."""
    body_halflife: Floats = column("1 + J")
    """`(N, 1 + J)` seconds, of the springs of hips and joints."""
    toe_shown: Vectors = column(2, 3, dtype=np.float64)
    """`(N, 2, 3)` world position of the toes in the last frame, float64, whoever planted them."""
    toe_speed: Vectors = column(2, 3)
    """`(N, 2, 3)` their world velocity, m/s."""
    toe_gap: Vectors = column(2, 3)
    """`(N, 2, 3)` from the clip's toes to the shown ones, in the world."""
    toe_gap_speed: Vectors = column(2, 3)
    """`(N, 2, 3)` its rate of change."""
    toe_swing: Floats = column(2)
    """`(N, 2)` how far a swing has got under way, 0 to 1."""
    toe_lift: Floats = column(2)
    """`(N, 2)` height added to toes that swing."""
    toe_lift_speed: Floats = column(2)
    """`(N, 2)`."""
    toe_step: Floats = column(2)
    """`(N, 2)` seconds left of a step that a foot takes while the clip stands."""
    hip_drop: Floats = column()
    """`(N,)` metres that the hips are lowered by."""
    hip_drop_speed: Floats = column()
    """`(N,)`."""
    legs_shown: Quaternions = column(6, 4)
    """`(N, 6, 4)` rotations of both thighs, shins and feet, where the stitcher bent them."""

    @classmethod
    def fresh(cls, rows: int, joints: int) -> "StitchState":
        """Return the state of characters of whom nothing was shown."""
        return cls(**allocate(cls, rows, {"J": joints, "1 + J": 1 + joints}))

    def clear(self, rows: Flags) -> None:
        """Forget everything about some characters."""
        for array in vars(self).values():
            array[rows] = 0.0


STITCH_COLUMNS = tuple(field.name for field in fields(StitchState))


class Stitcher(Protocol):
    """Hides transitions."""

    name: str
    """Name on the wire."""
    settled_s: float
    """So long after a transition, what is shown is the clip again, as good as."""
    keeps_root_velocity: bool
    """Whether the root's velocity, too, goes over without a step."""
    plants_feet: bool
    """Whether it keeps planted feet where they are; then nobody else needs to."""
    looks_ahead: tuple[float, ...]
    """Times ahead, in seconds, at which it wants to know where legs will be."""

    def begin(self, state: StitchState, source: Motion, target: Motion, roots: Roots) -> None:
        """Take over at a jump, for characters that all jump now.

        Args:
            state: Of what was shown of the source; changed in place.
            source: The clip that was playing, at the moment of the jump.
            target: The clip that comes, at its own moment.
            roots: Where the characters are.
        """

    def apply(self, state: StitchState, sample: Sample, dt: Floats) -> tuple[Vectors, Quaternions]:
        """Advance by `dt` `(N,)` and return the shown hips `(N, 3)` and rotations `(N, J, 4)`."""
