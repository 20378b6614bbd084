"""The frame of shows: misses fail, finished stages are kept, broken ones are not."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from show import points
from show.points import Point, show

runs: list[str] = []


def good() -> Iterator[Point]:
    """Show one thing."""
    runs.append("good")
    yield Point("two and two", "4", "4", True)


def bad() -> Iterator[Point]:
    """Miss one thing."""
    runs.append("bad")
    yield Point("two and two", "5", "4", False)


def broken() -> Iterator[Point]:
    """Break in the middle."""
    runs.append("broken")
    yield Point("first", "1", "1", True)
    raise OSError("the disk is full")


@pytest.fixture(autouse=True)
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep finished stages of the test apart from real ones; its checkout has one state."""
    monkeypatch.setattr(points, "ROOT", tmp_path)
    monkeypatch.setattr(points, "_state_of_checkout", lambda: "state-1")
    runs.clear()


def test_all_passed_is_0_and_a_miss_is_1(capsys: pytest.CaptureFixture[str]) -> None:
    """The exit status tells; the table shows figure and bar."""
    assert show("sums", [good], []) == 0
    assert show("sums", [good, bad], []) == 1
    printed = capsys.readouterr().out
    assert "MISS  bad          two and two: 5  [4]" in printed
    assert "1 of 2 points shown, 1 missed" in printed


def test_nothing_shown_is_no_pass() -> None:
    """A show without points has shown nothing."""
    assert show("nothing", [lambda: iter(())], []) == 1


def told() -> Iterator[Point]:
    """Tell a figure of which nothing is asked."""
    yield Point("two and three", "5")


def test_without_a_bar_nothing_is_passed(capsys: pytest.CaptureFixture[str]) -> None:
    """A figure without a bar is information: it counts neither as shown nor as missed."""
    assert show("sums", [good, told], []) == 0
    assert show("told", [told], []) == 1
    printed = capsys.readouterr().out
    assert "info  told         two and three: 5\n" in printed
    assert "1 of 1 points shown, 0 missed, 1 for information" in printed
    for bar, passed in (("", True), ("5", None)):
        with pytest.raises(ValueError, match="two and three"):
            Point("two and three", "5", bar, passed)


def test_finished_stages_are_kept_until_fresh_or_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second run uses what is kept, misses included; a changed checkout begins anew."""
    for _ in range(2):
        assert show("sums", [good, bad], []) == 1
    assert runs == ["good", "bad"]
    show("sums", [good, bad], ["--fresh"])
    assert runs == ["good", "bad"] * 2
    monkeypatch.setattr(points, "_state_of_checkout", lambda: "state-2")
    show("sums", [good], [])
    assert runs == [*["good", "bad"] * 2, "good"]


def test_a_stage_that_breaks_is_a_miss_and_runs_again(capsys: pytest.CaptureFixture[str]) -> None:
    """An error is shown as a miss and does not stop the stages behind it."""
    assert show("sums", [broken, good], []) == 1
    assert show("sums", [broken, good], []) == 1
    assert runs == ["broken", "good", "broken"]
    assert "OSError: the disk is full" in capsys.readouterr().out


def test_json_has_settings_and_flat_rows(capsys: pytest.CaptureFixture[str]) -> None:
    """Programs read one object."""
    show("sums", [good, bad], ["--json", "--stage", "bad"])
    printed = json.loads(capsys.readouterr().out)
    assert printed["settings"] == {"name": "sums", "state": "state-1"}
    assert [(row["stage"], row["passed"]) for row in printed["rows"]] == [("bad", False)]
