"""The controls that hold in a session, so that it can be opened again under the same."""

from collections.abc import Sequence

import numpy as np

from stridewire._messages import Sparse, Step
from stridewire.motion.array_types import Flags, Floats, Indices


class HeldControls:
    """Remembers the last control of each character; trajectories are not kept.

    Args:
        characters: Ids.
    """

    def __init__(self, characters: Sequence[int]) -> None:
        self.filters: dict[int, str] = {}
        """The last filter of each character that was given one in a step."""
        self._gaits: dict[int, str] = {}
        self._place = {id: place for place, id in enumerate(characters)}
        self._velocity: Floats = np.zeros((len(characters), 2), np.float32)
        self._facing: Floats = np.full(len(characters), np.nan, np.float32)

    def note(self, step: Step) -> None:
        """Take note of a step's controls; unknown ids are the server's to refuse."""
        rows, known = self._rows(step)
        if step.velocity_xz is not None:
            self._velocity[rows] = step.velocity_xz[known]
        if step.facing_yaw is not None:
            self._facing[rows] = step.facing_yaw[known]
        for sparse in step.sparse:
            if sparse.filter is not None:
                self.filters[sparse.character] = sparse.filter
                self._gaits.pop(sparse.character, None)
            elif sparse.gait is not None:
                self._gaits[sparse.character] = sparse.gait

    def keep(self, characters: Sequence[int]) -> None:
        """Forget characters that are gone and take in new ones."""
        before, self._place = self._place, {id: place for place, id in enumerate(characters)}
        velocity = np.zeros((len(characters), 2), np.float32)
        facing = np.full(len(characters), np.nan, np.float32)
        for id, place in self._place.items():
            if id in before:
                velocity[place] = self._velocity[before[id]]
                facing[place] = self._facing[before[id]]
        self._velocity, self._facing = velocity, facing
        for kept in (self.filters, self._gaits):
            for gone in set(kept) - set(self._place):
                del kept[gone]

    def step(self, number: int) -> Step:
        """Return a step that asks for all of it and lets no time pass."""
        return Step(
            step=number,
            dt_s=0.0,
            characters=np.fromiter(self._place, np.uint32),
            velocity_xz=self._velocity,
            facing_yaw=self._facing,
            sparse=tuple(Sparse(id, gait=gait) for id, gait in self._gaits.items()),
        )

    def _rows(self, step: Step) -> tuple[Indices | slice, Flags | slice]:
        """Return rows, and which of the step's characters they belong to."""
        if step.characters is None:
            return slice(None), slice(None)
        places = np.array([self._place.get(id, -1) for id in step.characters.tolist()], np.intp)
        known = places >= 0
        return places[known], known
