"""The code of examples/browser, run by Node: layout, encoding, decoding, kinematics."""

import json
import subprocess

import numpy as np
import pytest

from external import ROOT, binary
from serving import Doors
from stridewire import CharacterSpec, Client
from stridewire.motion.clip import Pose
from stridewire.motion.kinematics import forward_world

STEPS = 90
FLAG = "--experimental-websocket"


def websocket_is_there() -> bool:
    """Say whether Node has the browsers' WebSocket."""
    node = binary("node")
    if node is None:
        return False
    asked = [node, FLAG, "-e", "process.exit(typeof WebSocket === 'function' ? 0 : 1)"]
    return subprocess.run(asked, check=False, capture_output=True).returncode == 0


@pytest.mark.skipif(not websocket_is_there(), reason="needs node 20.10 or later")
def test_the_browsers_code_sees_what_python_sees(door: Doors) -> None:
    """The same session over gRPC: the same last frame, joints in the same places."""
    script = ROOT / "tests" / "node" / "drive_door.mjs"
    command = [str(binary("node")), FLAG, str(script), door.websocket, str(STEPS)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60.0)
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    spec = CharacterSpec(1, stitcher="spring")
    with Client(door.grpc) as client, client.open_session([spec], seed=7) as session:
        for _ in range(STEPS):
            frame = session.step(velocity=(0.3, 1.3), dt=1 / 60)
        skeleton = session.opened.skeleton
    assert seen["names"] == list(skeleton.names)
    assert seen["frame"] == frame.frame
    assert seen["time_s"] == pytest.approx(frame.time_s)
    np.testing.assert_allclose(seen["root"], frame.root[0], atol=1e-5)
    np.testing.assert_allclose(
        np.reshape(seen["rotations"], (-1, 4)), frame.rotations[0], atol=1e-5
    )
    pose = Pose(frame.root[:, :3], frame.root[:, 3:], frame.hips, frame.rotations)
    places, _ = forward_world(skeleton, pose)
    np.testing.assert_allclose(seen["places"], places[0], atol=1e-4)
