"""Contacts of running: feet that creep in stance count as planted, feet that swing do not."""

import numpy as np

from stridewire.motion import kinematics, quaternion
from stridewire.motion.contacts import detect_contacts
from stridewire.motion.skeleton import REFERENCE


def positions_of_a_stance(pace: float, creep: float) -> np.ndarray:
    """Return joints `(60, 22, 3)` at `pace`, the left foot creeping at `creep`."""
    t = np.arange(60) / 60.0
    hips = np.stack([0 * t, 0.95 + 0 * t, pace * t], axis=-1)
    positions, _ = kinematics.forward(REFERENCE, hips, quaternion.identity(60, 22, dtype=float))
    for name in ("LeftFoot", "LeftToe"):
        joint = REFERENCE.index(name)
        positions[:, joint, 2] = positions[0, joint, 2] + creep * t
    return positions


def test_a_creeping_foot_is_planted_while_running_only() -> None:
    """0.3 m/s is planted at 4 m/s and swings at 1 m/s; a foot that keeps pace never is planted."""
    running = detect_contacts(REFERENCE, positions_of_a_stance(4.0, 0.3), 60.0)
    walking = detect_contacts(REFERENCE, positions_of_a_stance(1.0, 0.3), 60.0)
    assert running[:, :2].all()
    assert not walking[:, :2].any()
    assert not running[:, 2:].any()
