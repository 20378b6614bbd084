"""From a file's motion to the reference skeleton: cleaned, mapped, retargeted, its unit found."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from stridewire.formats.bvh_writing import clip_in_centimetres
from stridewire.formats.source_motion import SourceMotion
from stridewire.formats.units import unit_name
from stridewire.motion.clip import Clip
from stridewire.motion.root import extract_root
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE
from stridewire_engine.building.cleaning import gaps, ground, leading_pose, mend_spikes
from stridewire_engine.building.figure import hip_height
from stridewire_engine.building.profiles import Profile, shipped_profiles
from stridewire_engine.building.retarget import Retargeted, fits, retarget
from stridewire_engine.building.unit_finding import find_unit
from stridewire_engine.rigs.joint_mapping import map_joints

SHORTEST_S = 0.25
"""Shorter files are refused where nothing else is asked for; seconds."""


class RefusedError(ValueError):
    """A file that can be read but not imported; the message says why and what to do."""


@dataclass(frozen=True)
class Brought:
    """A motion brought onto the reference skeleton."""

    motion: Retargeted
    """At the file's frame rate, the ground wherever the file has it."""
    profile: Profile
    unit: str
    """Name of the file's unit of length, else its metres."""
    notes: tuple[str, ...]
    """What was odd, the reader's notes first."""


def bring(
    source: SourceMotion,
    frame_rate: float,
    profiles: Sequence[Profile],
    metres_per_unit: float | None = None,
    shortest_s: float = SHORTEST_S,
) -> Brought:
    """Cut what lies before the motion, mend it, map its joints, retarget it and find its unit.

    Args:
        source: As read.
        frame_rate: Frames per second, the true one.
        profiles: Which may map its joints.
        metres_per_unit: Of the file, by a person's word.
        shortest_s: Seconds that it has to last at least.

    Raises:
        ValueError: If it is too short or no human's motion; the message names the file.
    """
    cut = leading_pose(source)
    notes = [f"{cut} frame(s) before the motion begins were cut"] if cut else []
    source, mended = mend_spikes(source.after(cut), frame_rate)
    notes += [*mended, *gaps(source, frame_rate)]
    if len(source) < shortest_s * frame_rate:
        raise RefusedError(
            f"{source.path}: {len(source)} frames at {frame_rate:g} per second; expected at least "
            f"{shortest_s:g} s"
        )
    profile = find_profile(source, profiles)
    motion = retarget(source, profile, frame_rate)
    hips = hip_height() / motion.scale
    metres, sized = find_unit(source.path, hips, source.metres_per_unit, metres_per_unit)
    said = (*source.notes, *notes, *motion.notes, *([sized] if sized else []))
    return Brought(motion, profile, unit_name(metres), said)


def find_profile(source: SourceMotion, profiles: Sequence[Profile]) -> Profile:
    """Return the fitting profile that names most joints, else one made up for this skeleton.

    Raises:
        MappingError: If no profile fits and the skeleton's parts cannot be told.
    """
    for profile in sorted(profiles, key=lambda p: (-len(p.joints), not p.axes)):
        if fits(source, profile):
            return profile
    return Profile("by names", source.path.name, map_joints(source.skeleton).joints)


def onto_reference(source: SourceMotion, metres_per_unit: float | None = None) -> SourceMotion:
    """Return a motion on the reference skeleton: in centimetres, Y up, the ground at 0.

    This is what `stridewire convert --skeleton reference` finds by its entry point.

    Args:
        source: Of any human, at a known frame rate.
        metres_per_unit: Of the file, by a person's word.

    Raises:
        ValueError: If it is too short or no human's motion; the message names the file.
    """
    if source.frame_rate is None:
        raise RefusedError(f"{source.path} says no frame rate; give one with --true-rate")
    rate = source.frame_rate
    brought = bring(source, rate, shipped_profiles(), metres_per_unit)
    motion = brought.motion
    hips = motion.hips
    if not motion.unchanged:
        hips = hips - np.array([0.0, ground(hips, motion.rotations, rate), 0.0])
    pose = extract_root(REFERENCE, hips, motion.rotations, rate)
    contacts = np.zeros((len(hips), len(CONTACT_JOINTS)), bool)
    clip = Clip(source.name, REFERENCE, rate, pose, contacts, source=source.path.name)
    notes = (*brought.notes, f"its unit is {brought.unit}, its profile {brought.profile.name!r}")
    return replace(clip_in_centimetres(clip, source.path), notes=notes)
