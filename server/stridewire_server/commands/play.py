"""`stridewire play`: a page on which to drive a character, or to look at files."""

import json
import logging
import webbrowser
from contextlib import AsyncExitStack
from pathlib import Path

import click

from stridewire._event_loop import run
from stridewire_server.commands.serve import calm_threads, open_libraries, wait_for_signal

DEFAULT_PORT = 8484


@click.command()
@click.argument(
    "files", nargs=-1, metavar="[FILE]...", type=click.Path(dir_okay=False, path_type=Path)
)
@click.option(
    "--library",
    "libraries",
    multiple=True,
    metavar="[NAME=]FOLDER",
    help="Library or folder of motion files to choose from; the embedded one by default.",
)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=DEFAULT_PORT,
    show_default=True,
    help="On this machine alone; 0 picks one.",
)
@click.option("--no-browser", is_flag=True, help="Only serve the page, open it nowhere.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object when ready.")
def play(
    files: tuple[Path, ...], libraries: tuple[str, ...], port: int, no_browser: bool, as_json: bool
) -> None:
    """Drive a character in the browser, or look at motion files side by side.

    Without FILEs: a character to drive with keys, mouse, gamepad or touch, and what the runtime
    thinks while it moves. With FILEs (BVH, AMC beside its ASF, npz, glTF): the same moment of each.
    """
    if files and libraries:
        raise click.UsageError("give either FILEs to look at or libraries to drive over")
    calm_threads()
    logging.basicConfig(format="%(asctime)s %(levelname)s %(name)s: %(message)s")
    run(_play(files, libraries, port, not no_browser, as_json))


async def _play(
    files: tuple[Path, ...], libraries: tuple[str, ...], port: int, browse: bool, as_json: bool
) -> None:
    async with AsyncExitStack() as running:
        start = _show(running, files, port) if files else _drive(running, libraries, port)
        url = f"http://{await start}/"
        click.echo(json.dumps({"url": url}) if as_json else f"listening on {url}")
        if browse and not webbrowser.open(url):
            click.echo("no browser could be opened here; open the page yourself", err=True)
        await wait_for_signal()


async def _drive(running: AsyncExitStack, libraries: tuple[str, ...], port: int) -> str:
    """Serve characters and the page; returns the address."""
    from stridewire_engine.runtime import Runtime
    from stridewire_server.page.site import Site, about
    from stridewire_server.server import AnimationServer
    from stridewire_server.settings import ServerSettings

    runtime = Runtime(open_libraries(libraries))
    settings = ServerSettings("127.0.0.1:0", websocket=f"127.0.0.1:{port}", drain_s=0.0)
    server = AnimationServer(runtime, settings, Site(about(runtime)))
    await server.start()
    running.push_async_callback(server.stop)
    return server.websocket_address


async def _show(running: AsyncExitStack, files: tuple[Path, ...], port: int) -> str:
    """Serve files and the page; returns the address."""
    from stridewire._messages import Limits
    from stridewire_server.page.file_view import file_view
    from stridewire_server.page.site import Site
    from stridewire_server.settings import ServerSettings
    from stridewire_server.websocket.door import WebSocketDoor

    site = Site(*file_view(files))
    settings = ServerSettings(websocket=f"127.0.0.1:{port}")
    door = WebSocketDoor(settings, Limits().max_message_bytes, site.talks, site.find)
    running.push_async_callback(door.stop)
    return await door.start()
