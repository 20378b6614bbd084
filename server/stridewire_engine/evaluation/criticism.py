"""Criticism: the critic on every stitcher, beside motion without a seam and beside itself.

The captured windows are those that the clips which play at a transition really hold there, before
it and after, so that the critic cannot go by what is done, only by how.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from stridewire.drawing import contact_sheet
from stridewire_engine.evaluation import critic
from stridewire_engine.evaluation.bench import Bench
from stridewire_engine.evaluation.cell import REPORT_SEEDS, Cell
from stridewire_engine.evaluation.critic import WINDOW, Sample, Verdict, Windows
from stridewire_engine.evaluation.streaming import Stream

SCRIPTS = ("stroll", "stop-and-go", "u-turns", "strafe", "circle")
_DRAWN = 3


@dataclass(frozen=True)
class Heard:
    """Streams of one stitcher over one library, and the windows cut out of them."""

    bench: Bench
    streams: Sequence[Stream]

    @classmethod
    def of(cls, bench: Bench, stitch: str, seeds: tuple[int, ...]) -> "Heard":
        """Stream the scripts with foot lock."""
        cells = [Cell(script, stitch=stitch, seeds=seeds) for script in SCRIPTS]
        return cls(bench, list(bench.run_all(cells)))

    @cached_property
    def places(self) -> list[tuple[Stream, Windows]]:
        """Windows with a transition in their middle, by stream."""
        return [(stream, critic.seam_windows(stream)) for stream in self.streams]

    @cached_property
    def seams(self) -> Sample:
        """Windows with a transition in their middle."""
        return self._cut(self.places)

    @cached_property
    def quiet(self) -> Sample:
        """Windows without one."""
        return self._cut([(stream, critic.quiet_windows(stream)) for stream in self.streams])

    @cached_property
    def captured(self) -> Sample:
        """What the clips of the seams really hold there, each window once."""
        starts = []
        for stream, windows in self.places:
            frame, who = windows
            starts.append(stream.rows[frame, who])
            starts.append(stream.rows[frame + WINDOW // 2, who] - WINDOW // 2)
        rows = np.unique(np.concatenate(starts))
        library = self.bench.library
        inside = rows >= library.clip_starts[library.clip_of[np.maximum(rows, 0)]]
        return critic.captured_sample(self.bench.captured, rows[inside & (rows >= 0)])

    def draw(self, indices: np.ndarray, folder: Path, name: str) -> list[Path]:
        """Draw seam windows by their numbers; return the PNGs."""
        where = [
            (stream, int(frame), int(who))
            for stream, windows in self.places
            for frame, who in zip(*windows, strict=True)
        ]
        paths = []
        for rank, index in enumerate(indices[:_DRAWN], start=1):
            stream, frame, who = where[index]
            path = folder / f"{name}-surest-{rank}.png"
            clip = stream.clip(self.bench.library, who, f"{name}: the critic's surest, {rank}")
            contact_sheet(clip.cut(frame, frame + WINDOW), path)
            paths.append(path)
        return paths

    def _cut(self, places: Sequence[tuple[Stream, Windows]]) -> Sample:
        parts = [critic.stream_sample(s, self.bench.captured, w) for s, w in places]
        return critic.joined(parts)


def criticise(
    train: Bench,
    test: Bench,
    stitchers: Sequence[str],
    out: Path | None = None,
    seeds: tuple[int, ...] = REPORT_SEEDS[:10],
) -> Iterator[dict[str, Any]]:
    """Yield flat rows: every stitcher's seams, its windows without, captured against captured.

    Args:
        train: Library of training people.
        test: Library of test people.
        stitchers: Their names.
        out: Folder for the windows that the critic is surest about; None draws none.
        seeds: Of the scripts.
    """
    legs = critic.columns_of(test.captured, critic.LEGS)
    rest = np.setdiff1d(np.arange(critic.dimensions(test.captured)), legs)
    for number, name in enumerate(stitchers):
        seen, quoted = Heard.of(train, name, seeds), Heard.of(test, name, seeds)
        head = {"library": test.library.name, "trained_on": train.library.name, "stitch": name}
        verdict = critic.judge(seen.seams, seen.captured, quoted.seams, quoted.captured)
        yield {**head, "row": "streamed", "joints": "all", **_numbers(verdict, quoted.seams)}
        if out is not None:
            quoted.draw(verdict.surest, out, f"{test.library.name}-{name}")
        for joints, columns in (("legs", legs), ("others", rest)):
            samples = (seen.seams, seen.captured, quoted.seams, quoted.captured)
            part = critic.judge(*(Sample(s.features[:, columns], s.takes) for s in samples))
            yield {**head, "row": "streamed", "joints": joints, **_numbers(part, quoted.seams)}
        if _enough(seen.quiet, quoted.quiet):
            verdict = critic.judge(seen.quiet, seen.captured, quoted.quiet, quoted.captured)
            yield {**head, "row": "quiet", "joints": "all", **_numbers(verdict, quoted.quiet)}
        halves = (*_halves(seen.captured), *_halves(quoted.captured))
        if number == 0 and _enough(*halves):
            verdict = critic.judge(*halves)
            own = {**head, "row": "captured", "stitch": "", "joints": "all"}
            yield {**own, **_numbers(verdict, quoted.captured)}


def _enough(*samples: Sample) -> bool:
    return min(len(sample.takes) for sample in samples) >= critic.LEAST_WINDOWS


def _halves(sample: Sample) -> tuple[Sample, Sample]:
    """Part windows by the number of their take: nothing but the takes differs."""
    even = sample.takes % 2 == 0
    return (
        Sample(sample.features[even], sample.takes[even]),
        Sample(sample.features[~even], sample.takes[~even]),
    )


def _numbers(verdict: Verdict, told: Sample) -> dict[str, Any]:
    return {
        "critic_auc": round(verdict.auc, 4),
        "critic_auc_low": round(verdict.low, 4),
        "critic_auc_high": round(verdict.high, 4),
        "windows": len(told.takes),
        "takes": len(np.unique(told.takes)),
    }
