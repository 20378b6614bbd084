"""What both transports over gRPC share: options of the channel, statuses as errors."""

import json
from typing import Any

import grpc

from stridewire._codec.calls import Call
from stridewire._codec.status import DETAILS_KEY, decode_error
from stridewire._errors import InvalidRequestError, StridewireError
from stridewire._messages import PartsQuery, Query

_RETRIES = {
    "methodConfig": [
        {
            "name": [
                {"service": f"stridewire.v1.{name}Service"}
                for name in ("Match", "Library", "Server")
            ],
            "retryPolicy": {
                "maxAttempts": 4,
                "initialBackoff": "0.1s",
                "maxBackoff": "1s",
                "backoffMultiplier": 2,
                "retryableStatusCodes": ["UNAVAILABLE"],
            },
        }
    ]
}
CHANNEL_OPTIONS: list[tuple[str, Any]] = [
    ("grpc.service_config", json.dumps(_RETRIES)),
    # Without these two a reader that stalls finds minutes of stale frames in its buffers.
    ("grpc.http2.bdp_probe", 0),
    ("grpc.http2.lookahead_bytes", 16_384),
    ("grpc.keepalive_time_ms", 30_000),
    ("grpc.keepalive_timeout_ms", 10_000),
    ("grpc.http2.ping_timeout_ms", 10_000),
    # A server that was started anew is found soon.
    ("grpc.initial_reconnect_backoff_ms", 100),
    ("grpc.max_reconnect_backoff_ms", 1_000),
    ("grpc.max_receive_message_length", 8 << 20),
]
"""Options of a channel to a server."""
PARTS_TIMEOUT_S = 600.0
"""Longest time that the whole of an answer in parts may take."""


def encode_query(call: Call, query: Query[Any] | PartsQuery[Any]) -> bytes:
    """Return the bytes of a query's request.

    Raises:
        InvalidRequestError: If a value has no place on the wire, such as a negative count.
    """
    try:
        return call.serialize(query)
    except (TypeError, ValueError) as error:
        raise InvalidRequestError(f"{type(query).__name__} cannot be sent: {error}") from error


def rpc_error(error: grpc.RpcError, address: str) -> StridewireError:
    """Return what an error of gRPC, blocking or of asyncio, means."""
    known: Any = error
    return to_error(known.code(), known.details(), known.trailing_metadata(), address)


def to_error(
    code: grpc.StatusCode, message: str | None, metadata: Any, address: str
) -> StridewireError:
    """Return what a status with its message and trailing metadata means."""
    # asyncio's metadata looks like a mapping, but old versions of it cannot be made a dict of
    details: bytes | None = {key: value for key, value in metadata or ()}.get(DETAILS_KEY)
    if code is grpc.StatusCode.UNAVAILABLE and details is None:  # not said by our server
        message = f"no connection to {address} ({message}); `stridewire serve` starts a server"
    return decode_error(code.name, message or "", details)
