"""The client for asyncio: the names and arguments of `Client` and `Session`, awaited."""

import os
from collections.abc import AsyncIterator, Awaitable, Callable, Generator, Mapping, Sequence
from functools import partial
from types import TracebackType
from typing import Any

from stridewire._async_session import AsyncSession
from stridewire._base_client import (
    DEFAULT_ADDRESS,
    opening,
    search_query,
    stitch_query,
    stitched,
    to_clip,
)
from stridewire._messages import (
    BlendManyQuery,
    BlendMethod,
    BlendQuery,
    BlendResult,
    BvhText,
    CharacterSpec,
    ClipInfo,
    ClipQuery,
    ClipSpan,
    ClipsQuery,
    ClipTime,
    DesiredMotion,
    Detail,
    InfoQuery,
    LibrariesQuery,
    LibraryDetails,
    LibraryInfo,
    LibraryQuery,
    Open,
    Pacing,
    PoseFormat,
    RootPath,
    SearchResult,
    ServerInfo,
    SkeletonQuery,
    Stitched,
    StitchPart,
    StitchQuery,
    Trajectory,
)
from stridewire._transport import AsyncStream, AsyncTransport, async_in_process_transport
from stridewire.motion.array_types import Floats
from stridewire.motion.clip import Clip, Pose
from stridewire.motion.skeleton import Skeleton


class AsyncClient:
    """Opens sessions, asks the motion database, blends postures, stitches clips, reads libraries.

        async with AsyncClient() as client, client.open_session(characters=4) as session:
            frame = await session.step(velocity=(0.0, 1.4))
            frame.rotations  # (4, 22, 4)

    Args:
        target: Address `host:port` of a server, or a transport.
        timeout_s: Longest wait for an answer or for the next frame.
    """

    def __init__(
        self, target: str | AsyncTransport = DEFAULT_ADDRESS, timeout_s: float = 5.0
    ) -> None:
        self._timeout_s = timeout_s
        self._transport = _connect(target, timeout_s) if isinstance(target, str) else target

    @classmethod
    def in_process(cls, library: str | os.PathLike[str] | None = None) -> "AsyncClient":
        """Run characters in this process, over a library folder or the embedded default library.

        Raises:
            StridewireError: If the extra that runs characters is not installed.
        """
        return cls(async_in_process_transport(None if library is None else os.fspath(library)))

    def open_session(
        self,
        characters: int | Sequence[int | CharacterSpec] = 1,
        *,
        library: str = "",
        pacing: Pacing = Pacing.CLIENT,
        rate_hz: float = 60.0,
        output_skeleton: Skeleton | None = None,
        format: PoseFormat = PoseFormat.F32,
        max_frames_in_flight: int = 30,
        detail: Detail = Detail.EVENTS,
        seed: int = 0,
        reconnect_s: float = 0.0,
    ) -> "Opening":
        """Open a session: `async with` the result, or `await` it.

        Args:
            characters: How many (ids from 0), or which, with ids or with specifications.
            library: Name of the library; empty means the server's default.
            pacing: Whether `step` makes frames or the server's clock.
            rate_hz: Frames per second with server pacing.
            output_skeleton: Skeleton that poses are retargeted to; None means the library's.
            format: How poses travel; half floats need half the bandwidth.
            max_frames_in_flight: Frames that may be under way unacknowledged; 0 means no limit.
            detail: What frames tell beside poses.
            seed: Seed of everything that is drawn by lot.
            reconnect_s: For how long a lost connection is opened again, each character at its last
                root under the control that held; 0 means not at all.

        Raises:
            InvalidRequestError: If a value is not allowed.
            NotFoundError: If there is no such library.
            UnavailableError: If there is no server.
        """
        message = opening(
            characters,
            library=library,
            pacing=pacing,
            rate_hz=rate_hz,
            output_skeleton=output_skeleton,
            format=format,
            max_frames_in_flight=max_frames_in_flight,
            detail=detail,
            seed=seed,
        )
        return Opening(self._transport.open, message, self._timeout_s, reconnect_s)

    async def search(
        self,
        pose: str | Pose,
        time_s: float = 0.0,
        intent: Trajectory | DesiredMotion | None = None,
        *,
        k: int = 5,
        library: str = "",
        exclude: Sequence[ClipTime] = (),
        filter: str = "",
        weights: Mapping[str, float] | None = None,
    ) -> SearchResult:
        """Find the moments that continue best from a moment of a clip, or from a pose.

        Args:
            pose: Name of the clip to continue from, or one pose on the library's skeleton; of a
                pose neither velocities nor the way before it are compared.
            time_s: Seconds within the clip.
            intent: Where to go; None means where the clip itself goes, with a pose anywhere.
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
        return await self._transport.ask(
            search_query(
                pose,
                time_s,
                intent,
                k=k,
                library=library,
                exclude=exclude,
                filter=filter,
                weights=weights,
            )
        )

    async def blend(
        self,
        start: ClipTime | Pose,
        end: ClipTime | Pose,
        weights: Sequence[float] | Floats,
        *,
        method: BlendMethod = BlendMethod.AUTO,
        joint_mask: Mapping[str, float] | None = None,
        ground_height: float = 0.0,
        duration_s: float = 0.0,
    ) -> BlendResult:
        """Return the postures between two postures.

        Args:
            start: At weight 0: a moment of a library, or one pose.
            end: At weight 1; a moment of another clip is moved to the start's root.
            weights: 1 to 10,000, each from 0 to 1.
            method: By the network, linear, or by the network where it is sure.
            joint_mask: Share of the weight that joints take, 0 to 1, by name; 1 where absent.
            ground_height: Where the feet may stand; metres.
            duration_s: Seconds between the postures; 0 means what their clip says, else unknown.

        Raises:
            InvalidRequestError: If a value is not allowed.
            NotFoundError: If there is no such library or clip.
        """
        return await self._transport.ask(
            BlendQuery(start, end, weights, method, joint_mask or {}, ground_height, duration_s)
        )

    async def blend_many(self, requests: Sequence[BlendQuery]) -> tuple[BlendResult, ...]:
        """Return the postures between many pairs, in one call.

        Args:
            requests: 1 to 1,000 pairs with 10,000 weights in all.

        Raises:
            InvalidRequestError: If a value is not allowed.
            NotFoundError: If there is no such library or clip.
        """
        return await self._transport.ask(BlendManyQuery(tuple(requests)))

    async def stitch(
        self,
        clips: Sequence[str | ClipSpan | Clip | BvhText],
        *,
        stitcher: str = "auto",
        window_s: float = 1.5,
        search_frames: int = 0,
        strength: float = 1.0,
        joint_mask: Mapping[str, float] | None = None,
        path: RootPath | None = None,
    ) -> Stitched:
        """Make one natural motion of clips, each going on where the one before ends.

        Args:
            clips: 2 to 64: names of clips of the default library, spans of clips, clips of yours,
                texts of BVH files.
            stitcher: What hides the seams; `auto` takes the best for each.
            window_s: Within so many seconds after a seam poses may differ from the clips'.
            search_frames: Up to so many frames are left out at each end of a clip where the seam
                gets better; 0 to 60.
            strength: Share of the correction, 0 to 1.
            joint_mask: Share of the correction that joints take, 0 to 1, by name; 1 where absent.
            path: Where the root is to go; None means where the clips lead.

        Raises:
            InvalidRequestError: If a value is not allowed.
            NotFoundError: If there is no such library or clip.
        """
        query = stitch_query(
            clips,
            stitcher=stitcher,
            window_s=window_s,
            search_frames=search_frames,
            strength=strength,
            joint_mask=joint_mask,
            path=path,
        )
        return stitched([part async for part in self.stitch_parts(query)])

    async def stitch_parts(self, query: StitchQuery) -> AsyncIterator[StitchPart]:
        """Yield a header, poses as they become final, then a report: for long motions.

        Args:
            query: All that can be asked for.

        Raises:
            InvalidRequestError: If a value is not allowed.
            NotFoundError: If there is no such library or clip.
        """
        async for part in self._transport.parts(query):
            yield part

    async def info(self) -> ServerInfo:
        """Tell versions, libraries, limits."""
        return await self._transport.ask(InfoQuery())

    async def libraries(self) -> tuple[LibraryInfo, ...]:
        """List the open libraries, the default first."""
        return await self._transport.ask(LibrariesQuery())

    async def library(self, name: str = "") -> LibraryDetails:
        """Tell what a library holds; an empty name means the default.

        Raises:
            NotFoundError: If there is no such library.
        """
        return await self._transport.ask(LibraryQuery(name))

    async def clips(
        self, library: str = "", *, name_contains: str = "", tag: str = ""
    ) -> AsyncIterator[ClipInfo]:
        """Yield the clips of a library; pages are fetched as they are needed.

        Args:
            library: Name of the library; empty means the server's default.
            name_contains: Only clips whose name holds this.
            tag: Only clips with this tag somewhere.

        Raises:
            NotFoundError: If there is no such library.
        """
        query = ClipsQuery(library, name_contains=name_contains, tag=tag)
        while True:
            page = await self._transport.ask(query)
            for clip in page.clips:
                yield clip
            if not page.next_page_token:
                return
            query = query.after(page)

    async def clip(
        self, name: str, *, library: str = "", start_s: float = 0.0, end_s: float = 0.0
    ) -> Clip:
        """Return a clip of a library, or a span of at most 60 seconds.

        Args:
            name: Name of the clip.
            library: Name of the library; empty means the server's default.
            start_s: Begin within the clip; seconds.
            end_s: End within the clip; seconds; 0 means its end.

        Raises:
            InvalidRequestError: If the span is not within the clip or too long.
            NotFoundError: If there is no such library or clip.
        """
        poses = await self._transport.ask(ClipQuery(name, library, start_s, end_s))
        return to_clip(poses, await self.skeleton(library), start_s)

    async def skeleton(self, library: str = "") -> Skeleton:
        """Return the skeleton of a library; an empty name means the default.

        Raises:
            NotFoundError: If there is no such library.
        """
        return await self._transport.ask(SkeletonQuery(library))

    async def close(self) -> None:
        """Free what the client holds; twice is harmless."""
        await self._transport.close()

    async def __aenter__(self) -> "AsyncClient":
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        await self.close()


class Opening:
    """A session that is about to be opened: awaited, or entered by `async with`."""

    def __init__(
        self,
        open_stream: Callable[[Open], Awaitable[AsyncStream]],
        opening: Open,
        timeout_s: float,
        reconnect_s: float,
    ) -> None:
        self._start = partial(AsyncSession.start, open_stream, opening, timeout_s, reconnect_s)
        self._session: AsyncSession | None = None

    def __await__(self) -> Generator[Any, None, AsyncSession]:
        return self._start().__await__()

    async def __aenter__(self) -> AsyncSession:
        self._session = await self
        return self._session

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._session is not None:
            await self._session.close()


def _connect(address: str, timeout_s: float) -> AsyncTransport:
    # Only here, so that a client in this process needs no gRPC.
    from stridewire._grpc_asyncio import AsyncGrpcTransport

    return AsyncGrpcTransport(address, timeout_s)
