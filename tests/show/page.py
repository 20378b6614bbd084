"""`make show-page`: the page and its door, files for other tools, engines, the documents.

Bars stand here as they were asked for. Needs chromium, and node with `tests/node` and
`examples/node` installed; BLENDER_PYTHON names a Python with `bpy`, where Blender is to be asked.
"""

import sys

from page_browser import browser, door, new_user, screenshot
from page_files import animation, engines, files, site
from points import show

STAGES = [door, browser, screenshot, new_user, files, animation, engines, site]

if __name__ == "__main__":
    sys.exit(show("page", STAGES))
