"""What is odd about real captures, file by file: each is read, and imported or refused, rightly."""

import csv
from pathlib import Path

import numpy as np
import pytest

from stridewire.formats.acclaim import read_acclaim
from stridewire.formats.bvh import read_bvh
from stridewire.formats.reading import read_motion
from stridewire.formats.source_motion import FormatError
from stridewire.motion import kinematics
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.importing import Outcome, import_file
from stridewire_engine.building.onto_reference import find_profile
from stridewire_engine.building.profiles import shipped_profiles
from stridewire_engine.building.retarget import NotHumanError
from stridewire_engine.rigs.joint_mapping import MappingError

WALK = "lafan1/clips/walk1_subject1_long.bvh"


def imported(path: Path) -> Clip:
    """Import a file that must not be refused."""
    clip = import_file(path).clip
    assert clip is not None
    return clip


def said(outcome: Outcome) -> str:
    """Return the notes on a file as one text."""
    return "; ".join(outcome.notes)


def head_height(clip: Clip) -> float:
    """Return the median height of the head; metres."""
    positions, _ = kinematics.forward_world(REFERENCE, clip.pose)
    return float(np.median(positions[:, REFERENCE.index("Head"), 1]))


class TestLafan1:
    """Bones along +X, absolute roots, one skeleton."""

    def test_zero_angles_are_no_standing_pose_and_yet_it_stands(self, capture: Path) -> None:
        """The profile's axes stand the figure up."""
        source = read_bvh(capture / WALK)
        offsets = source.skeleton.offsets[source.skeleton.indices(["LeftLeg", "LeftFoot"])]
        assert (np.abs(offsets[:, 1:]) < 0.01 * offsets[:, :1]).all()
        assert find_profile(source, shipped_profiles()).name == "lafan1"
        assert 1.4 < head_height(imported(capture / WALK)) < 1.7

    def test_root_offsets_differ_and_are_not_added(self, capture: Path) -> None:
        """The offset repeats the first frame's position; the rest of the skeleton is the same."""
        a, b = (
            read_bvh(capture / "lafan1" / name)
            for name in ("push1_subject2.bvh", "dance1_subject1.bvh")
        )
        assert not np.allclose(a.skeleton.offsets[0], b.skeleton.offsets[0])
        np.testing.assert_allclose(a.skeleton.offsets[1:], b.skeleton.offsets[1:], atol=1e-4)
        np.testing.assert_allclose(a.root_positions[0], a.skeleton.offsets[0], atol=0.01)

    def test_more_rows_than_announced_are_read(self, capture: Path) -> None:
        """`walk1_subject1_long` says 5,700 frames and holds 5,707."""
        source = read_bvh(capture / WALK)
        assert len(source) == 5707
        assert source.notes == ("says 5700 frames and holds 5707",)

    def test_thirty_frames_become_sixty(self, capture: Path) -> None:
        """The clip lasts as long as the file."""
        clip = imported(capture / WALK)
        assert clip.frame_rate == 60.0
        assert clip.seconds == pytest.approx(5706 / 30.0, abs=0.02)

    def test_feet_stand_flat_and_on_the_ground(self, capture: Path) -> None:
        """Planted ankles lie at their height at rest, and so do planted toes."""
        clip = imported(capture / WALK)
        positions, _ = kinematics.forward_world(REFERENCE, clip.pose)
        for joint, height in ((3, 0.07), (4, 0.02), (7, 0.07), (8, 0.02)):
            column = [3, 4, 7, 8].index(joint)
            planted = positions[clip.contacts[:, column], joint, 1]
            assert np.median(planted) == pytest.approx(height, abs=0.01)

    def test_a_walk_plants_its_feet_about_half_of_the_time(self, capture: Path) -> None:
        """Contact shares and tags are a walk's."""
        clip = imported(capture / "lafan1/clips/walk2_subject1_walk2.bvh")
        assert (clip.contacts.mean(axis=0) > 0.4).all()
        assert (clip.contacts.mean(axis=0) < 0.75).all()
        assert "walk" in {tag.name for tag in clip.tags}


class TestCmu:
    """Units, rates, rest poses, axis frames."""

    @pytest.mark.parametrize("file", ["cmu/02/02_01.amc", "cmu/07/07_04.bvh", "cmu/10/10_01.bvh"])
    def test_every_unit_comes_out_in_metres(self, capture: Path, file: str) -> None:
        """Acclaim's unit, the same in BVH, and centimetres."""
        assert 1.4 < head_height(imported(capture / file)) < 1.7

    def test_the_unit_of_asf_is_known(self, capture: Path) -> None:
        """1 unit = 1/0.45 inch."""
        source = read_acclaim(capture / "cmu/02/02_01.amc")
        assert source.metres_per_unit == pytest.approx(0.0564, abs=1e-4)

    def test_amc_rates_come_from_the_index(self, capture: Path) -> None:
        """`cmu` is 120 and `cmu-more` 60 frames/s; the files say nothing."""
        assert read_acclaim(capture / "cmu/02/02_01.amc").frame_rate is None
        fast = imported(capture / "cmu/02/02_01.amc")
        slow = imported(capture / "cmu-more/01/01_01.amc")
        assert fast.seconds == pytest.approx(342 / 120.0, abs=0.02)
        assert slow.seconds == pytest.approx(1375 / 60.0, abs=0.02)

    def test_wrong_frame_times_are_corrected_by_the_index(self, capture: Path) -> None:
        """Ten BVH say 120 or 15 frames/s and are 60."""
        with (capture / "cmu/index.csv").open(newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["file"].endswith(".bvh")]
        wrong = [
            row["file"]
            for row in rows
            if row["fps"] == "60" and row["subject"] in ("46", "60", "61", "69", "83")
        ]
        assert len(wrong) == 10
        outcome = import_file(capture / "cmu" / wrong[0])
        assert "its index 60, which holds" in said(outcome)

    def test_first_frames_in_a_rest_pose_are_cut(self, capture: Path) -> None:
        """All whole BVH begin with one; the fragments have none."""
        for file in ("07/07_04.bvh", "06/06_04.bvh", "60/60_01.bvh", "94/94_indian07.bvh"):
            assert "before the motion begins were cut" in said(import_file(capture / "cmu" / file))
        fragment = next(iter(sorted((capture / "cmu/fragments").glob("*.bvh"))))
        assert "were cut" not in said(import_file(fragment))

    def test_zero_length_bones_and_hip_joints_are_passed_over(self, capture: Path) -> None:
        """`LHipJoint` is neither hip nor leg."""
        source = read_bvh(capture / "cmu/07/07_04.bvh")
        profile = find_profile(source, shipped_profiles())
        assert profile.name == "cmu-motionbuilder"
        assert profile.joints["LeftUpLeg"] == "LeftUpLeg"

    def test_poser_orders_are_read_joint_by_joint(self, capture: Path) -> None:
        """The root turns in another order than its joints, and the figure stands."""
        text = (capture / "cmu/10/10_01.bvh").read_text()
        orders = {" ".join(line.split()[-3:]) for line in text.split("\n") if "CHANNELS" in line}
        assert len(orders) > 1
        assert 1.4 < head_height(imported(capture / "cmu/10/10_01.bvh")) < 1.7

    def test_missing_bones_rest(self, capture: Path) -> None:
        """`07_02.amc` has 56 values a frame, others 62."""
        source = read_acclaim(capture / "cmu/07/07_02.amc")
        assert source.notes == ("bones without values rest: lthumb, rthumb, lfingers, rfingers",)

    def test_flipped_joints_are_mended(self, capture: Path) -> None:
        """A thigh of `05_05` turns by 180 degrees for two frames."""
        outcome = import_file(capture / "cmu/05/05_05.amc")
        assert "with spikes were mended" in said(outcome)
        assert outcome.clip is not None
        thigh = outcome.clip.pose.rotations[166:172, REFERENCE.index("RightUpLeg")]
        dots = np.abs(np.sum(thigh[1:] * thigh[:-1], axis=-1))
        assert np.rad2deg(2.0 * np.arccos(np.minimum(dots.min(), 1.0))) < 15.0
        assert "jump(s) of a joint by more than 90 degrees are left" in said(outcome)

    def test_every_line_end_reads(self, capture: Path) -> None:
        """LF, CRLF and a mix with lone CR are among the files."""
        kinds = set()
        for path in sorted((capture / "cmu").glob("*/*.amc"))[::5]:
            raw = path.read_bytes()[:4000]
            kind = "mix" if b"\r\r\n" in raw else "crlf" if b"\r\n" in raw else "lf"
            if kind not in kinds:
                kinds.add(kind)
                assert len(read_acclaim(path)) > 10
        assert len(kinds) >= 2

    def test_the_couple_has_equal_lengths(self, capture: Path) -> None:
        """Subjects 60 and 61, trial for trial."""
        for trial in ("01", "02"):
            a, b = (read_bvh(capture / f"cmu/{s}/{s}_{trial}.bvh") for s in ("60", "61"))
            assert len(a) == len(b)


class TestExporters:
    """Channels, orders, rates, names, units and figures of many exporters."""

    @pytest.mark.parametrize(
        "file",
        [
            *("brekel_kinect_6ch_49j", "jackson_6ch_29fps_49j", "walkcycle_6ch_24fps_19j"),
            *("happy_6ch_24fps_42j", "ue4_run_6ch_26j", "mblab_run_6ch_60j", "mblab_walk_6ch_60j"),
            *("xbmotion_90fps_6ch_50j", "mixamo_walk_blender_65j", "blender_6ch_children_31j"),
        ],
    )
    def test_positions_on_joints(self, capture: Path, file: str) -> None:
        """Six channels on all joints or on some: bones keep their lengths, and it imports."""
        path = capture / f"exporters/odd/{file}.bvh"
        source = read_bvh(path)
        assert source.translations is not None
        lengths = np.linalg.norm(np.median(source.translations, axis=0)[1:], axis=-1)
        rest = np.linalg.norm(source.skeleton.offsets[1:], axis=-1)
        assert np.median(np.abs(lengths - rest)) < 0.05 * rest.max()
        assert len(imported(path)) > 10

    def test_rotation_before_position(self, capture: Path) -> None:
        """The root's position is found wherever it stands in the row."""
        source = read_bvh(capture / "exporters/odd/fixture_rotation_first_root.bvh")
        assert np.ptp(source.root_positions, axis=0).max() > 0.0

    @pytest.mark.parametrize(
        "file", ["zup_run_120fps_25j", "zup_idle_pelvis_21j", "walk_pelvis_root_at_origin_21j"]
    )
    def test_z_up(self, capture: Path, file: str) -> None:
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
            ("brekel_kinect_6ch_49j", 30.0),
            ("atest_40fps_yxz_23j", 40.0),
            ("mixamo_jog_circle_25j", 60.0),
            ("custom_72fps_78j", 72.0),
            ("xbmotion_90fps_6ch_50j", 90.0),
            ("accad_swagger_120fps_22j", 120.0),
        ],
    )
    def test_rates(self, capture: Path, file: str, rate: float) -> None:
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
    def test_profiles_are_found(self, capture: Path, file: str, profile: str) -> None:
        """Prefixes, orders and finger joints do not hide the family."""
        outcome = import_file(capture / f"exporters/odd/{file}.bvh")
        assert outcome.profile == profile
        assert outcome.clip is not None
        assert 0.6 < head_height(outcome.clip) < 1.8

    @pytest.mark.parametrize("file", ["classic_destroy_18j", "movingstories_8walk_xyz_23j"])
    def test_inches_come_out_in_metres(self, capture: Path, file: str) -> None:
        """Units follow from the legs."""
        assert 1.2 < head_height(imported(capture / f"exporters/odd/{file}.bvh")) < 1.7

    def test_no_hierarchy_is_refused(self, capture: Path) -> None:
        """A file that begins with MOTION is no BVH."""
        with pytest.raises(FormatError, match="names no joint"):
            read_motion(capture / "exporters/odd/broken_no_hierarchy.bvh")

    def test_one_chain_is_refused(self, capture: Path) -> None:
        """An arm alone is read as a motion and refused as a human."""
        source = read_bvh(capture / "exporters/odd/blender_arm_6j.bvh")
        with pytest.raises(MappingError, match="foot or ankle"):
            find_profile(source, shipped_profiles())

    def test_two_frames_are_refused(self, capture: Path) -> None:
        """A stance is no motion."""
        with pytest.raises(ValueError, match=r"2 frames .* expected at least 0\.25 s"):
            import_file(capture / "exporters/odd/geno_stance_6ch_75j.bvh")

    def test_the_dog_is_refused_and_kept_readable(self, capture: Path) -> None:
        """Four legs with a human's names are told by their proportions."""
        path = sorted((capture / "exporters/quadruped").glob("*.bvh"))[0]
        assert len(read_bvh(path).skeleton) == 21
        with pytest.raises(NotHumanError, match="no human: the arms measure"):
            import_file(path)

    @pytest.mark.parametrize("file", ["accad_swagger_120fps_22j", "cyprus_dance_andria_happy_24j"])
    def test_angles_that_wrap_do_not_jump(self, capture: Path, file: str) -> None:
        """A turn through 180 degrees of an Euler angle is no turn of the joint."""
        rotations = imported(capture / f"exporters/odd/{file}.bvh").pose.rotations
        assert np.sum(rotations[1:] * rotations[:-1], axis=-1).min() > 0.7
