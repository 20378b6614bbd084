"""`AsyncClient` and `AsyncSession` have the names and the arguments of `Client` and `Session`."""

import inspect
from typing import Any

import pytest

from stridewire._async_session import AsyncSession
from stridewire._session import Session
from stridewire.aio import AsyncClient
from stridewire.client import Client

PAIRS = [(Client, AsyncClient), (Session, AsyncSession)]
OWN = {AsyncSession: {"start"}}
"""Public names that only one of a pair has: `start` awaits what `Session()` does at once."""


def public(kind: type[Any]) -> dict[str, Any]:
    """Return the public functions of a class."""
    own = OWN.get(kind, set())
    members = inspect.getmembers(kind, callable)
    return {name: value for name, value in members if name[0] != "_" and name not in own}


@pytest.mark.parametrize(("blocking", "awaited"), PAIRS)
def test_the_names_are_the_same(blocking: type[Any], awaited: type[Any]) -> None:
    """What the one can, the other can."""
    assert set(public(blocking)) == set(public(awaited))


@pytest.mark.parametrize(("blocking", "awaited"), PAIRS)
def test_the_arguments_are_the_same(blocking: type[Any], awaited: type[Any]) -> None:
    """Names, order, kinds, defaults and annotations of all arguments agree."""
    for name, method in public(blocking).items():
        here = inspect.signature(method).parameters.values()
        there = inspect.signature(public(awaited)[name]).parameters.values()
        assert list(map(str, here)) == list(map(str, there)), name


def test_what_may_wait_is_awaited() -> None:
    """Everything that asks or sends is a coroutine or an asynchronous generator."""
    for _, awaited in PAIRS:
        for name, method in public(awaited).items():
            waits = inspect.iscoroutinefunction(method) or inspect.isasyncgenfunction(method)
            assert waits or name in ("in_process", "open_session"), name
