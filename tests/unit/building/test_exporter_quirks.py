"""What is odd about files of many exporters: each is read, and imported or refused, rightly."""

from pathlib import Path

import numpy as np
import pytest
from tests.unit.building.capture_clips import head_height, imported

from stridewire.formats.bvh import read_bvh
from stridewire.formats.reading import read_motion
from stridewire.formats.source_motion import FormatError
from stridewire_engine.building.importing import import_file
from stridewire_engine.building.onto_reference import find_profile
from stridewire_engine.building.profiles import shipped_profiles
from stridewire_engine.building.retarget import NotHumanError
from stridewire_engine.rigs.joint_mapping import MappingError


@pytest.mark.parametrize(
    "file",
    [
        *("brekel_kinect_6ch_49j", "jackson_6ch_29fps_49j", "walkcycle_6ch_24fps_19j"),
        *("happy_6ch_24fps_42j", "ue4_run_6ch_26j", "mblab_run_6ch_60j", "mblab_walk_6ch_60j"),
        *("xbmotion_90fps_6ch_50j", "mixamo_walk_blender_65j", "blender_6ch_children_31j"),
    ],
)
def test_positions_on_joints(capture: Path, file: str) -> None:
    """Six channels on all joints or on some: bones keep their lengths, and it imports."""
    path = capture / f"exporters/odd/{file}.bvh"
    source = read_bvh(path)
    assert source.translations is not None
    lengths = np.linalg.norm(np.median(source.translations, axis=0)[1:], axis=-1)
    rest = np.linalg.norm(source.skeleton.offsets[1:], axis=-1)
    assert np.median(np.abs(lengths - rest)) < 0.05 * rest.max()
    assert len(imported(path)) > 10


def test_rotation_before_position(capture: Path) -> None:
    """The root's position is found wherever it stands in the row."""
    source = read_bvh(capture / "exporters/odd/fixture_rotation_first_root.bvh")
    assert np.ptp(source.root_positions, axis=0).max() > 0.0


@pytest.mark.parametrize(
    "file", ["zup_run_120fps_25j", "zup_idle_pelvis_21j", "walk_pelvis_root_at_origin_21j"]
)
def test_z_up(capture: Path, file: str) -> None:
    """Z up is found, said, and turned."""
    outcome = import_file(capture / f"exporters/odd/{file}.bvh")
    assert outcome.clip is not None
    assert "Z is up" in outcome.notes
    assert 1.35 < head_height(outcome.clip) < 1.8


@pytest.mark.parametrize(
    ("file", "rate"),
    [
        ("fixture_full_precision_frame_time", 24000 / 1001),
        ("kinect_sprint_24fps_18j", 24.0),
        ("fixture_rotation_first_root", 25.0),
        ("jackson_6ch_29fps_49j", 29.0),
        ("walk_pelvis_root_at_origin_21j", 29.97),
        ("brekel_kinect_6ch_49j", 30.0),
        ("atest_40fps_yxz_23j", 40.0),
        ("mixamo_jog_circle_25j", 60.0),
        ("custom_72fps_78j", 72.0),
        ("xbmotion_90fps_6ch_50j", 90.0),
        ("accad_swagger_120fps_22j", 120.0),
    ],
)
def test_rates(capture: Path, file: str, rate: float) -> None:
    """The rate that is meant is read."""
    source = read_bvh(capture / f"exporters/odd/{file}.bvh")
    assert source.frame_rate == pytest.approx(rate, rel=1e-4)


@pytest.mark.parametrize(
    ("file", "profile"),
    [
        ("freebvh_mixamorig_55j", "mixamo"),
        ("mixamo_walk_circle_65j", "mixamo"),
        ("mixamo_jog_circle_25j", "mixamo"),
        ("motionbuilder_character1_walk_37j", "humanik-two-spines"),
        ("custom_72fps_78j", "kinematic-jnt"),
        ("cyprus_dance_andria_happy_24j", "humanik-five-spines"),
        ("pirouette_poser_43j", "poser"),
        ("dancing41_xzy_19j", "poser"),
        ("xia_old_13_000_31j", "cmu-motionbuilder"),
        ("pybvh_hands_60j", "humanik-four-spines-forefoot"),
    ],
)
def test_profiles_are_found(capture: Path, file: str, profile: str) -> None:
    """Prefixes, orders and finger joints do not hide the family."""
    outcome = import_file(capture / f"exporters/odd/{file}.bvh")
    assert outcome.profile == profile
    assert outcome.clip is not None
    assert 0.6 < head_height(outcome.clip) < 1.8


@pytest.mark.parametrize(
    ("file", "unit"),
    [
        ("classic_destroy_18j", "inch"),
        ("kinect_sprint_24fps_18j", "inch"),
        ("movingstories_8walk_xyz_23j", "inch"),
        ("xia_neutral_01_000_31j", "cmu"),
        ("walk_pelvis_root_at_origin_21j", "m"),
        ("zup_idle_pelvis_21j", "inch"),
        ("mixamo_jog_circle_25j", "cm"),
    ],
)
def test_units(capture: Path, file: str, unit: str) -> None:
    """The unit in which the hips stand as high as a human's is found, and gives metres."""
    outcome = import_file(capture / f"exporters/odd/{file}.bvh")
    assert outcome.unit == unit
    assert outcome.clip is not None
    assert 1.2 < head_height(outcome.clip) < 1.75


@pytest.mark.parametrize(
    ("file", "orders"),
    [
        ("xia_old_13_000_31j", {"ZYX"}),
        ("movingstories_8walk_xyz_23j", {"XYZ"}),
        ("atest_40fps_yxz_23j", {"YXZ"}),
        ("dancing41_xzy_19j", {"XYZ", "XZY", "YZX", "ZYX"}),
    ],
)
def test_orders(capture: Path, file: str, orders: set[str]) -> None:
    """Whatever the order of channels, joint by joint, the figure stands."""
    path = capture / f"exporters/odd/{file}.bvh"
    lines = [line.split() for line in path.read_text().splitlines() if "CHANNELS" in line]
    assert {"".join(word[0] for word in line[-3:]) for line in lines} == orders
    assert 1.2 < head_height(imported(path)) < 1.75


def test_no_hierarchy_is_refused(capture: Path) -> None:
    """A file that begins with MOTION is no BVH."""
    with pytest.raises(FormatError, match="names no joint"):
        read_motion(capture / "exporters/odd/broken_no_hierarchy.bvh")


def test_one_chain_is_refused(capture: Path) -> None:
    """An arm alone, or a fixture, is read as a motion and refused as a human."""
    odd = capture / "exporters/odd"
    for path in (odd / "blender_arm_6j.bvh", *odd.glob("fixture_*.bvh")):
        source = read_bvh(path)
        with pytest.raises(MappingError, match="foot or ankle"):
            find_profile(source, shipped_profiles())


def test_two_frames_are_refused(capture: Path) -> None:
    """A stance is no motion."""
    with pytest.raises(ValueError, match=r"2 frames .* expected at least 0\.25 s"):
        import_file(capture / "exporters/odd/geno_stance_6ch_75j.bvh")


def test_the_dog_is_refused_and_kept_readable(capture: Path) -> None:
    """Four legs with a human's names are told by their proportions."""
    path = sorted((capture / "exporters/quadruped").glob("*.bvh"))[0]
    assert len(read_bvh(path).skeleton) == 21
    with pytest.raises(NotHumanError, match="no human: the arms measure"):
        import_file(path)


@pytest.mark.parametrize(
    "file",
    [
        *("accad_swagger_120fps_22j", "cyprus_dance_andria_happy_24j", "happy_6ch_24fps_42j"),
        "xbmotion_90fps_6ch_50j",
    ],
)
def test_angles_that_wrap_do_not_jump(capture: Path, file: str) -> None:
    """A turn through 180 degrees of an Euler angle is no turn of the joint."""
    rotations = imported(capture / f"exporters/odd/{file}.bvh").pose.rotations
    assert np.sum(rotations[1:] * rotations[:-1], axis=-1).min() > 0.7
