"""A character of Panda3D that walks as Stridewire says: WASD or arrows, shift to run.

    pip install 'stridewire[server]' panda3d panda3d-gltf
    stridewire serve
    python walk.py

The skeleton that the session tells is given a body, loaded as an ordinary skinned `Actor`, whose
joints are then set in every frame of the game: any Actor with those joints would do.
"""

import math
import tempfile
from pathlib import Path

from direct.actor.Actor import Actor
from direct.showbase.ShowBase import ShowBase
from panda3d.core import AmbientLight, CardMaker, DirectionalLight, Quat, Vec3, loadPrcFileData

from stridewire import Client
from stridewire.coordinates import BLENDER as PANDA  # the same axes: right-handed, +Z up, -Y ahead
from stridewire.formats.gltf_writing import write_body

WALK, RUN = 1.4, 3.2
KEYS = {
    "w": (0, 1), "s": (0, -1), "a": (1, 0), "d": (-1, 0),
    "arrow_up": (0, 1), "arrow_down": (0, -1), "arrow_left": (1, 0), "arrow_right": (-1, 0),
}  # fmt: skip
"""Directions along the world's x and z; the camera looks along +Z, so that +X is left."""


class Character:
    """An Actor and the session that moves it."""

    def __init__(self, base, session):
        self.session = session
        skeleton = session.opened.skeleton
        with tempfile.TemporaryDirectory() as folder:
            body = Path(folder) / "body.glb"
            write_body(body, skeleton)
            self.actor = Actor(str(body))
        self.actor.reparentTo(base.render)
        self.joints = [self.actor.controlJoint(None, "modelRoot", n) for n in skeleton.names]

    def step(self, velocity, dt):
        """Ask for a frame of the game, m/s along the world's x and z, and take its pose."""
        frame = self.session.step(velocity, dt=min(dt, 0.25))
        turns = PANDA.rotations(frame.rotations[0]).tolist()
        root, facing = PANDA.positions(frame.root[0, :3]), PANDA.rotations(frame.root[0, 3:])
        self.actor.setPos(*root.tolist())
        self.actor.setQuat(Quat(*facing.tolist()))
        self.joints[0].setPos(*PANDA.positions(frame.hips[0]).tolist())
        for joint, turn in zip(self.joints, turns, strict=True):
            joint.setQuat(Quat(*turn))
        return frame


class Game(ShowBase):
    """A window, some ground, a camera that goes along, keys."""

    def __init__(self, session):
        super().__init__()
        self.disableMouse()
        self.setBackgroundColor(0.93, 0.94, 0.95)
        self.character = Character(self, session)
        ground = CardMaker("ground")
        ground.setFrame(-20, 20, -20, 20)
        card = self.render.attachNewNode(ground.generate())
        card.setP(-90)
        card.setColor(0.8, 0.82, 0.84, 1)
        sun = self.render.attachNewNode(DirectionalLight("sun"))
        sun.setHpr(-30, -60, 0)
        sky = self.render.attachNewNode(AmbientLight("sky"))
        sky.node().setColor((0.4, 0.42, 0.45, 1))
        self.render.setLight(sun)
        self.render.setLight(sky)
        self.taskMgr.add(self.update, "update")

    def update(self, task):
        """Move by the keys that are held."""
        held = [way for key, way in KEYS.items() if self.held(key)]
        speed = RUN if self.held("shift") else WALK
        x, z = (sum(parts) for parts in zip(*held, strict=True)) if held else (0, 0)
        length = math.hypot(x, z) or 1.0
        velocity = (speed * x / length, speed * z / length)
        self.character.step(velocity, self.clock.getDt())
        place = self.character.actor.getPos()
        self.camera.setPos(place + Vec3(0, 4, 1.8))  # behind: a character looks along -Y
        self.camera.lookAt(place + Vec3(0, 0, 0.9))
        return task.cont

    def held(self, key):
        """Say whether a key is down; without a window none is."""
        watcher = self.mouseWatcherNode
        return watcher is not None and watcher.isButtonDown(key)


if __name__ == "__main__":
    loadPrcFileData("", "window-title Stridewire")
    with Client() as client, client.open_session() as session:
        Game(session).run()
