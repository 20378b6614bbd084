"""Recorded sessions on disk: what was asked, when time passed, and what came of it.

JSON, one object a line, written as it happens: first `{"recording": 1, "open": …, "opened": …}`,
then `{"control": Step}` for controls taken over, `{"advance": Step}` for time that passed under a
step's controls (with `"level"` where the runtime gave way to load), `{"edit": Edit}`, and
`{"frame": Frame}`. Messages have the names of
`stridewire._messages` in `_`; arrays are base64 of their bytes, so that every bit survives. Frames
are counted from 1, one for each `advance`; a frame that never reached the recorder is absent.
"""

import base64
import json
import logging
import threading
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass, replace
from enum import IntEnum
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from stridewire import _messages
from stridewire._errors import Violation
from stridewire._messages import Edit, Frame, Open, Opened, Step
from stridewire.motion.skeleton import Skeleton

log = logging.getLogger("stridewire")

FORMAT = 1
_KINDS: Mapping[str, Any] = {
    **{name: getattr(_messages, name) for name in _messages.__all__},
    "Skeleton": Skeleton,
    "Violation": Violation,
}


class SessionFileError(ValueError):
    """A file is no recorded session, or a damaged one; the message names file and line."""


@dataclass(frozen=True)
class Control:
    """Controls that were taken over without time passing."""

    step: Step


@dataclass(frozen=True)
class Advance:
    """Time that passed under a step's controls: the recorded decision of client or clock."""

    step: Step
    level: int = 0
    """By how many levels the runtime gave way to load, which is the clock's decision, too."""


Entry = Control | Advance | Edit | Frame


class SessionWriter:
    """Writes a session as it happens.

    Args:
        path: Of the file, made anew.
        opening: What was asked for.
        opened: What was answered.

    Raises:
        OSError: If the file cannot be written.
    """

    def __init__(self, path: Path, opening: Open, opened: Opened) -> None:
        self._file = path.open("w", encoding="ascii")
        self._turn = threading.Lock()  # one thread may send while another receives
        self._write(recording=FORMAT, open=opening, opened=opened)

    def control(self, step: Step) -> None:
        """Note controls that are taken over without time passing."""
        self._write(control=step)

    def advance(self, step: Step, level: int = 0) -> None:
        """Note time that passes under a step's controls, and what gives way to load."""
        self._write(advance=step, **({"level": level} if level else {}))

    def edit(self, edit: Edit) -> None:
        """Note characters that come, go and change."""
        self._write(edit=edit)

    def frame(self, frame: Frame) -> None:
        """Note a frame; how long its stages took is left out, for that is no result."""
        self._write(frame=replace(frame, timings_ms={}, events=tuple(frame.events)))

    def close(self) -> None:
        """End the file; twice is harmless."""
        self._file.close()

    def __enter__(self) -> "SessionWriter":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def _write(self, **parts: Any) -> None:
        line = {name: _encode(value) for name, value in parts.items()}
        text = json.dumps(line, separators=(",", ":")) + "\n"
        with self._turn:
            if self._file.closed:
                return
            try:
                self._file.write(text)
            except OSError as error:  # a full disk ends the recording, not the session
                log.warning("recording %s ends here: %s", self._file.name, error)
                with suppress(OSError):
                    self._file.close()


@dataclass(frozen=True)
class SessionFile:
    """A recorded session; entries are read as they are needed."""

    path: Path
    opening: Open
    opened: Opened

    @classmethod
    def open(cls, path: Path) -> "SessionFile":
        """Read the head of a recorded session.

        Raises:
            SessionFileError: If the file is none.
            OSError: If it cannot be read.
        """
        with path.open(encoding="ascii", errors="replace") as file:
            head = _parse(path, 1, file.readline())
        if head.get("recording") != FORMAT:
            raise SessionFileError(
                f"{path}: no recorded session of format {FORMAT}; "
                "`stridewire stream --record FILE` writes one"
            )
        opening, opened = head.get("open"), head.get("opened")
        if not isinstance(opening, Open) or not isinstance(opened, Opened):
            raise SessionFileError(f"{path}, line 1: `open` or `opened` is missing")
        return cls(path, opening, opened)

    def entries(self) -> Iterator[Entry]:
        """Yield what happened, in order; a last line that was cut off is left out.

        Raises:
            SessionFileError: If a line is damaged.
        """
        with self.path.open(encoding="ascii", errors="replace") as file:
            file.readline()
            for number, line in enumerate(file, start=2):
                if not line.endswith("\n"):
                    return  # its writer was stopped in the middle
                yield _entry(self.path, number, line)


def _entry(path: Path, number: int, line: str) -> Entry:
    match _parse(path, number, line):
        case {"control": Step() as step}:
            return Control(step)
        case {"advance": Step() as step, **more}:
            return Advance(step, int(more.get("level", 0)))
        case {"edit": Edit() as edit}:
            return edit
        case {"frame": Frame() as frame}:
            return frame
    raise SessionFileError(f"{path}, line {number}: expected one of control, advance, edit, frame")


def _parse(path: Path, number: int, line: str) -> dict[str, Any]:
    try:
        parsed = json.loads(line)
        if not isinstance(parsed, dict):
            raise TypeError("no object")
        return {name: _decode(value) for name, value in parsed.items()}
    except (ValueError, TypeError, KeyError) as error:
        raise SessionFileError(f"{path}, line {number}: {error}") from error


def _encode(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        little = np.ascontiguousarray(value.astype(value.dtype.newbyteorder("<"), copy=False))
        data = base64.b64encode(little.tobytes()).decode()
        return {"_": "array", "type": little.dtype.str, "shape": value.shape, "data": data}
    if isinstance(value, IntEnum):
        return {"_": type(value).__name__, "value": int(value)}
    if is_dataclass(value) and not isinstance(value, type):
        parts = {field.name: _encode(getattr(value, field.name)) for field in fields(value)}
        return {"_": type(value).__name__, **parts}
    if isinstance(value, Mapping):
        return {"_": "map", "items": {str(key): _encode(item) for key, item in value.items()}}
    if isinstance(value, tuple | list):
        return [_encode(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def _decode(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(map(_decode, value))
    if not isinstance(value, dict):
        return value
    kind = value["_"]
    if kind == "array":
        flat = np.frombuffer(base64.b64decode(value["data"]), np.dtype(value["type"]))
        return flat.reshape(value["shape"])
    if kind == "map":
        return {name: _decode(item) for name, item in value["items"].items()}
    known = _KINDS[kind]
    if isinstance(known, type) and issubclass(known, IntEnum):
        return known(value["value"])
    return known(**{name: _decode(item) for name, item in value.items() if name != "_"})
