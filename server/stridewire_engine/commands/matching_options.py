"""Options of `library build` that say what is matched and how moments compare."""

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import click

from stridewire_engine.building.build import MatchingOptions
from stridewire_engine.library import Library, LibraryError
from stridewire_engine.matching.presets import PRESETS, find_schema

_LIBRARY = click.Path(exists=True, file_okay=False, path_type=Path)
_OPTIONS = (
    click.option(
        "--schema",
        default="locomotion",
        show_default=True,
        metavar="NAME|FILE.toml",
        help=f"What is matched: {', '.join(PRESETS)}, or a file of your own.",
    ),
    click.option(
        "--normalise-like",
        type=_LIBRARY,
        help="Library whose normalisation to take, so that costs compare across both.",
    ),
    click.option(
        "--favour", multiple=True, metavar="TAG[=N]", help="Favour moments by N typical costs [1]."
    ),
    click.option(
        "--avoid", multiple=True, metavar="TAG[=N]", help="Avoid moments by N typical costs [1]."
    ),
    click.option("--never", multiple=True, metavar="TAG", help="Never start within this tag."),
    click.option(
        "--probe",
        type=_LIBRARY,
        help="Library of other people to try the index with; generated motion by default.",
    ),
)


def matching_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options; the command gets them as `matching: MatchingOptions`."""

    @wraps(command)
    def with_matching(
        *,
        schema: str,
        normalise_like: Path | None,
        favour: tuple[str, ...],
        avoid: tuple[str, ...],
        never: tuple[str, ...],
        probe: Path | None,
        **others: Any,
    ) -> None:
        try:
            other = Library.open(probe) if probe else None
            matching = MatchingOptions(
                schema=find_schema(schema),
                normalise_like=Library.open(normalise_like) if normalise_like else None,
                bias_by_tag={
                    **{tag: -amount for tag, amount in map(_bias, favour)},
                    **dict(map(_bias, avoid)),
                },
                never_start=never,
                probe=[other.clip(entry.name) for entry in other.clips] if other else (),
            )
        except LibraryError as error:
            raise click.ClickException(str(error)) from None
        command(matching=matching, **others)

    for option in reversed(_OPTIONS):
        with_matching = option(with_matching)
    return with_matching


def _bias(text: str) -> tuple[str, float]:
    tag, _, amount = text.partition("=")
    try:
        return tag, float(amount or 1.0)
    except ValueError:
        raise click.BadParameter(f"{text!r}; expected TAG or TAG=NUMBER") from None
