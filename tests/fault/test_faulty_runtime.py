"""A fault of the runtime ends the streams it hit, tells nothing of its inside, leaves the rest."""

import logging
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import pytest

from serving import DEADLINE_S, HeldRuntime, Serve, eventually
from stridewire import Client, ServerError
from stridewire._messages import Frame, Step, StreamError
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime, Session

SECRET = "the inside of the server"


class Faulty(Runtime):
    """Fails for every session that has three characters."""

    def advance(
        self, due: Sequence[tuple[Session, Step | float]], level: int = 0
    ) -> list[tuple[Frame, StreamError | None]]:
        """Advance, or fail."""
        if any(len(session) == 3 for session, _ in due):
            raise ZeroDivisionError(SECRET)
        return super().advance(due, level)


def test_a_fault_is_internal_and_tells_an_id(
    serve: Serve, small_library: Library, caplog: pytest.LogCaptureFixture
) -> None:
    """The status has the id of the log's entry and not its text; the other session is healthy."""
    with Client(serve(Faulty([small_library]))) as client:
        with client.open_session(1) as healthy:
            healthy.step()
            with client.open_session(3) as hit, caplog.at_level(logging.ERROR):
                with pytest.raises(ServerError) as raised:
                    hit.step()
                assert SECRET not in str(raised.value)
                fault = str(raised.value).rpartition(" ")[2]
                assert fault in caplog.text
                assert SECRET in caplog.text
            assert healthy.step().frame == 2
        assert eventually(lambda: client.info().sessions == 0)


def test_steps_that_wait_share_the_next_tick(serve: Serve, small_library: Library) -> None:
    """While one tick runs, the steps of three other sessions gather, and one call advances them."""
    runtime = HeldRuntime(small_library)
    address = serve(runtime)
    with ThreadPoolExecutor(4) as pool, Client(address, timeout_s=DEADLINE_S) as client:
        sessions = [client.open_session(2) for _ in range(4)]
        first = pool.submit(sessions[0].step)
        assert runtime.inside.wait(DEADLINE_S)
        others = [pool.submit(session.step) for session in sessions[1:]]
        # A step that the server has read is answered in the tick after the one that is held.
        assert not eventually(lambda: any(step.done() for step in others), within_s=0.3)
        runtime.go.set()
        frames = [step.result(DEADLINE_S) for step in (first, *others)]
        for session in sessions:
            session.close()
    assert [frame.frame for frame in frames] == [1, 1, 1, 1]
    assert runtime.shared == [1, 3]
