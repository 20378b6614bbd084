"""Float32 stays float32 in all that a tick calls: widening would double its time in silence."""

from collections.abc import Callable

import numpy as np
import pytest

from stridewire.motion import kinematics, quaternion, springs
from stridewire.motion.clip import Clip, Pose, differences
from stridewire.motion.mirror import mirror_pose
from stridewire.motion.resample import resample_rotations, resample_values
from stridewire.motion.root import extract_root, savitzky_golay
from stridewire.motion.skeleton import REFERENCE
from stridewire.motion.two_bone_ik import two_bone_ik

Q = quaternion.from_scaled_axis(np.linspace(-2.0, 2.0, 24, dtype=np.float32).reshape(8, 3))
V = np.linspace(-1.0, 1.0, 24, dtype=np.float32).reshape(8, 3)
S = np.linspace(-1.0, 1.0, 8, dtype=np.float32)
ROW_DT = np.full(8, 1.0 / 60.0, np.float32)

FUNCTIONS: dict[str, Callable[[], object]] = {
    "multiply": lambda: quaternion.multiply(Q, Q),
    "conjugate": lambda: quaternion.conjugate(Q),
    "rotate": lambda: quaternion.rotate(Q, V),
    "normalize": lambda: quaternion.normalize(Q),
    "absolute": lambda: quaternion.absolute(Q),
    "unroll": lambda: quaternion.unroll(Q),
    "from_scaled_axis": lambda: quaternion.from_scaled_axis(V),
    "to_scaled_axis": lambda: quaternion.to_scaled_axis(Q),
    "from_axis_angle": lambda: quaternion.from_axis_angle((0.0, 1.0, 0.0), S),
    "from_axis_angle_of_axes": lambda: quaternion.from_axis_angle(V, 0.5),
    "from_yaw": lambda: quaternion.from_yaw(S),
    "to_yaw": lambda: quaternion.to_yaw(Q),
    "between": lambda: quaternion.between(V, V[::-1]),
    "nlerp": lambda: quaternion.nlerp(Q, Q[::-1], S),
    "slerp": lambda: quaternion.slerp(Q, Q[::-1], S),
    "angular_velocity": lambda: quaternion.angular_velocity(Q, 1.0 / 60.0),
    "from_euler": lambda: quaternion.from_euler(V, "zyx"),
    "to_euler_zyx": lambda: quaternion.to_euler_zyx(Q),
    "damper": lambda: springs.damper_exact(S, S, 0.2, 1.0 / 60.0),
    "damper_of_rows": lambda: springs.damper_exact(S, S, 0.2, ROW_DT),
    "damper_of_a_numpy_scalar": lambda: springs.damper_exact(S, S, 0.2, np.float64(0.1)),
    "spring": lambda: springs.spring_damper_exact(S, S, S, 0.2, 1.0 / 60.0),
    "spring_of_a_numpy_scalar": lambda: springs.spring_damper_exact(S, S, S, 0.2, np.float64(0.1)),
    "decay": lambda: springs.decay_spring_damper_exact(S, S, 0.2, 1.0 / 60.0),
    "decay_of_rows": lambda: springs.decay_spring_damper_exact(S, S, 0.2, ROW_DT),
    "velocity_spring": lambda: springs.velocity_spring_exact(S, S, S, S, 0.2, 1.0 / 60.0),
    "velocity_spring_of_rows": lambda: springs.velocity_spring_exact(S, S, S, S, 0.2, ROW_DT),
    "wrap_angle": lambda: springs.wrap_angle(S),
    "two_bone_ik": lambda: two_bone_ik(V, V + 1, V[::-1] + 2, Q, Q, V + 1.5, V)[:3],
    "differences": lambda: differences(V, 1.0 / 60.0),
    "savitzky_golay": lambda: savitzky_golay(V, 5),
    "savitzky_golay_of_few": lambda: savitzky_golay(V[:2], 5),
    "resample_values": lambda: resample_values(V, 30.0, 60.0),
    "resample_rotations": lambda: resample_rotations(Q, 30.0, 60.0),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_single_precision_is_kept(name: str) -> None:
    """A function of float32 arrays answers in float32, for scalar and for per-row `dt`."""
    result = FUNCTIONS[name]()
    for array in result if isinstance(result, tuple) else (result,):
        assert array.dtype == np.float32


def test_poses_and_clips_keep_single_precision(swaying_clip: Clip) -> None:
    """Kinematics, mirroring, sampling and roots keep float32 in every array."""
    pose = swaying_clip.pose.astype(np.float32)
    single = Clip("single", REFERENCE, 60.0, pose, swaying_clip.contacts)
    hips, turn = pose.world_hips
    in_world = pose.rotations.copy()
    in_world[:, 0] = turn
    made: list[Pose] = [
        single.sample(np.array([0.1, 0.55])),
        mirror_pose(REFERENCE, pose),
        extract_root(REFERENCE, hips, in_world, 60.0),
        Pose.concatenate([pose, pose]),
    ]
    for result in made:
        for field in ("root_position", "root_rotation", "hips", "rotations"):
            assert getattr(result, field).dtype == np.float32, field
    for array in kinematics.forward_world(REFERENCE, pose):
        assert array.dtype == np.float32
