"""The runtime: all sessions over all open libraries, reached by messages of arrays.

One thread drives a runtime; it has no locks. This is the boundary that could move to a process of
its own.
"""

import time
from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np

from stridewire import __version__
from stridewire._errors import NotFoundError
from stridewire._messages import (
    AnswerT,
    BlendManyQuery,
    BlendQuery,
    ClipQuery,
    ClipsQuery,
    Edit,
    Frame,
    InfoQuery,
    LibrariesQuery,
    LibraryQuery,
    Limits,
    Open,
    Opened,
    Query,
    SearchQuery,
    SearchResult,
    ServerInfo,
    Settings,
    SkeletonQuery,
    Step,
    StreamError,
)
from stridewire.formats.session_file import SessionWriter
from stridewire.motion.array_types import Floats
from stridewire_engine import blending
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.networks.blend import blend_network
from stridewire_engine.networks.rmr.refiner import refiner_if_shipped
from stridewire_engine.runtime import admission, catalogue, controls, queries
from stridewire_engine.runtime.crowd import Crowd
from stridewire_engine.runtime.output import Output
from stridewire_engine.runtime.session import Session
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.stitchers import DEFAULT_STITCHER, STITCHER_NAMES

Recorder = Callable[[Open, Opened], SessionWriter]
"""From what was asked for and answered to the file that a session is recorded in."""


@dataclass
class _Due:
    session: Session
    dt: Floats
    error: StreamError | None


class Runtime:
    """Opens sessions, advances them together, answers queries."""

    def __init__(
        self,
        libraries: Sequence[Library],
        *,
        limits: Limits | None = None,
        settings: TickSettings | None = None,
        clock: Callable[[], float] = time.perf_counter,
        record: Recorder | None = None,
    ) -> None:
        """Index the libraries.

        Args:
            libraries: The first is the default; names must differ.
            limits: Of messages.
            settings: Of the tick.
            clock: Seconds; only for the timings that are reported.
            record: Gives each session that is opened the file that it is recorded in.

        Raises:
            LibraryError: If there is none, two share a name, or one cannot be searched.
        """
        if not libraries:
            raise LibraryError("no library was given; a runtime needs at least one")
        self._limits = limits or Limits()
        self._settings = settings or TickSettings()
        self._crowds: dict[str, Crowd] = {}
        for library in libraries:
            if library.name in self._crowds:
                raise LibraryError(
                    f"two libraries are called {library.name!r}; give one another name: NAME=FOLDER"
                )
            self._crowds[library.name] = Crowd(
                library, self._settings, self._limits.max_speed, clock
            )
        self._sessions: dict[str, Session] = {}
        self._record = record
        self._recordings: dict[str, SessionWriter] = {}
        self._numbers = count(1)

    @property
    def libraries(self) -> dict[str, Library]:
        """The open libraries by name, the default first."""
        return {name: crowd.library for name, crowd in self._crowds.items()}

    @property
    def limits(self) -> Limits:
        """Limits that hold for every session."""
        return self._limits

    def library(self, name: str) -> Library:
        """Return an open library; an empty name means the default.

        Raises:
            NotFoundError: If it is not open here.
        """
        return self._crowd(name).library

    def open(self, message: Open) -> Session:
        """Open a session.

        Raises:
            InvalidRequestError: If a field is not allowed.
            NotFoundError: If the library is not open here.
            NotImplementedYetError: If a field of a later version is set.
        """
        crowd = self._crowd(message.library)
        admission.check_open(message, self._limits, crowd.matcher)
        settings = Settings(
            message.pacing,
            message.rate_hz,
            message.max_frames_in_flight,
            message.format,
            message.detail,
            message.seed,
            DEFAULT_STITCHER,
        )
        output = Output(message, crowd.library.skeleton)
        opened = Opened(
            session=f"s{next(self._numbers)}",
            skeleton=output.skeleton,
            library=crowd.library.info(),
            server_version=__version__,
            settings=settings,
            limits=self._limits,
        )
        session = Session(crowd, opened, output, self._limits)
        session.add(message.characters)
        if self._record is not None:
            self._recordings[session.id] = self._record(message, opened)
        self._sessions[session.id] = session
        return session

    def control(self, session: Session, step: Step) -> StreamError | None:
        """Apply a step's controls without advancing; for sessions that the server paces."""
        if recording := self._recordings.get(session.id):
            recording.control(step)
        return session.control(step)

    def edit(self, session: Session, edit: Edit) -> StreamError | None:
        """Add, remove and change characters."""
        if recording := self._recordings.get(session.id):
            recording.edit(edit)
        return session.edit(edit)

    def close(self, session: Session) -> None:
        """Free what a session holds; twice is harmless."""
        if self._sessions.pop(session.id, None) is not None:
            session.remove_all()
        if recording := self._recordings.pop(session.id, None):
            recording.close()

    def advance(
        self, due: Sequence[tuple[Session, Step | float]], level: int = 0
    ) -> list[tuple[Frame, StreamError | None]]:
        """Advance sessions by one step each, all of one library in one tick.

        Args:
            due: Sessions, each at most once, and their steps; or seconds, to advance under the
                controls as they are by then.
            level: By how many levels to give way to load; see `TickSettings.giving_way`.

        Returns:
            A frame, and what was wrong with the step, for each session in order.
        """
        steps = [(s, s.held_step(step) if isinstance(step, float) else step) for s, step in due]
        for session, step in steps:
            if recording := self._recordings.get(session.id):
                recording.advance(step, level)
        applied = self._apply_plain(steps)
        begun = [
            _Due(session, *session.begin_tick(step, session.id in applied))
            for session, step in steps
        ]
        frames: dict[str, Frame] = {}
        for crowd in {id(d.session.crowd): d.session.crowd for d in begun}.values():
            mine = [d for d in begun if d.session.crowd is crowd]
            block = crowd.step([d.session.rows for d in mine], [d.dt for d in mine], level)
            stops = np.cumsum([len(d.session) for d in mine]).tolist()
            for d, stop in zip(mine, stops, strict=True):
                rows = slice(stop - len(d.session), stop)
                frames[d.session.id] = d.session.end_tick(block, rows)
        for name, recording in self._recordings.items():
            if name in frames:
                recording.frame(frames[name])
        return [(frames[d.session.id], d.error) for d in begun]

    def _apply_plain(self, steps: Sequence[tuple[Session, Step]]) -> Container[str]:
        """Apply the plain steps of each crowd at once; return the sessions that were applied to."""
        plain: dict[Crowd, list[tuple[Session, Step]]] = {}
        for session, step in steps:
            if controls.is_plain(step, len(session)):
                plain.setdefault(session.crowd, []).append((session, step))
        applied: set[str] = set()
        for crowd, mine in plain.items():
            told = [(session.roster, step) for session, step in mine]
            if controls.apply_plain(told, crowd.state, self._limits):
                applied.update(session.id for session, _ in mine)
        return applied

    @property
    def characters(self) -> int:
        """Number of characters in all sessions."""
        return sum(len(crowd) for crowd in self._crowds.values())

    def ask(self, query: Query[AnswerT]) -> AnswerT:
        """Answer a query.

        Raises:
            InvalidRequestError: If a field is not allowed.
            NotFoundError: If there is no such library or clip.
        """
        answer: AnswerT = self._answer(query)
        return answer

    def search(self, query: SearchQuery) -> SearchResult:
        """Search the motion database.

        Raises:
            StridewireError: As `queries.search`.
        """
        matcher = self._crowd(query.library).matcher
        return queries.search(matcher, query, self._limits, self._settings)

    def info(self) -> ServerInfo:
        """Tell versions, libraries, limits and load."""
        return ServerInfo(
            version=__version__,
            libraries=tuple(library.info() for library in self.libraries.values()),
            models=_models(),
            limits=self._limits,
            stitchers=STITCHER_NAMES,
            sessions=len(self._sessions),
            characters=self.characters,
        )

    def _answer(self, query: Query[Any]) -> Any:
        match query:
            case SearchQuery():
                return self.search(query)
            case BlendQuery():
                return blending.answer(self.library, query)
            case BlendManyQuery():
                return blending.answer_many(self.library, query)
            case InfoQuery():
                return self.info()
            case LibrariesQuery():
                return self.info().libraries
            case LibraryQuery():
                return catalogue.details(self.library(query.name))
            case ClipsQuery():
                return catalogue.clips(self.library(query.library), query)
            case ClipQuery():
                return catalogue.poses(self.library(query.library), query)
            case SkeletonQuery():
                return self.library(query.library).skeleton
        raise TypeError(f"{type(query).__name__} is no query of this runtime")

    def _crowd(self, name: str) -> Crowd:
        if not name:
            return next(iter(self._crowds.values()))
        if name not in self._crowds:
            raise NotFoundError(
                f"no library {name!r} is open here; open are {', '.join(self._crowds)}"
            )
        return self._crowds[name]


def _models() -> dict[str, str]:
    """Return the hashes of the networks, by name."""
    models = {"blend": blend_network().model.hash}
    refiner = refiner_if_shipped()
    return models if refiner is None else {**models, "rmr": refiner.model.hash}
