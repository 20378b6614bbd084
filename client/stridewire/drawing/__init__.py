"""Pictures of motion for people: contact sheets.

Needs matplotlib, which is loaded when something is drawn.
"""

from stridewire.drawing.contact_sheet import contact_sheet, draw_contact_sheet
from stridewire.drawing.subject import Subject

__all__ = ["Subject", "contact_sheet", "draw_contact_sheet"]
