"""`stridewire.testing` gives users' own tests a real server."""

import pytest

from stridewire import Client, UnavailableError, testing
from stridewire_engine.library import Library


def test_a_server_is_there_and_gone(small_library: Library) -> None:
    """It serves the named library while the block lasts, and no longer."""
    with (
        testing.serve(f"mine={small_library.path}") as address,
        Client(address) as client,
        client.open_session(library="mine") as session,
    ):
        assert session.step().frame == 1
    with Client(address, timeout_s=1.0) as client, pytest.raises(UnavailableError):
        client.info()


def test_a_server_that_cannot_start_is_told() -> None:
    """A folder that is none ends it before it is ready."""
    with pytest.raises(UnavailableError, match="before it was ready"), testing.serve("/nowhere"):
        pass
