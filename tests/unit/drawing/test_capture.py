"""Subjects of real files: people stand upright in metres, feet are feet, walkers plant them."""

from pathlib import Path

import numpy as np
import pytest

from stridewire.drawing import Subject
from stridewire.formats.bvh import read_bvh


@pytest.mark.parametrize(
    ("file", "left_foot"),
    [
        ("lafan1/dance1_subject1.bvh", "LeftToe"),
        ("exporters/odd/walk_pelvis_root_at_origin_21j.bvh", "ltoes"),
        ("exporters/odd/zup_run_120fps_25j.bvh", "LeftToeBase"),
        ("exporters/odd/custom_72fps_78j.bvh", "L_toe_tip_jnt"),
        ("exporters/odd/walk01_24fps_19j.bvh", "LeftFoot"),
        ("exporters/pfnn/LocomotionFlat04_000.bvh", "LeftToeBase"),
    ],
)
def test_files_of_many_exporters_stand_upright_in_metres(
    capture: Path, file: str, left_foot: str
) -> None:
    """Centimetres, inches and metres, Y up and Z up: a person is 1.2 to 2 m tall and has feet."""
    source = read_bvh(capture / file)
    subject = Subject.of_source(source)
    assert 1.2 < np.median(subject.positions[..., 1].max(axis=1)) < 2.0
    assert source.skeleton.names[subject.feet[0]] == left_foot
    assert len(subject.feet) == 2
    assert 0.2 < subject.planted.mean() < 0.9


def test_walkers_face_where_they_walk(capture: Path) -> None:
    """The guessed heading agrees with the way, within 30 degrees most of the time."""
    subject = Subject.of_source(read_bvh(capture / "exporters/odd/accad_male1_b3_walk_22j.bvh"))
    step = np.gradient(subject.root, axis=0)
    way = np.arctan2(step[:, 0], step[:, 2])
    off = np.abs(np.angle(np.exp(1j * (way - subject.heading))))
    assert np.mean(off < np.radians(30.0)) > 0.9
