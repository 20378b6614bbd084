"""Options that say where characters run: on a server, or in this process."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from stridewire._base_client import DEFAULT_ADDRESS
from stridewire._transport import in_process_transport
from stridewire.client import Client, grpc_transport
from stridewire.session_recording import RecordingTransport


def target_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add `--address` and `--library` to a command."""
    address = click.option("--address", help=f"Server to use.  [default: {DEFAULT_ADDRESS}]")
    library = click.option(
        "--library",
        type=click.Path(file_okay=False, path_type=Path),
        help="Run in this process over this library or folder of motion files instead.",
    )
    return address(library(command))


def connect(address: str | None, library: Path | None, record: Path | None = None) -> Client:
    """Return the client that the options ask for, its session recorded where a file is given."""
    if library is None:
        transport = grpc_transport(address or DEFAULT_ADDRESS)
    elif address is not None:
        raise click.UsageError("--address and --library exclude each other; give one of them")
    else:
        transport = in_process_transport(str(library))
    return Client(transport if record is None else RecordingTransport(transport, record))
