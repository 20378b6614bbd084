"""Converting: rate, units and up axis change what they should and nothing else."""

import sys
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from tests.unit.building.figures import source

from stridewire._errors import StridewireError
from stridewire.commands.convert import convert
from stridewire.formats import retargeting
from stridewire.formats.bvh import read_bvh
from stridewire.formats.bvh_writing import clip_in_centimetres, write_source_bvh
from stridewire.formats.conversion import scaled, turned_up, with_rate
from stridewire.formats.npz import read_npz, write_npz
from stridewire.formats.source_motion import FormatError, SourceMotion
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import REFERENCE


@pytest.fixture
def motion(swaying_clip: Clip) -> SourceMotion:
    """Return a motion in centimetres."""
    return clip_in_centimetres(swaying_clip, Path("sway.bvh"))


def positions(motion: SourceMotion) -> np.ndarray:
    """Return where the joints are."""
    return motion.global_poses()[0]


def test_twice_the_rate_passes_through_the_frames(motion: SourceMotion) -> None:
    """Every second frame of the faster motion is one of the slower."""
    faster = with_rate(motion, 120.0)
    assert len(faster) == 2 * len(motion) - 1
    np.testing.assert_allclose(positions(faster)[::2], positions(motion), atol=1e-6)


def test_scaling_scales_positions(motion: SourceMotion) -> None:
    """All lengths are multiplied, and the unit divided."""
    metres = scaled(motion, 0.01)
    np.testing.assert_allclose(positions(metres), 0.01 * positions(motion), atol=1e-9)
    assert metres.metres_per_unit == pytest.approx(1.0)


def test_turning_up_and_back(motion: SourceMotion) -> None:
    """Y becomes Z, and turning back is exact."""
    z_up = turned_up(motion, "Y", "Z")
    np.testing.assert_allclose(positions(z_up)[..., 2], positions(motion)[..., 1], atol=1e-6)
    back = turned_up(z_up, "Z", "Y")
    np.testing.assert_allclose(positions(back), positions(motion), atol=1e-6)


def test_bvh_round_trip_with_moving_joints(tmp_path: Path, motion: SourceMotion) -> None:
    """Joints with positions of their own keep them."""
    from dataclasses import replace

    moving = np.repeat(motion.skeleton.offsets[None], len(motion), axis=0)
    moving[:, 5] += np.linspace(0.0, 3.0, len(motion))[:, None]
    moving[:, 0] = motion.root_positions
    source = replace(motion, translations=moving)
    write_source_bvh(tmp_path / "a.bvh", source)
    back = read_bvh(tmp_path / "a.bvh")
    np.testing.assert_allclose(positions(back), positions(source), atol=1e-3)


def test_npz_round_trip(tmp_path: Path, motion: SourceMotion) -> None:
    """An archive gives back every field."""
    write_npz(tmp_path / "a.npz", motion)
    back = read_npz(tmp_path / "a.npz")
    assert back.skeleton == motion.skeleton
    assert back.frame_rate == motion.frame_rate
    assert back.metres_per_unit == motion.metres_per_unit
    assert set(back.tips) == set(motion.tips)
    np.testing.assert_array_equal(back.rotations, motion.rotations)


@pytest.mark.parametrize("what", ["text", "cut", "other", "nan"])
def test_a_bad_archive_is_refused(tmp_path: Path, motion: SourceMotion, what: str) -> None:
    """What is no archive of a motion raises FormatError with the file."""
    path = tmp_path / "a.npz"
    write_npz(path, motion)
    raw = path.read_bytes()
    if what == "text":
        path.write_text("HIERARCHY")
    elif what == "cut":
        path.write_bytes(raw[: len(raw) // 2])
    elif what == "other":
        np.savez(path, a=np.zeros(3))
    else:
        motion.rotations[3, 2, 1] = np.nan
        write_npz(path, motion)
    with pytest.raises(FormatError, match=r"a\.npz"):
        read_npz(path)


def test_the_command_converts(tmp_path: Path, motion: SourceMotion) -> None:
    """Rate, unit and up axis are obeyed together."""
    write_source_bvh(tmp_path / "a.bvh", motion)
    args = [str(tmp_path / "a.bvh"), str(tmp_path / "b.npz"), "--rate", "30", "--up", "Z"]
    result = CliRunner().invoke(convert, [*args, "--unit", "cm", "--to-unit", "m"])
    assert result.exit_code == 0, result.output
    assert "30 per second" in result.output
    converted = read_npz(tmp_path / "b.npz")
    assert converted.frame_rate == 30.0
    expected = 0.01 * positions(motion)[::2, :, 1]
    np.testing.assert_allclose(positions(converted)[..., 2], expected, atol=1e-5)


def test_the_command_says_what_it_lacks(tmp_path: Path, motion: SourceMotion) -> None:
    """An unknown ending and an unknown unit are usage errors that say what to do."""
    write_source_bvh(tmp_path / "a.bvh", motion)
    source = str(tmp_path / "a.bvh")
    ending = CliRunner().invoke(convert, [source, str(tmp_path / "b.fbx")])
    assert ending.exit_code == 2
    assert "expected .bvh, .glb, .npz" in ending.output
    unit = CliRunner().invoke(convert, [source, str(tmp_path / "b.bvh"), "--to-unit", "m"])
    assert unit.exit_code == 2
    assert "--unit" in unit.output


def test_the_command_knows_gltf_both_ways(tmp_path: Path, motion: SourceMotion) -> None:
    """BVH to GLB in metres, Y up, its unit found by size; and back to BVH, joints in place."""
    write_source_bvh(tmp_path / "a.bvh", turned_up(motion, "Y", "Z"))
    there = [str(tmp_path / "a.bvh"), str(tmp_path / "a.glb"), "--from-up", "Z"]
    result = CliRunner().invoke(convert, there)
    assert result.exit_code == 0, result.output
    assert "cm by its size" in result.output
    back = [str(tmp_path / "a.glb"), str(tmp_path / "b.bvh"), "--to-unit", "cm"]
    result = CliRunner().invoke(convert, back)
    assert result.exit_code == 0, result.output
    again = read_bvh(tmp_path / "b.bvh")
    np.testing.assert_allclose(positions(again), positions(motion), atol=1e-3)


@pytest.mark.parametrize("option", [["--up", "Z"], ["--to-unit", "cm"]])
def test_a_glb_has_its_own_unit_and_axis(
    tmp_path: Path, motion: SourceMotion, option: list[str]
) -> None:
    """Another unit or axis is a usage error, not silently left out."""
    write_source_bvh(tmp_path / "a.bvh", motion)
    args = [str(tmp_path / "a.bvh"), str(tmp_path / "a.glb"), "--unit", "cm", *option]
    result = CliRunner().invoke(convert, args)
    assert result.exit_code == 2
    assert "in metres, Y up" in result.output


def test_without_pygltflib_the_error_says_what_to_install(
    tmp_path: Path, motion: SourceMotion, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The base install reads and writes BVH alone."""
    monkeypatch.setitem(sys.modules, "pygltflib", None)
    write_source_bvh(tmp_path / "a.bvh", motion)
    result = CliRunner().invoke(convert, [str(tmp_path / "a.bvh"), str(tmp_path / "a.glb")])
    assert result.exit_code == 1
    assert "pip install 'stridewire[server]'" in result.output


def test_the_command_brings_a_file_onto_the_reference(tmp_path: Path) -> None:
    """Whatever the rig, unit and up axis, the result imports without being retargeted."""
    rig = source(scale=39.37, z_up=True)
    write_source_bvh(tmp_path / "a.bvh", rig)
    args = [str(tmp_path / "a.bvh"), str(tmp_path / "b.bvh"), "--skeleton", "reference"]
    result = CliRunner().invoke(convert, args)
    assert result.exit_code == 0, result.output
    assert "its unit is inch" in result.output
    back = read_bvh(tmp_path / "b.bvh")
    assert back.skeleton.names == REFERENCE.names
    np.testing.assert_allclose(back.skeleton.offsets[1:], 100.0 * REFERENCE.offsets[1:], atol=1e-4)


def test_a_skeleton_that_nobody_offers_is_refused(tmp_path: Path, motion: SourceMotion) -> None:
    """The message names those that installed packages offer."""
    write_source_bvh(tmp_path / "a.bvh", motion)
    args = [str(tmp_path / "a.bvh"), str(tmp_path / "b.bvh"), "--skeleton", "alien"]
    result = CliRunner().invoke(convert, args)
    assert result.exit_code == 1
    assert "offered: reference" in result.output


@pytest.mark.parametrize("installed", [True, False])
def test_an_absent_extra_is_named(monkeypatch: pytest.MonkeyPatch, installed: bool) -> None:
    """Without the server's packages retargeting says what to install."""
    broken = EntryPoint("reference", "no_such_package:bring", "stridewire.skeletons")

    def points(group: str, **_: str) -> EntryPoints:
        return EntryPoints([broken] if installed else [])

    monkeypatch.setattr(retargeting, "entry_points", points)
    with pytest.raises(StridewireError, match=r"stridewire\[server\]"):
        retargeting.find_retargeting("reference")
