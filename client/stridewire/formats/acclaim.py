"""Reading Acclaim: a skeleton (ASF) and its motions (AMC).

A bone's joint is where the bone begins. Each bone turns in an axis frame C of its own: with the
rotation M of its degrees of freedom its local rotation is C M C^-1, so that zero angles are the
rest pose and all joints' frames are parallel there.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stridewire.formats.source_motion import FormatError, SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats, Quaternions, Vectors
from stridewire.motion.skeleton import Skeleton, SkeletonError

_INCH = 0.0254
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
    metres_per_unit: float
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
    units = dict(line.split(None, 1) for _, line in sections.get("units", []) if " " in line)
    length = _number(path, units.get("length", "1"), "length under :units")
    if length <= 0.0:
        raise FormatError(path, f"the unit's length is {length:g}; expected a positive number")
    radians = units.get("angle", "deg").strip().lower().startswith("rad")
    bones = [_root_bone(path, sections.get("root", []), radians)]
    bones += _bones(path, sections.get("bonedata", []), radians)
    parents = _parents(path, sections.get("hierarchy", []), [bone.name for bone in bones])
    return _figure(path, bones, parents, _INCH / length, radians)


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
    return re.split(r"\r*\n|\r", raw.decode("utf-8-sig", errors="replace"))


def _number(path: Path, text: str, what: str, line: int | None = None) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not abs(value) < 1e9:
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
    metres_per_unit: float,
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
    lengths = {
        name: len(degrees)
        for name, degrees in zip(figure.skeleton.names, figure.degrees, strict=True)
    }
    canonical = {name.lower(): name for name in lengths}
    values: dict[str, list[str]] = {name: [] for name in lengths}
    frames = 0
    notes: list[str] = []
    for number, line in enumerate(_lines(path), start=1):
        words = line.split()
        if not words or words[0][0] in "#:":
            continue
        if len(words) == 1 and words[0].isdigit():
            frames += 1
            continue
        name = canonical.get(words[0].lower())
        if name is None or frames == 0:
            what = "a bone that its ASF lacks" if frames else "expected a frame number first"
            raise FormatError(path, f"{words[0][:30]!r}: {what}", number)
        if len(words) - 1 != lengths[name]:
            raise FormatError(
                path, f"{name} has {len(words) - 1} values; its ASF has {lengths[name]}", number
            )
        column = values[name]
        if len(column) // max(lengths[name], 1) >= frames:
            raise FormatError(path, f"{name} occurs twice in frame {frames}", number)
        column += words[1:]
    if frames == 0:
        raise FormatError(path, "holds no frame; expected an AMC motion")
    return _columns(path, values, lengths, frames, notes), notes


def _columns(
    path: Path,
    values: dict[str, list[str]],
    lengths: dict[str, int],
    frames: int,
    notes: list[str],
) -> dict[str, Floats]:
    columns: dict[str, Floats] = {}
    absent = []
    for name, words in values.items():
        if lengths[name] == 0:
            continue
        if not words:
            absent.append(name)
            columns[name] = np.zeros((frames, lengths[name]))
            continue
        try:
            rows = np.array(words, np.float64).reshape(-1, lengths[name])
        except ValueError:
            raise FormatError(path, f"{name} holds something that is no number") from None
        if not np.all(np.abs(rows) < 1e9):
            raise FormatError(path, f"{name} holds a number that is not finite")
        if len(rows) < frames:
            notes.append(f"{name} is given in {len(rows)} of {frames} frames; its last value holds")
            rows = np.concatenate([rows, np.repeat(rows[-1:], frames - len(rows), axis=0)])
        columns[name] = rows
    if _ROOT in absent:
        raise FormatError(path, "the root has no values; expected them in every frame")
    if absent:
        notes.append(f"bones without values rest: {', '.join(absent)}")
    return columns


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
