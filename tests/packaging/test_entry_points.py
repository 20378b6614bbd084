"""Every entry point that the project declares leads to something that exists."""

import tomllib
from importlib.metadata import EntryPoint

import click
import pytest

from source_imports import PACKAGES, ROOT
from stridewire.commands import main

GROUPS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
COMMANDS = GROUPS["stridewire.commands"]


@pytest.mark.parametrize("group", GROUPS)
def test_targets_exist(group: str) -> None:
    """The module's file is there, also where its extra is not installed."""
    for name, value in GROUPS[group].items():
        module = EntryPoint(name, value, group).module
        top, *parts = module.split(".")
        path = (ROOT / PACKAGES[top] / top).joinpath(*parts)
        assert path.with_suffix(".py").exists() or (path / "__init__.py").exists(), module


@pytest.mark.parametrize(
    "name", [n for n in COMMANDS if not COMMANDS[n].startswith("stridewire_m")]
)
def test_commands_load_under_their_own_name_with_help(name: str) -> None:
    """A command has the name that users type, and says what it does."""
    command = EntryPoint(name, COMMANDS[name], "stridewire.commands").load()
    assert isinstance(command, click.Command)
    assert command.name == name
    assert command.help


def test_the_group_lists_exactly_these() -> None:
    """The installed metadata and the project file agree; reinstall where they do not."""
    assert main.list_commands(click.Context(main)) == sorted(COMMANDS)
