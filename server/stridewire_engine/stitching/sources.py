"""Sources: the clips of a request, whatever they are given as, at 60 frames/s on one skeleton."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import BvhText, ClipSpan
from stridewire.motion import kinematics, quaternion
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.contacts import detect_contacts
from stridewire.motion.resample import resample_rotations, resample_values
from stridewire_engine.library import Library

FRAME_RATE = 60.0
"""Frames per second of everything that is stitched."""

Libraries = Callable[[str], Library]
"""Returns an open library by name, empty for the default; raises `NotFoundError`."""
BvhReader = Callable[[str, str], Clip]
"""Returns the clip in the text of a BVH file, which it calls by a name in messages."""


def clip_of(
    path: str, source: ClipSpan | Clip | BvhText, libraries: Libraries, read_bvh: BvhReader
) -> Clip:
    """Return one source as a clip at 60 frames/s, with contacts.

    Args:
        path: Of its field.
        source: A span of a library, a clip that `checks` has found to be one, or a file's text.
        libraries: Of the runtime.
        read_bvh: Brings files onto the reference skeleton.

    Raises:
        InvalidRequestError: If the span is not within its clip, or the file cannot be read.
        NotFoundError: If there is no such library or clip.
    """
    match source:
        case ClipSpan():
            return at_rate(_span(path, source, libraries), FRAME_RATE)
        case Clip():
            return _with_contacts(at_rate(source, FRAME_RATE))
        case BvhText():
            try:
                return read_bvh(source.text, f"{path}.bvh")
            except ValueError as error:
                raise InvalidRequestError.of(Violation(f"{path}.bvh", str(error))) from error


def at_rate(clip: Clip, frame_rate: float) -> Clip:
    """Return a clip at another rate, velocities continuous; the same clip where it has it."""
    if clip.frame_rate == frame_rate or len(clip) < 2:
        return clip
    rates = clip.frame_rate, frame_rate
    pose = Pose(
        resample_values(clip.pose.root_position, *rates),
        resample_rotations(clip.pose.root_rotation, *rates),
        resample_values(clip.pose.hips, *rates),
        resample_rotations(clip.pose.rotations, *rates),
    )
    nearest = np.round(np.arange(len(pose.hips)) * (rates[0] / rates[1])).astype(np.intp)
    contacts = clip.contacts[np.minimum(nearest, len(clip) - 1)]
    return replace(clip, frame_rate=frame_rate, pose=pose, contacts=contacts, tags=())


def one_skeleton(paths: Sequence[str], clips: Sequence[Clip]) -> None:
    """Check that clips share a skeleton.

    Raises:
        InvalidRequestError: If one has another than the first.
    """
    wrong = [
        Violation(
            path,
            f"of another skeleton than {paths[0]}; stitch alike, or give BVH text, which is "
            "brought onto the reference skeleton",
        )
        for path, clip in zip(paths, clips, strict=True)
        if clip.skeleton != clips[0].skeleton
    ]
    if wrong:
        raise InvalidRequestError.of(*wrong)


def _span(path: str, span: ClipSpan, libraries: Libraries) -> Clip:
    clip = libraries(span.library).clip(span.clip)
    end_s = span.end_s or clip.seconds
    if not 0.0 <= span.start_s <= end_s <= clip.seconds + 1e-6:
        raise InvalidRequestError.of(
            Violation(
                f"{path}.span",
                f"{span.start_s:g} s to {end_s:g} s; clip {span.clip!r} goes from 0 to "
                f"{clip.seconds:g} s",
            )
        )
    rate = clip.frame_rate
    return clip.cut(round(span.start_s * rate), round(end_s * rate) + 1)


def _with_contacts(clip: Clip) -> Clip:
    """Find contacts anew: a wire carries none."""
    pose = clip.pose
    turn = pose.root_rotation
    hips = pose.root_position + quaternion.rotate(turn, pose.hips)
    rotations = pose.rotations.copy()
    rotations[:, 0] = quaternion.multiply(turn, rotations[:, 0])
    positions, _ = kinematics.forward(clip.skeleton, hips, rotations)
    return replace(clip, contacts=detect_contacts(clip.skeleton, positions, clip.frame_rate))
