"""Units of length in motion files, by name or in metres."""

UNITS = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 0.001,
    "foot": 0.3048,
    "inch": 0.0254,
    "cmu": 0.0254 / 0.45,
}
"""Metres per unit by the unit's name; `cmu` is the CMU database's."""

_SMALLEST, _LARGEST = 1e-6, 1e3
_ALIKE = 0.005


def parse_unit(text: str) -> float:
    """Return the metres of a unit given by its name or as a number of metres.

    Raises:
        ValueError: If it is neither.
    """
    try:
        metres = UNITS[text] if text in UNITS else float(text)
    except ValueError:
        metres = 0.0
    if not _SMALLEST <= metres <= _LARGEST:
        raise ValueError(
            f"unit {text!r}; expected {', '.join(UNITS)} or the metres of one unit, such as 0.0254"
        )
    return metres


def unit_name(metres: float) -> str:
    """Return the name of a unit, else how many metres it has."""
    for name, known in UNITS.items():
        if abs(metres - known) < _ALIKE * known:
            return name
    return f"{metres:.4g} m"
