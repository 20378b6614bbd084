"""What is odd about LaFAN1 and CMU, file by file: each is read, and imported, rightly."""

import csv
from pathlib import Path

import numpy as np
import pytest
from tests.unit.building.capture_clips import head_height, imported, said

from stridewire.formats.acclaim import read_acclaim
from stridewire.formats.bvh import read_bvh
from stridewire.motion import kinematics
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.importing import import_file
from stridewire_engine.building.onto_reference import find_profile
from stridewire_engine.building.profiles import shipped_profiles

WALK = "lafan1/clips/walk1_subject1_long.bvh"


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

    @pytest.mark.parametrize(
        "file",
        [
            *("02/02_07.amc", "03/03_03.amc", "05/05_14.amc", "06/06_14.bvh", "07/07_05.amc"),
            *("08/08_01.bvh", "09/09_12.amc", "10/10_04.bvh", "11/11_01.amc", "12/12_03.bvh"),
            *("13/13_30.amc", "14/14_27.amc", "16/16_04.amc", "17/17_03.amc"),
        ],
    )
    def test_early_subjects_come_out_clean(self, capture: Path, file: str) -> None:
        """Subjects below 20 may be of lower quality: what jumps is mended, or said to be left."""
        path = capture / "cmu" / file
        outcome = import_file(path)
        assert outcome.clip is not None
        rotations = outcome.clip.pose.rotations.astype(np.float64)
        dots = np.abs(np.sum(rotations[1:] * rotations[:-1], axis=-1))
        widest = np.rad2deg(2.0 * np.arccos(np.minimum(dots.min(), 1.0)))
        assert widest < 60.0 or "are left" in said(outcome)

    def test_long_trials_are_tagged_action_by_action(self, capture: Path) -> None:
        """`86_09` walks, sits, looks and stands up within 40 s: each has spans of its own."""
        clip = imported(capture / "cmu/86/86_09.amc")
        shares = {
            name: sum(tag.end - tag.start for tag in clip.tags if tag.name == name) / len(clip)
            for name in ("walk", "idle", "low", "sit")
        }
        assert shares["sit"] == 1.0
        for name in ("walk", "low"):
            assert 0.05 < shares[name] < 0.9
        fight = imported(capture / "cmu/86/86_01.amc")
        assert {"jump", "fight", "aloft", "gesture"} <= {tag.name for tag in fight.tags}
