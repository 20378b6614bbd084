"""Numbers in text, read as one block: the bulk of every motion file."""

import warnings

import numpy as np

from stridewire.motion.array_types import Floats


def numbers(text: str) -> Floats | None:
    """Return all numbers `(N,)` of a text of numbers and white space; None where a word is none."""
    with warnings.catch_warnings():
        # numpy reads up to the first word that is no number, and warns
        warnings.simplefilter("error", DeprecationWarning)
        try:
            return np.fromstring(text, dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
