"""A client in Node, `@grpc/grpc-js`: every query, and five seconds at 60 frames a second."""

from external import needs_node, node_example
from serving import Serve

SECONDS = 5.0
TRIES = 3
"""Runs, since one may fall into a moment when the machine stalls; one at 60 frames/s is enough."""


@needs_node
def test_node_asks(serve: Serve) -> None:
    """All methods answer."""
    answers = node_example(serve(), 0.1)["answers"]
    assert set(answers) == {
        *("GetInfo", "ListLibraries", "GetLibrary", "ListClips", "GetClip", "GetSkeleton"),
        *("Search", "Blend", "BlendMany"),
    }
    assert all(answers.values())
    assert (answers["Blend"], answers["BlendMany"]) == (3, 2)


@needs_node
def test_node_streams(serve: Serve) -> None:
    """Every step has its frame; the character walks at the speed asked for."""
    for _ in range(TRIES):
        found = node_example(serve(), SECONDS)
        assert found["joints"] == 22
        assert found["frames"] <= 60.0 * SECONDS
        # a machine that stalls lets frames go, which the newest then stands for
        assert 0.6 * 1.3 * SECONDS < found["walked_m"] < 1.2 * 1.3 * SECONDS
        if found["frames"] >= 0.8 * 60.0 * SECONDS:
            return
    raise AssertionError(f"{found['frames']} frames in {SECONDS} s, the last of {TRIES} runs")
