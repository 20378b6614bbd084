"""Importing: motion files to cleaned, retargeted, tagged clips, or a sentence that says why not."""

import multiprocessing
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from stridewire.formats.bvh import parse_bvh
from stridewire.formats.reading import READERS, read_motion
from stridewire.formats.source_motion import SourceMotion
from stridewire.motion.clip import Clip
from stridewire_engine.building.cleaning import clean, find_loop
from stridewire_engine.building.onto_reference import SHORTEST_S, RefusedError, bring
from stridewire_engine.building.profiles import Profile, shipped_profiles
from stridewire_engine.building.sidecars import Sidecar, Sidecars, Splits
from stridewire_engine.building.tagging import tag

ACCLAIM_RATE = 120.0
"""Frames per second where neither file nor index says it: most AMC files are CMU's."""

SLOWEST, FASTEST = 20.0, 240.0
"""Frame rates that can be imported; frames per second."""

_FEW = 8


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
    profile: str = ""
    """Name of the profile that mapped its joints."""
    unit: str = ""
    """Name of its unit of length, else the unit's metres."""


@dataclass(frozen=True)
class _Job:
    path: Path
    name: str
    sidecar: Sidecar


def motion_files(
    inputs: Iterable[Path], chosen: Collection[str] = (), splits: Splits | None = None
) -> list[Path]:
    """Return the motion files among files and in folders, sorted, each once.

    Args:
        inputs: Files, taken whatever their ending, and folders, searched for known endings.
        chosen: Take only files of these splits.
        splits: Which files are in which split; None where all are taken.

    Raises:
        SidecarError: If an index is malformed.
    """
    found: dict[Path, None] = {}
    sidecars = Sidecars()
    for path in inputs:
        inside = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in inside:
            known = file.suffix.lower() in READERS and file.is_file()
            if path.is_dir() and not known:
                continue
            if splits is None or splits.of(file, sidecars.of(file)) in chosen:
                found[file] = None
    return list(found)


def import_files(
    paths: Sequence[Path],
    *,
    profiles: Sequence[Profile] = (),
    frame_rate: float | None = None,
    metres_per_unit: float | None = None,
    jobs: int = 1,
) -> Iterator[Outcome]:
    """Import files in order; a bad one is refused and does not stop the others.

    Args:
        paths: Files.
        profiles: Tried before the shipped ones.
        frame_rate: Frames per second of all files, instead of what they or their indexes say.
        metres_per_unit: Of all files, where it cannot be told or they are no human's size.
        jobs: Processes that work at once.

    Raises:
        SidecarError: If an index is malformed.
    """
    sidecars = Sidecars()
    names = clip_names(paths)
    work = [_Job(path, names[path], sidecars.of(path)) for path in paths]
    every = (*profiles, *shipped_profiles())
    run = partial(
        _import_one, profiles=every, frame_rate=frame_rate, metres_per_unit=metres_per_unit
    )
    if jobs == 1 or len(work) < _FEW:
        yield from map(run, work)
        return
    # spawned, since a fork of a process with threads may hang
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context) as pool:
        yield from pool.map(run, work)


def import_file(
    path: Path,
    name: str | None = None,
    *,
    profiles: Sequence[Profile] = (),
    frame_rate: float | None = None,
    metres_per_unit: float | None = None,
    sidecar: Sidecar | None = None,
    shortest_s: float = SHORTEST_S,
) -> Outcome:
    """Import one file.

    Args:
        path: The file.
        name: Of the clip; the file's by default.
        profiles: Tried before the shipped ones.
        frame_rate: Frames per second, instead of what the file or its index says.
        metres_per_unit: Where it cannot be told or the figure is no human's size.
        sidecar: What an index says; by default looked up beside the file.
        shortest_s: Seconds that it has to last at least.

    Raises:
        ValueError: If it cannot be read or is not a human's motion.
        OSError: If it cannot be opened.
    """
    sidecar = Sidecars().of(path) if sidecar is None else sidecar
    source = read_motion(path)
    return _import_motion(source, name, profiles, frame_rate, metres_per_unit, sidecar, shortest_s)


def import_bvh_text(text: str, name: str, shortest_s: float = SHORTEST_S) -> Clip:
    """Import the text of a BVH file.

    Args:
        text: The file's content.
        name: Of the clip, and of the file in messages.
        shortest_s: Seconds that it has to last at least.

    Raises:
        ValueError: If it cannot be read or is not a human's motion.
    """
    source = parse_bvh(Path(name), text)
    clip = _import_motion(source, name, (), None, None, Sidecar(), shortest_s).clip
    assert clip is not None
    return clip


def _import_motion(
    source: SourceMotion,
    name: str | None,
    profiles: Sequence[Profile],
    frame_rate: float | None,
    metres_per_unit: float | None,
    sidecar: Sidecar,
    shortest_s: float,
) -> Outcome:
    path = source.path
    rate, timed = _frame_rate(source, frame_rate, sidecar)
    brought = bring(source, rate, profiles or shipped_profiles(), metres_per_unit, shortest_s)
    motion = brought.motion
    floor = 0.0 if motion.unchanged else None
    clip = clean(name or path.stem, motion.hips, motion.rotations, rate, path.name, floor)
    tagged = find_loop(tag(clip, f"{path.stem} {sidecar.words}"))
    notes = (*timed, *brought.notes, *(["it loops"] if tagged.loops else []))
    return Outcome(path, tagged, "", notes, brought.profile.name, brought.unit)


def clip_names(paths: Sequence[Path]) -> dict[Path, str]:
    """Name clips after their files; files of one name get their folder's in front."""
    names: dict[Path, str] = {}
    taken: set[str] = set()
    stems = Counter(path.stem for path in paths)
    for path in paths:
        alone = stems[path.stem] == 1
        base = path.stem if alone else f"{path.resolve().parent.name}-{path.stem}"
        name, number = base, 1
        while name in taken:
            number += 1
            name = f"{base}-{number}"
        names[path] = name
        taken.add(name)
    return names


def _import_one(
    job: _Job,
    profiles: Sequence[Profile],
    frame_rate: float | None,
    metres_per_unit: float | None,
) -> Outcome:
    try:
        return import_file(
            job.path,
            job.name,
            profiles=profiles,
            frame_rate=frame_rate,
            metres_per_unit=metres_per_unit,
            sidecar=job.sidecar,
        )
    except (ValueError, OSError) as error:
        text = str(error)
        return Outcome(job.path, None, text if str(job.path) in text else f"{job.path}: {text}")


def _frame_rate(
    source: SourceMotion, given: float | None, sidecar: Sidecar
) -> tuple[float, list[str]]:
    """Return the frame rate and a note where it is not the file's own."""
    rate = given or sidecar.frame_rate or source.frame_rate or ACCLAIM_RATE
    if not SLOWEST <= rate <= FASTEST:
        raise RefusedError(
            f"{source.path}: {rate:g} frames per second; expected {SLOWEST:g} to {FASTEST:g} "
            "(if the file is wrong, give the true rate with --rate)"
        )
    if given or rate == source.frame_rate:
        return rate, []
    if sidecar.frame_rate is None:
        return rate, [f"says no frame rate; {rate:g} frames per second were assumed"]
    if source.frame_rate is None or abs(rate - source.frame_rate) < 0.01 * rate:
        return rate, []
    said = f"says {source.frame_rate:g} frames per second, its index {rate:g}, which holds"
    return rate, [said]
