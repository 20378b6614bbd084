"""Importing: motion files to cleaned, retargeted, tagged clips, or a sentence that says why not."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from stridewire.formats.reading import read_motion
from stridewire.formats.source_motion import SourceMotion
from stridewire.motion.clip import Clip
from stridewire_engine.building.cleaning import clean
from stridewire_engine.building.joint_mapping import map_joints
from stridewire_engine.building.profiles import Profile, shipped_profiles
from stridewire_engine.building.retarget import fits, retarget
from stridewire_engine.building.tagging import tag

ENDINGS = (".bvh", ".amc")
"""Endings of the files that can be imported."""

ACCLAIM_RATE = 120.0
"""Frames per second where the file says nothing: most AMC files are CMU's."""

_FEWEST_FRAMES = 10


class RefusedError(ValueError):
    """A file that can be read but not imported; the message says why and what to do."""


@dataclass(frozen=True)
class Outcome:
    """What became of one file."""

    path: Path
    clip: Clip | None
    """None where the file was refused."""
    problem: str = ""
    """Why it was refused."""
    notes: tuple[str, ...] = ()
    """What was odd about it."""


def motion_files(inputs: Iterable[Path]) -> list[Path]:
    """Return the motion files among files and in folders, sorted, each once."""
    found: dict[Path, None] = {}
    for path in inputs:
        inside = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in inside:
            if not path.is_dir() or (file.suffix.lower() in ENDINGS and file.is_file()):
                found[file] = None
    return list(found)


def import_files(paths: Sequence[Path]) -> Iterator[Outcome]:
    """Import files one by one; a bad one is refused and does not stop the others."""
    profiles = shipped_profiles()
    names = clip_names(paths)
    for path in paths:
        try:
            yield import_file(path, profiles, names[path])
        except (ValueError, OSError) as error:
            yield Outcome(path, None, str(error))


def import_file(path: Path, profiles: Sequence[Profile], name: str) -> Outcome:
    """Import one file.

    Raises:
        ValueError: If it cannot be read or is not a human's motion.
        OSError: If it cannot be opened.
    """
    source = read_motion(path)
    profile = find_profile(source, profiles)
    if len(source) < _FEWEST_FRAMES:
        raise RefusedError(f"{path}: {len(source)} frames; expected at least {_FEWEST_FRAMES}")
    frame_rate = source.frame_rate or ACCLAIM_RATE
    motion = retarget(source, profile, frame_rate)
    floor = 0.0 if motion.unchanged else None
    clip = clean(name, motion.hips, motion.rotations, frame_rate, path.name, floor)
    return Outcome(path, tag(clip, path.stem), notes=(*source.notes, *motion.notes))


def clip_names(paths: Sequence[Path]) -> dict[Path, str]:
    """Name clips after their files; files of one name get their folder's in front."""
    names: dict[Path, str] = {}
    stems = [path.stem for path in paths]
    for path in paths:
        name = path.stem if stems.count(path.stem) == 1 else f"{path.parent.name}-{path.stem}"
        taken = set(names.values())
        names[path] = next(n for n in _numbered(name) if n not in taken)
    return names


def _numbered(name: str) -> Iterator[str]:
    yield name
    yield from (f"{name}-{number}" for number in range(2, 10**6))


def find_profile(source: SourceMotion, profiles: Sequence[Profile]) -> Profile:
    """Return the fitting profile that names most joints, else one made up for this skeleton.

    Raises:
        MappingError: If no profile fits and the skeleton's parts cannot be told.
    """
    for profile in sorted(profiles, key=lambda p: (-len(p.joints), not p.axes)):
        if fits(source, profile):
            return profile
    return Profile("unknown", source.path.name, map_joints(source.skeleton).joints)
