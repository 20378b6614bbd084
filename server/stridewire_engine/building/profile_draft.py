"""Drafts of profiles: what was found out about a skeleton, to be checked by a person."""

from dataclasses import dataclass

from stridewire.formats.source_motion import SourceMotion
from stridewire.formats.units import unit_name
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.figure import Figure, hip_height, leg_length, see
from stridewire_engine.building.profiles import Profile, spine
from stridewire_engine.building.rest_pose import rest_rotations
from stridewire_engine.building.unit_finding import UnitError, find_unit
from stridewire_engine.rigs.joint_mapping import map_joints
from stridewire_engine.rigs.joint_names import bare_names


@dataclass(frozen=True)
class Draft:
    """A profile and what a person should check in it."""

    profile: Profile
    unit: str
    """Name of the unit of length; empty where none makes the figure as tall as a human."""
    doubts: tuple[str, ...]

    def to_toml(self) -> str:
        """Return the text of a profile file."""
        profile = self.profile
        lines = [f"# check: {doubt}" for doubt in self.doubts]
        lines += [f"name = {_quoted(profile.name)}", f"title = {_quoted(profile.title)}"]
        if profile.up:
            lines.append(f"up = {_quoted(profile.up)}")
        lines.append(f"spine = [{', '.join(map(_quoted, profile.spine))}]")
        lines += ["", "[joints]"]
        for part in REFERENCE.names:
            if part in profile.joints:
                lines.append(f"{part} = {_quoted(profile.joints[part])}")
        absent = [part for part in REFERENCE.names if part not in profile.joints]
        if absent:
            lines.append(f"# absent, follow their neighbours: {', '.join(absent)}")
        return "\n".join(lines) + "\n"


def draft_profile(source: SourceMotion, name: str, title: str) -> Draft:
    """Fill in a profile for a skeleton and say what is uncertain.

    Args:
        source: A motion on it.
        name: Of the profile.
        title: Of the family of skeletons.

    Raises:
        MappingError: If the parts of a human cannot be told.
    """
    mapped = map_joints(source.skeleton)
    bare = dict(zip(source.skeleton.names, bare_names(source.skeleton), strict=True))
    chain = tuple(bare[joint] for joint in spine(source.skeleton, mapped.joints))
    figure = see(source, mapped.joints)
    doubts = list(mapped.uncertain)
    if figure.turned_up:
        doubts.append('the motion has Z up; if all files of the family do, add up = "Z"')
    if rest_rotations(figure) is None:
        doubts.append(
            "zero angles are no standing pose, so joint axes come from each file's average pose; "
            "add [axes] if you know them (see docs/import.md)"
        )
    if not any(part.endswith("Toe") for part in mapped.joints):
        doubts.append("there are no toe joints; the feet's ends stand in")
    unit, doubt = _unit(source, figure)
    doubts += [doubt] if doubt else []
    joints = {part: bare[joint] for part, joint in mapped.joints.items()}
    return Draft(Profile(name, title, joints, spine=chain), unit, tuple(doubts))


def _unit(source: SourceMotion, figure: Figure) -> tuple[str, str]:
    """Return the name of the file's unit, or what is wrong with its size."""
    legs = figure.length("UpLeg", "Leg", "Foot")
    try:
        metres, _ = find_unit(
            source.path, hip_height() * legs / leg_length(), source.metres_per_unit
        )
    except UnitError as error:
        return "", str(error)
    return unit_name(metres), ""


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
