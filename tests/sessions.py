"""Random sessions: what a well-behaved client may do, and what a hostile one sends."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from hypothesis import strategies as st

from stridewire import (
    CharacterSpec,
    CharacterUpdate,
    Client,
    CorrectionMode,
    Detail,
    Frame,
    GroundPose,
    InvalidRequestError,
    PoseFormat,
    RootCorrection,
    Sparse,
    Trajectory,
)
from stridewire._errors import Violation
from stridewire._messages import Transition
from stridewire.motion.skeleton import REFERENCE
from stridewire.v1 import animation_pb2 as pb

POSE_TOLERANCE = 1e-5
"""Metres and quaternion components."""

_IDS = (3, 0, 71, 4_000_000_000)
_ids = st.sampled_from(_IDS)
_speed = st.floats(-3.0, 3.0, width=32)
_angle = st.floats(-7.0, 7.0, width=32)
_place = st.tuples(st.floats(-50.0, 50.0), st.floats(-1.0, 1.0), st.floats(-50.0, 50.0))
_tags = st.sampled_from(["", "walk", "idle | walk", "!walk"])
_stitchers = st.sampled_from(["", "none", "spring"])
_spec_fields = {
    "root": st.builds(GroundPose, position=_place, yaw=_angle),
    "height_m": st.sampled_from([0.0, 1.2, 1.75, 2.1]),
    "stitcher": _stitchers,
    "filter": _tags,
    "weights": st.sampled_from([{}, {"trajectory-position": 2.0}]),
    "foot_lock": st.booleans(),
}


def _specs(ids: st.SearchStrategy[int]) -> st.SearchStrategy[CharacterSpec]:
    return st.builds(CharacterSpec, ids, **_spec_fields)


_paths = st.integers(1, 4).flatmap(
    lambda k: st.builds(
        lambda xz, facings: Trajectory(
            np.float32(xz).reshape(k, 2),
            np.linspace(0.3, 1.5, k, dtype=np.float32),
            None if facings is None else np.float32(facings),
        ),
        st.lists(st.floats(-5, 5, width=32), min_size=2 * k, max_size=2 * k),
        st.none() | st.lists(_angle, min_size=k, max_size=k),
    )
)
_corrections = st.builds(
    RootCorrection,
    st.builds(GroundPose, position=_place, yaw=_angle),
    st.sampled_from(CorrectionMode),
)
_sparse = st.builds(
    Sparse,
    _ids,
    trajectory=st.none() | _paths,
    filter=st.none() | _tags,
    root_correction=st.none() | _corrections,
    force_search=st.booleans(),
)


@dataclass(frozen=True)
class Drive:
    """Steps under one control."""

    steps: int
    dt_s: float
    velocity: tuple[float, float] | None
    facing: float | None
    sparse: tuple[Sparse, ...]


@dataclass(frozen=True)
class Change:
    """An edit."""

    add: tuple[CharacterSpec, ...]
    remove: tuple[int, ...]
    update: tuple[CharacterUpdate, ...]


@dataclass(frozen=True)
class Plan:
    """A whole session."""

    characters: tuple[CharacterSpec, ...]
    detail: Detail
    format: PoseFormat
    on_a_rig: bool
    seed: int
    acts: tuple[Drive | Change, ...]


_drives = st.builds(
    Drive,
    st.integers(1, 25),
    st.sampled_from([1 / 60, 1 / 60, 1 / 30, 0.0, 0.1, 0.3]),
    st.none() | st.tuples(_speed, _speed),
    st.none() | _angle | st.just(float("nan")),
    st.lists(_sparse, max_size=2).map(tuple),
)
_changes = st.builds(
    Change,
    st.lists(_specs(_ids), max_size=2).map(tuple),
    st.lists(_ids, max_size=2).map(tuple),
    st.lists(
        st.builds(
            CharacterUpdate,
            _specs(_ids),
            st.sampled_from([("stitcher",), ("foot_lock", "filter"), ("weights",)]),
        ),
        max_size=1,
    ).map(tuple),
)
plans = st.builds(
    Plan,
    st.lists(_specs(_ids), min_size=1, max_size=4, unique_by=lambda spec: spec.id).map(tuple),
    st.sampled_from(Detail),
    st.sampled_from(PoseFormat),
    st.booleans(),
    st.integers(0, 2**32 - 1),
    st.lists(_drives | _changes, min_size=1, max_size=5).map(tuple),
)
"""Valid sessions; some of their edits and characters are refused, which must be told alike."""


@dataclass(frozen=True)
class Outcome:
    """What came of a plan."""

    frames: list[Frame]
    refused: list[tuple[Violation, ...]]


def play(client: Client, plan: Plan) -> Outcome:
    """Carry a plan out."""
    frames = []
    with client.open_session(
        plan.characters,
        detail=plan.detail,
        format=plan.format,
        output_skeleton=REFERENCE.scaled(0.9) if plan.on_a_rig else None,
        seed=plan.seed,
    ) as session:
        present = [spec.id for spec in plan.characters]
        for act in plan.acts:
            if isinstance(act, Change):
                session.edit(add=act.add, remove=act.remove, update=act.update)
                # what is refused the session cannot know; the next frame tells who is there
                present = session.step(dt=0.0).characters.tolist()
                continue
            for number in range(act.steps):
                sparse = act.sparse if number == 0 else ()
                count = len(present)
                frame = session.step(
                    None if act.velocity is None else np.tile(np.float32(act.velocity), (count, 1)),
                    None if act.facing is None else np.full(count, act.facing, np.float32),
                    dt=act.dt_s,
                    characters=present,
                    sparse=sparse,
                )
                frames.append(frame)
    return Outcome(frames, [error.violations for error in session.errors])


def assert_alike(a: Outcome, b: Outcome) -> None:
    """The same refusals, clips, times, flags and contacts; poses within the tolerance."""
    assert a.refused == b.refused
    for one, other in zip(a.frames, b.frames, strict=True):
        assert _exactly(one) == _exactly(other)
        for name in ("root", "root_delta", "hips", "rotations", "foot_targets"):
            np.testing.assert_allclose(
                getattr(one, name),
                getattr(other, name),
                # a number on the edge between two half floats may be rounded either way
                atol=2e-3 if one.format is PoseFormat.F16 else POSE_TOLERANCE,
            )


def _exactly(frame: Frame) -> Sequence[Any]:
    jumps = [
        (e.character, e.from_clip, e.from_time_s, e.to_clip, e.to_time_s, e.reason)
        for e in frame.events
        if isinstance(e, Transition)
    ]
    return (
        *(frame.frame, frame.applied_step, frame.time_s, jumps, len(frame.events)),
        *(frame.characters.tolist(), frame.flags.tolist(), frame.contacts.tolist()),
    )


def violations_of(error: InvalidRequestError) -> list[str]:
    """Return the fields that an error names."""
    return [violation.field for violation in error.violations]


def _opening(**given: Any) -> pb.AnimateRequest:
    return pb.AnimateRequest(open=pb.Open(characters=[pb.CharacterSpec(id=1)], **given))


def _crowd(count: int) -> pb.AnimateRequest:
    specs = [pb.CharacterSpec(id=i) for i in range(count)]
    return pb.AnimateRequest(open=pb.Open(characters=specs))


_OPEN = _opening()
_STEP = pb.AnimateRequest(step=pb.Step(step=1, dt_s=1 / 60, velocity_xz=[0, 1]))
_EMPTY = pb.AnimateRequest()


def _step(**given: Any) -> pb.AnimateRequest:
    return pb.AnimateRequest(step=pb.Step(**{"dt_s": 1 / 60, **given}))


_good = st.lists(st.just(_STEP), max_size=3)
_in_stream = st.one_of(
    st.integers(50, 2**32 - 1).map(lambda n: (_step(last_frame=n), "step.last_frame")),
    st.integers(2, 2**32 - 1).map(
        lambda id: (pb.AnimateRequest(edit=pb.Edit(remove=[id])), "edit.remove[0]")
    ),
    st.integers(2, 2**32 - 1).map(
        lambda id: (
            pb.AnimateRequest(
                edit=pb.Edit(
                    update=[
                        pb.CharacterUpdate(
                            spec=pb.CharacterSpec(id=id), mask={"paths": ["stitcher"]}
                        )
                    ]
                )
            ),
            "edit.update[0].spec.id",
        )
    ),
    st.integers(2, 2**32 - 1).map(lambda id: (_step(characters=[id]), "step.characters[0]")),
    st.sampled_from([float("nan"), -0.5]).map(lambda dt: (_step(dt_s=dt), "step.dt_s")),
    st.sampled_from([float("inf"), 21.0]).map(
        lambda v: (_step(velocity_xz=[v, 0.0]), "step.velocity_xz[0]")
    ),
)
hostile_in_stream = st.tuples(
    _good,
    st.lists(_in_stream, min_size=1, max_size=4),
    st.lists(st.just(_STEP), min_size=1, max_size=3),
)
"""Good steps, bad messages with the field that each is refused for, good steps."""

hostile_ends = st.one_of(
    _good.map(lambda steps: ([_OPEN, *steps, _OPEN, _STEP], "FAILED_PRECONDITION")),
    _good.map(lambda steps: ([_STEP, _OPEN, *steps], "FAILED_PRECONDITION")),
    _good.map(lambda steps: ([_OPEN, *steps, _EMPTY], "FAILED_PRECONDITION")),
    st.just(([pb.AnimateRequest(close=pb.Close())], "FAILED_PRECONDITION")),
    st.just(([], "FAILED_PRECONDITION")),
    st.text("abcxyz", min_size=1, max_size=8).map(
        lambda name: ([_opening(library=name)], "NOT_FOUND")
    ),
    st.sampled_from([1.0, 9.9, 241.0, float("nan")]).map(
        lambda rate: ([_opening(rate_hz=rate)], "INVALID_ARGUMENT")
    ),
    st.sampled_from([0, 4097]).map(lambda n: ([_crowd(n)], "INVALID_ARGUMENT")),
    st.text("ab", min_size=1, max_size=5).map(
        lambda token: ([_opening(resume_token=token)], "UNIMPLEMENTED")
    ),
    st.integers(270_000, 290_000).map(
        lambda n: ([_OPEN, _step(velocity_xz=[1.0] * n)], "RESOURCE_EXHAUSTED")
    ),
)
"""Messages, and the status that their stream must end with."""
