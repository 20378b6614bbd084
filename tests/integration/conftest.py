"""The servers that these tests talk to."""

from serving import (
    address,
    client,
    either,
    loop_thread,
    raw_stream,
    serve,
    small_library,
    stopping,
)

__all__ = [
    "address",
    "client",
    "either",
    "loop_thread",
    "raw_stream",
    "serve",
    "small_library",
    "stopping",
]
