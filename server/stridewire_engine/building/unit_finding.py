"""Units of length: which one makes the hips of a standing figure as high as a human's."""

from pathlib import Path

from stridewire.formats.units import UNITS, unit_name

LOWEST, HIGHEST = 0.7, 1.1
"""Height of a human's hip joints while standing; metres. At most one known unit fits a figure."""


class UnitError(ValueError):
    """No unit makes a figure as tall as a human; the message says what was found and what to do."""


def find_unit(
    path: Path, hips: float, stated: float | None, given: float | None = None
) -> tuple[float, str]:
    """Return metres per file unit, and a note where the figure is no human's by a given unit.

    Args:
        path: The file, for messages.
        hips: Height of the hip joints over the ground with straight legs; file units.
        stated: Metres per unit by the file itself; None where it does not say.
        given: Metres per unit by a person, whose word holds for giants and dwarfs, too.

    Raises:
        UnitError: If neither the stated unit nor, without one, any known fits a human.
    """
    if given is not None:
        height = hips * given
        odd = f"in {unit_name(given)} the hips stand at {height:.3g} m; scaled to a human"
        return given, "" if _human(height) else odd
    if stated is not None and not _human(hips * stated):
        raise _refusal(path, f"{hips * stated:.3g} m by its own unit, {unit_name(stated)}")
    for metres in UNITS.values() if stated is None else (stated,):
        if _human(hips * metres):
            return metres, ""
    raise _refusal(path, f"{hips:.4g} units, no human's in {', '.join(UNITS)}")


def _human(height: float) -> bool:
    return LOWEST <= height <= HIGHEST


def _refusal(path: Path, found: str) -> UnitError:
    return UnitError(
        f"{path}: the hips stand at {found} (expected {LOWEST:g} to {HIGHEST:g} m); give the true "
        "unit, a name or metres, with --unit, and the figure is scaled to a human"
    )
