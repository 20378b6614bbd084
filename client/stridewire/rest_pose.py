"""A rig whose zero pose does not stand, made into one that does, and its rotations back again.

The runtime takes zero rotations for standing, since a skeleton has no rotations of its own at rest.
Rigs zeroed otherwise, as raw LaFAN1 with all bones along one axis, are described by the rotations
in which they stand:

    rest = RestPose(mine, standing_rotations)
    with client.open_session(output_skeleton=rest.skeleton) as session:
        mine_now = rest.rotations(session.step().rotations)
"""

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Quaternions
from stridewire.motion.skeleton import Skeleton


class RestPose:
    """A rig and how it stands.

    Args:
        skeleton: As the rig has it; metres.
        rotations: `(J, 4)` local unit quaternions with which it stands, T-pose or arms at its
            sides; the first one may also turn it upright.

    Raises:
        ValueError: If there is not one unit quaternion a joint.
    """

    def __init__(self, skeleton: Skeleton, rotations: Quaternions) -> None:
        given = np.asarray(rotations, np.float64)
        if given.shape != (len(skeleton), 4):
            raise ValueError(f"rotations of shape {given.shape}; expected {(len(skeleton), 4)}")
        if not np.allclose(np.linalg.norm(given, axis=-1), 1.0, atol=1e-3):
            raise ValueError("rotations are no unit quaternions; expected length 1 to 1e-3")
        positions, turned = kinematics.forward(skeleton, skeleton.offsets[0], given)
        parents = np.array(skeleton.parents)
        offsets = positions - positions[parents]
        offsets[0] = skeleton.offsets[0]
        self.skeleton = Skeleton(skeleton.names, skeleton.parents, offsets)
        """The rig standing with zero rotations: what `output_skeleton` takes."""
        self._turned = turned.astype(np.float32)
        above = self._turned[parents].copy()
        above[0] = (1.0, 0.0, 0.0, 0.0)
        self._back_above = quaternion.conjugate(above)

    def rotations(self, streamed: Quaternions) -> Quaternions:
        """Return local rotations `(..., J, 4)` of the rig itself for those of `skeleton`.

        Bones are turned from where they stand, so of a joint whose own axes at rest are G, below
        one whose axes are P, a streamed rotation L is `conj(P) L G`.
        """
        above, turned = (
            np.broadcast_to(turn, streamed.shape) for turn in (self._back_above, self._turned)
        )
        return quaternion.multiply(quaternion.multiply(above, streamed), turned)
