"""Units are found from how high the hips stand; giants and dwarfs need one that is given."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.unit.building.figures import source

from stridewire.formats.bvh_writing import write_source_bvh
from stridewire.formats.units import UNITS, parse_unit, unit_name
from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.building.importing import Outcome, import_file
from stridewire_engine.building.onto_reference import onto_reference
from stridewire_engine.building.unit_finding import HIGHEST, LOWEST, UnitError, find_unit

FILE = Path("walk.bvh")


def written(folder: Path, scale: float) -> Path:
    """Write a walk of a human in units of which `scale` make a metre; return the file."""
    write_source_bvh(folder / "walk.bvh", source(scale=scale))
    return folder / "walk.bvh"


def imported(path: Path, metres_per_unit: float | None = None) -> Outcome:
    """Import it."""
    return import_file(path, metres_per_unit=metres_per_unit)


@pytest.mark.parametrize("name", list(UNITS))
def test_a_humans_unit_is_found(tmp_path: Path, name: str) -> None:
    """A human written in any known unit is recognised by height alone."""
    assert imported(written(tmp_path, 1.0 / UNITS[name])).unit == name


def test_no_height_fits_two_units() -> None:
    """Ranges of the units do not overlap, so the order of trying does not matter."""
    for hips in np.geomspace(1e-1, 1e4, 3000):
        assert sum(LOWEST <= hips * metres <= HIGHEST for metres in UNITS.values()) <= 1


@pytest.mark.parametrize(("scale", "what"), [(185.0, "168"), (53.0, "48"), (3e4, "2.73e")])
def test_no_human_by_any_unit_is_refused(tmp_path: Path, scale: float, what: str) -> None:
    """The sentence says what was found, what is allowed and which option helps."""
    with pytest.raises(UnitError, match=rf"stand at {what}.*0\.7 to 1\.1 m.*--unit"):
        imported(written(tmp_path, scale))


def test_a_given_unit_holds_for_giants(tmp_path: Path) -> None:
    """By a person's word a giant is scaled to a human, and a note says so."""
    outcome = imported(written(tmp_path, 185.0), 0.01)
    assert outcome.unit == "cm"
    assert any("hips stand at 1.68 m; scaled to a human" in note for note in outcome.notes)
    assert outcome.clip is not None
    assert np.median(outcome.clip.pose.hips[:, 1]) == pytest.approx(0.93, abs=0.05)


def test_a_stated_unit_is_believed_or_refused() -> None:
    """What the file says is not replaced by a unit that would fit."""
    assert find_unit(FILE, 91.0, 0.01) == (0.01, "")
    with pytest.raises(UnitError, match=r"16\.1 m by its own unit, 0\.1774 m"):
        find_unit(FILE, 91.0, 0.1774)


def test_the_reference_itself_must_be_a_human_too(tmp_path: Path) -> None:
    """A file on the reference skeleton at twice the size is as refused as any other."""
    with pytest.raises(UnitError):
        imported(written(tmp_path, 2.0))


def test_units_by_name_and_by_metres() -> None:
    """Both ways of giving a unit are read; others are refused with what is allowed."""
    assert parse_unit("cmu") == pytest.approx(0.0564, abs=1e-4)
    assert parse_unit("0.033") == 0.033
    assert unit_name(0.0254) == "inch"
    assert unit_name(0.033) == "0.033 m"
    for bad in ("cow", "0", "-1", "nan", "inf"):
        with pytest.raises(ValueError, match="expected m, dm, cm"):
            parse_unit(bad)


def test_bringing_a_file_onto_the_reference() -> None:
    """In inches with Z up comes out in centimetres with Y up, the ground at 0."""
    result = onto_reference(replace(source(scale=39.37, z_up=True), notes=("odd",)))
    assert result.skeleton.names == REFERENCE.names
    assert result.metres_per_unit == 0.01
    assert result.frame_rate == 60.0
    assert result.notes[0] == "odd"
    assert "its unit is inch" in result.notes[-1]
    assert np.median(result.root_positions[:, 1]) == pytest.approx(93.0, abs=4.0)
