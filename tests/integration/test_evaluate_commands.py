"""The judge's commands over a small library: tables, pictures, what was measured is kept."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from stridewire.commands import main
from stridewire_engine.library import Library

pytest.importorskip("sklearn")


@pytest.fixture(autouse=True)
def fresh_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Keep measurements apart from the user's."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache"


def run(*arguments: object) -> Result:
    """Run the command line in this process."""
    result = CliRunner().invoke(main, ["evaluate", *map(str, arguments)])
    assert result.exit_code == 0, result.output
    return result


def test_a_search_begins_with_the_defaults_and_goes_on_where_it_stopped(
    small_library: Library, tmp_path: Path, fresh_cache: Path
) -> None:
    """Two candidates beside the defaults, the front marked and drawn; then all is read."""
    words = ("tune", "--library", small_library.path, "--trials", 2, "--out", tmp_path, "--json")
    first = json.loads(run(*words, "--decide", small_library.path).stdout)
    assert len(first["rows"]) == 3
    assert any(row["front"] for row in first["rows"])
    assert first["decision"]["defaults"] == pytest.approx(
        {key: value for key, value in first["rows"][0].items() if key != "front"}
    )
    assert (tmp_path / "front.png").read_bytes().startswith(b"\x89PNG")
    measured = sorted(fresh_cache.rglob("*.json"))
    again = json.loads(run(*words).stdout)
    assert again["rows"] == first["rows"]
    assert sorted(fresh_cache.rglob("*.json")) == measured


def test_the_critic_tells_cuts(small_library: Library, tmp_path: Path) -> None:
    """A bare cut is told from what the clips hold; the surest windows are drawn."""
    where = ("--train", small_library.path, "--library", small_library.path)
    told = run("critic", *where, "--stitch", "none", "--seeds", 2, "--out", tmp_path, "--json")
    rows = json.loads(told.stdout)["rows"]
    cut = next(row for row in rows if row["row"] == "streamed" and row["joints"] == "all")
    assert cut["critic_auc"] > 0.7
    assert cut["critic_auc_low"] <= cut["critic_auc"] <= cut["critic_auc_high"]
    assert {row["joints"] for row in rows} >= {"all", "legs", "others"}
    assert len(list(tmp_path.glob("*-surest-*.png"))) == 3


def test_the_table_has_captured_and_naive_rows(small_library: Library) -> None:
    """One script, one stitcher: streamed with and without lock, captured, naive, responses."""
    words = ("--library", small_library.path, "--stitch", "spring", "--script", "idle", "--quick")
    rows = json.loads(run("stream", *words, "--jobs", 1, "--json").stdout)["rows"]
    assert {row["row"] for row in rows if "row" in row} == {"captured", "streamed", "naive"}
    assert {row["change"] for row in rows if "change" in row} == {
        "idle-walk",
        "walk-jog",
        "turn-90",
    }
