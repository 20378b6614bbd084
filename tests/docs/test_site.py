"""The documents as a site: every page is there, every link leads somewhere, nothing is fetched."""

import importlib.util
import re
import subprocess
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
FETCHED = re.compile(r"<(?:script|link|img)[^>]+(?:src|href)=[\"']?(https?://[^\"'> ]+)")


@pytest.fixture(scope="module")
def builder() -> ModuleType:
    """Return what `make site` runs."""
    pytest.importorskip("material", reason="needs mkdocs-material: pip install mkdocs-material")
    spec = importlib.util.spec_from_file_location("site_build", ROOT / "docs/site/build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_site_has_every_document(builder: ModuleType, tmp_path: Path) -> None:
    """Strictly built: a warning fails. No page asks other hosts for scripts, styles, pictures."""
    builder.build(tmp_path)
    documents = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]
    for document in documents:
        page = document.relative_to(ROOT).with_suffix(".html")
        page = Path("index.html") if str(page) == "README.html" else page
        text = (tmp_path / page).read_text()
        assert not FETCHED.findall(text), page
    assert (tmp_path / "proto/stridewire/v1/index.html").exists()
    assert (tmp_path / "docs/images/run.webp").exists()


@pytest.mark.parametrize(
    "link", ["[a](docs/absent.md)", "[a](docs/there.md#absent)", "[a](docs/absent.json)"]
)
def test_a_link_that_leads_nowhere_fails(
    builder: ModuleType, tmp_path: Path, link: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """Pages, headings and files; the message names the page."""
    root = tmp_path / "root"
    (root / "docs").mkdir(parents=True)
    (root / "docs" / "there.md").write_text("# There\n")
    (root / "README.md").write_text(f"# Title\n\n[there](docs/there.md#there) {link}\n")
    with pytest.raises(subprocess.CalledProcessError):
        builder.build(tmp_path / "site", root)
    assert "README.md" in capfd.readouterr().err
