"""A session: one caller's characters, and the frames made of the tick's blocks."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from stridewire._errors import Violation
from stridewire._messages import (
    CharacterSpec,
    CharacterUpdate,
    Detail,
    Edit,
    Frame,
    FrameFlag,
    Limits,
    Opened,
    Step,
    StreamError,
)
from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.runtime import admission, controls
from stridewire_engine.runtime.crowd import Crowd
from stridewire_engine.runtime.events import TickEvents
from stridewire_engine.runtime.inside import look
from stridewire_engine.runtime.output import Output
from stridewire_engine.runtime.response import NEUTRAL
from stridewire_engine.runtime.roster import Roster
from stridewire_engine.runtime.tick import Block
from stridewire_engine.stitchers import DEFAULT_STITCHER, STITCHER_NAMES

_MAX_VIOLATIONS = 100
_UPDATABLE = ("stitcher", "foot_lock", "filter", "weights", "responsiveness", "rate_divider")


class Session:
    """One caller's characters. Made by `Runtime.open`; driven by one thread."""

    def __init__(self, crowd: Crowd, opened: Opened, output: Output, limits: Limits) -> None:
        self.opened = opened
        self._output = output
        self.crowd = crowd
        self._roster = Roster()
        self._limits = limits
        self._rng = np.random.default_rng(opened.settings.seed)
        self._frame = 0
        self._time = 0.0
        self._dt = 0.0
        self._applied = Step(step=0, client_time_s=0.0)

    def __len__(self) -> int:
        """Return the number of characters."""
        return len(self._roster)

    @property
    def id(self) -> str:
        """Name of the session."""
        return self.opened.session

    @property
    def rows(self) -> Indices:
        """`(N,)` rows of the crowd."""
        return self._roster.rows

    def add(self, specs: Sequence[CharacterSpec]) -> None:
        """Add characters that were checked."""
        rows = self.crowd.add(len(specs))
        state = self.crowd.state
        scales = np.array([self._output.scale(spec.height_m) for spec in specs])
        # in float32, as places come over the wire: in process the same frames
        positions = np.array([spec.root.position for spec in specs], np.float32) / scales[:, None]
        yaws = np.array([spec.root.yaw for spec in specs], np.float32)
        controls.place(state, rows, positions, yaws)
        for row, spec in zip(rows, specs, strict=True):
            self._set(int(row), spec, _UPDATABLE)
        # characters that search at different times share the work evenly among the ticks
        state.stagger[rows] = self._rng.random(len(specs))
        self._roster.add(np.array([spec.id for spec in specs]), rows, scales)

    def remove_all(self) -> None:
        """Give all rows back."""
        self.crowd.remove(self.rows)
        self._roster = Roster()

    def edit(self, edit: Edit) -> StreamError | None:
        """Remove, add and update characters; what is wrong is left out and told."""
        return _error(0, self._edit(edit))

    def control(self, step: Step) -> StreamError | None:
        """Apply a step's controls without advancing; what is wrong is left out, held and told."""
        self._applied = step
        return _error(step.step, controls.apply_step(self._roster, self.crowd, step, self._limits))

    def held_step(self, dt_s: float) -> Step:
        """Return a step that advances under the controls as they are, for a clock that paces."""
        nothing = Step(dt_s=dt_s)
        return replace(nothing, step=self._applied.step, client_time_s=self._applied.client_time_s)

    def begin_tick(self, step: Step, applied: bool) -> tuple[Floats, StreamError | None]:
        """Apply a step's controls and return how far to go, `(N,)` seconds, and what was wrong.

        Args:
            step: The step.
            applied: Whether its controls are applied already, together with others'.
        """
        dt, wrong = self._check_dt(step.dt_s)
        self._applied = step
        if not applied:
            wrong += controls.apply_step(self._roster, self.crowd, step, self._limits)
        self._time += dt
        self._dt = dt
        return np.full(len(self), dt), _error(step.step, wrong) if wrong else None

    @property
    def roster(self) -> Roster:
        """Its characters."""
        return self._roster

    def end_tick(self, block: Block, rows: slice) -> Frame:
        """Make the frame out of the session's rows of the tick's block."""
        self._frame += 1
        detail = self.opened.settings.detail
        ids, crowd = self._roster.ids, self.crowd
        shown = self._output.show(block, rows, self._roster, self._dt)
        return Frame(
            frame=self._frame,
            applied_step=self._applied.step,
            time_s=self._time,
            client_time_s=self._applied.client_time_s,
            characters=ids,
            root=shown.root,
            root_delta=shown.root_delta,
            hips=shown.hips,
            rotations=shown.rotations,
            contacts=block.contact_mask[rows],
            foot_targets=shown.foot_targets,
            flags=self._roster.take_flags() | block.flags[rows],
            simulated_root=shown.simulated_root if detail >= Detail.COSTS else None,
            inside=look(crowd, self.rows, self._roster.scales) if detail is Detail.INSIDE else None,
            events=TickEvents(block, rows, ids, self._frame, detail, crowd.matcher, crowd.sets),
            searches=len(block.searches.within(rows)),
            timings_ms=block.timings_ms,
            format=self.opened.settings.format,
        )

    def _check_dt(self, dt: float) -> tuple[float, list[Violation]]:
        if not dt >= 0.0:
            self._roster.flag(slice(None), FrameFlag.HELD)
            allowed = f"allowed are 0 to {self._limits.max_dt_s:g} seconds; no time passes"
            return 0.0, [Violation("step.dt_s", f"{dt}; {allowed}")]
        if dt > self._limits.max_dt_s:
            self._roster.flag(slice(None), FrameFlag.DT_CLAMPED)
            return self._limits.max_dt_s, []
        return dt, []

    def _edit(self, edit: Edit) -> Iterator[Violation]:
        for i, character in enumerate(edit.remove):
            yield from self._remove(f"edit.remove[{i}]", character)
        for i, spec in enumerate(edit.add):
            yield from self._add_one(f"edit.add[{i}]", spec)
        for i, update in enumerate(edit.update):
            yield from self._update_one(f"edit.update[{i}]", update)

    def _remove(self, path: str, character: int) -> Iterator[Violation]:
        at = self._roster.place(character)
        if at < 0:
            yield Violation(path, f"{character} is not in this session")
        elif len(self) == 1:
            yield Violation(path, f"{character} is the last character; close the session instead")
        else:
            self.crowd.remove(self.rows[at : at + 1])
            self._roster.remove(at)

    def _add_one(self, path: str, spec: CharacterSpec) -> Iterator[Violation]:
        taken = self._roster.ids.tolist()
        wrong = [*admission.check_spec(path, spec, taken, self.crowd.matcher)]
        most = self._limits.max_characters
        if len(self) >= most:
            wrong.append(Violation(path, f"a session holds at most {most} characters"))
        yield from wrong
        if not wrong:
            self.add([spec])

    def _update_one(self, path: str, update: CharacterUpdate) -> Iterator[Violation]:
        at = self._roster.place(update.spec.id)
        allowed = f"allowed are {', '.join(_UPDATABLE)}"
        wrong = []
        if at < 0:
            wrong.append(Violation(f"{path}.spec.id", f"{update.spec.id} is not in this session"))
        if not update.mask:
            wrong.append(Violation(f"{path}.mask", f"is empty; {allowed}"))
        for name in update.mask:
            if name not in _UPDATABLE:
                wrong.append(Violation(f"{path}.mask", f"{name!r} cannot change; {allowed}"))
        wrong += self._check_values(f"{path}.spec", update)
        yield from wrong
        if not wrong:
            self._set(int(self.rows[at]), update.spec, update.mask)

    def _check_values(self, path: str, update: CharacterUpdate) -> Iterator[Violation]:
        spec, matcher = update.spec, self.crowd.matcher
        if "stitcher" in update.mask:
            yield from admission.check_stitcher(f"{path}.stitcher", spec.stitcher)
        if "filter" in update.mask:
            yield from admission.check_filter(f"{path}.filter", spec.filter, matcher)
        if "weights" in update.mask:
            yield from admission.check_weights(f"{path}.weights", spec.weights, matcher.schema)
        if "responsiveness" in update.mask:
            yield from admission.check_responsiveness(f"{path}.responsiveness", spec)
        if "rate_divider" in update.mask:
            yield from admission.check_rate_divider(f"{path}.rate_divider", spec)

    def _set(self, row: int, spec: CharacterSpec, names: Iterable[str]) -> None:
        state = self.crowd.state
        if "stitcher" in names:
            chosen = spec.stitcher or DEFAULT_STITCHER
            state.stitcher[row] = STITCHER_NAMES.index(chosen)
        if "foot_lock" in names:
            state.foot_lock[row] = spec.foot_lock
        if "filter" in names:
            controls.set_filter(self.crowd, row, spec.filter)
        if "weights" in names:
            schema = self.crowd.matcher.schema
            state.weights[row] = admission.merged_weights(spec.weights, schema)
        if "responsiveness" in names:
            given = spec.responsiveness
            state.responsiveness[row] = NEUTRAL if given is None else given
        if "rate_divider" in names:
            state.rate_divider[row], state.ticks_left[row] = spec.rate_divider, 0


def _error(step: int, violations: Iterable[Violation]) -> StreamError | None:
    every = iter(violations)
    listed = tuple(islice(every, _MAX_VIOLATIONS))
    return StreamError(step, listed, sum(1 for _ in every)) if listed else None
