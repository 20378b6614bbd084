"""Recorded sessions replay: the same clips, times and poses; or what would have differed."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from serving import DEADLINE_S, Serve
from stridewire import CharacterSpec, Client, GroundPose, Pacing, Sparse
from stridewire._messages import CharacterUpdate, Trajectory
from stridewire.commands import main
from stridewire.formats.session_file import SessionFile, SessionWriter
from stridewire.scripts import script
from stridewire.session_recording import RecordingTransport
from stridewire_engine.building import build_library
from stridewire_engine.building.synthetic import synthetic_clips
from stridewire_engine.library import Library
from stridewire_engine.replaying.comparison import Track, compare
from stridewire_engine.replaying.replay import Variant, recorded, replay
from stridewire_engine.runtime import Runtime


def run(*arguments: object) -> Result:
    """Run the command line in this process."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def play(client: Client) -> None:
    """Drive characters that come, go, jump and follow paths."""
    with client.open_session(3, seed=4) as session:
        controls = script("random-stick").controls
        for i in range(150):
            session.step(*controls(i / 60.0, len(session.characters), 4))
        session.edit(add=[CharacterSpec(50, GroundPose((3.0, 0.0, 1.0), 1.0))], remove=[1])
        path = Trajectory(np.float32([[0, 1], [1, 2]]), np.float32([0.5, 1.5]))
        session.step(sparse=[Sparse(0, trajectory=path), Sparse(2, filter="walk")])
        session.edit(update=[CharacterUpdate(CharacterSpec(2, stitcher="none"), ("stitcher",))])
        session.teleport(50, (-4.0, 0.5, 2.0), 2.0)
        for _ in range(90):
            session.step(dt=1 / 45)


@pytest.mark.parametrize("over_wire", [False, True])
def test_a_recorded_session_replays(
    serve: Serve, small_library: Library, tmp_path: Path, over_wire: bool
) -> None:
    """Recorded over the wire or in this process, the same comes out of a fresh runtime."""
    inner = Client(serve(), DEADLINE_S) if over_wire else Client.in_process(small_library.path)
    path = tmp_path / "session.jsonl"
    with Client(RecordingTransport(inner._transport, path)) as client:
        play(client)
    file = SessionFile.open(path)
    difference = compare(Track.of(replay(file, small_library)), Track.of(recorded(file)))
    assert difference.same, difference
    assert difference.frames == 241
    assert difference.transitions > 5


def test_a_session_paced_by_the_server_replays(
    serve: Serve, small_library: Library, tmp_path: Path
) -> None:
    """The server records what its clock decided: when time passed and which controls held."""
    path = tmp_path / "paced.jsonl"
    runtime = Runtime(
        [small_library], record=lambda opening, opened: SessionWriter(path, opening, opened)
    )
    # the server warms up with a session of its own, which comes first and is written over
    address = serve(runtime)
    with (
        Client(address, timeout_s=DEADLINE_S) as client,
        client.open_session(2, pacing=Pacing.SERVER, rate_hz=120.0) as session,
    ):
        session.control(velocity=(0.0, 1.3))
        for frame in session.frames():
            if frame.frame % 20 == 10:
                session.control(
                    velocity=[(1.0, 0.0), (0.0, -1.0)] if frame.frame % 40 == 10 else (0, 0)
                )
            if frame.frame >= 120:
                break
    file = SessionFile.open(path)
    assert file.opening.pacing is Pacing.SERVER
    difference = compare(Track.of(replay(file, small_library)), Track.of(recorded(file)))
    assert difference.same, difference
    assert difference.frames >= 120


def test_a_variant_is_told_apart(small_library: Library, tmp_path: Path) -> None:
    """Another stitcher keeps the jumps that came before its first effect; weights change them."""
    path = tmp_path / "session.jsonl"
    inner = Client.in_process(small_library.path)._transport
    with Client(RecordingTransport(inner, path)) as client:
        play(client)
    file = SessionFile.open(path)
    before = Track.of(recorded(file))
    cut = compare(Track.of(replay(file, small_library, Variant("none"))), before)
    assert not cut.same
    assert cut.first_difference_s is not None
    weights = {"trajectory-position": 0.0, "trajectory-direction": 0.0}
    blind = compare(Track.of(replay(file, small_library, Variant(weights=weights))), before)
    assert blind.shared_transitions < before_count(before)
    assert blind.root_apart_max_m > 0.3


def before_count(track: Track) -> int:
    """Return the number of jumps of a replay."""
    return len(track.jumps)


def test_the_command(small_library: Library, tmp_path: Path) -> None:
    """Records, replays, compares two libraries; words, JSON and exit codes."""
    walks = [clip for clip in synthetic_clips() if clip.name.startswith(("idle", "walk-1", "stop"))]
    other = build_library(
        walks, tmp_path / "other", name="other", synthetic=True, licence="", mirror=False
    )
    path = tmp_path / "walk.jsonl"
    recording = run("stream", "--library", small_library.path, "--seconds", 3, "--record", path)
    assert recording.exit_code == 0, recording.output
    assert f"wrote       {path}" in recording.output
    again = run("replay", path, "--library", small_library.path)
    assert again.exit_code == 0, again.output
    assert "the same clips and times, poses to 1e-5" in again.output
    against = ("--against", small_library.path, "--against", other.path, "--stitch", "none")
    told = json.loads(run("replay", path, *against, "--json").output)
    assert [(row["library"], row["same"]) for row in told["rows"]] == [
        ("small", False),
        ("other", False),
    ]
    assert told["settings"]["recorded_library_hash"] == small_library.manifest.content_hash
    wrong = run("replay", path, "--library", other.path)
    assert wrong.exit_code == 2
    assert "was recorded over library 'small'" in wrong.output
    glue = run("replay", path, "--library", small_library.path, "--stitch", "glue")
    assert glue.exit_code == 2
    assert "'glue' is not present" in glue.output
