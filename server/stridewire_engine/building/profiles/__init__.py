"""Joint-map profiles: how a family of skeletons maps onto the reference skeleton, as TOML."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from stridewire.motion import quaternion
from stridewire.motion.array_types import Quaternions
from stridewire.motion.skeleton import REFERENCE, Skeleton
from stridewire_engine.rigs.joint_names import bare_names

_AXES = {
    sign + letter: factor * np.eye(3)[index]
    for index, letter in enumerate("XYZ")
    for sign, factor in (("+", 1.0), ("-", -1.0))
}


NEEDED = (
    "Hips",
    *(
        side + part
        for side in ("Left", "Right")
        for part in ("UpLeg", "Leg", "Foot", "Arm", "ForeArm", "Hand")
    ),
)
"""Parts that every profile must map; the others follow their neighbours where they are absent."""


class ProfileError(ValueError):
    """A profile is malformed; the message names the file, the key and what is allowed."""


@dataclass(frozen=True)
class Profile:
    """How one family of skeletons maps onto the reference skeleton."""

    name: str
    title: str
    joints: Mapping[str, str]
    """Source joint by reference joint."""
    axes: Mapping[str, Quaternions] = field(default_factory=dict)
    """By reference joint the turn from the reference's T-pose to the joint's own axes; where absent
    the file's zero pose tells, or its average one."""
    up: str | None = None
    """`Y` or `Z`; None where the motion tells."""
    spine: tuple[str, ...] = ()
    """All joints from above the hips to where the arms part; empty where any will do."""

    def source_joints(self, skeleton: Skeleton) -> dict[str, str]:
        """Return the skeleton's full joint names by reference joint."""
        full = dict(zip(bare_names(skeleton), skeleton.names, strict=True))
        return {part: full.get(name, name) for part, name in self.joints.items()}

    def covers(self, skeleton: Skeleton) -> bool:
        """Return whether the skeleton has the profile's joints and its spine."""
        joints = self.source_joints(skeleton)
        if not set(joints.values()) <= set(skeleton.names):
            return False
        full = dict(zip(skeleton.names, bare_names(skeleton), strict=True))
        return not self.spine or self.spine == tuple(full[j] for j in spine(skeleton, joints))


def spine(skeleton: Skeleton, joints: Mapping[str, str]) -> list[str]:
    """Return the joints from above the hips to where the arms part, the lowest first."""

    def common(a: str, b: str) -> list[str]:
        paths = [_path(skeleton, skeleton.index(joints[part])) for part in (a, b)]
        return [x for x, y in zip(*paths, strict=False) if x == y]

    below = common("LeftUpLeg", "RightUpLeg")
    return [name for name in common("LeftArm", "RightArm") if name not in below]


def _path(skeleton: Skeleton, joint: int) -> list[str]:
    names = []
    while joint >= 0:
        names.append(skeleton.names[joint])
        joint = skeleton.parents[joint]
    return names[::-1]


def load_profile(path: Path) -> Profile:
    """Read a profile.

    Raises:
        ProfileError: If a key is missing, unknown or has a value that is not allowed.
        OSError: If the file cannot be opened.
    """
    return _parse(path.read_text(encoding="utf-8"), str(path))


def shipped_profiles() -> tuple[Profile, ...]:
    """Return the profiles that come with the package, in the order of their names."""
    folder = files(__name__)
    names = sorted(entry.name for entry in folder.iterdir() if entry.name.endswith(".toml"))
    return tuple(_parse((folder / name).read_text(encoding="utf-8"), name) for name in names)


def _parse(text: str, where: str) -> Profile:
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ProfileError(f"{where}: {error}; expected TOML") from None
    unknown = sorted(set(table) - {"name", "title", "up", "spine", "joints", "axes"})
    joints = table.get("joints")
    if unknown or not isinstance(table.get("name"), str) or not isinstance(joints, dict):
        wrong = f"unknown key {unknown[0]!r}" if unknown else "`name` or `[joints]` is missing"
        raise ProfileError(
            f"{where}: {wrong}; expected name, title, up, spine, [joints] and [axes]"
        )
    _check_joints(joints, where)
    if missing := [part for part in NEEDED if part not in joints]:
        raise ProfileError(
            f"{where}: [joints] lacks {', '.join(missing)}; legs, arms and hips must map"
        )
    axes: dict[str, Quaternions] = {}
    for group, entry in table.get("axes", {}).items():
        turn = _axes(entry, f"{where}: axes.{group}")
        _check_joints(dict.fromkeys(entry["joints"], ""), f"{where}: axes.{group}")
        axes.update(dict.fromkeys(entry["joints"], turn))
    up = table.get("up")
    if up not in (None, "Y", "Z"):
        raise ProfileError(f'{where}: up = {up!r}; expected "Y" or "Z"')
    chain = table.get("spine", [])
    if not isinstance(chain, list) or not all(isinstance(name, str) for name in chain):
        raise ProfileError(f"{where}: spine = {chain!r}; expected the names of its joints")
    title = str(table.get("title", table["name"]))
    return Profile(table["name"], title, joints, axes, up, tuple(chain))


def _check_joints(joints: Mapping[str, Any], where: str) -> None:
    for name, source in joints.items():
        if name not in REFERENCE.names or not isinstance(source, str):
            raise ProfileError(
                f"{where}: {name} = {source!r}; expected a reference joint "
                f"({', '.join(REFERENCE.names)}) and the name of a source joint"
            )


def _axes(entry: Any, where: str) -> Quaternions:
    try:
        up, forward = _AXES[entry["up"]], _AXES[entry["forward"]]
        joints, pitch = list(entry["joints"]), float(entry.get("pitch", 0.0))
    except (KeyError, TypeError, ValueError):
        joints, up, forward, pitch = [], _AXES["+X"], _AXES["+X"], 0.0
    if not joints or up @ forward != 0.0:
        raise ProfileError(
            f"{where}: expected joints = [names], up and forward such as '+X', across one another, "
            "and an optional pitch in degrees"
        )
    columns = np.stack([np.cross(up, forward), up, forward], axis=-1)
    tilt = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.array(np.deg2rad(-pitch)))
    turn = Rotation.from_matrix(columns).as_quat(scalar_first=True)
    return quaternion.multiply(turn, tilt)
