"""Mapping an unknown skeleton onto the reference: by the names of its joints, else by its shape.

Names only have to give away the ends (feet, hands, head) and the sides; what lies between follows
from the tree, so that `LeftShoulder` may be a collar bone in one file, an upper arm in another.
"""

import re
from dataclasses import dataclass

import numpy as np

from stridewire.motion.array_types import Floats
from stridewire.motion.skeleton import Skeleton
from stridewire_engine.rigs.joint_names import bare_names, split_name

_SIDES = {"Left": "left", "Right": "right"}
_FEET = {"foot", "ankle"}
_HANDS = {"hand", "wrist"}
_TOES = {"toe", "toes", "toebase", "forefoot", "ball"}
_IGNORED = re.compile(r"twist|share|roll|rigmesh|end$")


class MappingError(ValueError):
    """A skeleton is not a human's, or the message says which joint could not be told."""


@dataclass(frozen=True)
class JointMap:
    """Which joint of a skeleton plays which part."""

    joints: dict[str, str]
    """Source joint by reference joint; parts that the skeleton lacks are absent."""
    uncertain: tuple[str, ...] = ()
    """What was guessed, in words."""


def map_joints(skeleton: Skeleton) -> JointMap:
    """Find the parts of a human among a skeleton's joints.

    Raises:
        MappingError: If there are no two legs and two arms on a trunk.
    """
    try:
        return _by_names(skeleton)
    except MappingError as error:
        try:
            return _by_shape(skeleton)
        except MappingError:
            raise error from None


def _by_names(skeleton: Skeleton) -> JointMap:
    parts = [split_name(name) for name in bare_names(skeleton)]
    joints: dict[str, int] = {}
    for prefix, side in _SIDES.items():
        foot = _first(parts, side, _FEET, f"{side} foot or ankle")
        leg = _chain(skeleton, foot, 2, f"{side} leg")
        joints |= {f"{prefix}UpLeg": leg[0], f"{prefix}Leg": leg[1], f"{prefix}Foot": foot}
        toe = _toe(skeleton, parts, foot)
        if toe is not None:
            joints[f"{prefix}Toe"] = toe
        hand = _first(parts, side, _HANDS, f"{side} hand or wrist")
        arm = _chain(skeleton, hand, 2, f"{side} arm")
        joints |= {f"{prefix}Arm": arm[0], f"{prefix}ForeArm": arm[1], f"{prefix}Hand": hand}
    return _with_trunk(skeleton, joints, ())


def _first(parts: list[tuple[str, str]], side: str, words: set[str], what: str) -> int:
    for index, (of, core) in enumerate(parts):
        if of == side and core in words:
            return index
    raise MappingError(f"no joint is named like a {what}")


def _chain(skeleton: Skeleton, end: int, length: int, what: str) -> list[int]:
    """Return the `length` ancestors of a joint, outermost last, skipping twist bones."""
    chain: list[int] = []
    joint = skeleton.parents[end]
    while len(chain) < length and joint >= 0:
        if not _IGNORED.search(skeleton.names[joint].lower()):
            chain.append(joint)
        joint = skeleton.parents[joint]
    if len(chain) < length or joint < 0:
        raise MappingError(f"the {what} has fewer joints than a human's")
    return chain[::-1]


def _toe(skeleton: Skeleton, parts: list[tuple[str, str]], foot: int) -> int | None:
    for child, parent in enumerate(skeleton.parents):
        if parent == foot and parts[child][1] in _TOES:
            return child
    return None


def _with_trunk(skeleton: Skeleton, joints: dict[str, int], uncertain: tuple[str, ...]) -> JointMap:
    """Add hips, spine, neck, head and shoulders to the limbs."""
    hips = _common(skeleton, joints["LeftUpLeg"], joints["RightUpLeg"])
    chest = _common(skeleton, joints["LeftArm"], joints["RightArm"])
    trunk_root = _common(skeleton, hips, chest)
    spine = [j for j in _path(skeleton, chest) if j not in _path(skeleton, trunk_root)]
    joints["Hips"] = hips
    if not spine:
        raise MappingError("there is no spine between the hips and the arms")
    joints |= _spine(spine)
    joints |= _head(skeleton, chest, joints)
    for prefix in _SIDES:
        between = [
            j
            for j in _path(skeleton, joints[f"{prefix}Arm"])[:-1]
            if j not in _path(skeleton, chest)
        ]
        if between:
            joints[f"{prefix}Shoulder"] = between[0]
    return JointMap({part: skeleton.names[j] for part, j in joints.items()}, uncertain)


def _spine(spine: list[int]) -> dict[str, int]:
    """Choose three of the spine's joints: the lowest, the highest and one halfway."""
    if len(spine) == 1:
        return {"Spine2": spine[0]}
    if len(spine) == 2:
        return {"Spine": spine[0], "Spine2": spine[1]}
    return {"Spine": spine[0], "Spine1": spine[len(spine) // 2], "Spine2": spine[-1]}


def _head(skeleton: Skeleton, chest: int, joints: dict[str, int]) -> dict[str, int]:
    arms = {j for side in _SIDES for j in _path(skeleton, joints[f"{side}Hand"])}
    above = [
        j
        for j, parent in enumerate(skeleton.parents)
        if j not in arms and chest in _path(skeleton, j) and parent >= 0
    ]
    bare = bare_names(skeleton)
    names = {j: split_name(bare[j])[1] for j in above}
    head = next((j for j in above if names[j] == "head"), None)
    necks = [j for j in above if "neck" in names[j] and not _IGNORED.search(names[j])]
    if not necks:
        necks = [j for j in above if "necktwist" in names[j]]
    if head is None and not necks:
        necks = [j for j in above if skeleton.parents[j] == chest][:1]
        necks += [j for j in above if necks and skeleton.parents[j] == necks[0]][:1]
    found = {"Neck": necks[0]} if necks else {}
    if head is None and len(necks) > 1:
        head = necks[-1]
    return found | ({"Head": head} if head is not None else {})


def _path(skeleton: Skeleton, joint: int) -> list[int]:
    """Return the joints from the root to this one."""
    path = []
    while joint >= 0:
        path.append(joint)
        joint = skeleton.parents[joint]
    return path[::-1]


def _common(skeleton: Skeleton, a: int, b: int) -> int:
    shared = [x for x, y in zip(_path(skeleton, a), _path(skeleton, b), strict=False) if x == y]
    if not shared:
        raise MappingError("the limbs hang on no common joint")
    return shared[-1]


def _by_shape(skeleton: Skeleton) -> JointMap:
    """Tell legs and arms by the tree: the two pairs of longest mirrored chains on one trunk."""
    pairs = _longest(skeleton, _pairs(skeleton, _limbs(skeleton)))
    if len(pairs) < 2:
        raise MappingError("the tree has no two pairs of limbs")
    depth = [len(_path(skeleton, _common(skeleton, pair[0][0], pair[1][0]))) for pair in pairs]
    legs = pairs[int(np.argmin(depth))]
    arms = pairs[int(np.argmax(depth))]
    if legs is arms:
        raise MappingError("legs and arms hang on the same joint")
    joints: dict[str, int] = {}
    for prefix, leg, arm in zip(_SIDES, legs, arms, strict=True):
        joints |= {f"{prefix}UpLeg": leg[0], f"{prefix}Leg": leg[1], f"{prefix}Foot": leg[2]}
        if len(leg) > 3:
            joints[f"{prefix}Toe"] = leg[3]
        arm = arm[len(arm) > 3 :]
        joints |= {f"{prefix}Arm": arm[0], f"{prefix}ForeArm": arm[1], f"{prefix}Hand": arm[2]}
    return _with_trunk(
        skeleton, joints, ("all joints were told by the shape of the tree, not by their names",)
    )


def _longest(
    skeleton: Skeleton, pairs: list[tuple[list[int], list[int]]]
) -> list[tuple[list[int], list[int]]]:
    """Return the pairs at least a third as long as the longest: no fingers, no feathers."""
    lengths = [np.linalg.norm(skeleton.offsets[left[1:]], axis=-1).sum() for left, _ in pairs]
    least = max(lengths, default=0.0) / 3.0
    return [pair for pair, length in zip(pairs, lengths, strict=True) if length >= least]


def _limbs(skeleton: Skeleton) -> list[list[int]]:
    """Return unbranched chains of at least three joints below branching ones."""
    children: list[list[int]] = [[] for _ in skeleton.names]
    for child, parent in enumerate(skeleton.parents[1:], start=1):
        children[parent].append(child)
    chains = []
    for joint, below in enumerate(children):
        for child in below if len(below) > 1 else []:
            chain = [child]
            while len(children[chain[-1]]) == 1:
                chain.append(children[chain[-1]][0])
            if len(chain) >= 3 and joint >= 0:
                chains.append(chain)
    return chains


def _pairs(skeleton: Skeleton, chains: list[list[int]]) -> list[tuple[list[int], list[int]]]:
    """Pair chains of one parent and of alike bones; the left one first."""
    pairs = []
    for i, a in enumerate(chains):
        for b in chains[i + 1 :]:
            if skeleton.parents[a[0]] != skeleton.parents[b[0]] or len(a) != len(b):
                continue
            lengths: list[Floats] = [
                np.linalg.norm(skeleton.offsets[c[1:]], axis=-1) for c in (a, b)
            ]
            if np.allclose(lengths[0], lengths[1], rtol=0.1):
                across = skeleton.offsets[a[0]] - skeleton.offsets[b[0]]
                side = across[np.argmax(np.abs(across))]
                pairs.append((a, b) if side > 0.0 else (b, a))
    return pairs
