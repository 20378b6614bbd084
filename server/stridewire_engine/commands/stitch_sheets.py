"""Contact sheets of seams: the clips laid end to end, and what became of them."""

from dataclasses import replace
from pathlib import Path

from stridewire.drawing import Subject, draw_contact_sheet
from stridewire.motion.clip import Clip
from stridewire_engine.stitching import Stitching

_BEFORE_S, _AFTER_S = 0.5, 2.0


def draw_seams(made: Stitching, clip: Clip, folder: Path) -> list[Path]:
    """Draw the time around each seam, before and after; return the PNGs.

    Args:
        made: The stitching, done.
        clip: What it made.
        folder: For the pictures; made where it is missing.
    """
    folder.mkdir(parents=True, exist_ok=True)
    laid = replace(clip, pose=made.plan.pose(slice(None)))
    pictures = []
    for number, frame in enumerate(made.plan.seams, start=1):
        seam_s = float(frame) / clip.frame_rate
        span = max(seam_s - _BEFORE_S, 0.0), min(seam_s + _AFTER_S, clip.seconds)
        for name, shown in (("before", laid), ("after", clip)):
            path = folder / f"{clip.name}-seam-{number}-{name}.png"
            title = f"{clip.name}, seam {number} at {seam_s:.2f} s, {name}"
            draw_contact_sheet(Subject.of_clip(shown).between(*span), path, title=title)
            pictures.append(path)
    return pictures
