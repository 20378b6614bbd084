"""Recorded sessions survive the disk bit by bit; damage is told with its line."""

from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    Detail,
    Edit,
    Frame,
    GroundPose,
    LibraryInfo,
    Limits,
    Open,
    Opened,
    Pacing,
    PoseFormat,
    Settings,
    Sparse,
    Step,
    Trajectory,
    Transition,
    TransitionReason,
)
from stridewire.formats.session_file import (
    Advance,
    Control,
    SessionFile,
    SessionFileError,
    SessionWriter,
)
from stridewire.motion.skeleton import REFERENCE

INFO = LibraryInfo("toy", "00ff", 1, 1, 60.0, True, "", "", "locomotion")
SETTINGS = Settings(Pacing.SERVER, 30.0, 5, PoseFormat.F32, Detail.EVENTS, 7, "spring")
OPENED = Opened("s1", REFERENCE, INFO, "0", SETTINGS, Limits())
OPENING = Open(
    (CharacterSpec(3, GroundPose((1.0, 0.0, float("nan")), 0.5), weights={"foot": 2.0}),),
    output_skeleton=REFERENCE,
    seed=7,
)


def frame(rng: np.random.Generator) -> Frame:
    """Return a frame of one character with an event."""
    jump = Transition(3, 1, "", 0.0, "walk", 1.25, TransitionReason.START, channels={"foot": 0.1})
    one = np.array([3], np.uint32)
    block = rng.normal(size=(1, 22, 4)).astype(np.float32)
    return Frame(
        *(1, 4, 1 / 60, 0.5, one, block[:, 0, :1].repeat(7, 1), block[:, 1], block[:, 2, :3]),
        *(block, one, np.full((1, 2, 3), np.nan, np.float32), one),
        events=(jump,),
        timings_ms={"search": 1.0},
    )


def assert_same(a: Any, b: Any) -> None:
    """Compare to the bit, types included."""
    assert type(a) is type(b)
    if is_dataclass(a):
        for field in fields(a):
            if field.name != "timings_ms":
                assert_same(getattr(a, field.name), getattr(b, field.name))
    elif isinstance(a, np.ndarray):
        assert a.dtype == b.dtype
        np.testing.assert_array_equal(a, b)
    elif isinstance(a, tuple):
        assert len(a) == len(b)
        for x, y in zip(a, b, strict=True):
            assert_same(x, y)
    else:
        np.testing.assert_equal(a, b)


def test_everything_survives(tmp_path: Path, rng: np.random.Generator) -> None:
    """Open, Opened, controls, edits and frames come back as they were."""
    path = tmp_path / "walk.jsonl"
    way = Trajectory(np.float32([[0, 1]]), np.float32([0.5]))
    step = Step(
        *(4, 0.016, 2, 0.25, np.array([3], np.uint32)),
        velocity_xz=np.float32([[0.1, np.nan]]),
        sparse=(Sparse(3, trajectory=way, gait="walk"),),
    )
    edit = Edit((CharacterSpec(9),), (1, 2), (CharacterUpdate(CharacterSpec(9), ("stitcher",)),))
    shown = frame(rng)
    with SessionWriter(path, OPENING, OPENED) as writer:
        writer.control(step)
        writer.edit(edit)
        writer.advance(step)
        writer.frame(shown)
    file = SessionFile.open(path)
    assert_same(file.opening, OPENING)
    assert_same(file.opened, OPENED)
    for read, written in zip(
        file.entries(), (Control(step), edit, Advance(step), shown), strict=True
    ):
        assert_same(read, written)


def test_a_file_cut_short_is_read_to_its_last_whole_line(tmp_path: Path) -> None:
    """A recorder that was killed leaves a recording that can be used."""
    path = tmp_path / "cut.jsonl"
    with SessionWriter(path, OPENING, OPENED) as writer:
        for number in range(3):
            writer.advance(Step(number))
    path.write_text(path.read_text()[:-20])
    assert [entry.step.step for entry in SessionFile.open(path).entries()] == [0, 1]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "line 1"),
        ("{}\n", "no recorded session"),
        ('{"recording": 99}\n', "no recorded session of format 1"),
        ('{"recording": 1}\n', "`open` or `opened` is missing"),
        ("HIERARCHY\n", "line 1"),
        ('{"recording": {"_": "os.system"}}\n', "line 1"),
    ],
)
def test_what_is_no_recording_is_refused(tmp_path: Path, text: str, says: str) -> None:
    """One typed error that names the file; nothing but messages is ever made of it."""
    path = tmp_path / "other.jsonl"
    path.write_text(text)
    with pytest.raises(SessionFileError, match=says):
        SessionFile.open(path)


def test_a_damaged_line_is_named(tmp_path: Path) -> None:
    """The number of the line stands in the error."""
    path = tmp_path / "damaged.jsonl"
    with SessionWriter(path, OPENING, OPENED) as writer:
        writer.advance(Step(1))
    path.write_text(path.read_text() + '{"advance": 5}\n')
    entries = SessionFile.open(path).entries()
    next(entries)
    with pytest.raises(SessionFileError, match="line 3"):
        next(entries)
