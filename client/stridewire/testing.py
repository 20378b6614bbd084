"""For tests of programs that use a server: a real one, in a process of its own.

@pytest.fixture(scope="session")
def address() -> Iterator[str]:
with stridewire.testing.serve() as address:
yield address
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from stridewire._errors import UnavailableError

_STOP_S = 10.0


@contextmanager
def serve(*libraries: str | os.PathLike[str]) -> Iterator[str]:
    """Run `stridewire serve` on a free port of this machine; gives its address.

    The server is ready when it is given and is stopped at the end. Needs the extra `server`.

    Args:
        libraries: Library folders, `NAME=FOLDER` to name them; the embedded library where there is
            none, which the first start on a machine builds.

    Raises:
        UnavailableError: If the server ended before it was ready; it has said why on standard
            error.
    """
    with server_process(*libraries) as (address, _):
        yield address


@contextmanager
def server_process(
    *libraries: str | os.PathLike[str],
) -> Iterator[tuple[str, "subprocess.Popen[str]"]]:
    """Run a server as `serve` does; gives its address and its process, to be watched.

    Raises:
        UnavailableError: As `serve`.
    """
    command = [sys.executable, "-m", "stridewire", "serve", "--address", "127.0.0.1:0", "--json"]
    for library in libraries:
        command += ["--library", os.fspath(library)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            assert server.stdout is not None
            ready = server.stdout.readline()
            if not ready:
                raise UnavailableError(
                    f"the server ended with {server.wait()} before it was ready; see above"
                )
            yield json.loads(ready)["address"], server
        finally:
            server.terminate()
            try:
                server.wait(_STOP_S)
            except subprocess.TimeoutExpired:
                server.kill()
