"""Reading Acclaim: a skeleton (ASF) and its motions (AMC).

A bone's joint is where the bone begins. Each bone turns in an axis frame C of its own: with the
rotation M of its degrees of freedom its local rotation is C M C^-1, so that zero angles are the
rest pose and all joints' frames are parallel there.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stridewire.formats.number_block import numbers
from stridewire.formats.source_motion import FormatError, SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import Skeleton, SkeletonError

_INCH = 0.0254
_LARGEST = 1e9
_ROOT = "root"
_ROOT_ORDER = ("tx", "ty", "tz", "rx", "ry", "rz")


@dataclass(frozen=True)
class _Bone:
    name: str
    direction: Vectors
    """`(3,)` times length: from the bone's joint to its end."""
    axis: Quaternions
    degrees: tuple[str, ...]
    """Of `rx ry rz`, and `tx ty tz` for the root, in file order."""


@dataclass(frozen=True)
class AcclaimSkeleton:
    """What an ASF file says."""

    path: Path
    skeleton: Skeleton
    """Offsets in file units; joints are named after their bones."""
    tips: dict[int, Vectors]
    metres_per_unit: float | None
    """None where the file does not say."""
    radians: bool
    axes: Quaternions
    """`(J, 4)` axis frames."""
    degrees: tuple[tuple[str, ...], ...]
    """By joint."""


def read_acclaim(path: Path | str, skeleton_path: Path | str | None = None) -> SourceMotion:
    """Read an AMC file.

    Args:
        path: The motion.
        skeleton_path: The ASF file; by default the one beside the motion with the name of its
            subject (`07.asf` for `07_02.amc`), else the only one there.

    Raises:
        FormatError: If a file is malformed, or the skeleton is not found or another one's.
        OSError: If a file cannot be opened.
    """
    path = Path(path)
    figure = read_asf(skeleton_path or _skeleton_beside(path))
    rows, notes = _rows(path, figure)
    return _motion(path, figure, rows, notes)


def read_asf(path: Path | str) -> AcclaimSkeleton:
    """Read an ASF file.

    Raises:
        FormatError: If it is malformed.
        OSError: If it cannot be opened.
    """
    path = Path(path)
    sections = _sections(path)
    words = (line.split() for _, line in sections.get("units", []))
    units = {word[0]: word[1] for word in words if len(word) > 1}
    metres = _metres_per_unit(path, units["length"]) if "length" in units else None
    radians = units.get("angle", "deg").strip().lower().startswith("rad")
    bones = [_root_bone(path, sections.get("root", []), radians)]
    bones += _bones(path, sections.get("bonedata", []), radians)
    parents = _parents(path, sections.get("hierarchy", []), [bone.name for bone in bones])
    return _figure(path, bones, parents, metres, radians)


def _metres_per_unit(path: Path, text: str) -> float:
    length = _number(path, text, "length under :units")
    if length <= 0.0:
        raise FormatError(path, f"the unit's length is {length:g}; expected a positive number")
    return _INCH / length


def _skeleton_beside(path: Path) -> Path:
    named = path.with_name(path.stem.partition("_")[0] + ".asf")
    there = sorted(path.parent.glob("*.[aA][sS][fF]"))
    if named in there:
        return named
    if len(there) != 1:
        raise FormatError(
            path, f"{len(there)} ASF files beside it, none called {named.name}; put its ASF there"
        )
    return there[0]


def _sections(path: Path) -> dict[str, list[tuple[int, str]]]:
    """Return the numbered lines of each `:section`, lower case, without comments."""
    sections: dict[str, list[tuple[int, str]]] = {}
    current: list[tuple[int, str]] = []
    for number, line in enumerate(_lines(path), start=1):
        text = line.partition("#")[0].strip()
        if text.startswith(":"):
            name, _, rest = text[1:].partition(" ")
            current = sections.setdefault(name.lower(), [])
            text = rest.strip()
        if text:
            current.append((number, text.lower() if not text.startswith("name") else text))
    if "bonedata" not in sections:
        raise FormatError(path, "no :bonedata section; expected an ASF skeleton")
    return sections


def _lines(path: Path) -> list[str]:
    raw = path.read_bytes()
    if b"\0" in raw:
        raise FormatError(path, "holds zero bytes; expected a text file")
    text = raw.decode("utf-8-sig", errors="replace")
    return re.split(r"\r*\n|\r", text) if "\r" in text else text.split("\n")


def _number(path: Path, text: str, what: str, line: int | None = None) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not abs(value) < _LARGEST:
        raise FormatError(path, f"{what}: {text[:20]!r} is no number", line)
    return value


def _numbers(path: Path, words: list[str], what: str, line: int, count: int) -> Floats:
    if len(words) < count:
        raise FormatError(path, f"{what} has {len(words)} values; expected {count}", line)
    return np.array([_number(path, word, what, line) for word in words[:count]])


def _axis(path: Path, words: list[str], line: int, radians: bool) -> Quaternions:
    angles = _numbers(path, words, "axis", line, 3)
    order = words[3] if len(words) > 3 else "xyz"
    if sorted(order) != ["x", "y", "z"]:
        raise FormatError(path, f"axis order {order!r}; expected letters such as XYZ", line)
    return _turn(angles if radians else np.deg2rad(angles), order)


def _turn(angles: Floats, order: str) -> Quaternions:
    """Turn about the first letter's axis first."""
    return quaternion.from_euler(angles[..., ::-1], order[::-1])


def _root_bone(path: Path, lines: list[tuple[int, str]], radians: bool) -> _Bone:
    order: tuple[str, ...] = _ROOT_ORDER
    letters, orientation = "xyz", ["0", "0", "0"]
    last = lines[-1][0] if lines else 1
    for _, line in lines:
        words = line.split()
        if words[0] == "order":
            order = tuple(words[1:])
        elif words[0] == "axis" and len(words) > 1:
            letters = words[1]
        elif words[0] == "orientation":
            orientation = words[1:]
    if not set(order) <= set(_ROOT_ORDER):
        raise FormatError(path, f"root order {' '.join(order)}; expected TX TY TZ RX RY RZ", last)
    axis = _axis(path, [*orientation, letters], last, radians)
    return _Bone(_ROOT, np.zeros(3), axis, order)


def _bones(path: Path, lines: list[tuple[int, str]], radians: bool) -> list[_Bone]:
    bones: list[_Bone] = []
    fields: dict[str, tuple[int, list[str]]] = {}
    for number, line in lines:
        words = line.split()
        if words[0] == "begin":
            fields = {}
        elif words[0] == "end":
            bones.append(_bone(path, fields, number, radians))
        else:
            fields.setdefault(words[0].lower(), (number, words[1:]))
    return bones


def _bone(path: Path, fields: dict[str, tuple[int, list[str]]], end: int, radians: bool) -> _Bone:
    for needed in ("name", "direction", "length"):
        if not fields.get(needed, (0, []))[1]:
            raise FormatError(path, f"a bone has no {needed}; export the file again", end)
    line, words = fields["direction"]
    direction = _numbers(path, words, "direction", line, 3)
    line, words = fields["length"]
    length = _number(path, words[0], "length", line)
    line, words = fields.get("axis", (end, ["0", "0", "0", "xyz"]))
    axis = _axis(path, words, line, radians)
    line, degrees = fields.get("dof", (end, []))
    if not set(degrees) <= set(_ROOT_ORDER):
        raise FormatError(path, f"dof {' '.join(degrees)}; expected some of rx ry rz", line)
    size = np.linalg.norm(direction)
    unit = direction / size if size > 0.0 else direction
    return _Bone(fields["name"][1][0], unit * length, axis, tuple(degrees))


def _parents(path: Path, lines: list[tuple[int, str]], names: list[str]) -> dict[str, str]:
    known = {name.lower(): name for name in names}
    parents: dict[str, str] = {}
    for number, line in lines:
        words = [known.get(word) for word in line.split()]
        if line in ("begin", "end"):
            continue
        if None in words:
            unknown = line.split()[words.index(None)]
            raise FormatError(path, f":hierarchy names {unknown!r}, which has no bone", number)
        for child in words[1:]:
            parents[str(child)] = str(words[0])
    return parents


def _figure(
    path: Path,
    bones: list[_Bone],
    parents: dict[str, str],
    metres_per_unit: float | None,
    radians: bool,
) -> AcclaimSkeleton:
    by_name = {bone.name: bone for bone in bones}
    order = [_ROOT]
    for name in order:
        order += [
            child for child, parent in parents.items() if parent == name and child not in order
        ]
    ordered = [by_name[name] for name in order]
    parent_of = [-1, *(order.index(parents[name]) for name in order[1:])]
    offsets = np.array([np.zeros(3), *(ordered[p].direction for p in parent_of[1:])])
    try:
        skeleton = Skeleton(tuple(order), tuple(parent_of), offsets)
    except SkeletonError as error:
        raise FormatError(path, f"{error}") from None
    leaves = [i for i in range(1, len(order)) if i not in parent_of]
    return AcclaimSkeleton(
        path,
        skeleton,
        {i: ordered[i].direction for i in leaves},
        metres_per_unit,
        radians,
        np.array([bone.axis for bone in ordered]),
        tuple(bone.degrees for bone in ordered),
    )


def _rows(path: Path, figure: AcclaimSkeleton) -> tuple[dict[str, Floats], list[str]]:
    """Return the values of each bone `(T, degrees)`; bones that a frame lacks keep their last."""
    lines = [
        (number, line)
        for number, line in enumerate(_lines(path), start=1)
        if line and not line.isspace() and line.lstrip()[0] not in "#:"
    ]
    counts = zip(figure.skeleton.names, map(len, figure.degrees), strict=True)
    lengths = {name: count for name, count in counts if count}
    regular = _regular_rows([line for _, line in lines], lengths)
    return (regular, []) if regular is not None else _irregular_rows(path, lines, lengths)


def _regular_rows(lines: list[str], lengths: dict[str, int]) -> dict[str, Floats] | None:
    """Read column by column where all frames name all bones in one order; None where not."""
    size = len(lengths) + 1
    if not lines or len(lines) % size or not all(line.strip().isdigit() for line in lines[::size]):
        return None
    rows: dict[str, Floats] = {}
    for at in range(1, size):
        name = lines[at].split(None, 1)[0]
        head = f"{name} "
        column = lines[at::size]
        if name not in lengths or not all(line.startswith(head) for line in column):
            return None
        values = numbers("".join(line[len(name) :] for line in column))
        if values is None or len(values) != len(column) * lengths[name]:
            return None
        if not np.all(np.abs(values) < _LARGEST):
            return None
        rows[name] = values.reshape(-1, lengths[name])
    return rows


def _irregular_rows(
    path: Path, lines: list[tuple[int, str]], lengths: dict[str, int]
) -> tuple[dict[str, Floats], list[str]]:
    """Read line by line: bones may be missing from frames, and faults are named with their line."""
    canonical = {name.lower(): name for name in lengths}
    values: dict[str, list[list[float]]] = {name: [] for name in lengths}
    at: dict[str, list[int]] = {name: [] for name in lengths}
    frame = -1
    for number, line in lines:
        words = line.split()
        if len(words) == 1 and words[0].isdigit():
            frame += 1
            continue
        name = canonical.get(words[0].lower())
        if name is None or frame < 0:
            what = "a bone that its ASF lacks" if frame >= 0 else "expected a frame number first"
            raise FormatError(path, f"{words[0][:30]!r}: {what}", number)
        if len(words) - 1 != lengths[name]:
            raise FormatError(
                path, f"{name} has {len(words) - 1} values; its ASF has {lengths[name]}", number
            )
        if at[name] and at[name][-1] == frame:
            raise FormatError(path, f"{name} occurs twice in frame {frame + 1}", number)
        values[name].append([_number(path, word, name, number) for word in words[1:]])
        at[name].append(frame)
    if frame < 0:
        raise FormatError(path, "holds no frame; expected an AMC motion")
    return _held(path, values, at, frame + 1)


def _held(
    path: Path, values: dict[str, list[list[float]]], at: dict[str, list[int]], frames: int
) -> tuple[dict[str, Floats], list[str]]:
    """Let values hold over frames that lack them."""
    if not at.get(_ROOT):
        raise FormatError(path, "the root has no values; expected them in every frame")
    rows, notes = {}, []
    for name, given in at.items():
        if given:
            latest = np.searchsorted(given, np.arange(frames), side="right") - 1
            rows[name] = np.array(values[name])[np.maximum(latest, 0)]
            if len(given) < frames:
                notes.append(
                    f"{name} is given in {len(given)} of {frames} frames and holds between"
                )
    absent = [name for name, given in at.items() if not given]
    if absent:
        notes.append(f"bones without values rest: {', '.join(absent)}")
    return rows, notes


def _motion(
    path: Path, figure: AcclaimSkeleton, rows: dict[str, Floats], notes: list[str]
) -> SourceMotion:
    frames = len(rows[_ROOT])
    rotations = quaternion.identity(frames, len(figure.skeleton), dtype=np.float64)
    root = np.zeros((frames, 3))
    for joint, (name, degrees) in enumerate(
        zip(figure.skeleton.names, figure.degrees, strict=True)
    ):
        if name not in rows:
            continue
        turns = [i for i, degree in enumerate(degrees) if degree[0] == "r"]
        angles = rows[name][:, turns]
        angles = angles if figure.radians else np.deg2rad(angles)
        turn = _turn(angles, "".join(degrees[i][1] for i in turns))
        axis = figure.axes[joint]
        rotations[:, joint] = quaternion.multiply(
            quaternion.multiply(axis, turn), quaternion.conjugate(axis)
        )
        for i, degree in enumerate(degrees):
            if name == _ROOT and degree[0] == "t":
                root[:, "xyz".index(degree[1])] = rows[name][:, i]
    return SourceMotion(
        path=path,
        skeleton=figure.skeleton,
        tips=figure.tips,
        frame_rate=None,
        root_positions=root,
        rotations=rotations,
        metres_per_unit=figure.metres_per_unit,
        notes=tuple(notes),
    )
