"""The door itself: one port for WebSockets, and for what is read beside them."""

import logging
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from http import HTTPStatus

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from stridewire_server.faults import as_error
from stridewire_server.settings import ServerSettings, is_loopback
from stridewire_server.websocket.admittance import Admittance, counted_connections
from stridewire_server.websocket.wire import refuse

Talk = Callable[[ServerConnection], Awaitable[None]]
"""What is talked over a WebSocket until either side ends it."""
Find = Callable[[str], Response | None]
"""From a path to what lies there; None where there is nothing."""

OPEN_S = 5.0
"""Longest wait for a request, and from there for a first message."""
_PING_S, _PONG_S = 2.0, 5.0
"""A silent client is given up, but not one whose main loop, which answers, loads a scene."""
_CLOSE_S = 1.0
"""Longest wait for the other side of a closing handshake."""
_MESSAGES_AHEAD = 1
"""Messages that are read before they are asked for; a flood waits in the client's own buffers."""
_MORE_CONNECTIONS = 64
"""Connections beyond the sessions: pages, and those that are just coming or going."""


class WebSocketDoor:
    """Lets WebSockets in; to be made and used in one event loop.

    Args:
        settings: Where to listen and which origins to let in.
        max_message_bytes: Largest message that is taken.
        talks: What is talked at each path.
        find: Finds what is there to be read.
    """

    def __init__(
        self,
        settings: ServerSettings,
        max_message_bytes: int,
        talks: Mapping[str, Talk],
        find: Find,
    ) -> None:
        self._settings = settings
        self._max_message_bytes = max_message_bytes
        self._talks = talks
        self._find = find
        self._admittance = Admittance(settings.max_sessions + _MORE_CONNECTIONS, settings.origins)
        self._server: Server | None = None

    async def start(self) -> str:
        """Listen; returns the bound address `host:port`.

        Raises:
            ValueError: If the address cannot be listened on.
        """
        host, _, port = self._settings.websocket.rpartition(":")
        try:
            self._server = await serve(
                self._serve,
                host.strip("[]"),
                int(port),
                process_request=self._answer,
                create_connection=counted_connections(self._admittance),
                logger=_quiet(),
                compression=None,
                server_header=None,
                open_timeout=OPEN_S,
                ping_interval=_PING_S,
                ping_timeout=_PONG_S,
                close_timeout=_CLOSE_S,
                max_size=self._max_message_bytes,
                max_queue=_MESSAGES_AHEAD,
            )
        except (OSError, ValueError, OverflowError) as error:
            raise ValueError(
                f"cannot listen on {self._settings.websocket}: {error}; give another HOST:PORT"
            ) from error
        bound = self._server.sockets[0].getsockname()[1]
        self._admittance.hosts = _names(host, bound) if is_loopback(f"{host}:{bound}") else None
        return f"{host}:{bound}"

    async def stop(self) -> None:
        """Let nobody in any more and close what is open."""
        if self._server is not None:
            self._server.close()
            await self._server.wait_closed()

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request; None lets the WebSocket's handshake go on."""
        try:
            if refused := self._admittance.refusal(request):
                return connection.respond(HTTPStatus.FORBIDDEN, f"{refused}\n")
            path = path_of(request)
            if path in self._talks:
                return None
            talks = " and ".join(self._talks)
            absent = connection.respond(HTTPStatus.NOT_FOUND, f"nothing here; streams: {talks}\n")
            return self._find(path) or absent
        except Exception as caught:
            told = as_error(caught, request.path)
            return connection.respond(HTTPStatus.INTERNAL_SERVER_ERROR, f"{told}\n")

    async def _serve(self, connection: ServerConnection) -> None:
        assert connection.request is not None
        path = path_of(connection.request)
        with suppress(ConnectionClosed):
            try:
                await self._talks[path](connection)
            except ConnectionClosed:
                raise
            except Exception as caught:
                await refuse(connection, as_error(caught, path))


def path_of(request: Request) -> str:
    """Return the path of a request without its query."""
    return request.path.partition("?")[0]


def found(body: bytes, kind: str) -> Response:
    """Return a response with a body of some media type."""
    headers = Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(len(body)),
            "Connection": "close",
            "Cache-Control": "no-cache",
            "X-Content-Type-Options": "nosniff",
        }
    )
    return Response(HTTPStatus.OK.value, HTTPStatus.OK.phrase, headers, body)


def _quiet() -> logging.Logger:
    """Return a log for the library: what strangers send is no news; our faults have their own."""
    logger = logging.Logger("stridewire.websocket", logging.CRITICAL)
    logger.addHandler(logging.NullHandler())
    return logger


def _names(host: str, port: int) -> frozenset[str]:
    """Return how a browser on this machine may name a loopback address."""
    return frozenset(f"{name}:{port}" for name in (host, "localhost", "127.0.0.1", "[::1]"))
