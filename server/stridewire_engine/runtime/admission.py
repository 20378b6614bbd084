"""Admission: what is allowed in messages, field by field.

Field paths are those of the wire. Fields of later versions are refused by name.
"""

from collections.abc import Collection, Iterator, Mapping

import numpy as np

from stridewire._errors import InvalidRequestError, NotImplementedYetError, Violation
from stridewire._messages import (
    CharacterSpec,
    CorrectionMode,
    Ground,
    GroundPose,
    Limits,
    Open,
    Sparse,
    Trajectory,
)
from stridewire.motion.array_types import Flags, Floats
from stridewire_engine.library import Library
from stridewire_engine.matching.gaits import gait_filter
from stridewire_engine.matching.schema import Schema
from stridewire_engine.matching.search import Matcher
from stridewire_engine.runtime.characters import MAX_TRAJECTORY_POINTS
from stridewire_engine.stitchers import STITCHER_NAMES

_MAX_COORDINATE = 1e6
_MAX_ID = 2**32 - 1
_UNIT, _STEEPEST = 0.01, 0.3
"""How far from unit a normal may be; least height of a normal, for ground of 72 degrees."""
_MAX_TRAJECTORY_S = 10.0
_MIN_RATE_HZ, _MAX_RATE_HZ = 10.0, 240.0
_MAX_CREDITS = 3600
_MAX_WEIGHT = 1e6
_MIN_HEIGHT_M, _MAX_HEIGHT_M = 0.5, 3.0
_MAX_DIVIDER = 15
"""So that no pose is older than a quarter of a second at 60 frames a second."""
_NOT_YET = "is not implemented yet; leave it out"


def check_open(message: Open, limits: Limits, matcher: Matcher) -> None:
    """Refuse an Open that is malformed or asks for what does not exist yet.

    Args:
        message: The Open.
        limits: That hold.
        matcher: Of the library that it names.

    Raises:
        InvalidRequestError: With one violation a field.
        NotImplementedYetError: Naming the field.
    """
    if message.resume_token:
        path = "open.resume_token"
        raise NotImplementedYetError(f"{path} {_NOT_YET}", [Violation(path, _NOT_YET)])
    found = [*_open_violations(message, limits)]
    taken: set[int] = set()
    for i, spec in enumerate(message.characters):
        found += check_spec(f"open.characters[{i}]", spec, taken, matcher)
        taken.add(spec.id)
    if found:
        raise InvalidRequestError.of(*found)


def check_spec(
    path: str, spec: CharacterSpec, taken: Collection[int], matcher: Matcher
) -> Iterator[Violation]:
    """Yield what is wrong with a character to be added.

    Args:
        path: Of the character.
        spec: The character.
        taken: Ids that the session has already.
        matcher: Of the library that it is added to.
    """
    if not 0 <= spec.id <= _MAX_ID:
        yield Violation(f"{path}.id", f"{spec.id} is no id; allowed are 0 to {_MAX_ID}")
    elif spec.id in taken:
        yield Violation(f"{path}.id", f"{spec.id} is taken; ids are unique within a session")
    if spec.height_m and not _MIN_HEIGHT_M <= spec.height_m <= _MAX_HEIGHT_M:
        yield Violation(
            f"{path}.height_m",
            f"{spec.height_m} m; allowed are {_MIN_HEIGHT_M:g} to {_MAX_HEIGHT_M:g}, or 0 for the "
            "skeleton's own",
        )
    yield from check_ground_pose(f"{path}.root", spec.root)
    yield from check_stitcher(f"{path}.stitcher", spec.stitcher)
    yield from check_filter(f"{path}.filter", spec.filter, matcher)
    yield from check_weights(f"{path}.weights", spec.weights, matcher.schema)
    yield from check_responsiveness(f"{path}.responsiveness", spec)
    yield from check_rate_divider(f"{path}.rate_divider", spec)


def check_stitcher(path: str, name: str) -> Iterator[Violation]:
    """Yield what is wrong with a stitcher's name; empty means the default."""
    if name and name not in STITCHER_NAMES:
        yield Violation(path, f"{name!r} is not present; present are {', '.join(STITCHER_NAMES)}")


def check_filter(path: str, text: str, matcher: Matcher) -> tuple[Violation, ...]:
    """Return what is wrong with a tag expression; empty means all."""
    try:
        matcher.candidates.get(text, path)
    except InvalidRequestError as error:
        return error.violations
    return ()


def check_gait(path: str, gait: str, library: Library) -> tuple[Violation, ...]:
    """Return what is wrong with a gait."""
    try:
        gait_filter(gait, path, library.tag_names)
    except InvalidRequestError as error:
        return error.violations
    return ()


def check_weights(path: str, weights: Mapping[str, float], schema: Schema) -> Iterator[Violation]:
    """Yield what is wrong with weights by channel."""
    names = [channel.name for channel in schema.channels]
    for name, weight in weights.items():
        if name not in names:
            yield Violation(f"{path}[{name!r}]", f"is no channel; channels are {', '.join(names)}")
        elif not 0.0 <= weight <= _MAX_WEIGHT:
            yield Violation(f"{path}[{name!r}]", f"{weight}; allowed are 0 to {_MAX_WEIGHT:g}")
    if weights and not merged_weights(weights, schema).any():
        yield Violation(path, "all channels have weight 0, so nothing could be compared")


def check_responsiveness(path: str, spec: CharacterSpec) -> Iterator[Violation]:
    """Yield what is wrong with a character's responsiveness; None means the default."""
    given = spec.responsiveness
    if given is not None and not 0.0 <= given <= 1.0:
        yield Violation(path, f"{given}; allowed are 0, for quality, to 1, for response")


def check_rate_divider(path: str, spec: CharacterSpec) -> Iterator[Violation]:
    """Yield what is wrong with the number of ticks between a character's poses."""
    if not 0 <= spec.rate_divider <= _MAX_DIVIDER:
        yield Violation(
            path, f"{spec.rate_divider}; allowed are 0 to {_MAX_DIVIDER} ticks from pose to pose"
        )


def merged_weights(weights: Mapping[str, float], schema: Schema) -> Floats:
    """Return a weight `(C,)` for every channel: the schema's where none is given."""
    return np.array([weights.get(c.name, c.weight) for c in schema.channels], np.float64)


def check_ground_pose(path: str, root: GroundPose) -> Iterator[Violation]:
    """Yield what is wrong with a place and heading."""
    for axis, value in zip("xyz", root.position, strict=True):
        if not abs(value) <= _MAX_COORDINATE:
            yield Violation(
                f"{path}.position.{axis}",
                f"{value} is not a place; allowed are finite metres up to {_MAX_COORDINATE:g}",
            )
    if not np.isfinite(root.yaw):
        yield Violation(f"{path}.yaw", f"{root.yaw} is no angle; allowed are finite radians")


def check_ground(path: str, ground: Ground) -> Iterator[Violation]:
    """Yield what is wrong with the ground under a character."""
    feet = ground.foot_heights
    heights = np.append(ground.height, [] if feet is None else np.ravel(feet))
    if feet is not None and np.size(feet) != 4:
        yield Violation(f"{path}.foot_heights", f"{np.size(feet)} values; expected 4 or none")
    if not (np.abs(heights) <= _MAX_COORDINATE).all():
        yield Violation(path, f"heights are finite metres up to {_MAX_COORDINATE:g}")
    normals = ground.foot_normals
    if normals is not None and np.size(normals) != 12:
        yield Violation(f"{path}.foot_normals", f"{np.size(normals)} values; expected 12 or none")
        normals = None
    for name, normal in (("normal", ground.normal), ("foot_normals", normals)):
        if normal is None:
            continue
        vectors = np.reshape(np.asarray(normal, np.float64), (-1, 3))
        unit = np.abs(np.linalg.norm(vectors, axis=-1) - 1.0) <= _UNIT
        if not (unit & (vectors[:, 1] >= _STEEPEST)).all():
            yield Violation(
                f"{path}.{name}",
                f"allowed are unit vectors that point up, their y at least {_STEEPEST:g}",
            )


def check_velocity(velocity: Floats, limits: Limits) -> tuple[Flags, Iterator[Violation]]:
    """Return which velocities `(N, 2)` are good `(N,)`, and what is wrong with the others."""
    good = np.abs(velocity) <= limits.max_speed

    def violations() -> Iterator[Violation]:
        for row, axis in np.argwhere(~good):
            yield Violation(
                f"step.velocity_xz[{2 * row + axis}]",
                f"{velocity[row, axis]} m/s; allowed are finite up to {limits.max_speed:g} in "
                "magnitude; the previous control holds",
            )

    return np.asarray(good.all(axis=1)), violations()


def check_facing(facing: Floats) -> tuple[Flags, Iterator[Violation]]:
    """Return which of the headings `(N,)` are good (NaN is), and what is wrong with the rest."""
    good = ~np.isinf(facing)

    def violations() -> Iterator[Violation]:
        for row in np.flatnonzero(~good):
            yield Violation(
                f"step.facing_yaw[{row}]",
                f"{facing[row]} is no angle; allowed are finite radians, or NaN for along the "
                "velocity; the previous control holds",
            )

    return good, violations()


def check_sparse(path: str, sparse: Sparse, matcher: Matcher, *, known: bool) -> list[Violation]:
    """Return what is wrong with the rarer controls of one character."""
    found: list[Violation] = []
    if sparse.ground is not None:
        found += check_ground(f"{path}.ground", sparse.ground)
    if sparse.filter is not None:
        found += check_filter(f"{path}.filter", sparse.filter, matcher)
    if sparse.gait is not None:
        found += check_gait(f"{path}.gait", sparse.gait, matcher.library)
    if sparse.filter is not None and sparse.gait is not None:
        found.append(Violation(f"{path}.gait", "is sugar for a filter; give one of the two"))
    if not known:
        found.append(
            Violation(
                f"{path}.character",
                f"{sparse.character} is not in this session; add it with an Edit",
            )
        )
    if sparse.trajectory is not None:
        found += check_trajectory(f"{path}.trajectory", sparse.trajectory)
    if sparse.root_correction is not None:
        found += check_ground_pose(f"{path}.root_correction.root", sparse.root_correction.root)
        if sparse.root_correction.mode not in tuple(CorrectionMode):
            found.append(Violation(f"{path}.root_correction.mode", "allowed are ADJUST, TELEPORT"))
    return found


def check_trajectory(path: str, trajectory: Trajectory) -> Iterator[Violation]:
    """Yield what is wrong with a trajectory."""
    times = np.asarray(trajectory.times_s)
    count = len(times)
    if not 1 <= count <= MAX_TRAJECTORY_POINTS:
        yield Violation(
            f"{path}.times_s", f"{count} points; allowed are 1 to {MAX_TRAJECTORY_POINTS}"
        )
        return
    if np.shape(trajectory.positions_xz) != (count, 2):
        yield Violation(
            f"{path}.positions_xz",
            f"{np.size(trajectory.positions_xz)} values for {count} times; expected {2 * count}",
        )
    elif not np.all(np.abs(trajectory.positions_xz) <= _MAX_COORDINATE):
        yield Violation(f"{path}.positions_xz", "a value is not finite or above 1e6 metres")
    inside = np.all((times >= 0.0) & (times <= _MAX_TRAJECTORY_S))
    if not inside or np.any(np.diff(times) <= 0.0):
        yield Violation(
            f"{path}.times_s", f"allowed are ascending seconds from 0 to {_MAX_TRAJECTORY_S:g}"
        )
    facings = trajectory.facings_yaw
    if facings is not None and (np.shape(facings) != (count,) or not np.all(np.isfinite(facings))):
        yield Violation(f"{path}.facings_yaw", f"expected {count} finite radians, or none")


def _open_violations(message: Open, limits: Limits) -> Iterator[Violation]:
    count = len(message.characters)
    if not 1 <= count <= limits.max_characters:
        yield Violation(
            "open.characters", f"{count} characters; allowed are 1 to {limits.max_characters}"
        )
    if not _MIN_RATE_HZ <= message.rate_hz <= _MAX_RATE_HZ:
        yield Violation(
            "open.rate_hz",
            f"{message.rate_hz} a second; allowed are {_MIN_RATE_HZ:g} to {_MAX_RATE_HZ:g}",
        )
    if not 0 <= message.max_frames_in_flight <= _MAX_CREDITS:
        yield Violation(
            "open.max_frames_in_flight",
            f"{message.max_frames_in_flight}; allowed are 0 to {_MAX_CREDITS}",
        )
    if not 0 <= message.seed <= _MAX_ID:
        yield Violation("open.seed", f"{message.seed}; allowed are 0 to {_MAX_ID}")
