"""The stitcher `refine`, live: the network guides feet after transitions, or it is told why not."""

from pathlib import Path

import numpy as np
import pytest

from stridewire._messages import (
    CharacterSpec,
    Detail,
    FallbackReason,
    Frame,
    FrameFlag,
    GroundPose,
    Open,
    Step,
    Transition,
    TransitionReason,
)
from stridewire_engine import compiled
from stridewire_engine.library import Library
from stridewire_engine.networks import onnx_model
from stridewire_engine.networks.onnx_model import ModelError
from stridewire_engine.networks.rmr import Guidance, Plans, shipped_refiner
from stridewire_engine.runtime import Runtime
from stridewire_engine.runtime.characters import GUIDED_FRAMES, PAST_FRAMES
from stridewire_engine.runtime.refining import followed
from stridewire_engine.runtime.settings import TickSettings


@pytest.fixture(autouse=True)
def reference(monkeypatch: pytest.MonkeyPatch) -> None:
    """Go the way by numpy: what stands in for the network speaks of whole plans."""
    monkeypatch.setattr(compiled, "ENABLED", False)


class StandIn:
    """Takes the place of the network; remembers what it was asked."""

    furthest = 2.0

    def __init__(self, distance: float = 1.0, offset: float = 0.0) -> None:
        self.distance, self.offset = distance, offset
        self.asked: list[Plans] = []

    def refine(self, plans: Plans) -> Guidance:
        """Say that the clips are right, but for an offset after the seam."""
        self.asked.append(plans)
        offset = np.zeros((*plans.contacts.shape, 3))
        offset[..., 0] = self.offset * (plans.since_first > 0)[..., None]
        planted = plans.contacts.astype(np.float64)
        return Guidance(planted, offset, 0.0 * offset, np.full(len(plans), self.distance))


def walk(
    library: Library,
    network: StandIn,
    count: int = 2,
    dt: float = 1 / 60,
    stitcher: str = "refine",
    seconds: float = 3.0,
) -> tuple[list[Frame], Runtime]:
    """Walk half of the time one way and as long another way."""
    runtime = Runtime([library], clock=lambda: 0.0)
    tick = runtime._crowd("")._tick
    assert tick._refining is not None
    tick._refining._refiner = network  # type: ignore[assignment]
    specs = [CharacterSpec(i, GroundPose((3.0 * i, 0, 0)), stitcher=stitcher) for i in range(count)]
    session = runtime.open(Open(specs, seed=5, detail=Detail.EVENTS))
    frames = []
    for i in range(round(seconds / dt)):
        velocity = np.tile([[0.0, 1.4]] if i * dt < seconds / 2 else [[1.4, 0.0]], (count, 1))
        ((frame, _),) = runtime.advance([(session, Step(i, dt, velocity_xz=velocity))])
        frames.append(frame)
    return frames, runtime


def fallbacks(frames: list[Frame]) -> int:
    """Count the frames in which somebody fell back."""
    return sum(len(frame.flagged(FrameFlag.FALLBACK)) > 0 for frame in frames)


def transitions(frames: list[Frame]) -> list[Transition]:
    """Return the transitions, beginnings not among them."""
    return [
        event
        for frame in frames
        for event in frame.events
        if isinstance(event, Transition) and event.reason is not TransitionReason.START
    ]


def test_the_network_is_asked_at_transitions(small_library: Library) -> None:
    """Plans go on from what was shown to what comes, without a step of the root."""
    network = StandIn()
    frames, _ = walk(small_library, network)
    assert network.asked
    assert not fallbacks(frames)
    for plans in network.asked:
        assert plans.frames == PAST_FRAMES + GUIDED_FRAMES
        steps = np.linalg.norm(np.diff(plans.root, axis=1), axis=-1)
        assert steps.max() < 0.1
        seam = np.linalg.norm(plans.toes[:, PAST_FRAMES] - plans.toes[:, PAST_FRAMES - 1], axis=-1)
        assert seam.max() < 0.12


def test_what_it_says_moves_feet_and_no_sent_frame(small_library: Library) -> None:
    """Frames are alike up to the first guided one; later ones differ; none jumps."""
    (still, _), (moved, _) = (walk(small_library, StandIn(offset=o)) for o in (0.0, 0.15))
    differs = [
        not np.array_equal(a.rotations, b.rotations) for a, b in zip(still, moved, strict=True)
    ]
    assert any(differs)
    assert np.isfinite([frame.rotations for frame in moved]).all()
    turns = np.abs(np.diff([frame.rotations for frame in moved], axis=0)).max()
    assert turns < 0.5


@pytest.mark.parametrize(
    ("network", "dt", "why"),
    [
        (StandIn(distance=3.0), 1 / 60, FallbackReason.UNLIKE_TRAINING),
        (StandIn(), 1 / 30, FallbackReason.OTHER_RATE),
    ],
)
def test_who_cannot_be_refined_falls_back(
    small_library: Library, network: StandIn, dt: float, why: FallbackReason
) -> None:
    """Stitched by stance, flagged in the frames, and the reason is kept."""
    frames, _ = walk(small_library, network, dt=dt)
    assert fallbacks(frames)
    told = {jump.fallback for jump in transitions(frames)}
    assert why in told
    assert told <= {why, None, FallbackReason.TOO_FEW_FRAMES}
    plain, _ = walk(small_library, network, dt=dt, stitcher="stance")
    np.testing.assert_allclose(frames[-1].rotations, plain[-1].rotations, atol=1e-5)


def test_a_tick_refines_no_more_than_it_may(small_library: Library) -> None:
    """All jump at once: so many are refined, the others flagged."""
    network = StandIn()
    most = TickSettings().most_refined
    frames, _ = walk(small_library, network, count=2 * most, seconds=1.0)
    assert max(len(plans) for plans in network.asked) == most
    assert max(len(frame.flagged(FrameFlag.FALLBACK)) for frame in frames) == most


def test_a_transition_tells_how_long_the_one_before_was_refined(small_library: Library) -> None:
    """As many frames as passed, at most 52; after the beginning none."""
    frames, _ = walk(small_library, StandIn(), count=1)
    jumps = transitions(frames)
    first, *later = jumps
    assert first.refined_frames == 0
    apart = np.diff([jump.frame for jump in jumps])
    assert later
    assert [j.refined_frames for j in later] == np.minimum(apart, GUIDED_FRAMES).tolist()


def test_an_absent_network_is_told(small_library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a network, transitions say so."""
    monkeypatch.setattr("stridewire_engine.runtime.tick.refiner_if_shipped", lambda: None)
    runtime = Runtime([small_library], clock=lambda: 0.0)
    session = runtime.open(
        Open([CharacterSpec(0, stitcher="refine")], seed=5, detail=Detail.EVENTS)
    )
    frames = []
    for i in range(120):
        step = Step(i, 1 / 60, velocity_xz=np.array([[0.0, 1.4 if i < 60 else -1.4]]))
        ((frame, _),) = runtime.advance([(session, step)])
        frames.append(frame)
    assert {jump.fallback for jump in transitions(frames)} == {FallbackReason.NO_NETWORK}


def test_labels_hold_and_swings_are_led_half_way(small_library: Library) -> None:
    """What the network says of a clip on its own path is followed in part."""
    network = StandIn(offset=0.2)
    walk(small_library, network, count=1, seconds=1.0)
    plans = network.asked[0]
    said = network.refine(plans)
    told = followed(plans, said._replace(planted=np.zeros(said.planted.shape)))
    np.testing.assert_array_equal(told.planted, plans.contacts)
    np.testing.assert_allclose(told.toe_offset, 0.5 * said.toe_offset)


@pytest.mark.parametrize("what", ["missing", "altered"])
def test_a_bad_network_is_told_at_the_start(
    small_library: Library, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    """Not at the first transition: no runtime begins, and the file is named."""
    shipped = Path(str(onnx_model.files(onnx_model.WEIGHTS)))
    (tmp_path / onnx_model.SUMS).write_bytes((shipped / onnx_model.SUMS).read_bytes())
    if what == "altered":
        (tmp_path / "rmr.onnx").write_bytes((shipped / "rmr.onnx").read_bytes() + b" ")
    monkeypatch.setattr(onnx_model, "files", lambda package: tmp_path)
    shipped_refiner.cache_clear()
    try:
        with pytest.raises(ModelError, match=r"rmr\.onnx"):
            Runtime([small_library])
    finally:
        shipped_refiner.cache_clear()
