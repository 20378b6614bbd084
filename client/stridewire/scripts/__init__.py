"""Named control scripts: what a player or an AI would ask for, the same every time.

A script is a pure function of time, character and seed. Characters of one call differ (heading,
phase, side), and what a character does does not depend on how many others there are.
"""

from stridewire.scripts.script import SCRIPT_NAMES, Controls, Script, script

__all__ = ["SCRIPT_NAMES", "Controls", "Script", "script"]
