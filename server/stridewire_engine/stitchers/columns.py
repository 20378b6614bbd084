"""Columns: dataclasses of plain arrays, one row a character, that say the shape of their rows."""

from dataclasses import field, fields
from typing import Any

import numpy as np


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
