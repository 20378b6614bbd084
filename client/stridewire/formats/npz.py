"""Motions as NumPy archives: the arrays of a `SourceMotion` under their names."""

import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from stridewire.formats.source_motion import FormatError, SourceMotion
from stridewire.motion.skeleton import Skeleton, SkeletonError

_NEEDED = ("names", "parents", "offsets", "root_positions", "rotations")


def write_npz(path: Path | str, motion: SourceMotion) -> None:
    """Write a motion as a compressed archive.

    It holds `names` (J), `parents` (J), `offsets` (J, 3), `root_positions` (T, 3), `rotations`
    (T, J, 4; w x y z), `tip_joints` (E), `tips` (E, 3) and, where known, `frame_rate`,
    `metres_per_unit` and `translations` (T, J, 3).

    Raises:
        OSError: If the file cannot be written.
    """
    known: dict[str, Any] = {
        "frame_rate": motion.frame_rate,
        "metres_per_unit": motion.metres_per_unit,
        "translations": motion.translations,
    }
    with Path(path).open("wb") as file:
        np.savez_compressed(
            file,
            names=np.array(motion.skeleton.names),
            parents=np.array(motion.skeleton.parents),
            offsets=motion.skeleton.offsets,
            tip_joints=np.array(list(motion.tips), np.int64),
            tips=np.array(list(motion.tips.values())).reshape(-1, 3),
            root_positions=motion.root_positions,
            rotations=motion.rotations,
            **{name: value for name, value in known.items() if value is not None},
        )


def read_npz(path: Path | str) -> SourceMotion:
    """Read what `write_npz` wrote.

    Raises:
        FormatError: If arrays are missing, do not fit together or are not finite.
        OSError: If the file cannot be opened.
    """
    path = Path(path)
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (ValueError, EOFError, zipfile.BadZipFile, KeyError) as error:
        raise FormatError(path, f"no NumPy archive ({error})") from None
    if missing := [name for name in _NEEDED if name not in arrays]:
        raise FormatError(path, f"lacks {', '.join(missing)}; write it with `stridewire convert`")
    try:
        return _motion(path, arrays)
    except (SkeletonError, ValueError, TypeError, IndexError) as error:
        raise FormatError(path, f"{error}") from None


def _motion(path: Path, arrays: dict[str, np.ndarray]) -> SourceMotion:
    skeleton = Skeleton(
        tuple(map(str, arrays["names"])),
        tuple(map(int, arrays["parents"])),
        arrays["offsets"].astype(np.float64),
    )
    frames, joints = len(arrays["root_positions"]), len(skeleton)
    shapes = {
        "root_positions": (frames, 3),
        "rotations": (frames, joints, 4),
        "translations": (frames, joints, 3),
    }
    for name, shape in shapes.items():
        if name in arrays and arrays[name].shape != shape:
            raise ValueError(f"{name} has shape {arrays[name].shape}; expected {shape}")
        if name in arrays and not np.all(np.abs(arrays[name].astype(np.float64)) < 1e9):
            raise ValueError(f"{name} is not finite")
    if frames == 0 or np.abs(np.linalg.norm(arrays["rotations"], axis=-1) - 1.0).max() > 1e-3:
        raise ValueError("expected at least one frame and unit quaternions w, x, y, z")
    joints_with_tips = map(int, arrays.get("tip_joints", np.zeros(0)))
    moving = arrays.get("translations")
    return SourceMotion(
        path=path,
        skeleton=skeleton,
        tips=dict(zip(joints_with_tips, arrays.get("tips", np.zeros((0, 3))), strict=True)),
        frame_rate=float(arrays["frame_rate"]) if "frame_rate" in arrays else None,
        root_positions=arrays["root_positions"].astype(np.float64),
        rotations=arrays["rotations"].astype(np.float64),
        translations=None if moving is None else moving.astype(np.float64),
        metres_per_unit=float(arrays["metres_per_unit"]) if "metres_per_unit" in arrays else None,
    )
