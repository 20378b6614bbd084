"""The server process: services, health and reflection around one runtime."""

import grpc
from grpc_health.v1 import health, health_pb2, health_pb2_grpc
from grpc_reflection.v1alpha import reflection

from stridewire.v1 import (
    animation_pb2,
    blend_pb2,
    blend_pb2_grpc,
    library_pb2,
    library_pb2_grpc,
    match_pb2,
    match_pb2_grpc,
    stitch_pb2,
    stitch_pb2_grpc,
)
from stridewire_engine.runtime import Runtime
from stridewire_server.interceptors import ErrorInterceptor
from stridewire_server.metrics import Metrics
from stridewire_server.page.site import Site
from stridewire_server.services import animation
from stridewire_server.services.about import ServerService
from stridewire_server.services.blend import BlendService
from stridewire_server.services.library import LibraryService
from stridewire_server.services.match import MatchService
from stridewire_server.services.stitch import StitchService
from stridewire_server.settings import ServerSettings
from stridewire_server.streaming.sessions import Sessions
from stridewire_server.ticker import Ticker
from stridewire_server.warming import warm_up
from stridewire_server.websocket.animate import ANIMATE, animate, find_layout
from stridewire_server.websocket.door import Talk, WebSocketDoor

_GRACE_S = 0.5
"""For calls that are still open when the time of open sessions is up."""

_READY = (
    animation_pb2.DESCRIPTOR.services_by_name["AnimationService"].full_name,
    match_pb2.DESCRIPTOR.services_by_name["MatchService"].full_name,
    blend_pb2.DESCRIPTOR.services_by_name["BlendService"].full_name,
    library_pb2.DESCRIPTOR.services_by_name["LibraryService"].full_name,
    library_pb2.DESCRIPTOR.services_by_name["ServerService"].full_name,
    stitch_pb2.DESCRIPTOR.services_by_name["StitchService"].full_name,
)


class AnimationServer:
    """Serves a runtime until it is stopped; to be made and used in one event loop.

    Args:
        runtime: Its libraries are open.
        settings: Of this process.
        page: What the WebSocket door serves beside streams.
    """

    def __init__(
        self, runtime: Runtime, settings: ServerSettings, page: Site | None = None
    ) -> None:
        self._settings = settings
        self._metrics = Metrics()
        self._ticker = Ticker(runtime, self._metrics)
        self._sessions = Sessions(self._ticker, settings)
        self._stitch = StitchService(runtime)
        self._health = health.aio.HealthServicer()  # type: ignore[attr-defined]
        self._server = grpc.aio.server(
            interceptors=[ErrorInterceptor(runtime.limits)],
            options=settings.channel_options(runtime.limits),
        )
        self._door: WebSocketDoor | None = None
        if settings.websocket:
            talks: dict[str, Talk] = {ANIMATE: animate(self._sessions)}
            self._door = WebSocketDoor(
                settings,
                runtime.limits.max_message_bytes,
                talks if page is None else {**talks, **page.talks},
                lambda path: find_layout(path) or (page.find(path) if page is not None else None),
            )
        self.websocket_address = ""
        """Where the WebSocket door listens, once it does."""
        self.metrics_address = ""
        """Where metrics are served, once they are."""

    async def start(self) -> str:
        """Listen, warm the libraries up, become healthy; returns the bound address.

        Raises:
            ValueError: If the address cannot be listened on.
        """
        self._register()
        await self._set_health(health_pb2.HealthCheckResponse.NOT_SERVING)
        address = self._bind()
        await self._server.start()
        await self._ticker.query(warm_up, self._ticker.runtime)
        if self._door is not None:
            self.websocket_address = await self._door.start()
        if self._settings.metrics:
            self.metrics_address = self._metrics.serve(self._settings.metrics)
        await self._set_health(health_pb2.HealthCheckResponse.SERVING)
        return address

    async def stop(self) -> None:
        """Stop in good order: no longer healthy, open sessions warned and awaited, then the end."""
        await self._set_health(health_pb2.HealthCheckResponse.NOT_SERVING)
        await self._sessions.drain()
        if self._door is not None:
            await self._door.stop()
        await self._server.stop(grace=_GRACE_S)
        await self._sessions.wait_until_empty(_GRACE_S)
        self._ticker.shut_down()
        self._stitch.shut_down()
        self._metrics.stop()

    async def wait(self) -> None:
        """Wait until the server has stopped."""
        await self._server.wait_for_termination()

    def _register(self) -> None:
        server, ticker = self._server, self._ticker
        animation.add_to_server(
            animation.AnimationService(self._sessions, ticker.runtime.limits), server
        )
        match_pb2_grpc.add_MatchServiceServicer_to_server(MatchService(ticker), server)
        library_pb2_grpc.add_LibraryServiceServicer_to_server(
            LibraryService(ticker.runtime), server
        )
        library_pb2_grpc.add_ServerServiceServicer_to_server(ServerService(ticker), server)
        blend_pb2_grpc.add_BlendServiceServicer_to_server(BlendService(ticker), server)
        stitch_pb2_grpc.add_StitchServiceServicer_to_server(self._stitch, server)
        health_pb2_grpc.add_HealthServicer_to_server(self._health, server)
        health_name = health_pb2.DESCRIPTOR.services_by_name["Health"].full_name
        names = (*_READY, health_name, reflection.SERVICE_NAME)
        reflection.enable_server_reflection(names, server)

    def _bind(self) -> str:
        address = self._settings.address
        try:
            port = self._server.add_insecure_port(address)
        except RuntimeError as error:
            raise ValueError(
                f"cannot listen on {address}: is the port taken? Give another --address"
            ) from error
        return address if address.startswith("unix:") else f"{address.rpartition(':')[0]}:{port}"

    async def _set_health(self, status: int) -> None:
        """Set the health of the server and of what it offers."""
        for name in ("", *_READY):
            await self._health.set(name, status)
