"""Who is let in: so many connections, from pages of ours or of origins that were named."""

from collections.abc import Sequence
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request


class Admittance:
    """Counts connections and checks where requests come from.

    A browser tells with every WebSocket which page asked for it, its origin. Without the check any
    page that is open in a browser could drive the server of that machine.

    Args:
        most: Connections at the same time; more are cut off as they come.
        origins: Origins beside the door's own, such as `http://localhost:3000`.
    """

    def __init__(self, most: int, origins: Sequence[str] = ()) -> None:
        self._most = most
        self._origins = frozenset(origins)
        self._connections = 0
        self.hosts: frozenset[str] | None = None
        """Names that the door answers to, `host:port`; None where other machines may name it."""

    def enter(self) -> bool:
        """Take a place; tells whether there was one."""
        self._connections += 1
        return self._connections <= self._most

    def leave(self) -> None:
        """Give a place back, also one that was beyond the most."""
        self._connections -= 1

    def refusal(self, request: Request) -> str:
        """Return why a request is refused; empty where it is not."""
        host = ", ".join(request.headers.get_all("Host"))
        if self.hosts is not None and host not in self.hosts:
            # another machine's name that was made to lead here: its pages count as ours else
            return f"host {host!r} is not a name of this server"
        origins = request.headers.get_all("Origin")
        if set(origins) <= {f"http://{host}", *self._origins}:
            return ""
        origin = ", ".join(origins)
        return f"origin {origin!r} is not let in; name it with --origin to let it in"


def counted_connections(admittance: Admittance) -> type[ServerConnection]:
    """Return what makes connections that are cut off at once where there is no place for them."""

    class Counted(ServerConnection):
        def connection_made(self, transport: Any) -> None:
            super().connection_made(transport)
            if not admittance.enter():
                transport.abort()

        def connection_lost(self, exc: Exception | None) -> None:
            admittance.leave()
            super().connection_lost(exc)

    return Counted
