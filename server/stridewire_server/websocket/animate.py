"""The stream of the contract at `/v1/animate`, and the layout of its bytes beside it."""

import json

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Response

from stridewire_server.streaming.sessions import Sessions
from stridewire_server.websocket.door import OPEN_S, Talk, found
from stridewire_server.websocket.layout import layout
from stridewire_server.websocket.wire import WebSocketWire

ANIMATE = "/v1/animate"
LAYOUT = "/v1/layout.json"


def animate(sessions: Sessions) -> Talk:
    """Return what is talked at `ANIMATE`: one session of those of a server."""

    async def talk(connection: ServerConnection) -> None:
        await sessions.serve(WebSocketWire(connection, OPEN_S))

    return talk


def find_layout(path: str) -> Response | None:
    """Return the layout where the path is its own."""
    if path != LAYOUT:
        return None
    return found(json.dumps(layout(), indent=1).encode(), "application/json")
