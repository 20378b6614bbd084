"""Preset schemas, and a user's own from a TOML file.

name = "mine"

[[channels]]
name = "foot-position"
kind = "position"
joints = ["LeftFoot", "RightFoot"]
weight = 0.5625

[[channels]]
name = "trajectory-position"
kind = "trajectory-position"
times = [0.333, 0.667, 1.0]
"""

import tomllib
from dataclasses import replace
from pathlib import Path

from stridewire_engine.matching.schema import Channel, ChannelKind, Schema, SchemaError

_AHEAD = (20 / 60, 40 / 60, 60 / 60)
_BACK = -20 / 60
_FEET = ("LeftFoot", "RightFoot")
_TOES = ("LeftToe", "RightToe")
_HANDS = ("LeftHand", "RightHand")

LOCOMOTION = Schema(
    "locomotion",
    (
        Channel("foot-position", ChannelKind.POSITION, 0.5625, joints=_FEET),
        Channel("foot-velocity", ChannelKind.VELOCITY, 1.0, joints=_FEET),
        Channel("hips-velocity", ChannelKind.VELOCITY, 1.0, joints=("Hips",)),
        Channel("trajectory-position", ChannelKind.TRAJECTORY_POSITION, 1.0, times=_AHEAD),
        Channel("trajectory-direction", ChannelKind.TRAJECTORY_DIRECTION, 2.25, times=_AHEAD),
    ),
)
"""The classic 27 features of Holden's *Motion-Matching*.

His weights are squared here, since cost is proportional to a weight.
"""

_FOOT_POSITION, _FOOT_VELOCITY, _HIPS_VELOCITY, _POSITION, _DIRECTION = LOCOMOTION.channels

PRESETS = {
    schema.name: schema
    for schema in (
        LOCOMOTION,
        Schema(
            "locomotion-toe",
            (
                replace(_FOOT_POSITION, name="toe-position", joints=_TOES),
                replace(_FOOT_VELOCITY, name="toe-velocity", joints=_TOES),
                _HIPS_VELOCITY,
                _POSITION,
                _DIRECTION,
            ),
        ),
        Schema(
            "locomotion-past",
            (
                _FOOT_POSITION,
                _FOOT_VELOCITY,
                _HIPS_VELOCITY,
                replace(_POSITION, times=(_BACK, *_AHEAD)),
                replace(_DIRECTION, times=(_BACK, *_AHEAD)),
            ),
        ),
        Schema(
            "strafe",
            (
                _FOOT_POSITION,
                _FOOT_VELOCITY,
                _HIPS_VELOCITY,
                Channel("hips-heading", ChannelKind.HEADING, 1.0, joints=("Hips",)),
                _POSITION,
                replace(_DIRECTION, weight=4.0),
            ),
        ),
        Schema(
            "full-body",
            (
                _FOOT_POSITION,
                _FOOT_VELOCITY,
                _HIPS_VELOCITY,
                Channel("hand-position", ChannelKind.POSITION, 0.25, joints=_HANDS),
                Channel("hand-velocity", ChannelKind.VELOCITY, 0.25, joints=_HANDS),
                _POSITION,
                _DIRECTION,
            ),
        ),
    )
}
"""All presets by name."""


def find_schema(name: str) -> Schema:
    """Return a preset by name, or read a schema from a `.toml` file.

    Raises:
        SchemaError: If there is neither, or the file is malformed.
    """
    if name in PRESETS:
        return PRESETS[name]
    path = Path(name)
    if path.suffix != ".toml":
        raise SchemaError(
            f"no preset {name!r}; presets: {', '.join(PRESETS)}; or give a .toml file"
        )
    try:
        return Schema.from_data(tomllib.loads(path.read_text(encoding="utf-8")))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SchemaError(f"{path} cannot be read: {error}") from error
    except SchemaError as error:
        raise SchemaError(f"{path}: {error}") from error
