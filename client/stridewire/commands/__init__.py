"""The command line: a group whose commands are found by entry points and loaded when used.

Each package brings its own; a command whose extra is not installed says what to install.
"""

from importlib.metadata import EntryPoint, entry_points

import click

from stridewire._errors import StridewireError
from stridewire._version import __version__

_EXTRA_BY_PACKAGE = {
    "stridewire": "server",
    "stridewire_engine": "server",
    "stridewire_server": "server",
    "stridewire_models": "train",
    "stridewire_loadtest": "loadtest",
}


class Refusal(click.ClickException):
    """Bad input: one line, exit code 2."""

    exit_code = 2


class LazyGroup(click.Group):
    """Loads a command when it is named; turns our errors into one line each."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands."""
        return sorted(_commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load a command; one that cannot be loaded says why when it is run."""
        point = _commands().get(cmd_name)
        if point is None:
            return None
        try:
            command: click.Command = point.load()
        except ModuleNotFoundError as error:
            return _absent(point, error)
        return command

    def invoke(self, ctx: click.Context) -> object:
        """Run a command."""
        try:
            return super().invoke(ctx)
        except ModuleNotFoundError as error:
            point = _commands()[str(ctx.invoked_subcommand)]
            raise click.ClickException(_advice(point, error)) from error
        except ValueError as error:
            raise Refusal(str(error)) from error
        except (StridewireError, OSError) as error:
            raise click.ClickException(str(error)) from error


@click.group(cls=LazyGroup)
@click.version_option(__version__, prog_name="stridewire")
def main() -> None:
    """Drive animated characters from control inputs, in real time."""


def _commands() -> dict[str, EntryPoint]:
    return {point.name: point for point in entry_points(group="stridewire.commands")}


def _absent(point: EntryPoint, error: ModuleNotFoundError) -> click.Command:
    """Stand in for a command that lacks something."""
    advice = _advice(point, error)

    def refuse() -> None:
        raise click.ClickException(advice)

    return click.Command(
        point.name,
        callback=refuse,
        short_help=f"({advice})",
        context_settings={"ignore_unknown_options": True, "allow_extra_args": True},
        add_help_option=False,
    )


def _advice(point: EntryPoint, error: ModuleNotFoundError) -> str:
    extra = _EXTRA_BY_PACKAGE.get(point.module.partition(".")[0], "server")
    return f"`{point.name}` needs {error.name}: pip install 'stridewire[{extra}]'"
