"""Control scripts: deterministic, different by character, at the speeds that they promise."""

import numpy as np
import pytest

from stridewire import NotFoundError
from stridewire.scripts import SCRIPT_NAMES, Controls, script

FRAMES = np.arange(0.0, 20.0, 0.1)


def run(name: str, characters: int = 16, seed: int = 3) -> Controls:
    """Return 20 s of a script: velocities `(T, N, 2)` and facings `(T, N)`."""
    controls = [script(name).controls(float(time), characters, seed) for time in FRAMES]
    return Controls(
        np.stack([c.velocity for c in controls]), np.stack([c.facing for c in controls])
    )


def speeds(name: str) -> set[float]:
    """Return the speeds that occur, to a centimetre per second."""
    speed = np.linalg.norm(run(name).velocity.astype(np.float64), axis=-1)
    return set(speed.round(2).ravel().tolist())


@pytest.mark.parametrize("name", SCRIPT_NAMES)
def test_controls_have_the_shapes_of_a_step(name: str) -> None:
    """Float32, one row a character, also for none and one."""
    for characters in (0, 1, 5):
        velocity, facing = script(name).controls(1.5, characters, 0)
        assert (velocity.shape, facing.shape) == ((characters, 2), (characters,))
        assert velocity.dtype == facing.dtype == np.float32
        assert np.isfinite(velocity).all()


@pytest.mark.parametrize("name", SCRIPT_NAMES)
def test_same_seed_same_controls(name: str) -> None:
    """Nothing but the arguments decides."""
    for one, other in zip(run(name), run(name), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("name", [n for n in SCRIPT_NAMES if n != "idle"])
def test_characters_and_seeds_differ(name: str) -> None:
    """No two characters and no two seeds walk alike."""
    velocity = run(name).velocity
    assert len(np.unique(velocity.swapaxes(0, 1).reshape(16, -1), axis=0)) == 16
    assert not np.array_equal(velocity, run(name, seed=4).velocity)


@pytest.mark.parametrize("name", SCRIPT_NAMES)
def test_a_character_does_not_depend_on_the_others(name: str) -> None:
    """Character 2 of 3 does what character 2 of 16 does."""
    np.testing.assert_array_equal(run(name, 3).velocity, run(name).velocity[:, :3])


def test_speeds_are_walk_jog_and_sprint() -> None:
    """1.3, 2.5 and 4 m/s, and 0 where a script stops."""
    assert speeds("stroll") == speeds("circle") == {1.3}
    assert speeds("sprint") == {4.0}
    assert speeds("zigzag") == {2.5}
    assert speeds("stop-and-go") == {0.0, 1.3, 2.5}
    assert speeds("u-turns") == {1.3, 2.5}
    assert speeds("idle") == {0.0}
    assert speeds("random-stick") == {0.0, 1.3, 2.5, 4.0}
    assert speeds("walk-turn-stop") == {0.0, 1.3}


def test_u_turns_turn_right_about() -> None:
    """Where the direction changes it is reversed."""
    velocity = run("u-turns").velocity[:, 0]
    direction = velocity / np.linalg.norm(velocity, axis=-1, keepdims=True)
    cosines = np.sum(direction[1:] * direction[:-1], axis=-1)
    turns = cosines < 0.999
    np.testing.assert_allclose(cosines[turns], -1.0, atol=1e-5)
    assert 5 <= turns.sum() <= 6


def test_strafing_faces_one_way_and_moves_all_ways() -> None:
    """Four directions of movement, one facing; other scripts face along the way."""
    velocity, facing = run("strafe")
    assert (facing == facing[0]).all()
    heading = np.arctan2(velocity[..., 0], velocity[..., 1])
    relative = np.round(np.degrees(heading - facing) % 360.0) % 360.0
    assert set(relative.ravel().tolist()) == {0.0, 90.0, 180.0, 270.0}
    assert np.isnan(run("stroll").facing).all()


def test_walk_turn_stop_does_what_it_says() -> None:
    """From second 0: walk, at 4 s a right angle, at 7 s stand."""
    velocity = run("walk-turn-stop").velocity
    walking, turned, standing = velocity[10], velocity[50], velocity[80]
    np.testing.assert_allclose(np.sum(walking * turned, axis=-1), 0.0, atol=1e-5)
    assert not standing.any()


def test_a_random_stick_holds_for_a_while() -> None:
    """Pushes last between 0.4 s and 2 s or their multiples, not one frame."""
    velocity = run("random-stick").velocity
    changes = np.any(velocity[1:] != velocity[:-1], axis=-1)
    pushes = changes.sum(axis=0)
    assert (pushes >= 8).all()
    assert (pushes <= 22).all()


def test_an_unknown_name_lists_the_names() -> None:
    """The error says what there is."""
    with pytest.raises(NotFoundError, match=r"'moonwalk'; there are stroll, sprint.*walk-turn-sto"):
        script("moonwalk")


def test_every_script_says_what_it_does() -> None:
    """Lists of scripts have a line for each."""
    assert all(script(name).description.endswith(".") for name in SCRIPT_NAMES)
