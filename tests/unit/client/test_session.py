"""The session of the client: what it sends, what it makes of what comes, when it acknowledges."""

from collections import deque
from collections.abc import Callable

import numpy as np
import pytest

from stridewire._errors import (
    InvalidRequestError,
    ProtocolError,
    ServerError,
    UnavailableError,
    Violation,
)
from stridewire._messages import (
    CharacterSpec,
    CorrectionMode,
    Detail,
    Edit,
    Frame,
    LibraryInfo,
    Limits,
    Notice,
    Open,
    Opened,
    Pacing,
    PoseFormat,
    ServerMessage,
    Settings,
    Step,
    StreamError,
)
from stridewire._session import Session
from stridewire.motion.skeleton import REFERENCE


def opened(pacing: Pacing, credits: int) -> Opened:
    """Return what a server says first."""
    settings = Settings(pacing, 60.0, credits, PoseFormat.F32, Detail.EVENTS, 0, "spring")
    info = LibraryInfo("toy", "", 1, 1, 60.0, True, "", "", "locomotion")
    return Opened("s1", REFERENCE, info, "0", settings, Limits())


def frame(number: int, step: int = 0) -> Frame:
    """Return a frame of two characters."""
    ids = np.array([0, 1], np.uint32)
    none = np.zeros(2, np.uint32)
    zeros = np.zeros
    return Frame(
        *(number, step, number / 60.0, 0.0, ids, zeros((2, 7)), zeros((2, 4)), zeros((2, 3))),
        *(zeros((2, 22, 4)), none, zeros((2, 2, 3)), none),
    )


class Script:
    """A stream that says what the test lines up, and remembers what it was sent."""

    def __init__(self, pacing: Pacing = Pacing.CLIENT, credits: int = 4) -> None:
        self.opened = opened(pacing, credits)
        self.sent: list[Step | Edit] = []
        self.lined_up: deque[ServerMessage | Exception] = deque()
        self.answer: Callable[[Step], list[ServerMessage]] = lambda step: []
        self.closed = 0

    def send(self, message: Step | Edit) -> None:
        """Remember, and line up the answer."""
        self.sent.append(message)
        if isinstance(message, Step) and not message.ack_only:
            self.lined_up += self.answer(message)

    def receive(self, timeout_s: float) -> ServerMessage | None:
        """Say the next thing."""
        message = self.lined_up.popleft() if self.lined_up else None
        if isinstance(message, Exception):
            raise message
        return message

    def close(self) -> None:
        """Count."""
        self.closed += 1

    @property
    def steps(self) -> list[Step]:
        """What was sent, edits left out."""
        return [message for message in self.sent if isinstance(message, Step)]


def session(stream: Script, characters: int = 2) -> Session:
    """Return a session over a scripted stream."""
    opening = Open([CharacterSpec(i) for i in range(characters)])
    return Session(lambda message: stream, opening, 1.0)


def test_a_step_returns_the_frame_of_its_controls() -> None:
    """Errors and notices on the way are kept, frames of earlier steps passed over."""
    stream = Script()
    refused = StreamError(1, (Violation("step.dt_s", "no"),))
    stream.answer = lambda step: [refused, frame(1, 0), Notice(1, "soon"), frame(2, step.step)]
    driven = session(stream)
    got = driven.step(velocity=[[0, 1], [2, 3]], facing=[0.0, np.nan], dt=0.02)
    assert (got.frame, got.applied_step) == (2, 1)
    assert list(driven.errors) == [refused]
    assert [notice.message for notice in driven.notices] == ["soon"]
    (sent,) = stream.steps
    assert (sent.step, sent.dt_s, sent.last_frame) == (1, 0.02, 0)
    np.testing.assert_array_equal(sent.velocity_xz, np.float32([[0, 1], [2, 3]]))


def test_one_control_is_for_all() -> None:
    """A single velocity or heading is repeated for every character, or for those named."""
    stream = Script()
    driven = session(stream, 3)
    driven.control(velocity=(0.0, 1.5), facing=0.5)
    driven.control(velocity=(1.0, 0.0), characters=[2, 0])
    all_of_them, two = stream.steps
    np.testing.assert_array_equal(all_of_them.velocity_xz, np.float32([[0.0, 1.5]] * 3))
    np.testing.assert_array_equal(all_of_them.facing_yaw, np.float32([0.5] * 3))
    assert all_of_them.characters is None
    np.testing.assert_array_equal(two.velocity_xz, np.float32([[1.0, 0.0]] * 2))
    assert two.characters is not None
    assert two.characters.tolist() == [2, 0]
    assert two.facing_yaw is None


@pytest.mark.parametrize(
    "velocity", [1.0, [1.0], [1.0, 2.0, 3.0], [[1.0, 2.0]] * 3, [[1.0], [2.0]]]
)
def test_a_wrong_shape_is_refused_here(velocity: object) -> None:
    """What cannot be meant is refused before it is sent; the message has both shapes."""
    stream = Script()
    with pytest.raises(InvalidRequestError, match=r"velocity: shape .* give \(2, 2\), or \(2,\)"):
        session(stream).control(velocity=velocity)  # type: ignore[arg-type]
    assert not stream.sent


def test_each_step_acknowledges_what_was_taken() -> None:
    """In lockstep no message is spent on acknowledging."""
    stream = Script()
    stream.answer = lambda step: [frame(step.step, step.step)]
    driven = session(stream)
    for _ in range(20):
        driven.step()
    assert [step.last_frame for step in stream.steps] == list(range(20))
    assert not any(step.ack_only for step in stream.steps)


@pytest.mark.parametrize(("credits", "every"), [(1, 1), (4, 2), (30, 15)])
def test_paced_frames_are_acknowledged_in_time(credits: int, every: int) -> None:
    """When half the credits are used up, and after the frame was handed out."""
    stream = Script(Pacing.SERVER, credits)
    stream.lined_up += [frame(number) for number in range(1, 61)]
    for taken in session(stream).frames():
        assert all(step.last_frame < taken.frame for step in stream.steps)
    assert [step.last_frame for step in stream.steps] == list(range(every, 61, every))
    assert all(step.ack_only for step in stream.steps)


def test_without_credits_nothing_is_acknowledged() -> None:
    """No message goes out for frames that need no acknowledgement."""
    stream = Script(Pacing.SERVER, 0)
    stream.lined_up += [frame(number) for number in range(1, 61)]
    assert len(list(session(stream).frames())) == 60
    assert not stream.sent


def test_the_end_is_told() -> None:
    """Frames stop where the stream ends, a step without its frame fails, errors come through."""
    stream = Script()
    driven = session(stream)
    assert list(driven.frames()) == []
    with pytest.raises(UnavailableError, match="has ended"):
        driven.step()
    stream.lined_up.append(ServerError("broken"))
    with pytest.raises(ServerError, match="broken"):
        driven.step()


def test_step_is_for_client_pacing() -> None:
    """With server pacing it says what to use."""
    with pytest.raises(ProtocolError, match=r"control\(\) and frames\(\)"):
        session(Script(Pacing.SERVER)).step()


def test_corrections_ride_with_the_next_step() -> None:
    """Client pacing: nothing is sent until the step; server pacing: at once."""
    stream = Script()
    driven = session(stream)
    driven.teleport(1, (1, 2, 3), 0.5)
    driven.correct_root(0, (4, 5, 6))
    assert not stream.sent
    driven.control()
    driven.control()
    first, second = stream.steps
    modes = [s.root_correction.mode for s in first.sparse if s.root_correction]
    assert modes == [CorrectionMode.TELEPORT, CorrectionMode.ADJUST]
    assert first.sparse[0].root_correction is not None
    assert first.sparse[0].root_correction.root.position == (1.0, 2.0, 3.0)
    assert second.sparse == ()
    paced = Script(Pacing.SERVER)
    session(paced).teleport(0, (0, 0, 0))
    assert len(paced.steps) == 1


def test_edits_change_who_is_meant_by_all() -> None:
    """After an edit one control is repeated for the characters that are there then."""
    stream = Script()
    driven = session(stream, 3)
    driven.edit(remove=[1], add=[CharacterSpec(9), CharacterSpec(10)])
    assert driven.characters == (0, 2, 9, 10)
    driven.control(velocity=(1.0, 1.0))
    assert stream.steps[0].velocity_xz is not None
    assert stream.steps[0].velocity_xz.shape == (4, 2)


def test_leaving_closes() -> None:
    """The context manager ends the session, also after an error."""
    stream = Script()
    with pytest.raises(ZeroDivisionError), session(stream):
        raise ZeroDivisionError
    assert stream.closed == 1
