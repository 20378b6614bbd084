"""Two-bone IK keeps its promises for any limb and any target."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from stridewire.motion import quaternion
from stridewire.motion.array_types import Floats
from stridewire.motion.two_bone_ik import two_bone_ik

unit = st.floats(-1.0, 1.0)
STILL = np.array(quaternion.IDENTITY)


@given(arrays(np.float64, (3, 3), elements=unit), st.floats(0.15, 0.6), st.floats(0.15, 0.6))
def test_rotations_place_the_end_where_the_answer_says(
    points: Floats, upper_length: float, lower_length: float
) -> None:
    """Bones keep their lengths, the end lies where stated, and `reached` is the truth."""
    down, forward = np.array([0.1, -1.0, 0.2]), np.array([0.0, 0.0, 1.0])
    first = points[0] * 0.9 + down
    second = points[1] * 0.9 + down
    knee = first / np.linalg.norm(first) * upper_length
    ankle = knee + second / np.linalg.norm(second) * lower_length
    target = points[2]
    limb = two_bone_ik(np.zeros(3), knee, ankle, STILL, STILL, target, forward)
    end = quaternion.rotate(limb.upper, knee) + quaternion.rotate(limb.lower, ankle - knee)
    np.testing.assert_allclose(end, limb.end, atol=1e-5)
    # the distance along the limb decides, to 0.1 mm; rounding may fall on either side of it
    assert not limb.reached or np.linalg.norm(limb.end - target) < 1.1e-4
    assert limb.reached or np.linalg.norm(limb.end - target) > 0.9e-4
