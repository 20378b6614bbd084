"""The page's files: built of the sources that lie beside them, complete, asking nobody else."""

import hashlib
import re
from pathlib import Path

import pytest

from stridewire_server.page.site import POLICY, Site

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "server" / "stridewire_server" / "page"
SOURCE = re.compile(r".*\.(js|mjs|json|html|css|svg)$")


def test_the_bundle_is_made_of_these_sources() -> None:
    """The hash that the build left equals that of the sources: else `make page`."""
    files = [(path.name, path) for path in (PAGE / "source").iterdir() if SOURCE.match(path.name)]
    digest = hashlib.sha256()
    for name, path in sorted(files):
        digest.update(f"{name}\n".encode() + path.read_bytes())
    built = (PAGE / "built" / "sources.sha256").read_text().strip()
    assert built == digest.hexdigest(), "the page's sources have changed: run `make page`"


def test_what_is_bundled_comes_with_its_licences() -> None:
    """three.js and protobuf are named with copyright and terms."""
    text = (PAGE / "built" / "LICENSES.txt").read_text()
    for phrase in ("three.js authors", "MIT License", "Google Inc.", "Apache License"):
        assert phrase in text


def test_no_document_names_another_host() -> None:
    """HTML and style sheets hold no address; of the script only names of namespaces."""
    for name in ("index.html", "page.css"):
        assert "//" not in re.sub(r"/\*.*?\*/", "", (PAGE / "built" / name).read_text())


@pytest.mark.parametrize("path", ["/", "/page.js", "/page.css", "/icon.svg", "/LICENSES.txt"])
def test_the_site_has_what_the_page_loads(path: str) -> None:
    """Each with its media type and a policy that lets nothing else be loaded."""
    found = Site({"files": []}).find(path)
    assert found is not None
    assert len(found.body) > 100
    assert found.headers["Content-Security-Policy"] == POLICY
    assert found.headers["X-Content-Type-Options"] == "nosniff"


@pytest.mark.parametrize(
    "path", ["/site.py", "/../site.py", "/source/main.js", "/sources.sha256", "//"]
)
def test_the_site_has_nothing_else(path: str) -> None:
    """No path leads to files that are not the page's."""
    assert Site({}).find(path) is None
