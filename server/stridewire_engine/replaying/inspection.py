"""Inspection: what went on behind every frame of a recorded session, for one character.

The session is replayed; before each tick the character's row is kept, and the choice of that tick
is made once more on a copy, so that candidates and costs are known whether it jumped, stayed, or
did not search at all.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from stridewire._messages import (
    Detail,
    Edit,
    ExcludedMatch,
    Frame,
    Match,
    Open,
    Transition,
    TransitionReason,
)
from stridewire.formats.session_file import Advance, Control, SessionFile
from stridewire.motion import kinematics
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Pose
from stridewire_engine.library import Library
from stridewire_engine.matching.explanation import explain
from stridewire_engine.runtime import Runtime, Session, choice
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.crowd import Crowd

CANDIDATES = 5


@dataclass(frozen=True)
class Hidden:
    """How far what is shown is from the clip that plays: what the stitcher hides."""

    mean_cm: float
    """Over joints, both under the same root."""
    most_cm: float
    joint: str
    """That is off by the most."""


@dataclass(frozen=True)
class Moment:
    """One frame of one character, explained."""

    frame: int
    time_s: float
    clip: str
    """That plays, after the tick."""
    clip_time_s: float
    searched: bool
    reason: str
    """Of the search; empty where none was due."""
    verdict: str
    """Why it jumped or stayed, in words."""
    stay: Match | None
    """Going on as before the tick; None where the character begins."""
    bias: float
    """By how much the cost of staying has to be beaten."""
    candidates: tuple[Match, ...]
    """Other moments, best first; where no search was due, what one would have found."""
    excluded: tuple[ExcludedMatch, ...]
    next_search_s: float
    hidden: Hidden
    speed: float
    """Of the character root, m/s."""
    asked_speed: float
    transition: Transition | None


def inspect(file: SessionFile, library: Library, character: int) -> Iterator[Moment]:
    """Yield every frame in which a character is there, explained.

    Args:
        file: The session.
        library: That it was recorded over.
        character: Its id.

    Raises:
        SessionFileError: If the file is damaged.
    """
    runtime = Runtime([library])
    session = runtime.open(_opening(file.opening))
    seen: list[tuple[Characters, Floats]] = []
    session.crowd.watch = lambda rows, dt: seen.append((rows.take(np.arange(len(rows))), dt))
    for entry in file.entries():
        match entry:
            case Control(step):
                runtime.control(session, step)
            case Edit():
                runtime.edit(session, entry)
            case Advance(step):
                seen.clear()
                ((frame, _),) = runtime.advance([(session, step)])
                at = np.flatnonzero(frame.characters == character)
                if len(at):
                    ((before, dt),) = seen
                    yield _moment(session, frame, int(at[0]), before, dt)


def _opening(opening: Open) -> Open:
    """Return an opening as it was, on the library's own skeleton, that tells what goes on."""
    return replace(opening, library="", resume_token="", detail=Detail.INSIDE, output_skeleton=None)


def _moment(session: Session, frame: Frame, at: int, before: Characters, dt: Floats) -> Moment:
    crowd, library = session.crowd, session.crowd.library
    row = before.take(np.array([at]))
    begins = bool(row.clip[0] < 0)
    reasons, seen = crowd.consider(row.take(np.zeros(1, np.intp)), dt[at : at + 1])
    due = int(reasons[0])
    candidates, excluded = explain(
        crowd.matcher, seen.queries[0], seen.weights[0], choice.exclusions(seen.excluded[0]),
        CANDIDATES, crowd.sets[int(row.filter[0])],
    )  # fmt: skip
    jumps = [e for e in frame.events if isinstance(e, Transition)]
    transition = next((e for e in jumps if e.character == frame.characters[at]), None)
    after = crowd.state.take(session.rows[at : at + 1])
    passed = max(float(dt[at]), 1e-6)
    return Moment(
        frame=frame.frame,
        time_s=frame.time_s,
        clip=library.clips[after.clip[0]].name,
        clip_time_s=float(after.clip_time[0]),
        searched=due > 0,
        reason=TransitionReason(due).name.lower().replace("_", " ") if due else "",
        verdict=_verdict(due, seen, transition, float(row.until_search[0] - dt[at]))
        + _unrefined(transition),
        stay=None if begins else _stay(crowd, seen),
        bias=float(seen.bias[0]),
        candidates=candidates,
        excluded=excluded,
        next_search_s=max(float(after.until_search[0]), 0.0),
        hidden=_hidden(library, frame, at),
        speed=float(np.hypot(frame.root_delta[at, 0], frame.root_delta[at, 2])) / passed,
        asked_speed=float(np.linalg.norm(row.desired_velocity[0])),
        transition=transition,
    )


def _stay(crowd: Crowd, seen: choice.Considered) -> Match:
    """Return the moment that was playing, with what going on costs."""
    library, row = crowd.library, int(seen.playing[0])
    entry = library.clips[library.clip_of[row]]
    names = [channel.name for channel in crowd.matcher.schema.channels]
    return Match(
        entry.name,
        (row - entry.start) / library.frame_rate,
        library.tags_at(row),
        float(seen.stay[0]),
        dict(zip(names, seen.stay_costs[0].tolist(), strict=True)),
        float(crowd.matcher.bias[row]),
    )


def _unrefined(transition: Transition | None) -> str:
    """Say why `stance` hides a transition that `refine` should hide."""
    if transition is None or transition.fallback is None:
        return ""
    return f"; not refined: {transition.fallback.name.lower().replace('_', ' ')}"


def _verdict(due: int, seen: choice.Considered, transition: Transition | None, wait: float) -> str:
    best, stay, bias = float(seen.found.costs[0, 0]), float(seen.stay[0]), float(seen.bias[0])
    if transition is not None:
        where = f"jumps to {transition.to_clip} at {transition.to_time_s:.2f} s"
        if transition.reason is TransitionReason.START:
            return f"begins: {where}, the cheapest"
        if transition.reason in (TransitionReason.CLIP_END, TransitionReason.FILTER_CHANGE):
            why = transition.reason.name.lower().replace("_", " ")
            return f"{where}: it had to leave ({why}), and that is the cheapest"
        return f"{where}: {best:.3f} is below staying {stay:.3f} by more than the bias {bias:.3f}"
    if not due:
        if wait > 0.0:
            return f"stays: no search was due for another {wait:.2f} s"
        return "stays: it stands and is asked to, so it does not search"
    if not np.isfinite(best):
        return "stays: nothing else may be chosen"
    return f"stays: the best other costs {best:.3f}, staying {stay:.3f}, bias {bias:.3f}"


def _hidden(library: Library, frame: Frame, at: int) -> Hidden:
    assert frame.inside is not None  # asked for in the opening
    shown = _joints(library, frame.hips[at], frame.rotations[at])
    clip = _joints(library, frame.inside.hips[at], frame.inside.rotations[at])
    off = 100.0 * np.linalg.norm(shown - clip, axis=-1)
    worst = int(np.argmax(off))
    return Hidden(float(off.mean()), float(off[worst]), library.skeleton.names[worst])


def _joints(library: Library, hips: Floats, rotations: Floats) -> Floats:
    """Return joints `(J, 3)` under a root at the origin."""
    pose = Pose(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), hips, rotations)
    return np.asarray(kinematics.forward_world(library.skeleton, pose.astype(np.float64))[0])
