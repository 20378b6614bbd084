"""Profiles: every shipped one reads, malformed ones are refused with file and key."""

from pathlib import Path

import pytest
from tests.unit.building.figures import source

from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.profile_draft import draft_profile
from stridewire_engine.building.profiles import (
    NEEDED,
    ProfileError,
    load_profile,
    shipped_profiles,
)

LIMBS = "\n".join(f'{part} = "{part}"' for part in NEEDED)


def write(folder: Path, text: str) -> Path:
    """Write a profile."""
    path = folder / "mine.toml"
    path.write_text(text)
    return path


def test_shipped_profiles_read() -> None:
    """All names differ, and all map what a figure needs."""
    profiles = shipped_profiles()
    assert len({profile.name for profile in profiles}) == len(profiles) > 20
    for profile in profiles:
        assert set(NEEDED) <= set(profile.joints) <= set(REFERENCE.names)


def test_a_draft_reads_as_a_profile(tmp_path: Path) -> None:
    """What `library profile` prints can be given back."""
    motion = source(rename={"Hips": "Pelvis"})
    draft = draft_profile(motion, "mine", 'a "rig"')
    profile = load_profile(write(tmp_path, draft.to_toml()))
    assert profile.title == 'a "rig"'
    assert profile.joints["Hips"] == "Pelvis"
    assert profile.spine == ("Spine", "Spine1", "Spine2")
    assert profile.covers(motion.skeleton)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("name =", "expected TOML"),
        ("name = 'a'", r"`\[joints\]` is missing"),
        (f"name = 'a'\nrig = 1\n[joints]\n{LIMBS}", "unknown key 'rig'"),
        ("name = 'a'\n[joints]\nHips = 'Hips'", "lacks LeftUpLeg"),
        (f"name = 'a'\n[joints]\n{LIMBS}\nTail = 'tail'", "Tail = 'tail'"),
        (f"name = 'a'\nup = 'X'\n[joints]\n{LIMBS}", "up = 'X'"),
        (f"name = 'a'\nspine = 'Spine'\n[joints]\n{LIMBS}", "spine = 'Spine'"),
        (
            f"name = 'a'\n[joints]\n{LIMBS}\n[axes]\nl = {{joints=['Hips'], up='+X', forward='-X'}}",  # noqa: E501
            "across one another",
        ),
        (f"name = 'a'\n[joints]\n{LIMBS}\n[axes]\nl = {{joints=['Hips'], up='up'}}", "axes.l"),
    ],
)
def test_malformed_profiles_are_refused(tmp_path: Path, text: str, says: str) -> None:
    """The error names the file and what is allowed."""
    path = write(tmp_path, text)
    with pytest.raises(ProfileError, match=says) as caught:
        load_profile(path)
    assert str(path) in str(caught.value)
