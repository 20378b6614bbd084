"""A session: controls in, frames out."""

import time
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from types import TracebackType

import numpy as np
import numpy.typing as npt

from stridewire._errors import (
    InvalidRequestError,
    ProtocolError,
    StridewireError,
    UnavailableError,
    Violation,
)
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    CorrectionMode,
    Edit,
    Frame,
    GroundPose,
    Notice,
    Pacing,
    RootCorrection,
    Sparse,
    Step,
    StreamError,
)
from stridewire._transport import Stream
from stridewire.motion.array_types import Floats

FRAME_S = 1.0 / 60.0


class Session:
    """Characters that are driven together.

    With client pacing, `step` sends controls and waits for the frame they make. With server pacing,
    `control` replaces the controls at any time and `frames` yields what comes. `control` and
    `frames` go with client pacing, too: then every control makes one frame. One thread may send
    while another receives.
    """

    def __init__(
        self, stream: Stream, characters: Sequence[CharacterSpec], timeout_s: float
    ) -> None:
        self.opened = stream.opened
        """What the server said at the beginning: skeleton, library, settings, limits."""
        self.characters = tuple(spec.id for spec in characters)
        """Ids in the order of adding, edits included."""
        self.errors: deque[StreamError] = deque(maxlen=256)
        """What the server refused, the newest last."""
        self.notices: deque[Notice] = deque(maxlen=16)
        """News of the server, the newest last."""
        self._stream = stream
        self._timeout_s = timeout_s
        self._credits = stream.opened.settings.max_frames_in_flight
        self._step = 0
        self._taken = 0
        self._acknowledged = 0
        self._sparse: list[Sparse] = []

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
        if self.opened.settings.pacing is not Pacing.CLIENT:
            raise ProtocolError("step is for client pacing; here use control() and frames()")
        number = self.control(velocity, facing, dt=dt, characters=characters, sparse=sparse)
        for frame in self.frames():
            if frame.applied_step == number:
                return frame
        raise UnavailableError("the session has ended")

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
        count = len(self.characters) if characters is None else len(characters)
        self._step += 1
        waiting, self._sparse = self._sparse, []
        message = Step(
            step=self._step,
            dt_s=dt,
            last_frame=self._taken,
            client_time_s=time.perf_counter() if client_time_s is None else client_time_s,
            characters=None if characters is None else np.asarray(characters, np.uint32),
            velocity_xz=_rows("velocity", velocity, count, 2),
            facing_yaw=_rows("facing", facing, count),
            sparse=(*waiting, *sparse),
        )
        self._acknowledged = message.last_frame
        self._stream.send(message)
        return self._step

    def frames(self) -> Iterator[Frame]:
        """Yield frames as they come, until the session ends; acknowledges those that were taken.

        Raises:
            TimeoutError: If no frame came in time.
            StridewireError: If the session ended with an error.
        """
        while (message := self._stream.receive(self._timeout_s)) is not None:
            match message:
                case Frame():
                    self._taken = message.frame
                    yield message
                    self._acknowledge()
                case StreamError():
                    self.errors.append(message)
                case Notice():
                    self.notices.append(message)

    def edit(
        self,
        *,
        add: Sequence[CharacterSpec] = (),
        remove: Sequence[int] = (),
        update: Sequence[CharacterUpdate] = (),
    ) -> None:
        """Add, remove and change characters; what is refused comes as one of `errors`."""
        self._stream.send(Edit(tuple(add), tuple(remove), tuple(update)))
        kept = [id for id in self.characters if id not in set(remove)]
        self.characters = (*kept, *(spec.id for spec in add if spec.id not in kept))

    def teleport(self, character: int, position: Sequence[float], yaw: float = 0.0) -> None:
        """Put a character somewhere else without a blend; its history is cleared.

        Args:
            character: Its id.
            position: x, y, z in the world; metres.
            yaw: Heading about +Y; radians.
        """
        self._correct(character, position, yaw, CorrectionMode.TELEPORT)

    def correct_root(self, character: int, position: Sequence[float], yaw: float = 0.0) -> None:
        """Tell where the engine has moved a character; it blends there.

        Args:
            character: Its id.
            position: x, y, z in the world; metres.
            yaw: Heading about +Y; radians.
        """
        self._correct(character, position, yaw, CorrectionMode.ADJUST)

    def close(self) -> None:
        """End the session; twice is harmless."""
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

    def _correct(
        self, character: int, position: Sequence[float], yaw: float, mode: CorrectionMode
    ) -> None:
        """Send a correction with the next step, or at once where the server makes the steps."""
        x, y, z = map(float, position)
        root = GroundPose((x, y, z), float(yaw))
        self._sparse.append(Sparse(character, root_correction=RootCorrection(root, mode)))
        if self.opened.settings.pacing is Pacing.SERVER:
            self.control()

    def _acknowledge(self) -> None:
        """Acknowledge without a step where steps come too seldom to do it in time."""
        if self._credits and self._taken - self._acknowledged >= max(1, self._credits // 2):
            self._acknowledged = self._taken
            with suppress(StridewireError):  # where the session has ended, `receive` says why
                self._stream.send(Step(step=self._step, last_frame=self._taken, ack_only=True))


def _rows(name: str, values: npt.ArrayLike | None, count: int, *shape: int) -> Floats | None:
    """Return `(count, *shape)` float32, one row repeated for all where only one is given."""
    if values is None:
        return None
    array = np.asarray(values, np.float32)
    if array.shape == shape:
        array = np.broadcast_to(array, (count, *shape))
    if array.shape != (count, *shape):
        raise InvalidRequestError.of(
            Violation(name, f"shape {array.shape}; give {(count, *shape)}, or {shape} for all")
        )
    return array
