"""A named script and how to find one."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stridewire._errors import NotFoundError
from stridewire.motion.array_types import Floats
from stridewire.scripts.cast import Cast
from stridewire.scripts.patterns import PATTERNS, Pattern

SCRIPT_NAMES = tuple(PATTERNS)
"""Names of all scripts."""


class Controls(NamedTuple):
    """What is asked of N characters at one moment, as a `Step` takes it."""

    velocity: Floats
    """`(N, 2)` float32 desired velocity x, z in the world, m/s."""
    facing: Floats
    """`(N,)` float32 desired heading about +Y in radians; NaN means along the velocity."""


@dataclass(frozen=True)
class Script:
    """A control script; see `script`."""

    name: str
    description: str
    """One line for lists."""
    pattern: Pattern

    def controls(self, time_s: float | Floats, characters: int, seed: int = 0) -> Controls:
        """Return the controls of characters 0 to `characters` - 1 at a moment, or at many.

        Args:
            time_s: Seconds since the script began; `(T, 1)` asks for T moments, and what is
                returned has T in front.
            characters: How many, N.
            seed: Draws headings, phases and sides.
        """
        speed, heading, facing = self.pattern(time_s, Cast(seed, np.arange(characters)))
        shape = np.broadcast_shapes(np.shape(time_s), (characters,))
        heading = np.broadcast_to(heading, shape)
        velocity = speed[..., None] * np.stack([np.sin(heading), np.cos(heading)], axis=-1)
        facing = np.broadcast_to(np.nan if facing is None else facing, shape)
        return Controls(velocity.astype(np.float32), facing.astype(np.float32))


def script(name: str) -> Script:
    """Return the script of a name.

    Raises:
        NotFoundError: If there is none; the message lists the names.
    """
    pattern = PATTERNS.get(name)
    if pattern is None:
        raise NotFoundError(f"no control script {name!r}; there are {', '.join(SCRIPT_NAMES)}")
    description = (pattern.__doc__ or "").partition("\n")[0]
    return Script(name, description, pattern)
