"""Retargeting to other skeletons: what installed packages offer, found by their entry points."""

from importlib.metadata import entry_points
from typing import Protocol

from stridewire._errors import StridewireError
from stridewire.formats.source_motion import SourceMotion

_GROUP = "stridewire.skeletons"


class Retargeting(Protocol):
    """Brings a motion onto one skeleton."""

    def __call__(self, source: SourceMotion, metres_per_unit: float | None = None) -> SourceMotion:
        """Return the motion on that skeleton, in centimetres, Y up.

        Args:
            source: At a known frame rate.
            metres_per_unit: Of the file, by a person's word; None where it is to be found.

        Raises:
            ValueError: If the motion cannot be brought there.
        """


def find_retargeting(skeleton: str) -> Retargeting:
    """Return what brings motions onto a skeleton, such as `reference`.

    Raises:
        StridewireError: If no installed package does, or what it needs is not installed.
    """
    for point in entry_points(group=_GROUP, name=skeleton):
        try:
            found: Retargeting = point.load()
        except ModuleNotFoundError as error:
            raise StridewireError(
                f"retargeting to the {skeleton} skeleton needs {error.name}: "
                "pip install 'stridewire[server]'"
            ) from error
        return found
    offered = sorted(point.name for point in entry_points(group=_GROUP))
    raise StridewireError(
        f"nothing brings motions onto a skeleton {skeleton!r}; offered: "
        + (", ".join(offered) or "none; pip install 'stridewire[server]'")
    )
