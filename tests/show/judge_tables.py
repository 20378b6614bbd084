"""Print the tables of docs/quality.md, as Markdown, out of the rows that `make show-judge` kept."""

import json
from collections.abc import Iterator
from typing import Any

from judge_results import ALL, RESULTS

COLUMNS = (
    ("C", "sliding_c_cm_s", ".2f", True),
    ("A", "sliding_a_cm_s", ".1f", False),
    ("locked %", "locked_pct", ".0f", False),
    ("lock, cm", "lock_offset_cm", ".2f", False),
    ("float, cm", "float_cm", ".3f", True),
    ("below, cm", "penetration_cm", ".3f", False),
    ("jerk", "jerk_ratio", ".2f", False),
    ("jumps, %", "jump_pct", ".2f", True),
    ("lag, cm", "clip_lag_cm", ".1f", False),
    ("truth, cm", "truth_error_cm", ".1f", False),
    ("follow, m", "following_error_m", ".2f", False),
    ("jumps/s", "transitions_per_s", ".2f", False),
)
"""Heading, figure, format, and whether half of its interval stands beside it."""
Row = dict[str, Any]


def natural(rows: list[Row], library: str) -> Iterator[str]:
    """Yield the table of one library's natural streams."""
    heads = " | ".join(head for head, *_ in COLUMNS)
    yield f"`{library}`:\n\n| | {heads} |\n|{'---|' * (len(COLUMNS) + 1)}"
    mine = [row for row in rows if row.get("library") == library and _is_natural(row)]
    # of the captured rows any will do: it is of the frames that one stitcher played
    parts = {kind: [row for row in mine if row["row"] == kind] for kind in ("captured", "naive")}
    streamed = [row for row in mine if row["row"] == "streamed"]
    for row in (*parts["captured"][:1], *parts["naive"], *streamed):
        cells = " | ".join(_cell(row, *column[1:]) for column in COLUMNS)
        yield f"| {_name(row)} | {cells} |"


def _is_natural(row: Row) -> bool:
    return (
        row.get("script") == "all"
        and row.get("block", "all") == "all"
        and "jerk_ratio" in row
        and not row.get("forced_interval_frames")
        and row.get("match_rank", 1) == 1
    )


def _name(row: Row) -> str:
    if row["row"] != "streamed":
        return str(row["row"])
    return f"`{row['stitch']}`" + (" + lock" if row["foot_lock"] else "")


def _cell(row: Row, figure: str, form: str, interval: bool) -> str:
    value = row.get(figure)
    if value is None or (row["row"] == "captured" and figure in ("locked_pct", "clip_lag_cm")):
        return ""
    text = format(value, form)
    if interval:
        half = 0.5 * (row[f"{figure}_high"] - row[f"{figure}_low"])
        text += f" ±{half:{form}}"
    return text


if __name__ == "__main__":
    kept = json.loads(RESULTS.read_text())["rows"]
    for name in ALL:
        print("\n".join(natural(kept, name)), end="\n\n")
