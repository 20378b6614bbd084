"""The client: the same interface to a server over gRPC and to a runtime in this process."""

import os
from collections.abc import Mapping, Sequence
from types import TracebackType

from stridewire._messages import (
    CharacterSpec,
    ClipTime,
    DesiredMotion,
    Detail,
    Open,
    Pacing,
    SearchQuery,
    SearchResult,
    ServerInfo,
    Trajectory,
)
from stridewire._session import Session
from stridewire._transport import Transport, in_process_transport

DEFAULT_ADDRESS = "127.0.0.1:50051"


class Client:
    """Opens sessions and asks the motion database.

        with Client("127.0.0.1:50051") as client, client.open_session(characters=4) as session:
            frame = session.step(velocity=(0.0, 1.4))
            frame.rotations  # (4, 22, 4)

    Args:
        target: Address `host:port` of a server, or a transport.
        timeout_s: Longest wait for an answer or for the next frame.
    """

    def __init__(self, target: str | Transport = DEFAULT_ADDRESS, timeout_s: float = 5.0) -> None:
        self._timeout_s = timeout_s
        self._transport = _connect(target, timeout_s) if isinstance(target, str) else target

    @classmethod
    def in_process(cls, library: str | os.PathLike[str] | None = None) -> "Client":
        """Run characters in this process, over a library folder or the embedded default library.

        Raises:
            StridewireError: If the extra that runs characters is not installed.
        """
        return cls(in_process_transport(None if library is None else os.fspath(library)))

    def open_session(
        self,
        characters: int | Sequence[int | CharacterSpec] = 1,
        *,
        library: str = "",
        pacing: Pacing = Pacing.CLIENT,
        rate_hz: float = 60.0,
        max_frames_in_flight: int = 30,
        detail: Detail = Detail.EVENTS,
        seed: int = 0,
    ) -> Session:
        """Open a session.

        Args:
            characters: How many (ids from 0), or which, with ids or with specifications.
            library: Name of the library; empty means the server's default.
            pacing: Whether `step` makes frames or the server's clock.
            rate_hz: Frames per second with server pacing.
            max_frames_in_flight: Frames that may be under way unacknowledged; 0 means no limit.
            detail: What frames tell beside poses.
            seed: Seed of everything that is drawn by lot.

        Raises:
            InvalidRequestError: If a value is not allowed.
            NotFoundError: If there is no such library.
            UnavailableError: If there is no server.
        """
        given = range(characters) if isinstance(characters, int) else characters
        specs = [c if isinstance(c, CharacterSpec) else CharacterSpec(c) for c in given]
        message = Open(
            characters=specs,
            library=library,
            pacing=pacing,
            rate_hz=rate_hz,
            max_frames_in_flight=max_frames_in_flight,
            detail=detail,
            seed=seed,
        )
        return Session(self._transport.open(message), specs, self._timeout_s)

    def search(
        self,
        clip: str,
        time_s: float,
        intent: Trajectory | DesiredMotion | None = None,
        *,
        k: int = 5,
        library: str = "",
        exclude: Sequence[ClipTime] = (),
        filter: str = "",
        weights: Mapping[str, float] | None = None,
    ) -> SearchResult:
        """Find the moments that continue best from a moment of a clip.

        Args:
            clip: Name of the clip to continue from.
            time_s: Seconds within it.
            intent: Where to go; None means where the clip itself goes.
            k: Number of matches.
            library: Name of the library; empty means the server's default.
            exclude: Moments that must not be among the matches; the result tells those that would
                have been better.
            filter: Tag expression, such as `(walk | run) & !turn`; empty means all.
            weights: Of channels by name; the schema's where absent. Cost is proportional to them.

        Raises:
            InvalidRequestError: If a value is not allowed.
            NotFoundError: If there is no such library or clip.
        """
        return self._transport.search(
            SearchQuery(
                ClipTime(clip, time_s), intent, k, library, tuple(exclude), filter, weights or {}
            )
        )

    def info(self) -> ServerInfo:
        """Tell versions, libraries, limits."""
        return self._transport.info()

    def close(self) -> None:
        """Free what the client holds; twice is harmless."""
        self._transport.close()

    def __enter__(self) -> "Client":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()


def _connect(address: str, timeout_s: float) -> Transport:
    # Only here, so that a client in this process needs no gRPC.
    from stridewire._grpc import GrpcTransport

    return GrpcTransport(address, timeout_s)
