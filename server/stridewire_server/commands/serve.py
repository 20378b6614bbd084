"""`stridewire serve`: the server process."""

import asyncio
import gc
import json
import logging
import os
import signal
import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from stridewire._event_loop import run

if TYPE_CHECKING:
    from stridewire._messages import Open, Opened
    from stridewire_engine.library import Library
    from stridewire_engine.runtime.runtime import Recorder
    from stridewire_server.server import AnimationServer
    from stridewire_server.settings import ServerSettings

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@click.command()
@click.option(
    "--library",
    "libraries",
    multiple=True,
    metavar="[NAME=]FOLDER",
    help="Library or folder of motion files to serve, the first is the default one; without any, "
    "the embedded synthetic library.",
)
@click.option("--address", default="127.0.0.1:50051", show_default=True, help="Port 0 picks one.")
@click.option(
    "--websocket",
    default="",
    metavar="HOST:PORT",
    help="Serve streams through WebSockets, too, at ws://HOST:PORT/v1/animate.",
)
@click.option(
    "--origin",
    "origins",
    multiple=True,
    metavar="http://HOST:PORT",
    help="Let pages of this origin come through the WebSocket door; may be given again.",
)
@click.option(
    "--metrics",
    default="",
    metavar="HOST:PORT",
    help="Serve metrics for Prometheus at http://HOST:PORT/metrics.",
)
@click.option("--insecure", is_flag=True, help="Allow an address that other machines can reach.")
@click.option(
    "--record",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to record every session in, for `stridewire replay`.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object when ready.")
def serve(
    libraries: tuple[str, ...],
    address: str,
    websocket: str,
    origins: tuple[str, ...],
    metrics: str,
    insecure: bool,
    record: Path | None,
    as_json: bool,
) -> None:
    """Serve characters over gRPC until SIGTERM or Ctrl-C."""
    calm_threads()
    from stridewire_server.settings import ServerSettings, is_loopback

    for given in filter(None, (address, websocket, metrics)):
        if not (insecure or is_loopback(given)):
            raise click.UsageError(
                f"{given} can be reached by other machines and this server asks nobody who they "
                "are; add --insecure to serve there all the same"
            )
    logging.basicConfig(format="%(asctime)s %(levelname)s %(name)s: %(message)s")
    settings = ServerSettings(
        address=address, websocket=websocket, origins=origins, metrics=metrics
    )
    run(_serve(open_libraries(libraries), settings, record, as_json))


def calm_threads() -> None:
    """Keep numeric libraries to one thread each; more only fight the tick.

    To be called before numpy is loaded.
    """
    for name in _THREADS:
        os.environ.setdefault(name, "1")


def open_libraries(given: tuple[str, ...]) -> "list[Library]":
    """Open the libraries that were named, `[NAME=]FOLDER`, or the embedded one."""
    from dataclasses import replace

    from stridewire_engine.building import open_library

    if not given:
        click.echo("opening the embedded library; the first start builds it …", err=True)
        return [open_library()]
    libraries = []
    for text in given:
        name, _, folder = text.rpartition("=")
        library = open_library(folder)
        if name:
            library.manifest = replace(library.manifest, name=name)
        libraries.append(library)
    return libraries


async def _serve(
    libraries: "list[Library]", settings: "ServerSettings", record: Path | None, as_json: bool
) -> None:
    from stridewire_engine.runtime import Runtime
    from stridewire_server.server import AnimationServer

    runtime = Runtime(libraries, record=None if record is None else _recorder(record))
    server = AnimationServer(runtime, settings)
    bound = await server.start()
    # what is there by now stays: going through it again and again would only stop every frame
    gc.collect()
    gc.freeze()
    _announce(bound, server, libraries, as_json)
    await wait_for_signal()
    await _stop(server)


def _recorder(folder: Path) -> "Recorder":
    """Return what opens a file for each session, named by the time and the session."""
    from stridewire.formats.session_file import SessionWriter

    folder.mkdir(parents=True, exist_ok=True)

    def record(opening: "Open", opened: "Opened") -> SessionWriter:
        name = f"{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}-{opened.session}.jsonl"
        return SessionWriter(folder / name, opening, opened)

    return record


def _announce(
    address: str, server: "AnimationServer", libraries: "list[Library]", as_json: bool
) -> None:
    websocket, metrics = server.websocket_address, server.metrics_address
    infos = [library.info() for library in libraries]
    if as_json:
        names = [{"name": info.name, "synthetic": info.synthetic} for info in infos]
        doors = {"websocket": websocket, "metrics": metrics}
        door = {name: where for name, where in doors.items() if where}
        click.echo(json.dumps({"address": address, **door, "libraries": names}))
        return
    click.echo(f"listening on {address}")
    if websocket:
        click.echo(f"listening on ws://{websocket}/v1/animate")
    if metrics:
        click.echo(f"metrics at http://{metrics}/metrics")
    for info in infos:
        kind = "synthetic" if info.synthetic else "captured"
        click.echo(f"library {info.name} ({kind}, {info.clips} clips, {info.frames} frames)")


async def wait_for_signal() -> None:
    """Wait for SIGTERM or Ctrl-C; a second one ends the process at once."""
    asked = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(number, asked.set)
    await asked.wait()
    for number in (signal.SIGTERM, signal.SIGINT):
        loop.remove_signal_handler(number)  # asked again, the process ends at once


async def _stop(server: "AnimationServer") -> None:
    click.echo("stopping: open sessions have been told", err=True)
    await server.stop()
