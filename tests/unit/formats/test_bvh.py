"""Reading BVH: what a file says arrives, what cannot be read is refused with file and line."""

from pathlib import Path

import numpy as np
import pytest

from stridewire.formats.bvh import read_bvh
from stridewire.formats.source_motion import FormatError
from stridewire.motion import quaternion

HIERARCHY = """HIERARCHY
ROOT Hips
{
\tOFFSET 1 2 3
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
\tJOINT Knee
\t{
\t\tOFFSET 0 -4 0
\t\tCHANNELS 3 Yrotation Xrotation Zrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 -5 0
\t\t}
\t}
}
"""
ROWS = ("10 20 30 0 0 90 0 0 0", "11 20 30 0 0 90 30 0 90")


def bvh(rows: tuple[str, ...] = ROWS, frames: int = 2, time: str = "0.0333333") -> str:
    """Return the text of a small file."""
    return "\n".join([HIERARCHY + "MOTION", f"Frames: {frames}", f"Frame Time: {time}", *rows, ""])


def write(folder: Path, text: str | bytes) -> Path:
    """Write a file and return its path."""
    path = folder / "motion.bvh"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_skeleton_and_frames_arrive(tmp_path: Path) -> None:
    """Names, rate, root, offsets and end sites are those of the file."""
    motion = read_bvh(write(tmp_path, bvh()))
    assert motion.skeleton.names == ("Hips", "Knee")
    assert motion.frame_rate == 30.0
    np.testing.assert_allclose(motion.root_positions, [[10, 20, 30], [11, 20, 30]])
    np.testing.assert_allclose(motion.skeleton.offsets[1], [0, -4, 0])
    np.testing.assert_allclose(motion.tips[1], [0, -5, 0])
    assert motion.notes == ()


def test_the_root_offset_is_not_added(tmp_path: Path) -> None:
    """The root's position channels are absolute."""
    motion = read_bvh(write(tmp_path, bvh()))
    positions, _ = motion.global_poses()
    np.testing.assert_allclose(positions[0, 0], [10, 20, 30])


def test_each_joint_turns_in_its_own_order(tmp_path: Path) -> None:
    """The order of the channels is read joint by joint."""
    motion = read_bvh(write(tmp_path, bvh()))
    angles = np.deg2rad([30.0, 0.0, 90.0])
    np.testing.assert_allclose(
        motion.rotations[1, 1], quaternion.from_euler(angles, "yxz"), atol=1e-12
    )


@pytest.mark.parametrize("ending", [b"\r\n", b"\r", b"\r\r\n"])
def test_line_ends_do_not_matter(tmp_path: Path, ending: bytes) -> None:
    """CRLF, lone CR and a mix read like LF."""
    motion = read_bvh(write(tmp_path, bvh().encode().replace(b"\n", ending)))
    assert len(motion) == 2
    assert motion.notes == ()


def test_a_wrong_number_of_frames_is_noted(tmp_path: Path) -> None:
    """The rows count, not what the header says."""
    motion = read_bvh(write(tmp_path, bvh(frames=5)))
    assert len(motion) == 2
    assert motion.notes == ("says 5 frames and holds 2",)


def test_a_last_row_cut_short_is_left_out(tmp_path: Path) -> None:
    """A file cut short is read up to its last whole frame."""
    motion = read_bvh(write(tmp_path, bvh((*ROWS, "1 2 3"))))
    assert len(motion) == 2
    assert "cut short" in motion.notes[0]


def test_positions_of_any_joint_replace_its_offset(tmp_path: Path) -> None:
    """Six channels on a child place it."""
    text = bvh(("0 0 0 0 0 0 0 -7 0 0 0 0",), 1).replace(
        "CHANNELS 3 Y", "CHANNELS 6 Xposition Yposition Zposition Y"
    )
    motion = read_bvh(write(tmp_path, text))
    positions, _ = motion.global_poses()
    np.testing.assert_allclose(positions[0, 1], [0, -7, 0])


def test_rotation_before_position_in_the_root(tmp_path: Path) -> None:
    """Channels may come in any order."""
    text = bvh(("90 0 0 1 2 3 0 0 0",), 1).replace(
        "Xposition Yposition Zposition Zrotation Yrotation Xrotation",
        "Zrotation Yrotation Xrotation Xposition Yposition Zposition",
    )
    motion = read_bvh(write(tmp_path, text))
    np.testing.assert_allclose(motion.root_positions, [[1, 2, 3]])
    np.testing.assert_allclose(motion.rotations[0, 0], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)])


def test_joints_of_one_name_are_told_apart(tmp_path: Path) -> None:
    """A repeated name gets a number."""
    motion = read_bvh(write(tmp_path, bvh().replace("JOINT Knee", "JOINT Hips")))
    assert motion.skeleton.names == ("Hips", "Hips_2")


@pytest.mark.parametrize(
    ("change", "line", "says"),
    [
        (("HIERARCHY\nROOT Hips", "HIERARCHY\nROOM Hips"), 2, "no BVH statement"),
        (("OFFSET 0 -4 0", "OFFSET 0 -4"), 8, "three numbers"),
        (("OFFSET 0 -4 0", "OFFSET 0 nan 0"), 8, "three numbers"),
        (("CHANNELS 3", "CHANNELS 4"), 9, "CHANNELS"),
        (("Yrotation Xrotation Zrotation", "Yrotation Yrotation Zrotation"), 9, "twice"),
        (("Yrotation Xrotation Zrotation", "Yrotation Wrotation Zrotation"), 9, "CHANNELS"),
        (("Frame Time: 0.0333333", "Frame Time: 0"), 18, "seconds"),
        (("30 0 90\n", "30 0 9o\n"), 20, "no number"),
        (("11 20", "11,5 20"), 20, "decimal comma"),
        (("10 20 30 0 0 90", "10 20 30 0 0"), 19, "8 values; expected 9"),
    ],
)
def test_a_fault_is_named_with_its_line(
    tmp_path: Path, change: tuple[str, str], line: int, says: str
) -> None:
    """An error names file, line and fault."""
    path = write(tmp_path, bvh().replace(*change))
    with pytest.raises(FormatError, match=says) as caught:
        read_bvh(path)
    assert str(caught.value).startswith(f"{path}, line {line}: ")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no MOTION"),
        ("MOTION\nFrames: 1\nFrame Time: 0.1\n1 2 3\n", "names no joint"),
        (bvh().replace("}\n}\n", "}\n"), "within a joint"),
        (bvh(()), "no whole frame"),
        (bvh(("nan 20 30 0 0 90 0 0 0",)), "frame 1, channel 1 is nan"),
        (bvh(("1e300 20 30 0 0 90 0 0 0",)), "expected a number"),
        (HIERARCHY + "MOTION\n", "Frame Time"),
        (HIERARCHY.replace("}\n}\n", "}\n}\nROOT Other\n{\n") + "MOTION\n", "second ROOT"),
        ("\0" * 100, "zero bytes"),
    ],
)
def test_what_is_no_motion_is_refused(tmp_path: Path, text: str, says: str) -> None:
    """What is no BVH or holds no finite motion raises FormatError."""
    path = write(tmp_path, text)
    with pytest.raises(FormatError, match=says) as caught:
        read_bvh(path)
    assert str(path) in str(caught.value)
