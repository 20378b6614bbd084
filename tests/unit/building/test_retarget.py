"""Retargeting: whatever the rest pose, axes, names and units of a rig, limbs point as they did."""

import numpy as np
import pytest
from tests.unit.building.figures import source, walking

from stridewire.formats.source_motion import SourceMotion
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Quaternions, Vectors
from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire_engine.building.figure import NEXT, direction
from stridewire_engine.building.onto_reference import find_profile
from stridewire_engine.building.profiles import shipped_profiles
from stridewire_engine.building.retarget import NotHumanError, Retargeted, retarget

ONE_DEGREE = np.cos(np.deg2rad(1.0))
LIMBS = [(REFERENCE.index(a), REFERENCE.index(b)) for a, b in NEXT.items()]


def retargeted(motion: SourceMotion) -> Retargeted:
    """Retarget with whatever profile is found."""
    return retarget(motion, find_profile(motion, shipped_profiles()), motion.frame_rate or 60.0)


def joints(hips: Vectors, rotations: Quaternions) -> Vectors:
    """Return where the joints are `(T, 22, 3)`."""
    return kinematics.forward(REFERENCE, hips, rotations)[0]


def agreement(motion: SourceMotion) -> float:
    """Return the mean cosine between limbs of the walk and of what is made of a file of it."""
    result = retargeted(motion)
    was, now = joints(*walking()), joints(result.hips, result.rotations)
    cosines = [
        np.sum(direction(was[:, b] - was[:, a]) * direction(now[:, b] - now[:, a]), axis=-1)
        for a, b in LIMBS
    ]
    return float(np.mean(cosines))


def folded() -> Quaternions:
    """Return axes `(22, 4)` such that each bone lies along its joint's +X, as in LaFAN1."""
    axes = quaternion.identity(len(REFERENCE), dtype=np.float64)
    for joint in range(len(REFERENCE)):
        child = next((c for c, p in enumerate(REFERENCE.parents) if p == joint), None)
        bone = REFERENCE.offsets[child] if child is not None else np.array([0.0, 1.0, 0.0])
        axes[joint] = quaternion.between(np.array([1.0, 0.0, 0.0]), bone)
    return axes


@pytest.mark.parametrize("scale", [1.0, 100.0, 39.37, 17.72])
def test_units_change_nothing(scale: float) -> None:
    """Metres, centimetres, inches and CMU's unit give the same motion in metres."""
    result = retargeted(source(scale=scale))
    assert result.scale == pytest.approx(1.0 / scale, rel=1e-3)
    np.testing.assert_allclose(result.hips, walking()[0], atol=1e-3)


def test_the_reference_itself_passes_unchanged() -> None:
    """A file on the reference skeleton is not retargeted at all."""
    result = retargeted(source())
    assert result.unchanged
    np.testing.assert_allclose(result.rotations, walking()[1], atol=1e-12)


def test_bones_along_one_axis() -> None:
    """Where zero angles are a folded line the average pose stands in for the rest pose."""
    assert agreement(source(axes=folded())) > ONE_DEGREE


def test_an_arbitrary_rig() -> None:
    """Joint axes that point anywhere leave limb directions as they are."""
    rng = np.random.default_rng(5)
    axes = quaternion.normalize(rng.normal(size=(len(REFERENCE), 4)))
    assert agreement(source(axes=axes)) > ONE_DEGREE


def test_z_up_is_turned_up() -> None:
    """A world with Z up comes out with Y up, and a note says so."""
    motion = source(axes=folded(), z_up=True)
    assert agreement(motion) > ONE_DEGREE
    assert retargeted(motion).notes == ("Z is up",)


def test_the_reference_with_z_up_is_turned_up() -> None:
    """Not even the reference skeleton may come out lying down."""
    result = retargeted(source(z_up=True))
    assert not result.unchanged
    np.testing.assert_allclose(result.hips[:, 1], walking()[0][:, 1], atol=0.02)


def test_names_of_another_exporter() -> None:
    """Prefixes and other words for the same parts are understood."""
    rename = {
        "LeftUpLeg": "LeftHip",
        "LeftLeg": "LeftKnee",
        "LeftFoot": "LeftAnkle",
        "LeftShoulder": "LeftCollar",
        "LeftArm": "LeftShoulder",
        "LeftForeArm": "LeftElbow",
        "LeftHand": "LeftWrist",
    }
    both = rename | {
        a.replace("Left", "Right"): b.replace("Left", "Right") for a, b in rename.items()
    }
    assert agreement(source(axes=folded(), rename=both)) > ONE_DEGREE


def test_planted_toes_slide_no_more_than_the_sources() -> None:
    """The toe keeps its distance from the source's toe wherever that one stands still."""
    motion = source(axes=folded(), scale=93.0)
    result = retargeted(motion)
    now = joints(result.hips, result.rotations)
    was = joints(*walking())
    for name in ("LeftToe", "RightToe"):
        toe = REFERENCE.index(name)
        speed = [
            np.linalg.norm(np.gradient(p[:, toe], 1 / 60, axis=0), axis=-1) for p in (was, now)
        ]
        still = speed[0] < np.percentile(speed[0], 10.0)
        assert speed[1][still].mean() < 1.1 * speed[0][still].mean() + 0.01


def test_four_legs_are_refused() -> None:
    """Arms as long as legs are no human's; the message says what measured how much."""
    motion = source()
    offsets = motion.skeleton.offsets.copy()
    for name in ("LeftForeArm", "LeftHand", "RightForeArm", "RightHand"):
        offsets[motion.skeleton.index(name)] *= 1.6
    names = tuple(f"dog_{name}" for name in motion.skeleton.names)
    dog = SourceMotion(
        motion.path,
        Skeleton(names, motion.skeleton.parents, offsets),
        {},
        60.0,
        motion.root_positions,
        motion.rotations,
    )
    with pytest.raises(NotHumanError, match=r"arms measure 1\.04 of the legs"):
        retargeted(dog)
