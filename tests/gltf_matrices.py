"""A second reader of GLB: the specification's 4 x 4 matrices and nothing of ours."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np


def parts(path: Path) -> tuple[dict[str, Any], bytes]:
    """Return JSON and binary of a GLB, taken apart by hand."""
    raw = path.read_bytes()
    length = struct.unpack("<I", raw[12:16])[0]
    return json.loads(raw[20 : 20 + length]), raw[28 + length :]


def by_matrices(path: Path) -> np.ndarray:
    """Return the joints `(T, J, 3)` by the glTF specification's 4 x 4 matrices, keys as they are.

    Another way than the reader's: no code of it is used.
    """
    document, binary = parts(path)

    def values(index: int) -> np.ndarray:
        accessor = document["accessors"][index]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start = document["bufferViews"][accessor["bufferView"]]["byteOffset"]
        flat = np.frombuffer(binary, "<f4", accessor["count"] * width, start)
        return flat.reshape(-1, width).astype(np.float64)

    animation = document["animations"][0]
    frames = len(values(animation["samplers"][0]["input"]))
    local = np.tile(np.eye(4), (frames, len(document["nodes"]), 1, 1))
    for index, node in enumerate(document["nodes"]):
        local[:, index, :3, 3] = node.get("translation", [0, 0, 0])
    for channel in animation["channels"]:
        keys = values(animation["samplers"][channel["sampler"]]["output"])
        node = channel["target"]["node"]
        if channel["target"]["path"] == "translation":
            local[:, node, :3, 3] = keys
        else:
            local[:, node, :3, :3] = np.stack([matrix(*key) for key in keys])
    world = local.copy()
    for index, node in enumerate(document["nodes"]):
        for child in node.get("children", []):
            world[:, child] = world[:, index] @ local[:, child]
    return world[:, document["skins"][0]["joints"]][..., :3, 3]


def matrix(x: float, y: float, z: float, w: float) -> np.ndarray:
    """Return the rotation matrix of a unit quaternion."""
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
