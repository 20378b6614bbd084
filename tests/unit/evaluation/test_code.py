"""Measurements are stale when the code that makes them changes, and only then."""

from pathlib import Path

from stridewire_engine.evaluation import bench, code


def test_what_makes_motion_counts_and_what_prints_it_does_not() -> None:
    """The tick, the stitchers and the kernel are hashed; commands and drawing are not."""
    reached = {path.as_posix() for path in code._reached(Path(bench.__file__))}
    for name in ("runtime/tick.py", "stitchers/stance.py", "motion/quaternion.py", "metrics.py"):
        assert any(path.endswith(name) for path in reached), name
    assert not [path for path in reached if "/commands/" in path or "/drawing/" in path]


def test_a_change_changes_the_hash(tmp_path: Path) -> None:
    """A comment more is another hash: nobody judges which changes matter."""
    source = tmp_path / "module.py"
    source.write_text("x = 1\n")
    before = code.code_hash(source)
    code.code_hash.cache_clear()
    source.write_text("x = 1  # one\n")
    assert code.code_hash(source) != before
