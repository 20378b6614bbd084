"""Limits of a server: sessions at a time, time to answer, one place freed is one taken."""

import pytest

from serving import DEADLINE_S, Serve, Stop, eventually
from stridewire import Client, ExhaustedError, UnavailableError
from stridewire._messages import Pacing


def test_sessions_are_limited(serve: Serve) -> None:
    """One more than allowed is refused with a time to wait; a place that is freed can be had."""
    with Client(serve(max_sessions=2), timeout_s=DEADLINE_S) as client:
        first, second = client.open_session(), client.open_session()
        with pytest.raises(ExhaustedError, match="all 2 sessions are taken") as raised:
            client.open_session()
        assert raised.value.retry_after_s == 1.0
        assert first.step().frame == 1
        first.close()
        assert eventually(lambda: client.info().sessions == 1)
        third = client.open_session()
        assert (second.step().frame, third.step().frame) == (1, 1)


def test_silence_is_told_in_time(client: Client) -> None:
    """Waiting for a frame that nobody asked for ends with a TimeoutError."""
    impatient = client.open_session()
    impatient._timeout_s = 0.05
    with pytest.raises(TimeoutError, match=r"within 0\.05 s"):
        next(impatient.frames())
    impatient.close()


def test_a_server_that_stops_ends_its_sessions(stopping: tuple[str, Stop]) -> None:
    """After the time to drain, frames end with UNAVAILABLE, and so does the next control."""
    address, stop = stopping
    with Client(address, timeout_s=DEADLINE_S) as client:
        session = client.open_session(pacing=Pacing.SERVER)
        frames = session.frames()
        next(frames)
        stop()
        with pytest.raises(UnavailableError):
            for _ in frames:
                pass
        with pytest.raises(UnavailableError):
            session.control(velocity=(0.0, 1.0))
