"""Answers in parts: queries that a runtime's libraries and offline tools answer together."""

from collections.abc import Iterator
from typing import Any

from stridewire._messages import PartsQuery, PartT, StitchQuery
from stridewire.motion.clip import Clip
from stridewire_engine import stitching
from stridewire_engine.building.importing import import_bvh_text
from stridewire_engine.runtime import Runtime


def answer_parts(runtime: Runtime, query: PartsQuery[PartT]) -> Iterator[PartT]:
    """Answer a query part by part.

    It reads the runtime's libraries, which never change, and needs no turn in its thread.

    Raises:
        InvalidRequestError: If a field is not allowed.
        NotFoundError: If there is no such library or clip.
    """
    parts: Iterator[PartT] = _parts(runtime, query)
    return parts


def _parts(runtime: Runtime, query: PartsQuery[Any]) -> Any:
    match query:
        case StitchQuery():
            return stitching.answer(runtime.library, _read_bvh, query)
    raise TypeError(f"{type(query).__name__} is no query that is answered in parts")


def _read_bvh(text: str, name: str) -> Clip:
    return import_bvh_text(text, name, stitching.SHORTEST_S)
