"""`stridewire library`: from capture to a library, and what is in it."""

import click

from stridewire_engine.commands.library_build import build
from stridewire_engine.commands.library_fetch import fetch_capture
from stridewire_engine.commands.library_info import info
from stridewire_engine.commands.library_profile import profile
from stridewire_engine.commands.library_report import report


@click.group()
def library() -> None:
    """Build libraries from motion capture and look into them."""


for command in (build, info, report, profile, fetch_capture):
    library.add_command(command)
