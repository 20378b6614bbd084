"""What an operator can set, and the transport options that follow from it."""

import ipaddress
from dataclasses import dataclass

from stridewire._messages import Limits

DEFAULT_ADDRESS = "127.0.0.1:50051"
_MAX_REPLY_BYTES = 8 << 20
LARGE_REQUEST_BYTES = 16 << 20
"""Requests that carry motion files may be so long; all others as long as the limits say."""


@dataclass(frozen=True)
class ServerSettings:
    """Settings of one server process."""

    address: str = DEFAULT_ADDRESS
    """Where to listen, `host:port`; port 0 lets the system choose one."""
    websocket: str = ""
    """Where the WebSocket door listens, `host:port`; empty means nowhere."""
    origins: tuple[str, ...] = ()
    """Origins of pages that may come through that door, beside its own."""
    metrics: str = ""
    """Where metrics are served in Prometheus' format, `host:port`; empty means nowhere."""
    max_sessions: int = 256
    """Sessions at the same time, whatever the door; one more is refused with RESOURCE_EXHAUSTED."""
    drain_s: float = 10.0
    """Time that open sessions are given when the server stops."""

    def channel_options(self, limits: Limits) -> list[tuple[str, int]]:
        """Return gRPC's options.

        A connection that has gone silent is pinged and given up, so that a client whose machine
        vanished holds its session for two seconds at most. One that was closed is noticed at once.
        """
        return [
            ("grpc.max_receive_message_length", max(LARGE_REQUEST_BYTES, limits.max_message_bytes)),
            ("grpc.max_send_message_length", _MAX_REPLY_BYTES),
            ("grpc.max_concurrent_streams", 4 * self.max_sessions),
            (
                "grpc.so_reuseport",
                0,
            ),  # a second server on the same port fails instead of sharing it
            # No larger windows than the smallest: a flood is held back early.
            ("grpc.http2.bdp_probe", 0),
            ("grpc.keepalive_time_ms", 800),
            ("grpc.keepalive_timeout_ms", 800),
            # Without it a ping that stays unanswered is waited for a minute.
            ("grpc.http2.ping_timeout_ms", 800),
            ("grpc.keepalive_permit_without_calls", 1),
            ("grpc.http2.max_pings_without_data", 0),
            ("grpc.http2.min_recv_ping_interval_without_data_ms", 10_000),
        ]


def is_loopback(address: str) -> bool:
    """Tell whether an address `host:port` can be reached from this machine alone."""
    host = address.rpartition(":")[0].strip("[]")
    if address.startswith("unix:") or host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
