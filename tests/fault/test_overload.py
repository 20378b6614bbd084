"""More than a server can do: it gives way as it says, tells so, and is itself again soon after."""

from overloading import crowding, neighbour
from serving import DEADLINE_S
from stridewire.testing import server_process
from stridewire.v1 import animation_pb2 as pb
from stridewire_engine.library import Library


def test_overload_is_told_and_passes(small_library: Library) -> None:
    """A neighbour's frames say DEGRADED beside too large a crowd, and no more once it is gone."""
    # in a process of its own: nobody else is to use the time of its loop
    with server_process(small_library.path) as (address, _), neighbour(address) as watching:
        watching.wait_for(degraded=False)
        with crowding(address):
            assert watching.wait_for(degraded=True) < DEADLINE_S
        # a second is promised; a busy machine takes its time to end the crowd's stream
        assert watching.wait_for(degraded=False) < DEADLINE_S
        while pb.NOTICE_KIND_RECOVERED not in watching.notices:
            assert watching.wait_for(degraded=False) < DEADLINE_S
    assert watching.notices[0] == pb.NOTICE_KIND_DEGRADED
    assert watching.notices[-1] == pb.NOTICE_KIND_RECOVERED
