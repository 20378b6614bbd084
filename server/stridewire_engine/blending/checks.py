"""What may be wrong with a blend, told by field."""

from collections.abc import Iterator, Mapping

import numpy as np

from stridewire._errors import Violation
from stridewire._messages import BlendQuery
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Pose
from stridewire.motion.skeleton import Skeleton

MAX_WEIGHTS = 10_000
MAX_PAIRS = 1_000
_MAX_COORDINATE = 1e6
_MAX_DURATION_S = 3600.0
_NORM_TOLERANCE = 1e-2


def check_query(path: str, query: BlendQuery, skeleton: Skeleton) -> Iterator[Violation]:
    """Yield what is wrong with numbers and names of a query.

    Args:
        path: In front of the fields' names: empty, or `requests[3].`.
        query: With postures by reference or inline.
        skeleton: Of the answer.
    """
    yield from _check_weights(f"{path}weights", np.asarray(query.weights))
    yield from _check_mask(f"{path}joint_mask", query.joint_mask, skeleton)
    if not abs(query.ground_height) <= _MAX_COORDINATE:
        yield Violation(f"{path}ground_height", f"{query.ground_height}; allowed are ±1e6 metres")
    if not 0.0 <= query.duration_s <= _MAX_DURATION_S:
        yield Violation(
            f"{path}duration_s",
            f"{query.duration_s}; allowed are 0, for unknown, to {_MAX_DURATION_S:g} seconds",
        )
    for name, source in (("start", query.start), ("end", query.end)):
        if isinstance(source, Pose):
            yield from _check_pose(f"{path}{name}.inline", source, skeleton)


def _check_weights(path: str, weights: Floats) -> Iterator[Violation]:
    if not 1 <= len(weights) <= MAX_WEIGHTS:
        yield Violation(path, f"{len(weights)} weights; allowed are 1 to {MAX_WEIGHTS}")
        return
    wrong = np.flatnonzero(~((weights >= 0.0) & (weights <= 1.0)))
    if wrong.size:
        first = int(wrong[0])
        yield Violation(
            f"{path}[{first}]", f"{weights[first]}; allowed are 0, the start, to 1, the end"
        )


def _check_mask(path: str, mask: Mapping[str, float], skeleton: Skeleton) -> Iterator[Violation]:
    for name, share in mask.items():
        if name not in skeleton.names:
            yield Violation(
                f"{path}[{name}]", f"no such joint; there are {', '.join(skeleton.names)}"
            )
        elif not 0.0 <= share <= 1.0:
            yield Violation(f"{path}[{name}]", f"{share}; allowed are 0 to 1")


def _check_pose(path: str, pose: Pose, skeleton: Skeleton) -> Iterator[Violation]:
    shapes = {"root": (7,), "hips": (3,), "rotations": (len(skeleton), 4)}
    if pose.rotations.shape != shapes["rotations"]:
        yield Violation(
            f"{path}.rotations",
            f"shape {pose.rotations.shape}; expected 4 numbers for each of {len(skeleton)} joints",
        )
    for name, values in (("root", pose.root_position), ("hips", pose.hips)):
        if values.shape != (3,) or not np.all(np.abs(values) <= _MAX_COORDINATE):
            yield Violation(f"{path}.{name}", "expected 3 finite coordinates of at most 1e6 metres")
    for name, values in (("root", pose.root_rotation), ("rotations", pose.rotations)):
        length = np.linalg.norm(values, axis=-1)
        if values.shape[-1:] != (4,) or not np.all(np.abs(length - 1.0) <= _NORM_TOLERANCE):
            yield Violation(f"{path}.{name}", "a quaternion w x y z is not of unit length")
