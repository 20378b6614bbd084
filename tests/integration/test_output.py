"""Poses on the caller's skeleton, in its size, and as half floats."""

from collections.abc import Iterable

import numpy as np
import pytest

from rigs import cmu, mixamo
from serving import Serve
from stridewire import CharacterSpec, Client, Frame, GroundPose, InvalidRequestError, PoseFormat
from stridewire.motion import kinematics, quaternion
from stridewire.motion.array_types import Floats, Vectors
from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire.scripts import script
from stridewire_engine.library import Library
from stridewire_engine.rigs.rig import rig_of

LIMBS = [
    (side + a, side + b)
    for side in ("Left", "Right")
    for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"), ("Arm", "ForeArm"), ("ForeArm", "Hand"))
]
TOES = ("LeftToe", "RightToe")


def walk(client: Client, skeleton: Skeleton | None, speed: float = 1.0) -> list[Frame]:
    """Let two characters walk, turn and stop; slower where they are smaller."""
    controls = script("walk-turn-stop").controls
    with client.open_session(2, output_skeleton=skeleton, seed=3) as session:
        frames = []
        for i in range(420):
            asked = controls(i / 60.0, 2, 0)
            frames.append(session.step(asked.velocity * speed, asked.facing))
        assert skeleton is None or session.opened.skeleton.names == skeleton.names
    return frames


def positions(frames: Iterable[Frame], skeleton: Skeleton) -> Vectors:
    """Return where the joints are in the world, `(T, N, J, 3)`."""
    return np.array(
        [
            frame.root[:, None, :3]
            + quaternion.rotate(
                np.repeat(frame.root[:, None, 3:], len(skeleton), axis=1),
                kinematics.forward(skeleton, frame.hips, frame.rotations)[0],
            )
            for frame in frames
        ]
    )


def bones(joints: Vectors, pairs: list[tuple[int, int]]) -> Vectors:
    """Return unit directions `(T, N, 8, 3)`."""
    ways = np.stack([joints[..., b, :] - joints[..., a, :] for a, b in pairs], axis=-2)
    return np.asarray(ways / np.linalg.norm(ways, axis=-1, keepdims=True))


def speeds(toes: Vectors, frames: list[Frame]) -> Floats:
    """Return planar speeds of locked toes; m/s."""
    locked = ~np.isnan([frame.foot_targets[..., 0] for frame in frames])
    way = np.linalg.norm(np.diff(toes[..., (0, 2)], axis=0), axis=-1) * 60.0
    return np.asarray(way[locked[1:] & locked[:-1]])


@pytest.mark.parametrize("skeleton", [mixamo(), cmu()], ids=["mixamo", "cmu"])
def test_limbs_point_as_they_did_and_feet_stay(small_library: Library, skeleton: Skeleton) -> None:
    """Limbs within a degree, planted toes no faster than the reference's, hips without jumps."""
    rig = rig_of(skeleton)
    client = Client.in_process(small_library.path)
    theirs = walk(client, skeleton, rig.scale)
    ours = walk(client, None)
    at = dict(zip(rig.parts, rig.joints.tolist(), strict=True))
    there, here = positions(theirs, skeleton), positions(ours, REFERENCE)
    cosines = np.sum(
        bones(there, [(at[a], at[b]) for a, b in LIMBS])
        * bones(here, [(REFERENCE.index(a), REFERENCE.index(b)) for a, b in LIMBS]),
        axis=-1,
    )
    apart = np.rad2deg(np.arccos(np.clip(cosines, -1.0, 1.0)))
    assert apart.max() < 1.0
    assert apart.mean() < 0.05
    own = speeds(there[:, :, [at[toe] for toe in TOES]], theirs)
    reference = speeds(here[:, :, REFERENCE.indices(TOES)], ours)
    assert own.mean() <= reference.mean()
    hips = there[:, :, rig.joints[rig.part("Hips")]]
    bumps = np.linalg.norm(np.diff(hips, 2, axis=0), axis=-1)
    assert np.percentile(bumps, 99.0) < 0.008, "metres from where the frames before lead"
    roots = np.array([frame.root[:, :3] for frame in theirs])
    ours_scaled = np.array([frame.root[:, :3] for frame in ours]) * rig.scale
    np.testing.assert_allclose(roots, ours_scaled, atol=1e-3)


def test_planted_toes_stand_on_the_ground(small_library: Library) -> None:
    """Their height is the rig's at rest, whatever the reference's ankle."""
    skeleton = mixamo()
    rig = rig_of(skeleton)
    frames = walk(Client.in_process(small_library.path), skeleton)
    toes = positions(frames, skeleton)[..., [rig.joints[rig.part(toe)] for toe in TOES], 1]
    locked = ~np.isnan([frame.foot_targets[..., 0] for frame in frames])
    assert rig.toe_height is not None
    assert np.median(toes[locked]) == pytest.approx(rig.toe_height, abs=0.01)


def test_locked_feet_are_sent_where_they_are(small_library: Library) -> None:
    """`foot_targets` are the rig's own toes, for an engine that bends the legs again."""
    skeleton = mixamo()
    rig = rig_of(skeleton)
    frames = walk(Client.in_process(small_library.path), skeleton)
    toes = positions(frames, skeleton)[..., [rig.joints[rig.part(toe)] for toe in TOES], :]
    targets = np.array([frame.foot_targets for frame in frames])
    gaps = np.linalg.norm(toes - targets, axis=-1)
    assert np.nanpercentile(gaps, 90) < 0.03


def test_heights_size_characters_each(small_library: Library) -> None:
    """A child beside a giant: hips as high as they are tall, asked for the same they walk it."""
    client = Client.in_process(small_library.path)
    specs = [
        CharacterSpec(1, height_m=0.875),
        CharacterSpec(2, GroundPose((3.0, 0.5, 0.0)), height_m=2.625),
        CharacterSpec(3, GroundPose((6.0, 0.0, 0.0))),
    ]
    with client.open_session(specs) as session:
        first = session.step(velocity=(0.0, 0.7))
        np.testing.assert_allclose(first.root[1, :3], (3.0, 0.5, 0.0), atol=0.05)
        for _ in range(240):
            frame = session.step()
        height = frame.hips[:, 1]
        assert height[0] == pytest.approx(0.5 * height[2], rel=0.05)
        assert height[1] == pytest.approx(1.5 * height[2], rel=0.05)
        way = frame.root[:, 2] - first.root[:, 2]
        np.testing.assert_allclose(way, 0.7 * 4.0, rtol=0.25)
        session.teleport(2, (10.0, 0.0, -5.0))
        np.testing.assert_allclose(session.step().root[1, :3], (10.0, 0.0, -5.0), atol=0.1)


def test_characters_come_and_go_on_a_rig(small_library: Library) -> None:
    """What feet remember stays with its character."""
    client = Client.in_process(small_library.path)
    with client.open_session([1, 2], output_skeleton=mixamo()) as session:
        before = [session.step(velocity=(0.0, 1.2)) for _ in range(90)][-1]
        session.edit(remove=[1], add=[CharacterSpec(9)])
        after = session.step()
        assert after.characters.tolist() == [2, 9]
        np.testing.assert_allclose(after.hips[0], before.hips[1], atol=0.03)


def test_half_floats_are_the_same_numbers_rounded(either: Client) -> None:
    """Rotations to 1e-3, the root whole; the same over a wire and without one."""
    with (
        either.open_session(2, seed=5) as plain,
        either.open_session(2, seed=5, format=PoseFormat.F16) as halves,
    ):
        for _ in range(60):
            a, b = plain.step(velocity=(0.3, 1.2)), halves.step(velocity=(0.3, 1.2))
        assert b.format is PoseFormat.F16
        np.testing.assert_allclose(b.rotations, a.rotations, atol=1e-3)
        np.testing.assert_allclose(b.hips, a.hips, atol=1e-3)
        np.testing.assert_array_equal(b.hips, a.hips.astype(np.float16).astype(np.float32))
        np.testing.assert_allclose(b.root, a.root, atol=1e-5)
        assert b.rotations.dtype == np.float32


def test_output_over_the_wire_is_that_in_process(serve: Serve, small_library: Library) -> None:
    """A rig's poses agree to 1e-5 between both."""
    with Client(serve(), timeout_s=20.0) as client:
        over_wire = walk(client, mixamo())
    here = walk(Client.in_process(small_library.path), mixamo())
    for a, b in zip(over_wire, here, strict=True):
        np.testing.assert_allclose(a.rotations, b.rotations, atol=1e-5)
        np.testing.assert_allclose(a.hips, b.hips, atol=1e-5)


@pytest.mark.parametrize(
    ("skeleton", "says"),
    [
        (mixamo().scaled(100.0), "offsets are metres"),
        (Skeleton(("a", "b"), (-1, 0), np.ones((2, 3))), "no human"),
    ],
)
def test_a_skeleton_that_cannot_be_posed_is_refused(
    either: Client, skeleton: Skeleton, says: str
) -> None:
    """Open is refused, the field named."""
    with pytest.raises(InvalidRequestError, match=says) as raised:
        either.open_session(output_skeleton=skeleton).__enter__()
    assert [violation.field for violation in raised.value.violations] == ["open.output_skeleton"]


@pytest.mark.parametrize("height", [0.49, 3.01, -1.0, float("nan")])
def test_heights_out_of_range_are_refused(either: Client, height: float) -> None:
    """0.5 to 3 m are allowed."""
    with pytest.raises(InvalidRequestError, match=r"allowed are 0\.5 to 3"):
        either.open_session([CharacterSpec(0, height_m=height)]).__enter__()
