"""`stridewire benchmark`: what each part costs, beside a reference in the same run."""

import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stridewire import __version__
from stridewire_server.commands.serve import calm_threads, open_libraries

if TYPE_CHECKING:
    from stridewire_engine.library import Library
    from stridewire_server.benchmarks.comparison import Compared

NAMES = ("search", "tick", "stitchers", "blend", "open", "encode", "memory")
_ROUNDS, _QUICK_ROUNDS = 15, 3
_SIZES, _QUICK_SIZES = (8, 64, 256, 1024), (8, 64)
_COLUMNS = "{:<20} {:<34} {:>12} {:<22} {:>9}  {}"


@click.command()
@click.option(
    "--library",
    type=click.Path(exists=True, path_type=Path),
    help="Library folder; the embedded synthetic one by default.",
)
@click.option("--only", multiple=True, type=click.Choice(NAMES), help="Part to measure, repeated.")
@click.option("--quick", is_flag=True, help="Few rounds and small crowds.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def benchmark(library: Path | None, only: tuple[str, ...], quick: bool, as_json: bool) -> None:
    """Measure search, tick, stitchers, blending, opening, encoding and memory in this process.

    Values are processor time, so that a busy machine hurts little; what is to be compared between
    machines is the ratio to the reference, which takes turns with what is measured.
    """
    calm_threads()
    opened = open_libraries((str(library),) if library else ())[0]
    wanted = [name for name in NAMES if not only or name in only]
    found: list[Compared] = []
    label = "measuring"
    with click.progressbar(wanted, label=label, file=sys.stderr, hidden=as_json) as names:
        for name in names:
            found += _parts(opened, quick)[name]()
    if as_json:
        rows = [one.row() for one in found]
        click.echo(json.dumps({"settings": _settings(opened, quick), "rows": rows}))
        return
    click.echo(_COLUMNS.format("part", "size", "value", "unit", "ratio to", "reference"))
    for one in found:
        click.echo(
            _COLUMNS.format(
                one.name,
                one.size,
                f"{one.value:.1f}",
                one.unit,
                f"{one.value / one.reference_value:.3f}",
                one.reference,
            )
        )


def _parts(library: "Library", quick: bool) -> "dict[str, Callable[[], Iterator[Compared]]]":
    """Return what is measured, by name."""
    from stridewire_server.benchmarks import engine, memory, wire

    rounds, sizes = (_QUICK_ROUNDS, _QUICK_SIZES) if quick else (_ROUNDS, _SIZES)
    return {
        "search": lambda: engine.search(library, rounds),
        "tick": lambda: engine.tick(library, rounds, sizes),
        "stitchers": lambda: engine.stitchers(library, rounds),
        "blend": lambda: engine.blend(library, rounds),
        "open": lambda: engine.opening(library, rounds),
        "encode": lambda: wire.encode(len(library.skeleton), rounds, sizes),
        "memory": lambda: memory.memory(library),
    }


def _settings(library: "Library", quick: bool) -> dict[str, Any]:
    return {
        "version": __version__,
        "command": "stridewire benchmark" + (" --quick" if quick else ""),
        "library": library.name,
        "frames": len(library.features),
        "cpus": os.cpu_count(),
    }
