"""Reading BVH of any exporter: any channel order, positions on any joint, any line ends.

The hierarchy is read statement by statement, the frames as one block of numbers.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

import numpy as np

from stridewire.formats.frame_rates import named_rate
from stridewire.formats.number_block import numbers
from stridewire.formats.source_motion import FormatError, SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import Skeleton

_CHANNEL = re.compile(r"([xyz])(position|rotation)", re.IGNORECASE)
_FRAMES = re.compile(r"\s*Frames\s*:\s*(\d+)\s*", re.IGNORECASE)
_FRAME_TIME = re.compile(r"\s*Frame\s*Time\s*:\s*(\S+)\s*", re.IGNORECASE)
_MOTION = re.compile(r"^[ \t]*MOTION[ \t]*$", re.IGNORECASE | re.MULTILINE)
_MOST_JOINTS = 2000


@dataclass
class _Joint:
    name: str
    parent: int
    offset: tuple[float, ...] | None = None
    channels: list[str] = field(default_factory=list)
    """`xp` for a position along x, `zr` for a rotation about z, in file order."""
    tip: tuple[float, ...] | None = None


def read_bvh(path: Path | str) -> SourceMotion:
    """Read a BVH file.

    A wrong number of frames and a last row that is cut short are read for what is there and noted.

    Raises:
        FormatError: If the file is no BVH, is malformed or holds numbers that are not finite.
        OSError: If it cannot be opened.
    """
    path = Path(path)
    return parse_bvh(path, _text(path))


def parse_bvh(path: Path, text: str) -> SourceMotion:
    """Read the text of a BVH file.

    Args:
        path: What the file is called in messages.
        text: Its content.

    Raises:
        FormatError: If it is no BVH, is malformed or holds numbers that are not finite.
    """
    split = _MOTION.search(text)
    if split is None:
        raise FormatError(path, "no MOTION section; expected a BVH file, export it again")
    joints = _hierarchy(path, text[: split.start()])
    header_lines = text.count("\n", 0, split.end()) + 1
    rate, values, notes = _frames(path, text[split.end() :], header_lines, joints)
    return _motion(path, joints, rate, values, notes)


def _text(path: Path) -> str:
    raw = path.read_bytes()
    if b"\0" in raw:
        raise FormatError(
            path, "holds zero bytes; expected a text file, export as BVH (text, UTF-8)"
        )
    text = raw.decode("utf-8-sig", errors="replace")
    return re.sub(r"\r+\n?", "\n", text) if "\r" in text else text


def _hierarchy(path: Path, text: str) -> list[_Joint]:
    """Return the joints, parents first."""
    joints: list[_Joint] = []
    open_joints: list[int] = []
    pending: int | None = None
    tip_of = -2
    for line, statement in _statements(text):
        words = statement.split()
        keyword = words[0].upper()
        if keyword in ("ROOT", "JOINT"):
            pending = _add_joint(path, line, joints, keyword, statement, open_joints)
        elif keyword.startswith("END"):
            pending = -1
        elif keyword == "{":
            if pending is None:
                raise FormatError(path, "a { that belongs to no joint; export the file again", line)
            if pending == -1:
                tip_of = open_joints[-1] if open_joints else -2
            open_joints.append(pending)
            pending = None
        elif keyword == "}":
            if not open_joints:
                raise FormatError(path, "a } too many; export the file again", line)
            open_joints.pop()
        elif keyword == "OFFSET":
            _set_offset(path, line, joints, open_joints, tip_of, words[1:])
        elif keyword == "CHANNELS":
            _set_channels(path, line, joints, open_joints, words[1:])
        elif keyword != "HIERARCHY":
            raise FormatError(path, f"{statement[:40]!r} is no BVH statement", line)
    if open_joints or not joints:
        problem = "ends within a joint" if open_joints else "names no joint"
        raise FormatError(path, f"the HIERARCHY {problem}; the file is cut short, export it again")
    return joints


def _statements(text: str) -> list[tuple[int, str]]:
    return [
        (number, part.strip())
        for number, line in enumerate(text.split("\n"), start=1)
        for part in re.split(r"([{}])", line)
        if part.strip()
    ]


def _add_joint(
    path: Path,
    line: int,
    joints: list[_Joint],
    keyword: str,
    statement: str,
    open_joints: list[int],
) -> int:
    if (keyword == "ROOT") != (not joints):
        problem = "a second ROOT" if keyword == "ROOT" else "a JOINT before the ROOT"
        raise FormatError(path, f"{problem}; expected one figure a file, split it", line)
    if keyword == "JOINT" and (not open_joints or open_joints[-1] < 0):
        raise FormatError(path, "a JOINT outside of its parent's braces; export it again", line)
    if len(joints) == _MOST_JOINTS:
        raise FormatError(path, f"more than {_MOST_JOINTS} joints; expected one figure", line)
    taken = {joint.name for joint in joints}
    name = base = statement[len(keyword) :].strip() or f"joint{len(joints)}"
    for number in range(2, len(joints) + 2):
        if name not in taken:
            break
        name = f"{base}_{number}"
    joints.append(_Joint(name, open_joints[-1] if open_joints else -1))
    return len(joints) - 1


def _set_offset(
    path: Path,
    line: int,
    joints: list[_Joint],
    open_joints: list[int],
    tip_of: int,
    words: list[str],
) -> None:
    try:
        offset = tuple(float(word) for word in words)
    except ValueError:
        offset = ()
    if len(offset) != 3 or not np.all(np.isfinite(offset)) or not open_joints:
        raise FormatError(path, f"OFFSET {' '.join(words)[:40]}; expected three numbers", line)
    if open_joints[-1] >= 0:
        joints[open_joints[-1]].offset = offset
    elif tip_of >= 0:
        joints[tip_of].tip = offset


def _set_channels(
    path: Path, line: int, joints: list[_Joint], open_joints: list[int], words: list[str]
) -> None:
    if not open_joints or open_joints[-1] < 0:
        raise FormatError(path, "CHANNELS outside of a joint; export the file again", line)
    matches = [_CHANNEL.fullmatch(word) for word in words[1:]]
    channels = [f"{m[1]}{m[2][0]}".lower() for m in matches if m]
    if len(channels) != len(matches) or words[:1] != [str(len(channels))]:
        raise FormatError(
            path,
            f"CHANNELS {' '.join(words)[:80]}; expected their number, then names such as Xposition "
            "or Zrotation",
            line,
        )
    if len(set(channels)) != len(channels):
        raise FormatError(path, f"a channel occurs twice in CHANNELS {' '.join(words)[:80]}", line)
    joints[open_joints[-1]].channels = channels


def _frames(
    path: Path, text: str, first_line: int, joints: list[_Joint]
) -> tuple[float, Floats, list[str]]:
    """Return the frame rate, the frames `(T, channels)` and notes."""
    text_start = len(text) - len(text.lstrip())
    said = _FRAMES.match(text)
    time = _FRAME_TIME.match(text, said.end()) if said else None
    if said is None or time is None:
        raise FormatError(
            path,
            "no 'Frames: N' and 'Frame Time: SECONDS' after MOTION",
            first_line + (text_start > 0),
        )
    rate = _rate(path, time[1], first_line + text.count("\n", 0, time.start(1)))
    channels = sum(len(joint.channels) for joint in joints)
    if channels == 0:
        raise FormatError(path, "no joint has CHANNELS, so nothing moves; export with motion")
    body_line = first_line + text.count("\n", 0, time.end())
    values, notes = _rows(path, text[time.end() :], body_line, channels)
    if len(values) != int(said[1]):
        notes.append(f"says {said[1]} frames and holds {len(values)}")
    return rate, values, notes


def _rate(path: Path, text: str, line: int) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 1e-4 <= seconds <= 10.0:
        raise FormatError(
            path, f"Frame Time {text[:20]!r}; expected seconds, such as 0.016667", line
        )
    return named_rate(text)


def _rows(path: Path, text: str, first_line: int, channels: int) -> tuple[Floats, list[str]]:
    values = numbers(text)
    if values is None:
        _raise_bad_number(path, text, first_line)
    notes = []
    if len(values) % channels:
        # a shifted row would turn all later ones to nonsense, so only the last may be incomplete
        lines = [(n, len(row.split())) for n, row in enumerate(text.split("\n")) if row.strip()]
        wrong = next(((n, count) for n, count in lines if count != channels), lines[-1])
        if wrong != lines[-1] or wrong[1] > channels:
            raise FormatError(
                path,
                f"{wrong[1]} values; expected {channels}, one a channel",
                first_line + wrong[0],
            )
        notes.append("the last row is cut short; it was left out")
        values = values[: len(values) // channels * channels]
    if len(values) == 0:
        raise FormatError(path, "holds no whole frame; the file is cut short, export it again")
    rows = values.reshape(-1, channels)
    # a channel beyond this is no length and no angle, and products of it are not finite
    bad = ~(np.abs(rows) < 1e9)
    if bad.any():
        row, channel = np.argwhere(bad)[0]
        raise FormatError(
            path,
            f"frame {row + 1}, channel {channel + 1} is {rows[row, channel]}; expected a number",
        )
    return rows, notes


def _raise_bad_number(path: Path, text: str, first_line: int) -> NoReturn:
    for number, line in enumerate(text.split("\n")):
        for word in line.split():
            try:
                float(word)
            except ValueError:
                comma = " (a decimal comma?)" if "," in word else ""
                raise FormatError(
                    path, f"{word[:20]!r} is no number{comma}; export it again", first_line + number
                ) from None
    raise FormatError(path, "a frame holds something that is no number; export it again")


def _motion(
    path: Path, joints: list[_Joint], rate: float, values: Floats, notes: list[str]
) -> SourceMotion:
    if missing := [joint.name for joint in joints if joint.offset is None]:
        raise FormatError(path, f"joint {missing[0]!r} has no OFFSET; export the file again")
    offsets = np.array([joint.offset for joint in joints], np.float64)
    if np.abs(offsets).max() > 1e6:
        raise FormatError(path, "an OFFSET is above 1e6; expected lengths of a figure")
    skeleton = Skeleton(
        tuple(joint.name for joint in joints), tuple(joint.parent for joint in joints), offsets
    )
    starts = np.cumsum([0, *(len(joint.channels) for joint in joints)])
    translations = _translations(joints, starts, offsets, values)
    moving = any(c[1] == "p" for joint in joints[1:] for c in joint.channels)
    return SourceMotion(
        path=path,
        skeleton=skeleton,
        tips={i: np.array(joint.tip) for i, joint in enumerate(joints) if joint.tip is not None},
        frame_rate=rate,
        root_positions=translations[:, 0],
        rotations=_rotations(joints, starts, values),
        translations=translations if moving else None,
        notes=tuple(notes),
    )


def _translations(
    joints: list[_Joint], starts: Floats, offsets: Vectors, values: Floats
) -> Vectors:
    """Return `(T, J, 3)`; where no joint but the root moves only the root's row is filled."""
    moving = any(c[1] == "p" for joint in joints[1:] for c in joint.channels)
    out = np.repeat(offsets[None, : len(joints) if moving else 1], len(values), axis=0)
    for index, joint in enumerate(joints):
        for at, channel in enumerate(joint.channels):
            if channel[1] == "p":
                out[:, index, "xyz".index(channel[0])] = values[:, starts[index] + at]
    return out


def _rotations(joints: list[_Joint], starts: Floats, values: Floats) -> Quaternions:
    """Convert joints of the same order of rotations together."""
    groups: dict[str, list[tuple[int, list[int]]]] = {}
    for index, joint in enumerate(joints):
        turns = [(c[0], starts[index] + i) for i, c in enumerate(joint.channels) if c[1] == "r"]
        order = "".join(letter for letter, _ in turns)
        groups.setdefault(order, []).append((index, [column for _, column in turns]))
    out = quaternion.identity(len(values), len(joints), dtype=np.float64)
    for order, members in groups.items():
        if order:
            columns = np.array([columns for _, columns in members])
            angles = np.deg2rad(values[:, columns])
            out[:, [index for index, _ in members]] = quaternion.from_euler(angles, order)
    return out
