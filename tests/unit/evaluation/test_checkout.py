"""Which commit made a figure: told by a checkout, of its own code only."""

import subprocess
from pathlib import Path

import pytest

from stridewire_engine.evaluation.checkout import CHANGED, commit


def git(folder: Path, *arguments: str) -> None:
    """Run git in a folder as a person of no fame."""
    person = ("-c", "user.name=a", "-c", "user.email=a@example.org")
    subprocess.run(["git", *person, *arguments], cwd=folder, check=True, capture_output=True)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Return a checkout with one committed file, `code.py`."""
    (tmp_path / "code.py").write_text("1\n")
    git(tmp_path, "init")
    git(tmp_path, "add", "code.py")
    git(tmp_path, "commit", "-m", "Begin")
    return tmp_path


def test_the_commit_is_told_and_what_differs_from_it(checkout: Path) -> None:
    """Changed code is not the commit's; files that git does not know change nothing."""
    name = commit(checkout / "code.py")
    assert len(name) == 12
    (checkout / "notes.txt").write_text("new\n")
    assert commit(checkout / "code.py") == name
    (checkout / "code.py").write_text("2\n")
    assert commit(checkout / "code.py") == name + CHANGED


def test_installed_code_has_no_commit(
    checkout: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Neither outside of a checkout, nor in one that does not hold the code."""
    (checkout / "site.py").write_text("1\n")
    assert commit(checkout / "site.py") == ""
    assert commit(tmp_path_factory.mktemp("nowhere") / "code.py") == ""
