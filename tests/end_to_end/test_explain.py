"""A recorded session explains itself: every frame, whether it jumped or stayed."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from stridewire import Client
from stridewire._messages import CharacterSpec, Detail
from stridewire.commands import main
from stridewire.formats.session_file import SessionFile
from stridewire.scripts import script
from stridewire.session_recording import RecordingTransport
from stridewire_engine.library import Library
from stridewire_engine.replaying.inspection import Moment, inspect
from stridewire_engine.replaying.replay import recorded


def run(*arguments: object) -> Result:
    """Run the command line in this process."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def recording(small_library: Library, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Record two characters that turn to and fro for three seconds."""
    path = tmp_path_factory.mktemp("explain") / "session.jsonl"
    inner = Client.in_process(small_library.path)._transport
    with (
        Client(RecordingTransport(inner, path)) as client,
        client.open_session(2, seed=4, detail=Detail.COSTS) as session,
    ):
        controls = script("u-turns").controls
        for i in range(180):
            session.step(*controls(i / 60.0, 2, 4))
    return path


@pytest.fixture(scope="module")
def moments(recording: Path, small_library: Library) -> list[Moment]:
    """Return the second character's frames, explained."""
    return list(inspect(SessionFile.open(recording), small_library, 1))


def test_what_is_explained_is_what_happened(recording: Path, moments: list[Moment]) -> None:
    """Jumps, costs and biases are those of the recorded events, frame by frame."""
    frames = list(recorded(SessionFile.open(recording)))
    assert [m.frame for m in moments] == [frame.frame for frame in frames]
    jumps = {
        event.frame: event
        for frame in frames
        for event in frame.events
        if hasattr(event, "to_clip") and event.character == 1
    }
    assert {m.frame for m in moments if m.transition is not None} == set(jumps)
    assert len(jumps) > 2
    for moment in moments:
        if moment.transition is not None and moment.stay is not None:
            event = jumps[moment.frame]
            assert moment.stay.cost == pytest.approx(event.stay_cost)
            assert moment.bias == pytest.approx(event.bias)
            assert moment.candidates[0].clip == event.to_clip
            assert moment.candidates[0].cost == pytest.approx(event.cost)


def test_why_a_transition_is_not_refined_is_explained(
    small_library: Library, tmp_path: Path
) -> None:
    """At 30 frames/s the network is not asked, and the verdict says so."""
    path = tmp_path / "slow.jsonl"
    inner = Client.in_process(small_library.path)._transport
    with (
        Client(RecordingTransport(inner, path)) as client,
        client.open_session([CharacterSpec(0, stitcher="refine")], seed=4) as session,
    ):
        controls = script("u-turns").controls
        for i in range(60):
            session.step(*controls(i / 30.0, 1, 4), dt=1 / 30)
    verdicts = [
        m.verdict for m in inspect(SessionFile.open(path), small_library, 0) if m.transition
    ]
    assert len(verdicts) > 1
    assert not any("not refined" in verdict for verdict in verdicts[:1])  # the beginning
    assert all(verdict.endswith("; not refined: other rate") for verdict in verdicts[1:])


def test_staying_is_explained_too(moments: list[Moment]) -> None:
    """Where a search was made and nothing jumped, the best other was not better by the bias."""
    stays = [m for m in moments if m.searched and m.transition is None]
    assert stays
    for moment in stays:
        assert moment.stay is not None
        assert moment.candidates[0].cost + moment.bias >= moment.stay.cost
        assert sum(moment.stay.channels.values()) == pytest.approx(moment.stay.cost)
        assert "stays" in moment.verdict
    waiting = [m for m in moments if not m.searched]
    assert all("no search" in m.verdict or "does not search" in m.verdict for m in waiting)


def test_what_the_stitcher_hid_fades(moments: list[Moment]) -> None:
    """Right after a jump joints are farther from the clip than they were just before it."""
    hidden = np.array([m.hidden.mean_cm for m in moments])
    jumps = [i for i, m in enumerate(moments) if m.transition is not None and i > 0]
    assert np.mean(hidden[jumps]) > np.mean([hidden[i - 1] for i in jumps])
    assert hidden[0] == pytest.approx(0.0, abs=1.0)


def test_the_command_tells_draws_and_refuses(
    recording: Path, small_library: Library, tmp_path: Path
) -> None:
    """A table by jumps or of one frame, JSON, a PNG; a frame that is not there is an error."""
    over = ("explain", recording, "--library", small_library.path, "--character", 1)
    listed = run(*over)
    assert listed.exit_code == 0, listed.output
    assert "searches" in listed.output
    drawn = tmp_path / "timeline.png"
    one = run(*over, "--at", 1.0, "--png", drawn)
    assert "candidate" in one.output
    assert "trajectory-direction" in one.output
    assert drawn.read_bytes().startswith(b"\x89PNG")
    (row,) = json.loads(run(*over, "--frame", 60, "--json").stdout)["rows"]
    assert row["frame"] == 60
    assert row["candidates"]
    assert run(*over, "--frame", 9999).exit_code != 0
    assert run(*over, "--frame", 1, "--at", 1.0).exit_code != 0
