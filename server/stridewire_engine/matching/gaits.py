"""Gaits: sugar for filters. A gait is the fastest that is allowed; slower ones stay allowed.

    idle   `idle`
    walk   `idle | walk`
    jog    `idle | walk | jog`
    run    `idle | walk | jog | run`
    any    no filter

Tags that the library lacks are left out.
"""

from collections.abc import Sequence

from stridewire._errors import InvalidRequestError, Violation

GAITS = ("idle", "walk", "jog", "run")
ANY = "any"


def gait_filter(gait: str, path: str, tags: Sequence[str]) -> str:
    """Return the filter that a gait stands for.

    Args:
        gait: One of `GAITS`, or `any`.
        path: Field path for errors.
        tags: Tags of the library.

    Raises:
        InvalidRequestError: If there is no such gait, or the library has nothing for it.
    """
    if gait == ANY:
        return ""
    if gait not in GAITS:
        what = f"{gait!r} is no gait; gaits are {', '.join((*GAITS, ANY))}; or give a filter"
        raise InvalidRequestError.of(Violation(path, what))
    slower = [tag for tag in GAITS[: GAITS.index(gait) + 1] if tag in tags]
    if not slower:
        what = f"this library has no clip for {gait!r}; its tags: {', '.join(tags)}"
        raise InvalidRequestError.of(Violation(path, what))
    return " | ".join(slower)
