"""Sources for engines that are not at hand: what they know of the contract is what it says."""

import re

from external import ROOT
from stridewire_server.websocket.layout import layout

EXAMPLES = ROOT / "examples"

UNITY_NAMES = {
    "AnimateRequest": ("Open", "Step"),
    "AnimateResponse": ("Opened", "Error", "Frame"),
    "CharacterSpec": ("Id",),
    "Frame": ("Frame_", "Root", "Hips", "Rotations"),
    "Open": ("Pacing", "Characters"),
    "Opened": ("Skeleton",),
    "Skeleton": ("Joints",),
    "Step": ("Step_", "LastFrame", "VelocityXz"),
}
"""Properties of generated classes that the component for Unity uses."""


def test_the_tags_of_the_unreal_actor_are_those_of_the_contract() -> None:
    """Every constant names a message and a field, and has its tag."""
    source = (EXAMPLES / "unreal" / "StridewireCharacter.cpp").read_text()
    constants = re.findall(r"constexpr uint32 ([A-Za-z]+)_(\w+) = (\d+);", source)
    told = layout()
    assert len(constants) == 18
    for message, field, value in constants:
        if message == "PACING":
            assert told["enums"]["Pacing"]["PACING_SERVER"] == int(value)
        else:
            assert told["messages"][message][field]["tag"] == int(value), (message, field)
    used = set(re.findall(r"Tag::(\w+)", source))
    assert used == {f"{m}_{f}" for m, f, _ in constants if m != "PACING"}


def test_the_godot_script_sends_and_reads_fields_that_exist() -> None:
    """Names in what it sends; names that it takes out of messages."""
    source = (EXAMPLES / "godot" / "stridewire_character.gd").read_text()
    messages = layout()["messages"]
    assert {"characters", "pacing"} <= set(messages["Open"])
    assert '"open": {"characters": [{"id": 1}], "pacing": 2}' in source
    sent = re.search(r'"step": \{(.+?)\}\}', source)
    assert sent is not None
    assert set(re.findall(r'"(\w+)":', sent[1])) <= set(messages["Step"])
    assert set(re.findall(r"\bframe\.(\w+)", source)) - {"frame"} <= set(messages["Frame"])
    assert "skeleton" in messages["Opened"]
    assert "joints" in messages["Skeleton"]
    kinds = {messages["Frame"][name]["type"] for name in ("root", "hips", "rotations")}
    assert kinds == {"float32"}


def test_the_unity_component_uses_names_that_protoc_makes() -> None:
    """By protoc's rule for C#: words capitalised; an underscore after a class's own name."""
    source = (EXAMPLES / "unity" / "StridewireCharacter.cs").read_text()
    messages = layout()["messages"]
    for message, properties in UNITY_NAMES.items():
        made = {in_csharp(field, message) for field in messages[message]}
        for name in properties:
            assert name in made, (message, name)
            assert re.search(rf"\b{name}\b", source), name
    assert "using Stridewire.V1;" in source
    assert "Pacing.Server" in source
    assert "PACING_SERVER" in layout()["enums"]["Pacing"]


def in_csharp(field: str, message: str) -> str:
    """Return the name of a field's property."""
    name = "".join(word.capitalize() for word in field.split("_"))
    return f"{name}_" if name == message else name
