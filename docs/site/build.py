"""`make site`: the documents as web pages, every link checked.

    python docs/site/build.py [FOLDER]

Pages lie on the site as in the repository, so that their links hold in both; what they link to
beside pages, such as the contract, is copied along. A link to a folder gets a page that lists it.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
CONFIG = Path(__file__).with_name("mkdocs.yml")

SECTIONS = {
    "Start": ["README.md", "docs/quick-start.md", "docs/concepts.md", "docs/play.md"],
    "Use": [
        "docs/serving.md", "docs/engines.md", "docs/output.md", "docs/playout.md",
        "docs/search.md", "docs/blending.md", "docs/files.md", "docs/troubleshooting.md",
    ],
    "Libraries": ["docs/import.md", "docs/your-own-capture.md", "docs/synthetic.md"],
    "Inside": ["docs/architecture.md", "docs/motion.md", "CONTRIBUTING.md", "CHANGELOG.md"],
    "Figures": ["docs/quality.md", "docs/performance.md"],
    "Reference": ["docs/reference.md"],
}  # fmt: skip
"""Pages in the order in which they are offered; those that nobody named come at the end."""

LINK = re.compile(r"(?<=\]\()([^)#:\s]+)(?=[)#])")


def build(site: Path, root: Path = ROOT) -> None:
    """Write the site into a folder.

    Args:
        site: The folder.
        root: Of the repository.

    Raises:
        subprocess.CalledProcessError: If a link leads nowhere.
    """
    with tempfile.TemporaryDirectory() as folder:
        pages, config = Path(folder) / "pages", Path(folder) / "mkdocs.yml"
        pages.mkdir()
        for page in _pages(root):
            _copy(root, page, pages)
        config.write_text(f"{CONFIG.read_text()}docs_dir: pages\nnav:\n{_navigation(pages)}")
        command = [sys.executable, "-m", "mkdocs", "build", "--strict"]
        quiet = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}  # an advertisement
        out = ["-f", str(config), "-d", str(site.resolve())]
        subprocess.run([*command, *out], check=True, env=quiet)


def _pages(root: Path) -> list[Path]:
    """Return the documents, relative to the repository."""
    found = [*root.glob("*.md"), *(root / "docs").rglob("*.md")]
    return sorted(page.relative_to(root) for page in found)


def _copy(root: Path, page: Path, pages: Path) -> None:
    """Copy a page and what it links to; links to folders become links to a list of them."""

    def follow(match: re.Match[str]) -> str:
        target = (root / page.parent / match[1]).resolve()
        if not target.is_relative_to(root) or target.suffix == ".md":
            return match[1]
        if target.is_dir():
            _list(root, target, pages)
            return f"{match[1].rstrip('/')}/README.md"
        if target.is_file():
            _place(root, target, pages)
        return match[1]

    out = pages / page
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(LINK.sub(follow, (root / page).read_text()))


def _list(root: Path, folder: Path, pages: Path) -> None:
    """Write a page that links to the files of a folder."""
    files = sorted(path for path in folder.iterdir() if path.is_file())
    for file in files:
        _place(root, file, pages)
    place = folder.relative_to(root)
    lines = [f"# {place}\n", *(f"- [{file.name}]({file.name})" for file in files)]
    (pages / place / "README.md").write_text("\n".join(lines) + "\n")


def _place(root: Path, file: Path, pages: Path) -> None:
    out = pages / file.relative_to(root)
    out.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(file, out)


def _navigation(pages: Path) -> str:
    """Return the navigation as YAML: sections in order, what they leave out at the end."""
    present = {str(page.relative_to(pages)) for page in pages.rglob("*.md")}
    sections: dict[str, Any] = {
        title: [page for page in named if page in present] for title, named in SECTIONS.items()
    }
    rest = sorted(present.difference(*sections.values()))
    sections["Decisions"] = [page for page in rest if "/adr/" in page]
    sections["More"] = [page for page in rest if "/adr/" not in page]
    lines = []
    for title, named in sections.items():
        if named:
            lines += [f"  - {title}:", *(f"      - {page}" for page in named)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    build(Path(sys.argv[1]) if sys.argv[1:] else ROOT / "build" / "site")
