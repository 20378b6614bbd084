"""A client in Node, `@grpc/grpc-js`: every query, and five seconds at 60 frames a second."""

from external import needs_node, node_example
from serving import Serve

SECONDS = 5.0


@needs_node
def test_node_asks_and_streams(serve: Serve) -> None:
    """All methods answer; every step has its frame; the character walks at the speed asked for."""
    found = node_example(serve(), SECONDS)
    assert set(found["answers"]) == {
        *("GetInfo", "ListLibraries", "GetLibrary", "ListClips", "GetClip", "GetSkeleton"),
        *("Search", "Blend", "BlendMany"),
    }
    assert all(found["answers"].values())
    assert (found["answers"]["Blend"], found["answers"]["BlendMany"]) == (3, 2)
    # a machine that stalls lets frames go, which the newest then stands for
    assert 0.8 * 60.0 * SECONDS <= found["frames"] <= 60.0 * SECONDS
    assert found["joints"] == 22
    assert 0.6 * 1.3 * SECONDS < found["walked_m"] < 1.2 * 1.3 * SECONDS
