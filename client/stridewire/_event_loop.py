"""The event loop that our processes run in: libuv's where it is installed, else Python's own."""

import asyncio
from collections.abc import Coroutine
from importlib.util import find_spec
from typing import Any, TypeVar

T = TypeVar("T")


def run(main: Coroutine[Any, Any, T]) -> T:
    """Run a coroutine to its end, as `asyncio.run` does.

    Messages wait a few milliseconds less in libuv's loop where streams are many. Its clock ticks in
    milliseconds: measure with `time.monotonic`.
    """
    if find_spec("uvloop") is None:
        return asyncio.run(main)
    import uvloop

    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        return runner.run(main)
