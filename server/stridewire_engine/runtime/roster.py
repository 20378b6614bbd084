"""The roster: which characters a session has and where their state lies."""

import numpy as np

from stridewire._messages import FrameFlag
from stridewire.motion.array_types import Floats, Indices


class Roster:
    """Ids, rows of the crowd and pending flags of a session's characters."""

    def __init__(self) -> None:
        self.ids: Indices = np.zeros(0, np.uint32)
        """`(N,)` the caller's ids."""
        self.rows: Indices = np.zeros(0, np.intp)
        """`(N,)` rows of the crowd."""
        self.scales: Floats = np.zeros(0)
        """`(N,)` sizes in the reference skeleton's."""
        self.of_one_size = True
        """Whether all are of the reference skeleton's."""
        self._flags: Indices = np.zeros(0, np.uint32)

    def __len__(self) -> int:
        return len(self.ids)

    def add(self, ids: Indices, rows: Indices, scales: Floats) -> None:
        """Add characters at the end."""
        self.ids = np.concatenate([self.ids, ids.astype(np.uint32)])
        self.rows = np.concatenate([self.rows, rows])
        self._size(np.concatenate([self.scales, scales]))
        self._flags = np.concatenate([self._flags, np.zeros(len(ids), np.uint32)])

    def remove(self, place: int) -> None:
        """Take a character out."""
        self.ids = np.delete(self.ids, place)
        self.rows = np.delete(self.rows, place)
        self._size(np.delete(self.scales, place))
        self._flags = np.delete(self._flags, place)

    def _size(self, scales: Floats) -> None:
        self.scales, self.of_one_size = scales, bool(np.all(scales == 1.0))

    def places(self, ids: Indices) -> Indices:
        """Return the place `(M,)` of each id `(M,)`, -1 for an unknown one."""
        order = np.argsort(self.ids, kind="stable")
        at = np.minimum(np.searchsorted(self.ids[order], ids), len(self) - 1)
        places = order[at]
        return np.where(self.ids[places] == ids, places, -1)

    def place(self, character: int) -> int:
        """Return the place of an id, -1 for an unknown one."""
        return int(self.places(np.array([character], np.int64))[0])

    def flag(self, places: slice | int | Indices, flag: FrameFlag) -> None:
        """Set a flag in the next frame."""
        self._flags[places] |= np.uint32(1 << flag)

    def take_flags(self) -> Indices:
        """Return the pending flags `(N,)` and clear them."""
        flags, self._flags = self._flags, np.zeros(len(self), np.uint32)
        return flags
