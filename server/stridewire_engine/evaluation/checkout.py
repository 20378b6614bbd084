"""The checkout that code runs from: which commit made a figure."""

import subprocess
from pathlib import Path

CHANGED = "-changed"


def commit(file: Path = Path(__file__)) -> str:
    """Return the commit that code is of, with `-changed` where tracked files differ from it.

    Args:
        file: Of the code.

    Returns:
        Empty where the code is installed, not run from a checkout.
    """
    here = file.parent
    name = _git(here, "rev-parse", "--short=12", "HEAD")
    # a package inside of somebody else's checkout is not of its commit
    if not name or not _git(here, "ls-files", file.name):
        return ""
    return name + (CHANGED if _git(here, "status", "--porcelain", "--untracked-files=no") else "")


def _git(folder: Path, *arguments: str) -> str:
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=folder, capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout.strip()
