"""Which addresses other machines can reach."""

import pytest

from stridewire_server.settings import is_loopback


@pytest.mark.parametrize(
    "address", ["127.0.0.1:50051", "127.8.8.8:0", "localhost:1", "[::1]:50051", "unix:/run/s.sock"]
)
def test_loopback(address: str) -> None:
    """These stay on the machine."""
    assert is_loopback(address)


@pytest.mark.parametrize(
    "address", ["0.0.0.0:50051", "[::]:50051", "192.168.1.5:1", "example.org:1", "50051", ""]
)
def test_public(address: str) -> None:
    """These do not, or nobody knows."""
    assert not is_loopback(address)
