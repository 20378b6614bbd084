"""What the libraries hold: details, clips page by page, poses by span."""

from stridewire._errors import InvalidRequestError, Violation
from stridewire._messages import (
    ClipInfo,
    ClipPage,
    ClipPoses,
    ClipQuery,
    ClipsQuery,
    LibraryDetails,
    TagTime,
)
from stridewire.motion.clip import Clip
from stridewire.motion.contacts import to_mask
from stridewire_engine.library import ClipEntry, Library

MAX_SPAN_S = 60.0
MAX_PAGE = 1000
DEFAULT_PAGE = 100


def details(library: Library) -> LibraryDetails:
    """Tell what a library holds."""
    return LibraryDetails(library.info(), library.seconds_by_tag())


def clips(library: Library, query: ClipsQuery) -> ClipPage:
    """Return a page of clips, in the order of the library.

    Raises:
        InvalidRequestError: If the size or the token of the page is not allowed.
    """
    fitting = [entry for entry in library.clips if _fits(entry, query)]
    start, size = _page(query, len(fitting))
    return ClipPage(
        tuple(_info(entry, library.frame_rate) for entry in fitting[start : start + size]),
        str(start + size) if start + size < len(fitting) else "",
        len(fitting),
    )


def poses(library: Library, query: ClipQuery) -> ClipPoses:
    """Return the poses of a clip's span.

    Raises:
        InvalidRequestError: If the span is not within the clip, or too long.
        NotFoundError: If there is no such clip.
    """
    clip = library.clip(query.clip)
    part = _cut(clip, query)
    return ClipPoses(
        _info(library.entry(clip.name), library.frame_rate),
        clip.frame_rate,
        part.pose,
        to_mask(part.contacts),
    )


def _fits(entry: ClipEntry, query: ClipsQuery) -> bool:
    tagged = not query.tag or any(tag.name == query.tag for tag in entry.tags)
    return tagged and query.name_contains in entry.name


def _page(query: ClipsQuery, total: int) -> tuple[int, int]:
    """Return the first clip and the number of clips of a page."""
    if not 0 <= query.page_size <= MAX_PAGE:
        raise InvalidRequestError.of(
            Violation(
                "page_size",
                f"{query.page_size}; allowed are 0 (means {DEFAULT_PAGE}) to {MAX_PAGE}",
            )
        )
    token = query.page_token or "0"
    known = token.isascii() and token.isdigit() and len(token) < 10
    if not (known and int(token) <= total):
        raise InvalidRequestError.of(
            Violation("page_token", f"{token!r} is of no page; give next_page_token as it came")
        )
    return int(token), query.page_size or DEFAULT_PAGE


def _cut(clip: Clip, query: ClipQuery) -> Clip:
    """Return the frames of a span."""
    end_s = query.end_s or clip.seconds
    if not 0.0 <= query.start_s <= end_s <= clip.seconds + 1e-6:
        raise InvalidRequestError.of(
            Violation(
                "span",
                f"{query.start_s:g} s to {end_s:g} s; clip {clip.name!r} goes from 0 to "
                f"{clip.seconds:g} s",
            )
        )
    if end_s - query.start_s > MAX_SPAN_S:
        raise InvalidRequestError.of(
            Violation("span", f"{end_s - query.start_s:g} s; ask for {MAX_SPAN_S:g} s at most")
        )
    first, last = round(query.start_s * clip.frame_rate), round(end_s * clip.frame_rate)
    return clip.cut(first, last + 1)


def _info(entry: ClipEntry, frame_rate: float) -> ClipInfo:
    return ClipInfo(
        entry.name,
        (entry.frames - 1) / frame_rate,
        entry.frames,
        entry.source,
        tuple(
            TagTime(tag.name, tag.start / frame_rate, tag.end / frame_rate) for tag in entry.tags
        ),
    )
