"""Frame rates: written frame times are read as the rates that people mean."""

import pytest

from stridewire.formats.frame_rates import named_rate


@pytest.mark.parametrize(
    ("written", "rate"),
    [
        ("0.0333333", 30.0),
        ("0.033333", 30.0),
        ("0.033", 30.0),
        (".0083333", 120.0),
        ("0.016666", 60.0),
        ("0.017", 60.0),
        ("0.0416667", 24.0),
        ("0.0333667", 30000 / 1001),
        ("0.041708333333", 24000 / 1001),
        ("0.0111111", 90.0),
        ("0.0138889", 72.0),
        ("0.1", 10.0),
        ("1", 1.0),
        ("8.33333e-3", 1 / 8.33333e-3),
    ],
)
def test_rate(written: str, rate: float) -> None:
    """A rounded or cut frame time names its rate."""
    assert named_rate(written) == pytest.approx(rate, rel=1e-9)
