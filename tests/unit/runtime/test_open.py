"""Opening a session: every limit is an error of its field, and on the limit all is well."""

from dataclasses import replace

import numpy as np
import pytest

from stridewire._errors import InvalidRequestError, NotFoundError, NotImplementedYetError
from stridewire._messages import (
    CharacterSpec,
    GroundPose,
    Step,
)
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.matching.presets import LOCOMOTION
from stridewire_engine.runtime import Runtime
from unit.runtime.conftest import one, opening

NAN = float("nan")
CHANNELS = [channel.name for channel in LOCOMOTION.channels]


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"characters": []}, "open.characters"),
        ({"characters": [CharacterSpec(i) for i in range(4097)]}, "open.characters"),
        ({"characters": [CharacterSpec(1), CharacterSpec(1)]}, "open.characters[1].id"),
        ({"characters": [CharacterSpec(-1)]}, "open.characters[0].id"),
        ({"characters": [CharacterSpec(2**32)]}, "open.characters[0].id"),
        (
            {"characters": [CharacterSpec(1, GroundPose((NAN, 0, 0)))]},
            "open.characters[0].root.position.x",
        ),
        (
            {"characters": [CharacterSpec(1, GroundPose((0, 0, 1.1e6)))]},
            "open.characters[0].root.position.z",
        ),
        ({"characters": [CharacterSpec(1, GroundPose(yaw=NAN))]}, "open.characters[0].root.yaw"),
        ({"characters": [CharacterSpec(1, stitcher="glue")]}, "open.characters[0].stitcher"),
        ({"characters": [CharacterSpec(1, rate_divider=16)]}, "open.characters[0].rate_divider"),
        ({"rate_hz": 9.9}, "open.rate_hz"),
        ({"rate_hz": 240.1}, "open.rate_hz"),
        ({"rate_hz": NAN}, "open.rate_hz"),
        ({"max_frames_in_flight": 3601}, "open.max_frames_in_flight"),
        ({"max_frames_in_flight": -1}, "open.max_frames_in_flight"),
        ({"seed": -1}, "open.seed"),
        ({"characters": [CharacterSpec(1, filter="wlk")]}, "open.characters[0].filter"),
        ({"characters": [CharacterSpec(1, filter="walk & idle")]}, "open.characters[0].filter"),
        ({"characters": [CharacterSpec(1, weights={"a": 1})]}, "open.characters[0].weights['a']"),
        (
            {"characters": [CharacterSpec(1, weights={"foot-position": NAN})]},
            "open.characters[0].weights['foot-position']",
        ),
        (
            {"characters": [CharacterSpec(1, weights={"foot-position": -0.1})]},
            "open.characters[0].weights['foot-position']",
        ),
        (
            {"characters": [CharacterSpec(1, weights=dict.fromkeys(CHANNELS, 0.0))]},
            "open.characters[0].weights",
        ),
    ],
)
def test_a_bad_open_is_refused_naming_the_field(
    runtime: Runtime, changes: dict, field: str
) -> None:
    """Each limit of Open is an error with its path, and nothing is left of the session."""
    with pytest.raises(InvalidRequestError) as caught:
        runtime.open(opening(1, **changes))
    assert field in [violation.field for violation in caught.value.violations]
    assert runtime.info().characters == 0


@pytest.mark.parametrize(
    "changes",
    [
        {"characters": [CharacterSpec(2**32 - 1, GroundPose((1e6, 0, -1e6), -700.0))]},
        {"characters": [CharacterSpec(i) for i in range(4096)]},
        {"characters": [CharacterSpec(1, rate_divider=15)]},
        {"rate_hz": 10.0},
        {"rate_hz": 240.0},
        {"max_frames_in_flight": 0},
        {"max_frames_in_flight": 3600},
    ],
)
def test_limits_themselves_are_allowed(runtime: Runtime, changes: dict) -> None:
    """A value on the limit is good."""
    session = runtime.open(opening(1, **changes))
    assert len(session) >= 1


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"resume_token": "x"}, "open.resume_token"),
    ],
)
def test_fields_of_later_versions_are_refused_by_name(
    runtime: Runtime, changes: dict, field: str
) -> None:
    """What is not there yet is said to be so, and which field it is."""
    with pytest.raises(NotImplementedYetError, match="not implemented yet") as caught:
        runtime.open(opening(1, **changes))
    assert [violation.field for violation in caught.value.violations] == [field]


def test_an_unknown_library_is_not_found(runtime: Runtime) -> None:
    """The error names the libraries that are open."""
    with pytest.raises(NotFoundError, match="small"):
        runtime.open(opening(1, library="large"))


def test_two_libraries_need_two_names(small_library: Library) -> None:
    """A runtime does not guess which of two equal names is meant, and needs one library."""
    with pytest.raises(LibraryError, match="two libraries"):
        Runtime([small_library, small_library])
    with pytest.raises(LibraryError, match="at least one"):
        Runtime([])


def test_places_and_sizes_count_as_they_come_over_the_wire(runtime: Runtime) -> None:
    """A rig, a height and a root, and the float32 of them that a wire carries: the same poses."""
    given = REFERENCE.scaled(0.9)
    sent = replace(given, offsets=given.offsets.astype(np.float32))
    frames = []
    for rig, kind in ((given, float), (sent, np.float32)):
        root = GroundPose((float(kind(49.3)), float(kind(0.4619)), 0.0), float(kind(4.1)))
        spec = CharacterSpec(1, root, float(kind(1.2)))
        session = runtime.open(opening(1, characters=[spec], output_skeleton=rig))
        frames.append([one(runtime, session, Step(i + 1, 1 / 60))[0] for i in range(4)])
    for a, b in zip(*frames, strict=True):
        np.testing.assert_array_equal(a.rotations, b.rotations)
        np.testing.assert_array_equal(a.root, b.root)
