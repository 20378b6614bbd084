"""Where Blender puts the joints of two files of one motion; run with a Python that has `bpy`.

python in_blender.py walk.bvh walk.glb
"""

import sys
from pathlib import Path

import bpy  # type: ignore[import-not-found]
import numpy as np


def joints(path: Path, frame_rate: int = 60) -> dict[str, np.ndarray]:
    """Return by name where each joint is in every frame; metres, Blender's axes."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = frame_rate
    if path.suffix == ".bvh":
        axes = {"axis_forward": "-Z", "axis_up": "Y"}
        bpy.ops.import_anim.bvh(filepath=str(path), global_scale=0.01, **axes)
    else:
        bpy.ops.import_scene.gltf(filepath=str(path))
    rig = next(thing for thing in bpy.data.objects if thing.type == "ARMATURE")
    first, last = map(round, rig.animation_data.action.frame_range)
    places: dict[str, list[list[float]]] = {bone.name: [] for bone in rig.pose.bones}
    for frame in range(first, last + 1):
        bpy.context.scene.frame_set(frame)
        for bone in rig.pose.bones:
            places[bone.name].append(list(rig.matrix_world @ bone.head))
    return {name: np.array(rows) for name, rows in places.items()}


if __name__ == "__main__":
    one, other = (joints(Path(argument).resolve()) for argument in sys.argv[1:3])
    shared = sorted(set(one) & set(other))
    apart = max(np.abs(one[name] - other[name]).max() for name in shared)
    frames = len(one[shared[0]])
    print(f"{len(shared)} joints of {len(one)} and {len(other)}")
    print(f"largest difference: {1e3 * apart:.3f} mm in {frames} frames")
