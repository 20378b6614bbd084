"""Metrics: what an operator reads adds up to what ticks told."""

from urllib.request import urlopen

import pytest
from prometheus_client.parser import text_string_to_metric_families

from stridewire_server.metrics import Metrics


def served(metrics: Metrics) -> dict[str, float]:
    """Return the samples that are served, by name and labels."""
    address = metrics.serve("127.0.0.1:0")
    try:
        with urlopen(f"http://{address}/metrics") as answer:
            text = answer.read().decode()
    finally:
        metrics.stop()
    return {
        sample.name + "".join(sample.labels.values()): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def test_ticks_add_up() -> None:
    """Frames, degraded ones, stages, and the histogram of ticks are those that were told."""
    metrics = Metrics()
    metrics.populated(3, 40)
    metrics.ticked(0.003, 3, 0, {"search": 1.0, "stitch": 0.5})
    metrics.ticked(0.020, 3, 2, {"search": 2.0})
    metrics.dropped()
    told = served(metrics)
    assert told["stridewire_sessions"] == 3
    assert told["stridewire_characters"] == 40
    assert told["stridewire_frames_total"] == 6
    assert told["stridewire_frames_degraded_total"] == 3
    assert told["stridewire_frames_dropped_total"] == 1
    assert told["stridewire_strain_level"] == 2
    assert told["stridewire_stage_seconds_totalsearch"] == pytest.approx(0.003)
    assert told["stridewire_tick_seconds_count"] == 2
    assert told["stridewire_tick_seconds_bucket0.003"] == 1
    assert told["stridewire_tick_seconds_sum"] == pytest.approx(0.023)


def test_a_taken_port_is_told() -> None:
    """A second server on the same port says what to do."""
    first, second = Metrics(), Metrics()
    address = first.serve("127.0.0.1:0")
    try:
        with pytest.raises(ValueError, match="is the port taken"):
            second.serve(address)
    finally:
        first.stop()
