"""Answers to queries: clips looked up, checked, stitched."""

from collections.abc import Iterator, Sequence

from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import StitchPart, StitchQuery
from stridewire.motion.clip import Clip
from stridewire_engine.networks.rmr.refiner import refiner_if_shipped
from stridewire_engine.stitching.checks import check_clips, check_query
from stridewire_engine.stitching.sources import BvhReader, Libraries, clip_of, one_skeleton
from stridewire_engine.stitching.stitch import Stitching


def answer(libraries: Libraries, read_bvh: BvhReader, query: StitchQuery) -> Iterator[StitchPart]:
    """Stitch clips of libraries, clips that were sent and texts of files.

    Everything is checked before the first part comes.

    Raises:
        InvalidRequestError: If a field is not allowed.
        NotFoundError: If there is no such library or clip.
    """
    _refuse(*check_query(query))
    paths = [f"clips[{i}]" for i in range(len(query.clips))]
    clips = [
        clip_of(path, source, libraries, read_bvh)
        for path, source in zip(paths, query.clips, strict=True)
    ]
    return stitching(paths, clips, query).parts()


def stitching(paths: Sequence[str], clips: Sequence[Clip], query: StitchQuery) -> Stitching:
    """Return the motion that clips at 60 frames/s will be.

    Args:
        paths: What the clips are called in messages.
        clips: In order.
        query: Says how.

    Raises:
        InvalidRequestError: If the clips do not go together or something else is not allowed.
    """
    one_skeleton(paths, clips)
    _refuse(*check_query(query), *check_clips(query, paths, clips))
    return Stitching(clips, query, refiner_if_shipped())


def _refuse(*wrong: Violation) -> None:
    if wrong:
        raise InvalidRequestError.of(*wrong)
