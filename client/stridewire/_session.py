"""A session: controls in, frames out."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from types import TracebackType

import numpy.typing as npt

from stridewire._base_session import FRAME_S, RETRY_S, BaseSession
from stridewire._errors import StridewireError, UnavailableError
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    CorrectionMode,
    Frame,
    Open,
    Pacing,
    ServerMessage,
    Sparse,
    Step,
)
from stridewire._transport import Stream


class Session(BaseSession):
    """Characters that are driven together.

    With client pacing, `step` sends controls and waits for the frame they make. With server pacing,
    `control` replaces the controls at any time and `frames` yields what comes. `control` and
    `frames` go with client pacing, too: then every control makes one frame. One thread may send
    while another receives.
    """

    def __init__(
        self,
        open_stream: Callable[[Open], Stream],
        opening: Open,
        timeout_s: float,
        reconnect_s: float = 0.0,
    ) -> None:
        self._open_stream = open_stream
        self._stream = open_stream(opening)
        self._reconnect_s = reconnect_s
        super().__init__(opening, self._stream.opened, timeout_s)

    def step(
        self,
        velocity: npt.ArrayLike | None = None,
        facing: npt.ArrayLike | None = None,
        *,
        dt: float = FRAME_S,
        characters: Sequence[int] | None = None,
        sparse: Sequence[Sparse] = (),
    ) -> Frame:
        """Advance all characters and return their poses; client pacing only.

        Args:
            velocity: `(N, 2)` x and z in the world, or `(2,)` for all; m/s. None holds the last.
            facing: `(N,)` yaw in the world, or one for all; radians; NaN means along the velocity.
                None holds the last.
            dt: Seconds to advance by; 0 pauses.
            characters: Ids that the arrays are about; None means all, in the order of adding.
            sparse: Rarer controls of single characters.

        Raises:
            ProtocolError: If the session has server pacing.
            TimeoutError: If no frame came in time.
            StridewireError: If the session has ended.
        """
        self._require_client_pacing()
        message = self._next_step(velocity, facing, dt, characters, sparse, None)
        try:
            return self._step_with(message)
        except UnavailableError as error:
            self._reopen(error, message.step - 1)
            return self._step_with(replace(message, last_frame=0))

    def control(
        self,
        velocity: npt.ArrayLike | None = None,
        facing: npt.ArrayLike | None = None,
        *,
        dt: float = FRAME_S,
        characters: Sequence[int] | None = None,
        sparse: Sequence[Sparse] = (),
        client_time_s: float | None = None,
    ) -> int:
        """Send controls without waiting; the arguments are those of `step`.

        Args:
            velocity: As in `step`.
            facing: As in `step`.
            dt: As in `step`; only with client pacing.
            characters: As in `step`.
            sparse: As in `step`.
            client_time_s: Comes back in the frame; None means `time.perf_counter()`.

        Returns:
            The step's number; the frame that it is in has it as `applied_step`.
        """
        message = self._next_step(velocity, facing, dt, characters, sparse, client_time_s)
        try:
            self._stream.send(message)
        except UnavailableError:
            if not self._reconnect_s:
                raise  # else `frames` opens again, under the controls that hold
        return message.step

    def frames(self) -> Iterator[Frame]:
        """Yield frames as they come, until the session ends; acknowledges those that were taken.

        Raises:
            TimeoutError: If no frame came in time.
            StridewireError: If the session ended with an error.
        """
        while (message := self._receive()) is not None:
            frame = self._take(message)
            if frame is not None:
                yield frame
                self._acknowledge()

    def edit(
        self,
        *,
        add: Sequence[CharacterSpec] = (),
        remove: Sequence[int] = (),
        update: Sequence[CharacterUpdate] = (),
    ) -> None:
        """Add, remove and change characters; what is refused comes as one of `errors`."""
        self._stream.send(self._edit(add, remove, update))

    def teleport(self, character: int, position: Sequence[float], yaw: float = 0.0) -> None:
        """Put a character somewhere else without a blend; its history is cleared.

        Args:
            character: Its id.
            position: x, y, z in the world; metres.
            yaw: Heading about +Y; radians.
        """
        self._correction(character, position, yaw, CorrectionMode.TELEPORT)
        self._send_corrections()

    def correct_root(self, character: int, position: Sequence[float], yaw: float = 0.0) -> None:
        """Tell where the engine has moved a character; it blends there.

        Args:
            character: Its id.
            position: x, y, z in the world; metres.
            yaw: Heading about +Y; radians.
        """
        self._correction(character, position, yaw, CorrectionMode.ADJUST)
        self._send_corrections()

    def close(self) -> None:
        """End the session; twice is harmless."""
        self._reconnect_s = 0.0
        self._stream.close()

    def __enter__(self) -> "Session":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def _step_with(self, message: Step) -> Frame:
        self._stream.send(message)
        while (answer := self._stream.receive(self._timeout_s)) is not None:
            frame = self._take(answer)
            if frame is not None and frame.applied_step == message.step:
                return frame
        raise UnavailableError("the session has ended")

    def _receive(self) -> ServerMessage | None:
        try:
            return self._stream.receive(self._timeout_s)
        except UnavailableError as error:
            self._reopen(error, self._step)
            return self._stream.receive(self._timeout_s)

    def _send_corrections(self) -> None:
        """Send corrections at once where the server makes the steps; else with the next step."""
        if self.opened.settings.pacing is Pacing.SERVER:
            self.control()

    def _acknowledge(self) -> None:
        message = self._acknowledgement()
        if message is not None:
            with suppress(StridewireError):  # where the session has ended, `receive` says why
                self._stream.send(message)

    def _reopen(self, lost: UnavailableError, number: int) -> None:
        """Open again at the last roots under the controls that hold, for as long as is allowed.

        Args:
            lost: Why.
            number: Of the step that asks for the controls that hold.

        Raises:
            UnavailableError: What was lost, if that does not succeed in time.
        """
        if not self._reconnect_s:
            raise lost
        self._stream.close()
        end, wait = time.monotonic() + self._reconnect_s, RETRY_S
        while True:
            try:
                self._stream = self._open_stream(self._opening_again())
                break
            except UnavailableError:
                if time.monotonic() + wait > end:
                    raise lost from None
            time.sleep(wait)
            wait = min(2.0 * wait, 1.0)
        self._stream.send(self._begin_again(self._stream.opened, number))
