"""Pictures of motion for people: contact sheets, and animated ones.

Needs matplotlib, which is loaded when something is drawn.
"""

from stridewire.drawing.animation import draw_animation
from stridewire.drawing.contact_sheet import contact_sheet, draw_contact_sheet
from stridewire.drawing.subject import Subject

__all__ = ["Subject", "contact_sheet", "draw_animation", "draw_contact_sheet"]
