"""The network's part in stitching: when it is asked, what it changes, when it is not heard."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._messages import StitchQuery, StitchReport
from stridewire.motion.clip import Clip
from stridewire_engine.library import Library
from stridewire_engine.networks.rmr import Guidance, Plans
from stridewire_engine.stitching import Stitching
from unit.stitching.clips import cuts_of


class StandIn:
    """Says of every plan that the clips are right, but for an offset of the toes."""

    furthest = 2.0

    def __init__(self, offset: float = 0.0, distance: float = 1.0) -> None:
        self.offset, self.distance = offset, distance
        self.plans: list[Plans] = []
        self.model = type("Model", (), {"hash": "0123"})

    def refine(self, plans: Plans) -> Guidance:
        """Return the clips' own contacts and offsets along x from the first seam on."""
        self.plans.append(plans)
        offset = np.zeros((*plans.contacts.shape, 3))
        offset[..., 0] = self.offset * (plans.since_first > 0)[..., None]
        planted = plans.contacts.astype(np.float64)
        return Guidance(planted, offset, 0.0 * offset, np.full(len(plans), self.distance))


def refined(clips: list[Clip], network: StandIn, **given: object) -> tuple[Stitching, StitchReport]:
    """Stitch by a network."""
    query = StitchQuery(tuple(clips), "refine", **given)  # type: ignore[arg-type]
    made = Stitching(clips, query, network)  # type: ignore[arg-type]
    parts = list(made.parts())
    assert isinstance(parts[-1], StitchReport)
    return made, parts[-1]


def test_the_network_reads_windows_around_seams(small_library: Library) -> None:
    """Sixty frames, eight of them before the first seam; further ones follow by the shift."""
    clips = cuts_of(small_library)
    network = StandIn()
    refined(clips, network, shift_s=0.1)
    (plans,) = network.plans
    assert plans.frames == 60
    assert plans.first_seam.max() == 8
    # eight windows hold a seam, since each is six frames further than the one before
    assert sorted(plans.first_seam.tolist()) == [2, 2, 2, 8, 8, 8]
    first = plans.seam[:, 0] == 8
    np.testing.assert_allclose(plans.toes[first, :8], plans.clip_toes[first, :8], atol=1e-6)
    assert not plans.imposed.any()


def test_what_it_says_is_done_and_told(small_library: Library) -> None:
    """Offsets move swinging toes; the report names method and model."""
    clips = cuts_of(small_library)
    (still, _), (moved, report) = (refined(clips, StandIn(offset)) for offset in (0.0, 0.3))
    assert [seam.method for seam in report.seams] == ["refine"] * 3
    assert report.models == {"rmr": "0123"}
    difference = np.abs(moved.motion().rotations - still.motion().rotations).max(axis=(1, 2))
    seam = moved.plan.seams[0]
    # toes that stay planted are not moved, wherever their swings would lead
    assert difference.max() > 0.05
    assert difference[seam + 90 : moved.plan.seams[1]].max() == 0.0


def test_far_input_is_dead_blended(small_library: Library) -> None:
    """Unlike the training data: another method, and the reason with the distance."""
    _, report = refined(cuts_of(small_library), StandIn(distance=3.5))
    assert {seam.method for seam in report.seams} == {"dead-blend"}
    assert "distance 3.5, allowed 2.0" in report.seams[0].reason
    assert report.models == {}


def test_further_passes_read_their_own_result(small_library: Library) -> None:
    """Each pass asks once; the second is told of toes that the first has moved."""
    network = StandIn(0.2)
    refined(cuts_of(small_library), network, passes=3)
    first, second, _ = network.plans
    assert not np.allclose(first.toes, second.toes)
    assert np.array_equal(first.clip_toes, second.clip_toes)


@pytest.mark.parametrize("why", ["no network", "another skeleton", "too short"])
def test_without_the_network_stance_does_it(small_library: Library, why: str) -> None:
    """Asked for by name, and told why not."""
    clips = cuts_of(small_library)
    network = StandIn()
    if why == "another skeleton":
        bigger = clips[0].skeleton.scaled(1.1)
        clips = [replace(clip, skeleton=bigger) for clip in clips]
    if why == "too short":
        clips = [clip.cut(0, 20) for clip in clips[:2]]
    query = StitchQuery(tuple(clips), "refine")
    made = Stitching(clips, query, None if why == "no network" else network)  # type: ignore[arg-type]
    *_, report = made.parts()
    assert isinstance(report, StitchReport)
    assert {seam.method for seam in report.seams} == {"stance"}
    assert report.seams[0].reason
    assert not network.plans
