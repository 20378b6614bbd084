"""Columns: dataclasses of plain arrays, one row a character, that say the shape of their rows."""

from dataclasses import field, fields
from typing import Any, Self

import numpy as np

from stridewire.motion.array_types import Indices


def column(*shape: int | str, dtype: type = np.float32, fill: float = 0.0) -> Any:
    """Describe an array `(N, *shape)`; sizes that are not known yet have names, such as J."""
    return field(metadata={"shape": shape, "dtype": dtype, "fill": fill})


def allocate(kind: type, rows: int, sizes: dict[str, int]) -> dict[str, Any]:
    """Return fresh arrays for all columns of a dataclass, by name.

    Args:
        kind: The dataclass.
        rows: Of each array.
        sizes: Of the named sizes.
    """
    arrays = {}
    for described in fields(kind):
        shape = [sizes[n] if isinstance(n, str) else n for n in described.metadata["shape"]]
        arrays[described.name] = np.full(
            (rows, *shape), described.metadata["fill"], described.metadata["dtype"]
        )
    return arrays


class Columns:
    """Base of such dataclasses: rows of theirs can be taken out and put back."""

    _lender: "tuple[Self, slice | Indices]"

    def take(self, rows: slice | Indices) -> Self:
        """Return some rows: views for a slice, copies for indices."""
        return type(self)(**{name: array[rows] for name, array in vars(self).items()})

    def borrow(self, rows: slice | Indices) -> Self:
        """Return some rows like `take`, but a column only when it is first asked for.

        Most of what is done to a few rows needs few of their columns. Until they are put back,
        these rows must not be changed otherwise.
        """
        part = object.__new__(type(self))
        object.__setattr__(part, "_lender", (self, rows))
        return part

    def put(self, rows: slice | Indices, part: Self) -> None:
        """Write rows back; of borrowed ones, the columns that were asked for."""
        for name, array in vars(part).items():
            if name != "_lender":
                getattr(self, name)[rows] = array

    def __getattr__(self, name: str) -> Any:
        # only for what is not there yet: a column that was not asked for
        if name.startswith("_"):
            raise AttributeError(name)
        lender, rows = self._lender
        array = getattr(lender, name)[rows]
        self.__dict__[name] = array
        return array
