"""Sessions: what is admitted, what is refused by name, and that one bad row harms nobody else."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from stridewire._errors import InvalidRequestError, NotFoundError, NotImplementedYetError
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    CorrectionMode,
    Detail,
    Edit,
    Frame,
    FrameFlag,
    Ground,
    GroundPose,
    Open,
    PoseFormat,
    RootCorrection,
    Sparse,
    Step,
    Trajectory,
    Transition,
)
from stridewire.motion import quaternion
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.runtime import Runtime, Session
from unit.runtime.conftest import DT, opening

Walk = Callable[..., Iterator[Frame]]
NAN = float("nan")
CHANNELS = [channel.name for channel in LOCOMOTION.channels]


def one(runtime: Runtime, session: Session, step: Step) -> tuple[Frame, list[str]]:
    """Advance by a step and return the frame and the fields that were refused."""
    ((frame, error),) = runtime.advance([(session, step)])
    return frame, [violation.field for violation in error.violations] if error else []


# --- open ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"characters": []}, "open.characters"),
        ({"characters": [CharacterSpec(i) for i in range(4097)]}, "open.characters"),
        ({"characters": [CharacterSpec(1), CharacterSpec(1)]}, "open.characters[1].id"),
        ({"characters": [CharacterSpec(-1)]}, "open.characters[0].id"),
        ({"characters": [CharacterSpec(2**32)]}, "open.characters[0].id"),
        (
            {"characters": [CharacterSpec(1, GroundPose((NAN, 0, 0)))]},
            "open.characters[0].root.position.x",
        ),
        (
            {"characters": [CharacterSpec(1, GroundPose((0, 0, 1.1e6)))]},
            "open.characters[0].root.position.z",
        ),
        ({"characters": [CharacterSpec(1, GroundPose(yaw=NAN))]}, "open.characters[0].root.yaw"),
        ({"characters": [CharacterSpec(1, stitcher="glue")]}, "open.characters[0].stitcher"),
        ({"rate_hz": 9.9}, "open.rate_hz"),
        ({"rate_hz": 240.1}, "open.rate_hz"),
        ({"rate_hz": NAN}, "open.rate_hz"),
        ({"max_frames_in_flight": 3601}, "open.max_frames_in_flight"),
        ({"max_frames_in_flight": -1}, "open.max_frames_in_flight"),
        ({"seed": -1}, "open.seed"),
        ({"characters": [CharacterSpec(1, filter="wlk")]}, "open.characters[0].filter"),
        ({"characters": [CharacterSpec(1, filter="walk & idle")]}, "open.characters[0].filter"),
        ({"characters": [CharacterSpec(1, weights={"a": 1})]}, "open.characters[0].weights['a']"),
        (
            {"characters": [CharacterSpec(1, weights={"foot-position": NAN})]},
            "open.characters[0].weights['foot-position']",
        ),
        (
            {"characters": [CharacterSpec(1, weights={"foot-position": -0.1})]},
            "open.characters[0].weights['foot-position']",
        ),
        (
            {"characters": [CharacterSpec(1, weights=dict.fromkeys(CHANNELS, 0.0))]},
            "open.characters[0].weights",
        ),
    ],
)
def test_a_bad_open_is_refused_naming_the_field(
    runtime: Runtime, changes: dict, field: str
) -> None:
    """Each limit of Open is an error with its path, and nothing is left of the session."""
    with pytest.raises(InvalidRequestError) as caught:
        runtime.open(opening(1, **changes))
    assert field in [violation.field for violation in caught.value.violations]
    assert runtime.info().characters == 0


@pytest.mark.parametrize(
    "changes",
    [
        {"characters": [CharacterSpec(2**32 - 1, GroundPose((1e6, 0, -1e6), -700.0))]},
        {"characters": [CharacterSpec(i) for i in range(4096)]},
        {"rate_hz": 10.0},
        {"rate_hz": 240.0},
        {"max_frames_in_flight": 0},
        {"max_frames_in_flight": 3600},
    ],
)
def test_limits_themselves_are_allowed(runtime: Runtime, changes: dict) -> None:
    """A value on the limit is good."""
    session = runtime.open(opening(1, **changes))
    assert len(session) >= 1


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"output_skeleton": REFERENCE}, "open.output_skeleton"),
        ({"format": PoseFormat.F16}, "open.format"),
        ({"resume_token": "x"}, "open.resume_token"),
        ({"characters": [CharacterSpec(1, height_m=1.8)]}, "open.characters[0].height_m"),
        (
            {"characters": [CharacterSpec(1, responsiveness=0.0)]},
            "open.characters[0].responsiveness",
        ),
        ({"characters": [CharacterSpec(1, rate_divider=2)]}, "open.characters[0].rate_divider"),
    ],
)
def test_fields_of_later_versions_are_refused_by_name(
    runtime: Runtime, changes: dict, field: str
) -> None:
    """What is not there yet is said to be so, and which field it is."""
    with pytest.raises(NotImplementedYetError, match="not implemented yet") as caught:
        runtime.open(opening(1, **changes))
    assert [violation.field for violation in caught.value.violations] == [field]


def test_an_unknown_library_is_not_found(runtime: Runtime) -> None:
    """The error names the libraries that are open."""
    with pytest.raises(NotFoundError, match="small"):
        runtime.open(opening(1, library="large"))


def test_two_libraries_need_two_names(small_library: Library) -> None:
    """A runtime does not guess which of two equal names is meant, and needs one library."""
    with pytest.raises(LibraryError, match="two libraries"):
        Runtime([small_library, small_library])
    with pytest.raises(LibraryError, match="at least one"):
        Runtime([])


# --- step ----------------------------------------------------------------------------------------


def test_one_bad_control_among_256_holds_that_character_alone(runtime: Runtime) -> None:
    """The bad row keeps its previous control and is flagged; all 255 others take the new one."""
    session = runtime.open(opening(256))
    for i in range(60):
        runtime.advance([(session, Step(i, DT, velocity_xz=np.tile([0.0, 1.2], (256, 1))))])
    velocity = np.tile([1.2, 0.0], (256, 1))
    velocity[100, 1] = NAN
    frame, fields = one(runtime, session, Step(61, DT, velocity_xz=velocity))
    assert fields == ["step.velocity_xz[201]"]
    assert frame.flagged(FrameFlag.HELD).tolist() == [110]
    velocity[100] = [np.inf, 0.0]
    for i in range(120):
        frame, _ = one(runtime, session, Step(62 + i, DT, velocity_xz=velocity))
    moved = frame.root[:, [0, 2]] - np.stack([3.0 * np.arange(256), np.zeros(256)], axis=1)
    assert moved[100, 1] > 1.5 * np.abs(moved[100, 0])
    assert np.all(np.delete(moved[:, 0], 100) > 0.5)


@pytest.mark.parametrize("dt", [NAN, -0.001, -np.inf])
def test_a_bad_dt_lets_no_time_pass(runtime: Runtime, walk: Walk, dt: float) -> None:
    """Negative or NaN: refused, told, all held, the same pose again, and the stream goes on."""
    session = runtime.open(opening(2))
    *_, before = walk(session, 0.5, (0.0, 1.0))
    frame, fields = one(runtime, session, Step(9, dt))
    assert fields == ["step.dt_s"]
    assert np.array_equal(frame.rotations, before.rotations)
    assert frame.flagged(FrameFlag.HELD).tolist() == [10, 11]
    frame, fields = one(runtime, session, Step(10, DT))
    assert not fields
    assert not frame.flags.any()


def test_a_long_dt_is_clamped_and_flagged(runtime: Runtime) -> None:
    """Up to 0.25 s a step is taken as it is, above it is cut and said so."""
    session = runtime.open(opening(1))
    frame, fields = one(runtime, session, Step(1, 0.25))
    assert (frame.time_s, fields) == (0.25, [])
    assert not frame.flags.any()
    frame, fields = one(runtime, session, Step(2, 7.0))
    assert (frame.time_s, fields) == (0.5, [])
    assert frame.flagged(FrameFlag.DT_CLAMPED).tolist() == [10]


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"velocity_xz": np.zeros((3, 2))}, "step.velocity_xz"),
        ({"velocity_xz": np.zeros(4)}, "step.velocity_xz"),
        ({"velocity_xz": [[0, 20.01], [0, 0]]}, "step.velocity_xz[1]"),
        ({"facing_yaw": np.zeros(3)}, "step.facing_yaw"),
        ({"facing_yaw": [0.0, np.inf]}, "step.facing_yaw[1]"),
        ({"characters": np.array([10, 99])}, "step.characters[1]"),
    ],
)
def test_bad_controls_are_told_by_path(runtime: Runtime, changes: dict, field: str) -> None:
    """Wrong lengths, values out of range and unknown ids never raise and name their field."""
    session = runtime.open(opening(2))
    _, fields = one(runtime, session, Step(1, DT, **changes))
    assert fields == [field]


def test_ids_choose_whom_a_control_is_for(runtime: Runtime) -> None:
    """Controls may name some characters in any order; the others hold theirs."""
    session = runtime.open(opening(3))
    one(runtime, session, Step(1, DT, velocity_xz=np.tile([0.0, 1.0], (3, 1))))
    ids = np.array([12, 10])
    one(runtime, session, Step(2, DT, characters=ids, velocity_xz=[[2.0, 0.0], [3.0, 0.0]]))
    wanted = session.crowd.state.desired_velocity[session.rows]
    assert wanted.tolist() == [[3.0, 0.0], [0.0, 1.0], [2.0, 0.0]]


def test_a_facing_turns_a_character_that_walks_elsewhere(runtime: Runtime) -> None:
    """Heading and direction of travel are independent; NaN means along the velocity."""
    session = runtime.open(opening(1))
    velocity = [[0.0, 0.8]]
    for i in range(240):
        frame, _ = one(runtime, session, Step(i, DT, velocity_xz=velocity, facing_yaw=[1.2]))
    assert quaternion.to_yaw(frame.root[0, 3:]) > 0.5
    for i in range(240):
        frame, _ = one(runtime, session, Step(i, DT, velocity_xz=velocity, facing_yaw=[NAN]))
    assert abs(quaternion.to_yaw(frame.root[0, 3:])) < 0.5


@pytest.mark.parametrize(
    ("sparse", "field"),
    [
        (Sparse(99), "step.sparse[0].character"),
        (Sparse(10, filter="wlk"), "step.sparse[0].filter"),
        (Sparse(10, filter="walk & idle"), "step.sparse[0].filter"),
        (Sparse(10, gait="hop"), "step.sparse[0].gait"),
        (Sparse(10, gait="walk", filter="walk"), "step.sparse[0].gait"),
        (Sparse(10, ground=Ground()), "step.sparse[0].ground"),
        (
            Sparse(10, root_correction=RootCorrection(GroundPose((NAN, 0, 0)))),
            "step.sparse[0].root_correction.root.position.x",
        ),
        (
            Sparse(10, root_correction=RootCorrection(GroundPose(yaw=np.inf))),
            "step.sparse[0].root_correction.root.yaw",
        ),
        (
            Sparse(10, Trajectory(np.zeros((0, 2)), np.zeros(0))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((33, 2)), np.linspace(0, 1, 33))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((2, 2)), np.array([1.0, 1.0]))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((2, 2)), np.array([0.0, 10.1]))),
            "step.sparse[0].trajectory.times_s",
        ),
        (
            Sparse(10, Trajectory(np.zeros((3, 2)), np.array([0.0, 1.0]))),
            "step.sparse[0].trajectory.positions_xz",
        ),
        (
            Sparse(10, Trajectory(np.full((1, 2), NAN), np.zeros(1))),
            "step.sparse[0].trajectory.positions_xz",
        ),
        (
            Sparse(10, Trajectory(np.zeros((1, 2)), np.zeros(1), np.array([NAN]))),
            "step.sparse[0].trajectory.facings_yaw",
        ),
    ],
)
def test_bad_sparse_controls_are_told_by_path(runtime: Runtime, sparse: Sparse, field: str) -> None:
    """Whatever is wrong with one character's rarer controls is named; the stream goes on."""
    session = runtime.open(opening(2))
    frame, fields = one(runtime, session, Step(1, DT, sparse=[sparse]))
    assert fields == [field]
    assert frame.flagged(FrameFlag.HELD).tolist() == ([10] if sparse.character == 10 else [])


def test_a_trajectory_is_followed_until_the_next_velocity(runtime: Runtime) -> None:
    """A character walks a given path, stops at its end, and obeys velocities again afterwards."""
    session = runtime.open(opening(1))
    path = Trajectory(np.array([[0, 0], [0, 2], [2, 2.0]]), np.array([0.0, 2.0, 4.0]))
    one(runtime, session, Step(0, DT, sparse=[Sparse(10, trajectory=path)]))
    for i in range(420):
        frame, _ = one(runtime, session, Step(i, DT))
    assert np.linalg.norm(frame.root[0, [0, 2]] - [2.0, 2.0]) < 0.5
    for i in range(180):
        frame, _ = one(runtime, session, Step(i, DT, velocity_xz=[[0.0, -1.4]]))
    assert frame.root[0, 2] < 1.0


def test_a_teleport_moves_at_once_and_starts_anew(runtime: Runtime, walk: Walk) -> None:
    """The root is there in the same frame, its delta is not a leap, the flag says so."""
    session = runtime.open(opening(2))
    list(walk(session, 1.0, (0.0, 1.4)))
    there = RootCorrection(GroundPose((50.0, 2.0, -20.0), 1.0), CorrectionMode.TELEPORT)
    frame, _ = one(runtime, session, Step(1, DT, sparse=[Sparse(11, root_correction=there)]))
    assert np.allclose(frame.root[1, :3], [50.0, 2.0, -20.0], atol=0.1)
    assert np.linalg.norm(frame.root_delta[1, :3]) < 0.1
    assert frame.flagged(FrameFlag.TELEPORTED).tolist() == [11]
    assert np.isfinite(frame.rotations).all()
    assert np.linalg.norm(frame.root[0, :3]) < 5.0


def test_an_adjustment_blends(runtime: Runtime, walk: Walk) -> None:
    """A corrected root goes there within half a second, no frame by more than a part of the way."""
    session = runtime.open(opening(1))
    *_, before = walk(session, 1.0, (0.0, 0.0))
    goal = (0.5, 0.0, 0.3)
    correction = RootCorrection(GroundPose(goal, 0.0), CorrectionMode.ADJUST)
    sparse = [Sparse(10, root_correction=correction)]
    positions = [before.root[0, :3]]
    frame, _ = one(runtime, session, Step(0, DT, sparse=sparse))
    positions.append(frame.root[0, :3])
    for i in range(60):
        frame, _ = one(runtime, session, Step(i, DT))
        positions.append(frame.root[0, :3])
        assert np.linalg.norm(frame.root_delta[0, :3]) < 0.02
    assert np.linalg.norm(positions[-1] - goal) < 0.06
    assert np.linalg.norm(np.diff(positions, axis=0), axis=1).max() < 0.1


def test_a_forced_search_searches_now(runtime: Runtime, walk: Walk) -> None:
    """`force_search` resets the character's clock, whatever its interval."""
    session = runtime.open(opening(2))
    list(walk(session, 0.5, (0.0, 1.0)))
    state = session.crowd.state
    state.until_search[session.rows] = 10.0
    one(runtime, session, Step(1, DT, sparse=[Sparse(10, force_search=True)]))
    assert state.until_search[session.rows[0]] < 1.0
    assert state.until_search[session.rows[1]] > 9.0


# --- edit ----------------------------------------------------------------------------------------


def test_characters_come_and_go(runtime: Runtime) -> None:
    """Frames follow the roster: order of adding, removed ones gone, rows given back."""
    session = runtime.open(opening(3))
    edit = Edit(add=[CharacterSpec(50)], remove=[11])
    assert runtime.edit(session, edit) is None
    frame, _ = one(runtime, session, Step(1, DT))
    assert frame.characters.tolist() == [10, 12, 50]
    assert frame.rotations.shape == (3, 22, 4)
    assert runtime.info().characters == 3
    runtime.close(session)
    runtime.close(session)
    assert runtime.info().characters == runtime.info().sessions == 0


def test_a_new_character_does_not_disturb_the_others(small_library: Library) -> None:
    """Adding and removing neighbours leaves a character's stream as it would have been."""
    frames = []
    for busy in (False, True):
        runtime = Runtime([small_library], clock=lambda: 0.0)
        session = runtime.open(opening(1))
        for i in range(120):
            if busy and i % 10 == 5:
                runtime.edit(session, Edit(add=[CharacterSpec(100 + i)]))
            if busy and i % 20 == 15:
                runtime.edit(session, Edit(remove=[100 + i - 10]))
            step = Step(i, DT, characters=np.array([10]), velocity_xz=[[0.0, 1.4]])
            frame, _ = one(runtime, session, step)
        frames.append(frame)
    assert np.allclose(frames[0].root[0], frames[1].root[0], atol=1e-5)
    assert np.allclose(frames[0].rotations[0], frames[1].rotations[0], atol=1e-5)


@pytest.mark.parametrize(
    ("edit", "field"),
    [
        (Edit(remove=[99]), "edit.remove[0]"),
        (Edit(remove=[10, 11]), "edit.remove[1]"),
        (Edit(add=[CharacterSpec(10)]), "edit.add[0].id"),
        (Edit(add=[CharacterSpec(20), CharacterSpec(20)]), "edit.add[1].id"),
        (Edit(add=[CharacterSpec(20, filter="(walk")]), "edit.add[0].filter"),
        (Edit(add=[CharacterSpec(20, rate_divider=2)]), "edit.add[0].rate_divider"),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(99), ("stitcher",))]),
            "edit.update[0].spec.id",
        ),
        (Edit(update=[CharacterUpdate(CharacterSpec(10), ())]), "edit.update[0].mask"),
        (Edit(update=[CharacterUpdate(CharacterSpec(10), ("root",))]), "edit.update[0].mask"),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(10), ("responsiveness",))]),
            "edit.update[0].spec.responsiveness",
        ),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(10, filter="!"), ("filter",))]),
            "edit.update[0].spec.filter",
        ),
        (
            Edit(update=[CharacterUpdate(CharacterSpec(10, stitcher="glue"), ("stitcher",))]),
            "edit.update[0].spec.stitcher",
        ),
    ],
)
def test_bad_edits_are_told_by_path(runtime: Runtime, edit: Edit, field: str) -> None:
    """What is wrong with an edit is left out and named; the rest of it holds."""
    session = runtime.open(opening(2))
    error = runtime.edit(session, edit)
    assert error is not None
    assert [violation.field for violation in error.violations] == [field]
    frame, _ = one(runtime, session, Step(1, DT))
    assert len(frame.characters) >= 1


def test_a_session_holds_no_more_than_its_limit(small_library: Library) -> None:
    """The 4,097th character is refused."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    session = runtime.open(opening(4096))
    error = runtime.edit(session, Edit(add=[CharacterSpec(1)]))
    assert error is not None
    assert "4096" in error.violations[0].description


def test_updates_change_what_the_mask_names(runtime: Runtime) -> None:
    """Stitcher and foot lock may change while the character runs, and nothing else does."""
    session = runtime.open(opening(1))
    spec = CharacterSpec(10, stitcher="none", foot_lock=False)
    assert runtime.edit(session, Edit(update=[CharacterUpdate(spec, ("foot_lock",))])) is None
    state = session.crowd.state
    row = session.rows[0]
    assert (bool(state.foot_lock[row]), int(state.stitcher[row])) == (False, 0)
    assert runtime.edit(session, Edit(update=[CharacterUpdate(spec, ("stitcher",))])) is None
    assert int(state.stitcher[row]) == 1


# --- frames --------------------------------------------------------------------------------------


def test_frames_count_and_echo(runtime: Runtime) -> None:
    """Frames number from 1 and carry the step and the caller's clock."""
    session = runtime.open(opening(1))
    for i in range(1, 4):
        frame, _ = one(runtime, session, Step(100 + i, DT, client_time_s=5.5 * i))
        assert (frame.frame, frame.applied_step, frame.client_time_s) == (i, 100 + i, 5.5 * i)
    assert frame.time_s == pytest.approx(3 * DT)


def test_violations_are_listed_up_to_a_hundred(runtime: Runtime) -> None:
    """A thousand bad rows give a hundred violations and the number of the others."""
    session = runtime.open(opening(600))
    ((_, error),) = runtime.advance([(session, Step(1, DT, velocity_xz=np.full((600, 2), NAN)))])
    assert error is not None
    assert (len(error.violations), error.more) == (100, 1100)


def test_detail_none_sends_no_events(runtime: Runtime) -> None:
    """Without detail there are no events and no simulated roots; with events, no costs."""
    quiet = runtime.open(opening(1, detail=Detail.NONE))
    frame, _ = one(runtime, quiet, Step(1, DT))
    assert not frame.events
    assert frame.simulated_root is None
    plain = runtime.open(opening(1, detail=Detail.EVENTS))
    frame, _ = one(runtime, plain, Step(1, DT))
    start = next(event for event in frame.events if isinstance(event, Transition))
    assert (start.cost, start.channels) == (0.0, {})


def test_a_session_paced_by_a_clock_holds_its_controls(runtime: Runtime) -> None:
    """Controls given apart from the tick hold for every following one."""
    session = runtime.open(opening(1))
    assert runtime.control(session, Step(5, velocity_xz=[[0.0, 1.4]], client_time_s=2.0)) is None
    for _ in range(180):
        frame, _ = one(runtime, session, session.held_step(DT))
    assert (frame.applied_step, frame.client_time_s) == (5, 2.0)
    assert frame.root[0, 2] > 1.5


def test_rows_are_used_again(small_library: Library) -> None:
    """Opening and closing sessions a hundred times does not grow the crowd."""
    runtime = Runtime([small_library], clock=lambda: 0.0)
    keep = runtime.open(opening(3))
    for _ in range(100):
        session = runtime.open(opening(5))
        one(runtime, session, Step(1, DT))
        runtime.close(session)
    assert len(keep.crowd.state) <= 16
    one(runtime, keep, Step(1, DT))


def test_open_is_copied_not_kept(runtime: Runtime) -> None:
    """A different seed staggers the searches differently, the same one alike."""
    clocks = []
    for seed in (1, 1, 2):
        session = runtime.open(replace(opening(4), seed=seed))
        clocks.append(session.crowd.state.until_search[session.rows].tolist())
    assert clocks[0] == clocks[1] != clocks[2]
    assert isinstance(opening(1), Open)
