"""A client that is gone holds nothing for long."""

import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import islice

import pytest

from serving import DEADLINE_S, Serve, eventually
from stridewire import Client, Pacing

GONE_WITHIN_S = 2.0
"""The contract: a vanished client's session is gone after two seconds."""

DRIVER = """
import sys
from stridewire import Client, Pacing
with Client(sys.argv[1]) as client, client.open_session(8, pacing=Pacing.SERVER) as session:
    for frame in session.frames():
        print(frame.frame, flush=True)
"""


@pytest.fixture
def own_server(serve: Serve) -> str:
    """Return the address of a server without other sessions."""
    return serve()


def test_the_session_of_a_killed_client_ends(own_server: str) -> None:
    """SIGKILL in the middle of a session: it is gone in time, a neighbour misses no frame."""
    command = [sys.executable, "-c", DRIVER, own_server]
    with (
        ThreadPoolExecutor(1) as reader,
        Client(own_server, timeout_s=DEADLINE_S) as client,
        client.open_session(pacing=Pacing.SERVER) as neighbour,
        subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as driver,
    ):
        reading = reader.submit(lambda: list(islice(neighbour.frames(), 240)))
        assert driver.stdout is not None
        assert driver.stdout.readline().strip() == "1"
        assert client.info().sessions == 2
        driver.send_signal(signal.SIGKILL)
        assert eventually(lambda: client.info().sessions == 1, GONE_WITHIN_S)
        frames = reading.result()
        assert [frame.frame for frame in frames] == list(range(1, 241))
        assert not any(frame.dropped for frame in frames)


class Tunnel:
    """Forwards TCP to a server until it goes silent, as a cut cable does: no close, no reset."""

    def __init__(self, target: str) -> None:
        host, port = target.split(":")
        self._target = (host, int(port))
        self._cut = threading.Event()
        self._sockets: list[socket.socket] = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self._listener.getsockname()[1]}"
        self._spawn(self._accept)

    def cut(self) -> None:
        """Forward nothing more."""
        self._cut.set()

    def close(self) -> None:
        """Close all sockets."""
        for opened in (self._listener, *self._sockets):
            opened.close()

    def _spawn(self, work: object, *args: object) -> None:
        threading.Thread(target=work, args=args, daemon=True).start()  # type: ignore[arg-type]

    def _accept(self) -> None:
        try:
            near, _ = self._listener.accept()
        except OSError:
            return
        far = socket.create_connection(self._target)
        self._sockets += [near, far]
        self._spawn(self._pump, near, far)
        self._spawn(self._pump, far, near)

    def _pump(self, source: socket.socket, sink: socket.socket) -> None:
        try:
            while data := source.recv(65536):
                if self._cut.is_set():
                    return
                sink.sendall(data)
        except OSError:
            return


@pytest.fixture
def tunnel(own_server: str) -> Iterator[Tunnel]:
    """Return a tunnel to the server."""
    tunnel = Tunnel(own_server)
    yield tunnel
    tunnel.close()


def test_the_session_behind_a_cut_cable_ends(own_server: str, tunnel: Tunnel) -> None:
    """Nothing says that the client is gone: pings find out."""
    far = Client(tunnel.address, timeout_s=1.0)
    session = far.open_session()
    session.step()
    with Client(own_server) as client:
        assert client.info().sessions == 1
        tunnel.cut()
        assert eventually(lambda: client.info().sessions == 0)
    tunnel.close()
    session.close()
    far.close()


def test_closing_a_client_ends_its_sessions(own_server: str) -> None:
    """Close in good order, and a client that is closed with a session still open."""
    with Client(own_server) as watcher:
        with Client(own_server) as client:
            tidy = client.open_session()
            tidy.step()
            tidy.close()
            tidy.close()
            forgotten = client.open_session()
            forgotten.step()
        assert eventually(lambda: watcher.info().sessions == 0, GONE_WITHIN_S)
