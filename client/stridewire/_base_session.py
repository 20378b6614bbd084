"""What sessions of every kind share, without any I/O: numbers, credits, controls, reopening."""

import time
from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from stridewire._errors import InvalidRequestError, ProtocolError, Violation
from stridewire._held import HeldControls
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    CorrectionMode,
    Edit,
    Frame,
    GroundPose,
    Notice,
    Open,
    Opened,
    Pacing,
    RootCorrection,
    ServerMessage,
    Sparse,
    Step,
    StreamError,
)
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats

FRAME_S = 1.0 / 60.0
RETRY_S = 0.1
"""Time between attempts to open a lost session again; doubles up to a second."""


class BaseSession:
    """Makes messages out of arguments, and takes note of what comes."""

    def __init__(self, opening: Open, opened: Opened, timeout_s: float) -> None:
        self.opened = opened
        """What the server said at the beginning: skeleton, library, settings, limits."""
        self.errors: deque[StreamError] = deque(maxlen=256)
        """What the server refused, the newest last."""
        self.notices: deque[Notice] = deque(maxlen=16)
        """News of the server, the newest last."""
        self.reopened = 0
        """How often the session was opened again after its connection was lost."""
        self._opening = opening
        self._timeout_s = timeout_s
        self._specs = {spec.id: spec for spec in opening.characters}
        self._held = HeldControls(self.characters)
        self._step = 0
        self._last: Frame | None = None
        self._acknowledged = 0
        self._sparse: list[Sparse] = []

    @property
    def characters(self) -> tuple[int, ...]:
        """Ids in the order of adding, edits included."""
        return tuple(self._specs)

    @property
    def _taken(self) -> int:
        return 0 if self._last is None else self._last.frame

    def _require_client_pacing(self) -> None:
        if self.opened.settings.pacing is not Pacing.CLIENT:
            raise ProtocolError("step is for client pacing; here use control() and frames()")

    def _next_step(
        self,
        velocity: npt.ArrayLike | None,
        facing: npt.ArrayLike | None,
        dt: float,
        characters: Sequence[int] | None,
        sparse: Sequence[Sparse],
        client_time_s: float | None,
    ) -> Step:
        """Return the message of a control; corrections that wait go with it."""
        count = len(self.characters) if characters is None else len(characters)
        velocities = _rows("velocity", velocity, count, 2)
        facings = _rows("facing", facing, count)
        self._step += 1
        waiting, self._sparse = self._sparse, []
        message = Step(
            step=self._step,
            dt_s=dt,
            last_frame=self._taken,
            client_time_s=time.perf_counter() if client_time_s is None else client_time_s,
            characters=None if characters is None else np.asarray(characters, np.uint32),
            velocity_xz=velocities,
            facing_yaw=facings,
            sparse=(*waiting, *sparse),
        )
        self._acknowledged = message.last_frame
        self._held.note(message)
        return message

    def _take(self, message: ServerMessage) -> Frame | None:
        """Take note of a message and return it if it is a frame."""
        match message:
            case Frame():
                self._last = message
                return message
            case StreamError():
                self.errors.append(message)
            case Notice():
                self.notices.append(message)
        return None

    def _acknowledgement(self) -> Step | None:
        """Return a message that acknowledges, where steps come too seldom to do it in time."""
        limit = self.opened.settings.max_frames_in_flight
        if not limit or self._taken - self._acknowledged < max(1, limit // 2):
            return None
        self._acknowledged = self._taken
        return Step(step=self._step, last_frame=self._taken, ack_only=True)

    def _edit(
        self,
        add: Sequence[CharacterSpec],
        remove: Sequence[int],
        update: Sequence[CharacterUpdate],
    ) -> Edit:
        for character in remove:
            self._specs.pop(character, None)
        for spec in add:
            self._specs.setdefault(spec.id, spec)
        for change in update:
            if change.spec.id in self._specs:
                changed = {
                    name: getattr(change.spec, name)
                    for name in change.mask
                    if hasattr(change.spec, name)
                }
                self._specs[change.spec.id] = replace(self._specs[change.spec.id], **changed)
        self._held.keep(self.characters)
        return Edit(tuple(add), tuple(remove), tuple(update))

    def _correction(
        self, character: int, position: Sequence[float], yaw: float, mode: CorrectionMode
    ) -> None:
        """Let a correction wait for the next step."""
        x, y, z = map(float, position)
        root = GroundPose((x, y, z), float(yaw))
        self._sparse.append(Sparse(character, root_correction=RootCorrection(root, mode)))

    def _opening_again(self) -> Open:
        """Return Open for the characters as they are, each at its last root."""
        specs = dict(self._specs)
        if self._last is not None:
            yaws = quaternion.to_yaw(self._last.root[:, 3:])
            for row, character in enumerate(self._last.characters.tolist()):
                if character in specs:
                    x, y, z = self._last.root[row, :3].tolist()
                    root = GroundPose((x, y, z), float(yaws[row]))
                    specs[character] = replace(specs[character], root=root)
        filters = self._held.filters
        characters = tuple(
            replace(spec, filter=filters.get(id, spec.filter)) for id, spec in specs.items()
        )
        return replace(self._opening, characters=characters)

    def _begin_again(self, opened: Opened, number: int) -> Step:
        """Take note of a session opened again; returns the controls that hold, without time."""
        self.opened = opened
        self.reopened += 1
        self._last = None
        self._acknowledged = 0
        return self._held.step(number)


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
