"""glTF written and read back; other exporters' ways of saying the same; damaged files refused."""

import json
import struct
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from external import needs_gltf_validator, validate_gltf
from gltf_matrices import by_matrices, parts
from stridewire.formats.bvh import read_bvh
from stridewire.formats.bvh_writing import clip_in_centimetres, write_source_bvh
from stridewire.formats.gltf import read_gltf
from stridewire.formats.gltf_writing import write_body, write_glb
from stridewire.formats.source_motion import FormatError, SourceMotion
from stridewire.motion import quaternion
from stridewire.motion.clip import Clip
from stridewire.motion.skeleton import REFERENCE, Skeleton

MILLIMETRE = 1e-3
Change = Callable[[dict[str, Any]], None]


@pytest.fixture
def motion(swaying_clip: Clip) -> SourceMotion:
    """Return a motion in centimetres."""
    return clip_in_centimetres(swaying_clip, Path("sway.bvh"))


@pytest.fixture
def glb(tmp_path: Path, motion: SourceMotion) -> Path:
    """Return the motion as a file."""
    write_glb(tmp_path / "sway.glb", motion)
    return tmp_path / "sway.glb"


def metres(motion: SourceMotion) -> np.ndarray:
    """Return where the joints are, in metres."""
    return motion.global_poses()[0] * motion.metres_per_unit


def changed(path: Path, change: Change, extra: bytes = b"") -> Path:
    """Change a GLB's JSON, add to its binary."""
    document, binary = parts(path)
    binary += extra
    document["buffers"][0]["byteLength"] = len(binary)
    change(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    path.write_bytes(head + chunks)
    return path


def test_a_motion_comes_back(glb: Path, motion: SourceMotion) -> None:
    """Places, rotations, names, end sites and rate; in metres."""
    back = read_gltf(glb)
    assert (back.metres_per_unit, back.frame_rate, len(back)) == (1.0, 60.0, len(motion))
    assert back.skeleton.names == motion.skeleton.names
    assert back.translations is None
    assert back.notes == ()
    assert set(back.tips) == set(motion.tips)
    np.testing.assert_allclose(metres(back), metres(motion), atol=1e-5)
    turned = quaternion.multiply(quaternion.conjugate(back.rotations), motion.rotations)
    assert np.abs(quaternion.to_scaled_axis(turned)).max() < 1e-5


def test_bvh_and_glb_place_joints_alike(tmp_path: Path, glb: Path, motion: SourceMotion) -> None:
    """To 1 mm, by the reader and by the specification's matrices."""
    write_source_bvh(tmp_path / "sway.bvh", motion)
    bvh = 0.01 * read_bvh(tmp_path / "sway.bvh").global_poses()[0]
    assert np.abs(metres(read_gltf(glb)) - bvh).max() < MILLIMETRE
    assert np.abs(by_matrices(glb) - bvh).max() < MILLIMETRE


@needs_gltf_validator
@pytest.mark.parametrize("moving", [False, True])
def test_the_khronos_validator_finds_no_error(
    tmp_path: Path, motion: SourceMotion, moving: bool
) -> None:
    """No error, also where joints move; one warning, which the engines' convention costs."""
    written = with_moving_joints(motion) if moving else motion
    write_glb(tmp_path / "a.glb", written)
    issues = validate_gltf(tmp_path / "a.glb")["issues"]
    assert issues["numErrors"] == 0, issues["messages"]
    assert [m["code"] for m in issues["messages"]] == ["NODE_SKINNED_MESH_NON_ROOT"]


def test_joints_that_move_keep_moving(tmp_path: Path, motion: SourceMotion) -> None:
    """Offsets by frame are written and read."""
    written = with_moving_joints(motion)
    write_glb(tmp_path / "a.glb", written)
    np.testing.assert_allclose(metres(read_gltf(tmp_path / "a.glb")), metres(written), atol=1e-5)


def test_a_body_alone_has_no_animation(tmp_path: Path) -> None:
    """For engines that move it: all joints, a skin, nothing to play."""
    write_body(tmp_path / "body.glb", REFERENCE)
    document, _ = parts(tmp_path / "body.glb")
    assert [node["name"] for node in document["nodes"][:22]] == list(REFERENCE.names)
    assert document["skins"][0]["joints"] == list(range(22))
    with pytest.raises(FormatError, match="no animation"):
        read_gltf(tmp_path / "body.glb")


def with_moving_joints(motion: SourceMotion) -> SourceMotion:
    """Return a motion whose knee slides."""
    moving = np.repeat(motion.skeleton.offsets[None], len(motion), axis=0)
    moving[:, 2] += np.linspace(0.0, 5.0, len(motion))[:, None]
    moving[:, 0] = motion.root_positions
    return replace(motion, translations=moving)


def test_a_body_has_three_colours_and_follows_every_limb(glb: Path) -> None:
    """Left, middle and right surfaces; all joints but the ends of limbs carry vertices."""
    document, binary = parts(glb)
    assert len(document["materials"]) == 3
    followed: set[int] = set()
    for primitive in document["meshes"][0]["primitives"]:
        accessor = document["accessors"][primitive["attributes"]["JOINTS_0"]]
        start = document["bufferViews"][accessor["bufferView"]]["byteOffset"]
        followed |= set(np.frombuffer(binary, "<u2", 4 * accessor["count"], start)[::4].tolist())
    assert followed == set(range(22))


def test_a_body_stands_where_its_skeleton_stands(glb: Path) -> None:
    """At rest the reference is 1.75 m tall, its feet near the ground."""
    document, _ = parts(glb)
    accessors = [
        document["accessors"][primitive["attributes"]["POSITION"]]
        for primitive in document["meshes"][0]["primitives"]
    ]
    assert max(a["max"][1] for a in accessors) == pytest.approx(1.75, abs=0.1)
    assert min(a["min"][1] for a in accessors) == pytest.approx(0.0, abs=0.1)


def test_any_skeleton_gets_a_body(tmp_path: Path) -> None:
    """Without sides, heads or lengths: a chain, a single joint."""
    chain = Skeleton(("a", "b", "c"), (-1, 0, 1), np.array([[0, 0, 0], [0, 1.0, 0], [0, 0, 0]]))
    one = Skeleton(("a", "b"), (-1, 0), np.array([[0, 0, 0], [0, 0.5, 0]]))
    for skeleton in (chain, one):
        rotations = quaternion.identity(3, len(skeleton), dtype=np.float64)
        motion = SourceMotion(Path("a"), skeleton, {}, 30.0, np.zeros((3, 3)), rotations)
        write_glb(tmp_path / "a.glb", replace(motion, metres_per_unit=1.0))
        assert len(read_gltf(tmp_path / "a.glb")) == 3


def test_joints_may_be_turned_at_rest(glb: Path, motion: SourceMotion) -> None:
    """Another exporter's joint axes: rest is where rotations are zero, all places are the same."""
    turn = quaternion.normalize(np.array([0.5, 0.1, -0.7, 0.3]))
    back = read_gltf(turned_knee(glb, turn))
    np.testing.assert_allclose(metres(back), metres(motion), atol=1e-5)
    np.testing.assert_allclose(back.skeleton.offsets, 0.01 * motion.skeleton.offsets, atol=1e-6)


def turned_knee(glb: Path, turn: np.ndarray) -> Path:
    """Turn the axes of joint 2 by `turn` at rest: its keys after it, its child before it."""
    document, binary = parts(glb)
    keys, child = (rotation_keys(document, binary, node) for node in (2, 3))
    new_keys = quaternion.multiply(keys, turn)
    back = quaternion.conjugate(turn)
    new_child = quaternion.multiply(np.broadcast_to(back, child.shape), child)

    def change(document: dict[str, Any]) -> None:
        scalar_last = [1, 2, 3, 0]
        document["nodes"][2]["rotation"] = turn[scalar_last].tolist()
        document["nodes"][3]["rotation"] = back[scalar_last].tolist()
        step = np.array(document["nodes"][3]["translation"])
        document["nodes"][3]["translation"] = quaternion.rotate(back, step).tolist()
        start = len(binary)
        for number, node in enumerate((2, 3)):
            length = 16 * len(keys)
            view = {"buffer": 0, "byteOffset": start + number * length, "byteLength": length}
            document["bufferViews"].append(view)
            accessor = {
                "bufferView": len(document["bufferViews"]) - 1,
                "componentType": 5126,
                "count": len(keys),
                "type": "VEC4",
            }
            document["accessors"].append(accessor)
            sampler = document["animations"][0]["samplers"][node]
            sampler["output"] = len(document["accessors"]) - 1

    floats = [k[:, [1, 2, 3, 0]].astype("<f4").tobytes() for k in (new_keys, new_child)]
    return changed(glb, change, b"".join(floats))


def rotation_keys(document: dict[str, Any], binary: bytes, node: int) -> np.ndarray:
    """Return a joint's rotations, w x y z."""
    accessor = document["accessors"][document["animations"][0]["samplers"][node]["output"]]
    start = document["bufferViews"][accessor["bufferView"]]["byteOffset"]
    flat = np.frombuffer(binary, "<f4", 4 * accessor["count"], start)
    return flat.reshape(-1, 4)[:, [3, 0, 1, 2]].astype(np.float64)


def test_nodes_above_the_skeleton_place_it(glb: Path, motion: SourceMotion) -> None:
    """An armature that is turned, moved and scaled, as matrix or in parts, counts."""
    half = np.sqrt(0.5)

    def above(document: dict[str, Any]) -> None:
        armature = document["nodes"][-1]
        armature.update(rotation=[-half, 0, 0, half], scale=[2, 2, 2])
        whole = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1]
        document["nodes"].append({"matrix": whole, "children": [len(document["nodes"]) - 1]})
        document["scenes"][0]["nodes"] = [len(document["nodes"]) - 1]

    back = read_gltf(changed(glb, above))
    x, y, z = np.moveaxis(metres(motion), -1, 0)
    expected = 2.0 * np.stack([x, z, -y], axis=-1) + [0.5, 0.0, 0.0]
    np.testing.assert_allclose(metres(back), expected, atol=1e-5)


def test_without_a_skin_what_moves_is_the_skeleton(glb: Path, motion: SourceMotion) -> None:
    """Joints in the order of the tree, those between them too."""

    def bare(document: dict[str, Any]) -> None:
        del document["skins"], document["meshes"]
        document["nodes"] = document["nodes"][:-2]
        document["scenes"][0]["nodes"] = [0]

    back = read_gltf(changed(glb, bare))
    np.testing.assert_allclose(metres(back), metres(motion), atol=1e-5)


def test_several_animations_and_stray_joints_are_noted(glb: Path) -> None:
    """The first animation and the largest tree are read, and it is said."""

    def more(document: dict[str, Any]) -> None:
        document["animations"].append({**document["animations"][0], "name": "other"})
        document["nodes"].append({"name": "Prop"})
        document["skins"][0]["joints"].append(len(document["nodes"]) - 1)

    back = read_gltf(changed(glb, more))
    assert len(back.skeleton) == 22
    assert sorted(back.notes) == ["1 joints beside the skeleton", "2 animations; sway was read"]


def test_keys_may_be_sparse(tmp_path: Path) -> None:
    """Two keys and a third: positions lie on lines, steps and splines as the specification says."""
    for way, middle in (("LINEAR", 0.5), ("STEP", 0.0), ("CUBICSPLINE", 0.75)):
        back = read_gltf(two_keys(tmp_path / f"{way}.gltf", way))
        at = round(0.5 * back.frame_rate)
        assert back.root_positions[at, 0] == pytest.approx(middle, abs=1e-6)
        assert back.root_positions[-1, 0] == pytest.approx(1.0)


def two_keys(path: Path, way: str) -> Path:
    """Write a `.gltf`, buffer in its text: one node goes from 0 to 1 m in 1 s, another turns."""
    import base64

    dense = np.linspace(0.0, 1.0, 31)
    turning = np.stack([0 * dense, np.sin(dense), 0 * dense, np.cos(dense)], axis=-1)
    keys = np.array([[0.0, 0, 0], [1.0, 0, 0]])
    if way == "CUBICSPLINE":  # leaves at 2 m/s, arrives at rest
        none = np.zeros(3)
        keys = np.array([none, keys[0], [2.0, 0, 0], none, keys[1], none])
    blocks = [np.array([0.0, 1.0]), keys, dense, turning]
    data = [block.astype("<f4").tobytes() for block in blocks]
    starts = np.cumsum([0, *map(len, data)])
    kinds = ["SCALAR", "VEC3", "SCALAR", "VEC4"]
    document = {
        "asset": {"version": "2.0"},
        "buffers": [
            {
                "byteLength": int(starts[-1]),
                "uri": "data:application/octet-stream;base64,"
                + base64.b64encode(b"".join(data)).decode(),
            }
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": int(start), "byteLength": len(block)}
            for start, block in zip(starts, data, strict=False)
        ],
        "accessors": [
            {"bufferView": i, "componentType": 5126, "count": len(blocks[i]), "type": kind}
            for i, kind in enumerate(kinds)
        ],
        "nodes": [{"children": [1]}, {"translation": [0, 1, 0]}],
        "animations": [
            {
                "channels": [
                    {"sampler": 0, "target": {"node": 0, "path": "translation"}},
                    {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
                ],
                "samplers": [
                    {"input": 0, "output": 1, "interpolation": way},
                    {"input": 2, "output": 3},
                ],
            }
        ],
    }
    path.write_text(json.dumps(document))
    return path


def out_of_the_folder(document: dict[str, Any]) -> None:
    """Name a buffer elsewhere."""
    document["buffers"][0]["uri"] = "../secret.bin"


def a_ring(document: dict[str, Any]) -> None:
    """Put the first joint below its last."""
    document["nodes"][21]["children"] = [0]
    del document["nodes"][-1]["children"]


def out_of_bounds(document: dict[str, Any]) -> None:
    """Promise more keys than there are."""
    document["accessors"][document["animations"][0]["samplers"][0]["output"]]["count"] = 10**9


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.pop("animations"), "no animation"),
        (lambda d: d.update(extensionsRequired=["EXT_meshopt_compression"]), "meshopt"),
        (lambda d: d["animations"][0].update(channels=[]), "moves nothing"),
        (lambda d: d["animations"][0]["samplers"][0].update(output=999), "can be read"),
        (out_of_bounds, "out of its buffer"),
        (out_of_the_folder, "beside it"),
        (a_ring, "below itself"),
    ],
)
def test_what_cannot_be_read_is_a_sentence(glb: Path, change: Change, message: str) -> None:
    """The file and what is wrong, no traceback and nothing read elsewhere."""
    with pytest.raises(FormatError, match=message) as error:
        read_gltf(changed(glb, change))
    assert "sway.glb" in str(error.value)


@given(st.data())
def test_damaged_files_are_refused_or_read(tmp_path_factory: Any, data: st.DataObject) -> None:
    """Any bytes changed or cut off: a motion or FormatError, nothing else."""
    path = tmp_path_factory.getbasetemp() / "damaged.gltf"
    text = bytearray(two_keys(path, "LINEAR").read_bytes())
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(text) - 1))
        text[at] = data.draw(st.integers(0, 255))
    path.write_bytes(text[: data.draw(st.integers(0, len(text)))])
    with suppress(FormatError):
        assert len(read_gltf(path)) > 0


@pytest.mark.parametrize("cut", [0, 3, 11, 15, 200, 5000])
def test_cut_off_files_are_refused(glb: Path, cut: int) -> None:
    """Wherever a GLB ends early."""
    glb.write_bytes(glb.read_bytes()[:cut])
    with pytest.raises(FormatError, match=r"sway\.glb"):
        read_gltf(glb)
