"""What joint names say: prefixes of exporters, sides, and the word that is left."""

import re
from collections import Counter

from stridewire.motion.skeleton import Skeleton

_NOISE = {"jnt", "joint", "bone", "ctrl", "fk"}
_SIDED = {
    *("foot", "ankle", "hand", "wrist", "toe", "toes", "toebase", "thumb", "fingers", "buttock"),
    *("femur", "tibia", "humerus", "radius", "clavicle", "hipjoint", "shoulderjoint", "collar"),
    *("thigh", "shin", "shldr", "forearm"),
}
"""Words that a bare `l` or `r` may stand before."""


def bare_names(skeleton: Skeleton) -> tuple[str, ...]:
    """Return the names without an exporter's prefix (`mixamorig:`, `Model_`, `CC_Base_`)."""
    names = [re.split(r"[:|]", name)[-1] for name in skeleton.names]
    while True:
        heads = Counter(name.partition("_")[0] for name in names if "_" in name)
        head, count = heads.most_common(1)[0] if heads else ("", 0)
        if count <= len(names) // 2 or len(head) < 2:
            break
        names = [name.removeprefix(f"{head}_") for name in names]
    return tuple(names) if len(set(names)) == len(names) else skeleton.names


def split_name(name: str) -> tuple[str, str]:
    """Return side (`left`, `right` or empty) and what remains of a bare name, lower case.

    Understands `LeftUpLeg`, `lfemur`, `rShin`, `foot_L`, `L_foot_jnt`, `foot.L`.
    """
    words = re.sub(r"([a-z0-9])([A-Z])|([A-Z])(?=[A-Z][a-z])", r"\1\3_\2", name).lower()
    parts = [word for word in re.split(r"[_.\- ]+", words) if word]
    for index, word in enumerate(parts):
        if word in ("left", "l", "right", "r"):
            side = "left" if word[0] == "l" else "right"
            return side, _core(parts[index + 1 :] or parts[:index])
    joined = _core(parts)
    for side in ("left", "right"):
        if joined.startswith(side):
            return side, joined[len(side) :]
    if joined[:1] in ("l", "r") and joined[1:] in _SIDED:
        return ("left" if joined[0] == "l" else "right"), joined[1:]
    return "", joined


def _core(words: list[str]) -> str:
    return "".join([word for word in words if word not in _NOISE] or words)
