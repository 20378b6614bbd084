"""The benchmark against a small library: every part has a reference and a ratio."""

import json

import pytest
from click.testing import CliRunner

from stridewire_engine.library import Library
from stridewire_server.commands.benchmark import benchmark


@pytest.mark.parametrize(
    ("part", "reference"),
    [
        ("search", "exact scan"),
        ("blend", "SLERP"),
        ("open", "reading its files"),
        ("encode", "empty gRPC echo"),
    ],
)
def test_a_part_is_told_beside_its_reference(
    small_library: Library, part: str, reference: str
) -> None:
    """One flat row for each size, values and ratios above zero."""
    arguments = ["--library", str(small_library.path), "--quick", "--json", "--only", part]
    result = CliRunner().invoke(benchmark, arguments)
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["rows"]
    assert rows
    for row in rows:
        assert set(row) == {"name", "size", "value", "unit", "reference", "ratio"}
        assert row["reference"] == reference
        assert row["value"] > 0.0
        assert row["ratio"] > 0.0
