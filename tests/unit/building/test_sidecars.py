"""Sidecars: rates and words from indexes, splits by subject."""

from pathlib import Path

import pytest

from stridewire_engine.building.importing import motion_files
from stridewire_engine.building.sidecars import Sidecar, SidecarError, Sidecars, read_splits

SPLITS = "data,subject,split\ncmu,06,test\ncmu,38,exclude\ncmu,*,train\nlafan1,subject4,test\n"


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """Return a folder of empty motions with an index and splits."""
    for file in (
        *("cmu/06/06_01.bvh", "cmu/07/07_01.amc", "cmu/38/38_1.bvh", "cmu/fragments/07_1.bvh"),
        *("cmu-more/06/06_13.bvh", "lafan1/walk_subject4.bvh", "lafan1/walk_subject1.bvh"),
    ):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).touch()
    (tmp_path / "cmu/index.csv").write_text(
        'file,subject,description,fps\n06/06_01.bvh,6,"walk, slow",60\n07/07_01.amc,7,run,\n'
    )
    (tmp_path / "split.csv").write_text(SPLITS)
    return tmp_path


def test_an_index_speaks_for_files_below_it(data: Path) -> None:
    """Rate, subject and description arrive; files that it does not name are blank."""
    sidecars = Sidecars()
    known = sidecars.of(data / "cmu/06/06_01.bvh")
    assert (known.subject, known.frame_rate, known.words) == ("6", 60.0, "walk, slow")
    assert sidecars.of(data / "cmu/07/07_01.amc").frame_rate is None
    assert sidecars.of(data / "cmu-more/06/06_13.bvh") == Sidecar()


@pytest.mark.parametrize("subject", ["6", "06", "006"])
def test_subjects_compare_as_integers(data: Path, subject: str) -> None:
    """06 and 6 are test, however the index pads them."""
    splits = read_splits(data / "split.csv")
    assert splits.of(data / "cmu/06/06_01.bvh", Sidecar(subject=subject)) == "test"


def test_splits_choose_files(data: Path) -> None:
    """A data set covers its extensions; fragments are never chosen for training."""
    splits = read_splits(data / "split.csv")

    def chosen(split: str) -> list[str]:
        return [path.name for path in motion_files([data], [split], splits)]

    assert set(chosen("test")) == {"06_01.bvh", "06_13.bvh", "walk_subject4.bvh"}
    assert chosen("train") == ["07_01.amc"]
    assert set(chosen("exclude")) == {"38_1.bvh", "07_1.bvh"}


def test_a_split_file_without_its_columns_is_refused(tmp_path: Path) -> None:
    """The error names the column and what the first line should be."""
    path = tmp_path / "split.csv"
    path.write_text("data,who,split\n")
    with pytest.raises(SidecarError, match="no column 'subject'"):
        read_splits(path)


def test_a_malformed_rate_in_an_index_is_refused(data: Path) -> None:
    """The error names the index and the file."""
    (data / "cmu/index.csv").write_text("file,fps\n06/06_01.bvh,fast\n")
    with pytest.raises(SidecarError, match=r"06_01\.bvh is 'fast'"):
        Sidecars().of(data / "cmu/06/06_01.bvh")
