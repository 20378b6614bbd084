"""Presets and schemas of a user's own."""

from pathlib import Path

import numpy as np
import pytest

from stridewire.motion.clip import Clip
from stridewire_engine.building import build_library
from stridewire_engine.building.build import MatchingOptions
from stridewire_engine.library import LibraryError
from stridewire_engine.matching.features import clip_features
from stridewire_engine.matching.gaits import gait_filter
from stridewire_engine.matching.presets import LOCOMOTION, PRESETS, find_schema
from stridewire_engine.matching.schema import Channel, ChannelKind, Schema, SchemaError
from stridewire_engine.matching.search import Matcher

OWN = """
name = "mine"

[[channels]]
name = "head"
kind = "height"
joints = ["Head"]
weight = 0.5

[[channels]]
name = "ahead"
kind = "trajectory-position"
times = [-0.25, 0.5]
"""


@pytest.mark.parametrize(
    ("name", "dimensions"),
    [
        ("locomotion", 27),
        ("locomotion-toe", 27),
        ("locomotion-past", 31),
        ("strafe", 29),
        ("full-body", 39),
    ],
)
def test_presets_build_and_have_their_size(
    swaying_clip: Clip, tmp_path: Path, name: str, dimensions: int
) -> None:
    """Every preset measures what it says and can be searched."""
    schema = find_schema(name)
    library = build_library(
        [swaying_clip], tmp_path / "lib", name="x", matching=MatchingOptions(schema=schema)
    )
    assert library.features.shape[1] == schema.dimensions == dimensions
    assert library.manifest.schema["name"] == name


def test_the_past_lies_behind(swaying_clip: Clip) -> None:
    """A negative time asks where the root was: behind a figure that goes ahead."""
    schema = PRESETS["locomotion-past"]
    channel = schema.channels[3]
    positions = clip_features(schema, swaying_clip)[60, schema.slice(channel)].reshape(-1, 2)
    assert positions[0, 1] < -0.3
    assert positions[1, 1] > 0.3


def test_a_schema_of_a_users_own(tmp_path: Path, swaying_clip: Clip) -> None:
    """A TOML file is a schema; weights default to 1."""
    path = tmp_path / "mine.toml"
    path.write_text(OWN)
    schema = find_schema(str(path))
    assert schema.dimensions == 5
    assert schema.weights.tolist() == [0.5, 1.0]
    assert np.isfinite(clip_features(schema, swaying_clip)).all()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('kind = "height"', 'kind = "smell"', "kinds: position"),
        ('joints = ["Head"]', "", "needs joints"),
        ("weight = 0.5", "weight = -1.0", "allowed are finite"),
        ("weight = 0.5", "wieght = 0.5", "unknown wieght"),
        ("times = [-0.25, 0.5]", "times = [0.0]", "not 0"),
        ("times = [-0.25, 0.5]", "times = [9.0]", "up to 5"),
        ('name = "head"', "", "lacks 'name'"),
        ('name = "ahead"', 'name = "head"', "two channels"),
        ("[[channels]]", "[[canals]]", "lacks 'channels'"),
        ('name = "mine"', "name = ", "cannot be read"),
    ],
)
def test_a_malformed_schema_is_refused_naming_the_fix(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    """Each way a schema file can be wrong is said with its channel."""
    path = tmp_path / "mine.toml"
    path.write_text(OWN.replace(old, new))
    with pytest.raises(SchemaError, match=said):
        find_schema(str(path))


def test_an_unknown_preset_names_those_present() -> None:
    """The error lists the presets; a missing file is said to be so."""
    with pytest.raises(SchemaError, match="full-body"):
        find_schema("loco")
    with pytest.raises(SchemaError, match="cannot be read"):
        find_schema("nowhere.toml")


def test_custom_channels_come_from_the_builder(swaying_clip: Clip, tmp_path: Path) -> None:
    """Numbers of the builder's own are features; without a source or of another size, an error."""
    custom = Channel("height-of-hips", ChannelKind.CUSTOM, 1.0, size=1)
    schema = Schema("own", (*LOCOMOTION.channels, custom))
    source = {"height-of-hips": lambda clip: clip.pose.hips[:, 1:2]}
    matching = MatchingOptions(schema=schema, custom=source)
    library = build_library([swaying_clip], tmp_path / "lib", name="x", matching=matching)
    heights = library.clip("sway").pose.hips[:, 1]
    assert np.corrcoef(library.features[: len(heights), -1], heights)[0, 1] > 0.999
    with pytest.raises(SchemaError, match="no source"):
        clip_features(schema, swaying_clip)
    with pytest.raises(SchemaError, match="expected"):
        clip_features(schema, swaying_clip, {"height-of-hips": lambda clip: clip.pose.hips})


def test_costs_compare_across_libraries_normalised_alike(
    swaying_clip: Clip, tmp_path: Path
) -> None:
    """A library normalised like another one gives a moment the same features."""
    first = build_library([swaying_clip], tmp_path / "a", name="a")
    other = build_library(
        [swaying_clip.cut(0, 100)],
        tmp_path / "b",
        name="b",
        matching=MatchingOptions(normalise_like=first),
    )
    assert np.allclose(other.features[20], first.features[20], atol=1e-5)
    with pytest.raises(SchemaError, match="same channels"):
        build_library(
            [swaying_clip],
            tmp_path / "c",
            name="c",
            matching=MatchingOptions(schema=PRESETS["full-body"], normalise_like=first),
        )


def test_tags_may_be_avoided_or_never_started(swaying_clip: Clip, tmp_path: Path) -> None:
    """A bias is a cost of a row in typical costs; within other tags no search may start."""
    matching = MatchingOptions(bias_by_tag={"turn-left": 2.0}, never_start=("walk",))
    with pytest.raises(LibraryError, match="nothing else may be started"):
        build_library([swaying_clip], tmp_path / "lib", name="x", mirror=False, matching=matching)
    matching = MatchingOptions(bias_by_tag={"turn-left": 2.0}, never_start=("stop",))
    library = build_library(
        [swaying_clip], tmp_path / "lib", name="x", mirror=False, matching=matching
    )
    matcher = Matcher(library)
    assert matcher.bias[20] == pytest.approx(2.0 * matcher.typical_cost)
    assert matcher.bias[50] == 0.0
    with pytest.raises(LibraryError, match="no clip has the tag 'hop'"):
        build_library(
            [swaying_clip],
            tmp_path / "lib",
            name="x",
            matching=MatchingOptions(never_start=("hop",)),
        )


def test_gaits_are_filters() -> None:
    """A gait allows itself and all slower ones that the library has."""
    assert gait_filter("walk", "gait", ("idle", "run", "walk")) == "idle | walk"
    assert gait_filter("run", "gait", ("run", "walk")) == "walk | run"
    assert gait_filter("any", "gait", ()) == ""
