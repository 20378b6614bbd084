"""Every limit of the contract, at the limit and just beyond it, over the wire and in process."""

from typing import Any

import numpy as np
import pytest

from stridewire import (
    CharacterSpec,
    Client,
    ClipTime,
    CorrectionMode,
    DesiredMotion,
    GroundPose,
    InvalidRequestError,
    RootCorrection,
    Sparse,
    Trajectory,
)
from stridewire._messages import ClipsQuery
from stridewire_engine.library import Library

NAN = float("nan")
MAX_ID = 2**32 - 1


def character(**given: Any) -> dict[str, Any]:
    """Return arguments of `open_session` for one character."""
    return {"characters": [CharacterSpec(given.pop("id", 0), **given)]}


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> GroundPose:
    """Return a place."""
    return GroundPose((x, y, z))


OPEN = [
    # field, good values, bad values
    ("open.characters", [{"characters": 1}, {"characters": 4096}],
     [{"characters": 0}, {"characters": 4097}]),
    ("open.rate_hz", [{"rate_hz": 10.0}, {"rate_hz": 240.0}],
     [{"rate_hz": 9.99}, {"rate_hz": 240.01}, {"rate_hz": NAN}]),
    ("open.max_frames_in_flight", [{"max_frames_in_flight": 0}, {"max_frames_in_flight": 3600}],
     [{"max_frames_in_flight": 3601}]),
    ("open.characters[0].id", [character(id=0), character(id=MAX_ID)], []),
    ("open.characters[0].height_m", [character(height_m=0.5), character(height_m=3.0)],
     [character(height_m=0.49), character(height_m=3.01)]),
    ("open.characters[0].root.position.x", [character(root=at(x=1e6)), character(root=at(x=-1e6))],
     [character(root=at(x=1.1e6)), character(root=at(x=-1.1e6)), character(root=at(x=NAN))]),
    ("open.characters[0].filter", [character(filter="!walk" + "|walk" * 199)],
     [character(filter="!walk " + "|walk" * 199)]),
    ("open.characters[0].weights['trajectory-position']",
     [character(weights={"trajectory-position": w}) for w in (0.0, 1e6)],
     [character(weights={"trajectory-position": w}) for w in (-0.1, 1.1e6, NAN)]),
]  # fmt: skip


@pytest.mark.parametrize(("field", "good", "bad"), OPEN, ids=[row[0] for row in OPEN])
def test_open(either: Client, field: str, good: list[Any], bad: list[Any]) -> None:
    """What is on the limit opens; what is beyond is refused by the field's path."""
    for given in good:
        with either.open_session(**given) as session:
            assert session.characters
    for given in bad:
        with pytest.raises(InvalidRequestError) as raised:
            either.open_session(**given).__enter__()
        assert [violation.field for violation in raised.value.violations] == [field], given


def path(count: int, last_s: float = 1.0, far: float = 1.0) -> dict[str, Any]:
    """Return a control that gives a trajectory."""
    positions = np.full((count, 2), far, np.float32)
    times = np.linspace(0.0, last_s, count + 1, dtype=np.float32)[1:]
    return {"sparse": [Sparse(0, trajectory=Trajectory(positions, times))]}


def correction(x: float) -> dict[str, Any]:
    """Return a control that corrects the root."""
    root = RootCorrection(at(x=x), CorrectionMode.ADJUST)
    return {"sparse": [Sparse(0, root_correction=root)]}


STEP = [
    ("step.dt_s", [{"dt": 0.0}, {"dt": 0.25}], [{"dt": -1e-9}, {"dt": NAN}]),
    ("step.velocity_xz[1]", [{"velocity": (0.0, 20.0)}, {"velocity": (0.0, -20.0)}],
     [{"velocity": (0.0, 20.01)}, {"velocity": (0.0, -20.01)}, {"velocity": (0.0, NAN)}]),
    ("step.facing_yaw[0]", [{"facing": 1e6}, {"facing": NAN}], [{"facing": float("inf")}]),
    ("step.sparse[0].trajectory.times_s", [path(1), path(32), path(2, 10.0)],
     [path(0), path(33), path(2, 10.01)]),
    ("step.sparse[0].trajectory.positions_xz", [path(2, far=1e6)], [path(2, far=1.1e6)]),
    ("step.sparse[0].root_correction.root.position.x", [correction(1e6)], [correction(1.1e6)]),
]  # fmt: skip


@pytest.mark.parametrize(("field", "good", "bad"), STEP, ids=[row[0] for row in STEP])
def test_step(either: Client, field: str, good: list[Any], bad: list[Any]) -> None:
    """What is on the limit is taken; what is beyond is refused in the stream."""
    with either.open_session() as session:
        for given in good:
            session.step(**given)
        assert not session.errors
        for given in bad:
            session.errors.clear()
            session.step(**given)
            (error,) = session.errors
            assert [violation.field for violation in error.violations] == [field], given


def test_a_step_above_the_longest_is_clamped_and_flagged(either: Client) -> None:
    """0.25 s pass, whatever more was asked for."""
    with either.open_session() as session:
        assert session.step(dt=0.25).flags.tolist() == [0]
        frame = session.step(dt=0.26)
        assert frame.time_s == pytest.approx(0.5)
        assert frame.flags.tolist() == [1 << 1]


def test_search(either: Client, small_library: Library) -> None:
    """k, time, velocity and exclusions."""
    entry = small_library.clips[0]
    length = (entry.frames - 1) / small_library.frame_rate
    few = [ClipTime(entry.name, 0.0)] * 64
    for good in ({"k": 1}, {"k": 1000}, {"time_s": length}, {"exclude": few},
                 {"intent": DesiredMotion(20.0, -20.0)}):  # fmt: skip
        assert either.search(entry.name, **good).library == "small"
    for field, bad in {
        "k": {"k": 1001},
        "pose.clip.time_s": {"time_s": length + 0.01},
        "exclude": {"exclude": [*few, few[0]]},
        "motion.velocity_x": {"intent": DesiredMotion(20.01, 0.0)},
    }.items():
        with pytest.raises(InvalidRequestError) as raised:
            either.search(entry.name, **bad)
        assert [violation.field for violation in raised.value.violations] == [field]


def test_pages(either: Client, small_library: Library) -> None:
    """Sizes 1 to 1000, tokens as they came, also the one behind the last clip."""
    ask = either._transport.ask
    total = len(small_library.clips)
    one = ask(ClipsQuery(page_size=1))
    assert (len(one.clips), one.total, one.next_page_token) == (1, total, "1")
    assert len(ask(ClipsQuery(page_size=1000)).clips) == total
    assert ask(ClipsQuery(page_size=1000)).next_page_token == ""
    assert ask(ClipsQuery(page_token=str(total))).clips == ()
    exact = ask(ClipsQuery(page_size=total))
    assert (len(exact.clips), exact.next_page_token) == (total, "")
    for field, bad in {
        "page_size": ClipsQuery(page_size=1001),
        "page_token": ClipsQuery(page_token=str(total + 1)),
    }.items():
        with pytest.raises(InvalidRequestError) as raised:
            ask(bad)
        assert [violation.field for violation in raised.value.violations] == [field]
    for token in ("-1", "x", "1e3", "٣", "9" * 30):
        with pytest.raises(InvalidRequestError, match="is of no page"):
            ask(ClipsQuery(page_token=token))
