"""Reading Acclaim: bones, axis frames, degrees of freedom and units arrive; faults are named."""

from pathlib import Path

import numpy as np
import pytest

from stridewire.formats.acclaim import read_acclaim, read_asf
from stridewire.formats.source_motion import FormatError
from stridewire.motion import quaternion

ASF = """# a leg
:version 1.10
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name thigh
     direction 0 -2 0
     length 7
     axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
     id 2
     name shin
     direction 0 -1 0
     length 6
     axis 90 0 0 XYZ
    dof rz
  end
:hierarchy
  begin
    root thigh
    thigh shin
  end
"""
AMC = """#!OML:ASF somewhere
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 90 0
thigh 10 20 30
shin 40
2
root 1 2 4 0 90 0
thigh 10 20 30
shin 45
"""


def write(folder: Path, asf: str = ASF, amc: str = AMC) -> Path:
    """Write a skeleton and a motion; return the motion's path."""
    (folder / "07.asf").write_text(asf)
    (folder / "07_02.amc").write_text(amc)
    return folder / "07_02.amc"


def test_bones_become_joints_at_their_beginnings(tmp_path: Path) -> None:
    """A bone of length 7 puts its child 7 below; directions need not be unit vectors."""
    motion = read_acclaim(write(tmp_path))
    assert motion.skeleton.names == ("root", "thigh", "shin")
    np.testing.assert_allclose(motion.skeleton.offsets, [[0, 0, 0], [0, 0, 0], [0, -7, 0]])
    np.testing.assert_allclose(motion.tips[2], [0, -6, 0])
    assert motion.frame_rate is None
    assert motion.metres_per_unit == pytest.approx(0.0564444, rel=1e-5)
    np.testing.assert_allclose(motion.root_positions, [[1, 2, 3], [1, 2, 4]])


def test_a_bone_turns_in_its_axis_frame(tmp_path: Path) -> None:
    """The local rotation is C M C^-1, x turned first."""
    motion = read_acclaim(write(tmp_path))

    def about(axis: str, degrees: float) -> np.ndarray:
        return quaternion.from_euler(np.deg2rad([degrees]), axis)

    c = about("z", 20.0)
    m = quaternion.multiply(
        about("z", 30.0), quaternion.multiply(about("y", 20.0), about("x", 10.0))
    )
    expected = quaternion.multiply(quaternion.multiply(c, m), quaternion.conjugate(c))
    np.testing.assert_allclose(motion.rotations[0, 1], expected, atol=1e-12)
    # the shin's z axis lies along -y of the rest pose
    shin = quaternion.from_axis_angle((0.0, -1.0, 0.0), np.deg2rad(np.array(40.0)))
    np.testing.assert_allclose(motion.rotations[0, 2], shin, atol=1e-12)


def test_bones_without_values_rest(tmp_path: Path) -> None:
    """A bone that no frame names keeps its rest pose, and a note says so."""
    without = "\n".join(line for line in AMC.split("\n") if not line.startswith("shin"))
    motion = read_acclaim(write(tmp_path, amc=without))
    np.testing.assert_allclose(motion.rotations[:, 2, 0], 1.0)
    assert motion.notes == ("bones without values rest: shin",)


def test_values_hold_over_frames_that_lack_them(tmp_path: Path) -> None:
    """A bone that one frame does not name keeps its last values there, and a note says so."""
    third = "3\nroot 1 2 5 0 90 0\nthigh 0 0 0\nshin 70\n"
    amc = AMC.replace("shin 45\n", "") + third
    motion = read_acclaim(write(tmp_path, amc=amc))
    whole = read_acclaim(write(tmp_path, amc=AMC.replace("shin 45", "shin 40") + third))
    np.testing.assert_array_equal(motion.rotations, whole.rotations)
    assert motion.notes == ("shin is given in 2 of 3 frames and holds between",)


def test_line_ends_and_case_do_not_matter(tmp_path: Path) -> None:
    """CRLF mixes read like LF."""
    path = write(tmp_path)
    path.write_bytes(AMC.replace("\n", "\r\r\n").encode())
    assert len(read_acclaim(path)) == 2


def test_radians(tmp_path: Path) -> None:
    """`angle rad` is obeyed."""
    degrees = read_acclaim(
        write(tmp_path, ASF.replace("20 XYZ", "0 XYZ").replace("90 0 0", "0 0 0"))
    )
    asf = (
        ASF.replace("angle deg", "angle rad").replace("20 XYZ", "0 XYZ").replace("90 0 0", "0 0 0")
    )
    amc = AMC.replace("shin 40", f"shin {np.deg2rad(40.0)}")
    radians = read_acclaim(write(tmp_path, asf, amc))
    np.testing.assert_allclose(radians.rotations[0, 2], degrees.rotations[0, 2], atol=1e-9)


@pytest.mark.parametrize(
    ("asf", "amc", "says"),
    [
        ((":bonedata", ":bones"), None, "no :bonedata"),
        (("direction 0 -2 0", "direction 0 -2"), None, "direction has 2 values"),
        (("length 7", "length seven"), None, "is no number"),
        (("20 XYZ", "20 XYW"), None, "axis order"),
        (("dof rz", "dof rw"), None, "dof rw"),
        (("thigh shin", "thigh foot"), None, "'foot', which has no bone"),
        (None, ("shin 40", "shin 40 50"), "shin has 2 values; its ASF has 1"),
        (None, ("shin 40", "toe 40"), "'toe': a bone that its ASF lacks"),
        (None, ("shin 40", "shin nan"), "'nan' is no number"),
        (None, ("shin 40", "shin x"), "'x' is no number"),
        (None, ("1\nroot", "root"), "expected a frame number first"),
        (None, ("shin 40", "thigh 1 2 3"), "occurs twice"),
        (None, (AMC, ":DEGREES\n"), "holds no frame"),
    ],
)
def test_faults_are_named(
    tmp_path: Path, asf: tuple[str, str] | None, amc: tuple[str, str] | None, says: str
) -> None:
    """What is wrong in skeleton or motion raises FormatError with the file."""
    path = write(tmp_path, ASF.replace(*asf) if asf else ASF, AMC.replace(*amc) if amc else AMC)
    with pytest.raises(FormatError, match=says) as caught:
        read_acclaim(path)
    assert str(path.parent) in str(caught.value)


def test_the_skeleton_is_looked_for_beside_the_motion(tmp_path: Path) -> None:
    """`07.asf` serves `07_02.amc`; without it the only one does; else the error says what to do."""
    path = write(tmp_path)
    (tmp_path / "08.asf").write_text(ASF)
    assert len(read_acclaim(path)) == 2
    (tmp_path / "07.asf").unlink()
    assert len(read_acclaim(path)) == 2
    (tmp_path / "08.asf").unlink()
    with pytest.raises(FormatError, match=r"0 ASF files beside it, none called 07\.asf"):
        read_acclaim(path)
    assert read_asf(_saved(tmp_path)).skeleton.names[0] == "root"


def _saved(folder: Path) -> Path:
    path = folder / "other.asf"
    path.write_text(ASF)
    return path
