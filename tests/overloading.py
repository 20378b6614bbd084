"""More than a server can do, and a neighbour who watches it."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import grpc

from stridewire.v1 import animation_pb2 as pb
from stridewire.v1.animation_pb2_grpc import AnimationServiceStub

TOO_MANY, FASTEST_HZ = 1024, 240.0
"""Characters whose tick takes several times as long as this pace allows."""
LONGEST_S = 80.0
_DEGRADED = 1 << pb.FRAME_FLAG_DEGRADED
_OPTIONS = [("grpc.max_receive_message_length", 64 << 20)]


class Neighbour:
    """A character of its own, paced by the server, whose frames tell how the server is."""

    def __init__(self, frames: Iterator[pb.AnimateResponse]) -> None:
        self._frames = frames
        self.notices: list[int] = []
        """Kinds of the notices that came."""

    def wait_for(self, degraded: bool) -> float:
        """Read until a frame is, or is not, made under strain; return the seconds that it took."""
        began = time.monotonic()
        for response in self._frames:
            if response.HasField("notice"):
                self.notices.append(response.notice.kind)
            flagged = any(flags & _DEGRADED for flags in response.frame.flags)
            if response.HasField("frame") and flagged == degraded:
                break
        return time.monotonic() - began


@contextmanager
def neighbour(address: str) -> Iterator[Neighbour]:
    """Open a stream of one character at sixty frames a second."""
    with grpc.insecure_channel(address) as channel, _paced(channel, 1, 60.0) as frames:
        yield Neighbour(frames)


@contextmanager
def crowding(address: str) -> Iterator[None]:
    """Keep a crowd going that is too large, read as fast as it comes."""
    with grpc.insecure_channel(address, _OPTIONS) as channel:
        with _paced(channel, TOO_MANY, FASTEST_HZ) as frames:

            def read() -> None:
                with suppress(grpc.RpcError):
                    for _ in frames:
                        pass

            reading = threading.Thread(target=read, daemon=True)
            reading.start()
            yield
        reading.join()


@contextmanager
def _paced(
    channel: grpc.Channel, characters: int, rate_hz: float
) -> Iterator[Iterator[pb.AnimateResponse]]:
    """Open a stream that the server paces; give what it sends."""
    over = threading.Event()
    specs = [pb.CharacterSpec(id=i) for i in range(characters)]

    def requests() -> Iterator[pb.AnimateRequest]:
        yield pb.AnimateRequest(
            open=pb.Open(
                characters=specs,
                pacing=pb.PACING_SERVER,
                rate_hz=rate_hz,
                max_frames_in_flight=0,
            )
        )
        over.wait(LONGEST_S)

    call = AnimationServiceStub(channel).Animate(requests(), timeout=LONGEST_S)
    try:
        yield call
    finally:
        call.cancel()
        over.set()
