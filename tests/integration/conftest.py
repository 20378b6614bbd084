"""The servers that these tests talk to."""

from serving import (
    address,
    client,
    door,
    either,
    loop_thread,
    own_door,
    raw_stream,
    serve,
    small_library,
    stopping,
)

__all__ = [
    "address",
    "client",
    "door",
    "either",
    "loop_thread",
    "own_door",
    "raw_stream",
    "serve",
    "small_library",
    "stopping",
]
