"""Options that say where characters run: on a server, or in this process."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from stridewire._base_client import DEFAULT_ADDRESS
from stridewire.client import Client


def target_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add `--address` and `--library` to a command."""
    address = click.option("--address", help=f"Server to use.  [default: {DEFAULT_ADDRESS}]")
    library = click.option(
        "--library",
        type=click.Path(file_okay=False, path_type=Path),
        help="Run in this process over this library or folder of motion files instead.",
    )
    return address(library(command))


def connect(address: str | None, library: Path | None) -> Client:
    """Return the client that the options ask for."""
    if library is None:
        return Client(address or DEFAULT_ADDRESS)
    if address is not None:
        raise click.UsageError("--address and --library exclude each other; give one of them")
    return Client.in_process(library)
