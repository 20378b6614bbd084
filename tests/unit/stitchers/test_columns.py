"""What stitchers keep is what characters keep for them."""

from dataclasses import fields

from stridewire_engine.runtime.characters import Characters
from stridewire_engine.stitchers import STITCH_COLUMNS, StitchState


def test_characters_keep_what_stitchers_need() -> None:
    """Same names, shapes and types, so that states go in and out of the tick's rows."""
    kept = {column.name: dict(column.metadata) for column in fields(Characters)}
    needed = {column.name: dict(column.metadata) for column in fields(StitchState)}
    assert {name: kept[name] for name in STITCH_COLUMNS} == needed


def test_a_fresh_state_is_all_zero() -> None:
    """Of as many rows as asked for."""
    state = StitchState.fresh(3, 22)
    assert state.offset_rotations.shape == (3, 22, 3)
    assert all(len(array) == 3 and not array.any() for array in vars(state).values())
