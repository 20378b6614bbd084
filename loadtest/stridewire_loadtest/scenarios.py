"""What can be asked of a server: streams and characters, and what goes on beside them."""

from collections.abc import Callable
from dataclasses import dataclass

FRAME_S = 1.0 / 60.0
RATE_HZ = 60.0
_CHARACTERS_A_STREAM = 4
_QUERIES_PER_S = 40.0
_SURGE = 200
_SLOW_READERS = 4


@dataclass(frozen=True)
class Scenario:
    """A load; every stream is driven at 60 steps a second for the whole time."""

    name: str
    streams: int
    characters: int
    """Of each stream."""
    blends_per_s: float = 0.0
    searches_per_s: float = 0.0
    churn: int = 0
    """Visitors that come, are driven for a few seconds, and leave or vanish, over and over."""
    surge: int = 0
    """Streams that are opened within one second, in the middle."""
    slow_readers: int = 0
    """Streams that send and take nothing."""


def _mixed(characters: int) -> Scenario:
    streams = max(1, characters // _CHARACTERS_A_STREAM)
    return Scenario("mixed", streams, _CHARACTERS_A_STREAM, _QUERIES_PER_S, _QUERIES_PER_S)


_SCENARIOS: dict[str, Callable[[int], Scenario]] = {
    "single": lambda n: Scenario("single", 1, 1),
    "streams": lambda n: Scenario("streams", n, 1),
    "crowd": lambda n: Scenario("crowd", 1, n),
    "mixed": _mixed,
    "blend": lambda n: Scenario("blend", 1, n, blends_per_s=4 * _QUERIES_PER_S),
    "search": lambda n: Scenario("search", 1, n, searches_per_s=4 * _QUERIES_PER_S),
    "soak": lambda n: Scenario("soak", max(1, n // 32), 32, churn=8),
    "surge": lambda n: Scenario("surge", 8, max(1, n // 8), surge=_SURGE),
    "slow-reader": lambda n: Scenario("slow-reader", 8, max(1, n // 8), slow_readers=_SLOW_READERS),
}

SCENARIO_NAMES = tuple(_SCENARIOS)
"""Names of all scenarios."""


def scenario(name: str, characters: int) -> Scenario:
    """Return the scenario of a name for a number of characters in all.

    Raises:
        KeyError: If there is none.
    """
    return _SCENARIOS[name](characters)
