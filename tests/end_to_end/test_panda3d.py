"""A real engine, without a window: Panda3D's Actor stands as the frames say, and is drawn."""

import importlib.util
import sys
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from external import ROOT
from serving import Serve
from stridewire import Client
from stridewire.coordinates import BLENDER
from stridewire.motion.clip import Pose
from stridewire.motion.kinematics import forward_world

core = pytest.importorskip("panda3d.core", reason="needs panda3d: pip install panda3d")
pytest.importorskip("gltf", reason="needs panda3d-gltf: pip install panda3d-gltf")

PLACES_M = 1e-4
"""Float32 along nine joints, some metres from the origin."""


@pytest.fixture(scope="module")
def example() -> ModuleType:
    """Return the example as a module, in an engine that draws into memory."""
    settings = "load-display p3tinydisplay\nwindow-type offscreen\nwin-size 320 240\n"
    core.loadPrcFileData("", settings + "audio-library-name null\nnotify-level-gobj error\n")
    path = ROOT / "examples" / "panda3d" / "walk.py"
    spec = importlib.util.spec_from_file_location("panda3d_walk", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["panda3d_walk"] = module
    spec.loader.exec_module(module)
    return module


def picture(game: Any) -> np.ndarray:
    """Return what the engine draws, `(240, 320, 3)`."""
    game.graphicsEngine.renderFrame()
    shot = game.win.getScreenshot()
    raw = np.frombuffer(shot.getRamImageAs("RGB"), np.uint8)
    return raw.reshape(shot.getYSize(), shot.getXSize(), 3).astype(int)


def test_an_actor_of_panda3d_walks(serve: Serve, example: ModuleType) -> None:
    """Its joints are where the frames have them in the world; its body moves in the picture."""
    with Client(serve()) as client, client.open_session() as session:
        game = example.Game(session)
        try:
            check(game, session.opened.skeleton)
        finally:
            game.destroy()


def check(game: Any, skeleton: Any) -> None:
    """Walk two seconds by the engine's own steps."""
    game.taskMgr.remove("update")
    node = game.character.actor
    exposed = [node.exposeJoint(None, "modelRoot", name) for name in skeleton.names]
    pictures = []
    for number in range(120):
        frame = game.character.step((0.0, 1.4), 1 / 60)
        if number % 40 == 39:
            pictures.append(looked_at(game))
            node.update(force=True)
            pose = Pose(frame.root[:, :3], frame.root[:, 3:], frame.hips, frame.rotations)
            places, _ = forward_world(skeleton, pose)
            shown = np.array([list(joint.getPos(game.render)) for joint in exposed])
            assert np.abs(shown - BLENDER.positions(places[0])).max() < PLACES_M
    assert node.getY() < -1.0, "nobody walked"
    blue, red = (colourful(pictures[0], channel) for channel in (2, 0))
    assert min(blue, red) > 100, "both sides' limbs are to be seen"
    assert np.abs(pictures[0] - pictures[1]).max(axis=-1).astype(bool).sum() > 300


def looked_at(game: Any) -> np.ndarray:
    """Return a picture, the camera in front of the character."""
    place = game.character.actor.getPos()
    game.camera.setPos(place + core.Vec3(1.5, -3, 1.5))
    game.camera.lookAt(place + core.Vec3(0, 0, 0.9))
    return picture(game)


def colourful(image: np.ndarray, channel: int) -> int:
    """Count pixels in which one channel is far above another."""
    other = 2 - channel
    return int((image[..., channel] - image[..., other] > 60).sum())
