"""The reference: every method, field and command, out of the contract's comments and help texts.

Prints `docs/reference.md`; a test compares both.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import click

from stridewire.commands import main

ROOT = Path(__file__).parents[2]
PROTOS = ("animation", "match", "library", "pose", "blend", "stitch")

HEAD = """# Reference

Made by `make reference` out of the comments of [`proto/stridewire/v1`](../proto/stridewire/v1) and
of the help texts of the commands; change those.
"""


def reference() -> str:
    """Return the whole document."""
    parts = [HEAD, "## Methods and messages\n"]
    for name in PROTOS:
        text = (ROOT / "proto" / "stridewire" / "v1" / f"{name}.proto").read_text()
        parts += _proto(text)
    parts.append("## Commands\n")
    context = click.Context(main, info_name="stridewire")
    for name in main.list_commands(context):
        command = main.get_command(context, name)
        if command is not None:
            parts += _command(command, click.Context(command, context, info_name=name))
    return "\n".join(parts)


def _proto(text: str) -> Iterator[str]:
    """Yield the sections of one file: services first to last, messages, enums."""
    comment: list[str] = []
    inside: list[str] = []
    for line in map(str.strip, text.splitlines()):
        if line.startswith("//"):
            comment.append(line[2:].strip())
            continue
        about, comment = " ".join(comment), []
        if match := re.match(r"(service|message|enum|oneof) (\w+) \{(\})?", line):
            kind, name, empty = match.groups()
            if kind == "oneof":
                yield f"- one of *{name}*: {about}"
            else:
                yield f"\n### {name} ({kind})\n\n{about}\n"
            if not empty:
                inside.append(kind)
        elif line == "}":
            inside.pop()
        elif match := re.match(r"rpc (\w+)\((.+?)\) returns \((.+?)\)", line):
            yield f"- **{match[1]}**({match[2]}) → {match[3]}: {about}"
        elif inside and (match := re.match(r"(.+?) (\w+) = (\d+);|(\w+) = (\d+);", line)):
            kind, name = (match[1], match[2]) if match[2] else ("", match[4])
            typed = f" ({kind})" if kind else ""
            yield f"- `{name}`{typed}: {about}"
    yield ""


def _command(command: click.Command, context: click.Context) -> Iterator[str]:
    """Yield a command's help, and that of the commands below it."""
    context.max_content_width = 96
    yield f"### {context.command_path}\n\n```text\n{command.get_help(context)}\n```\n"
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            below = command.get_command(context, name)
            if below is not None:
                yield from _command(below, click.Context(below, context, info_name=name))


if __name__ == "__main__":
    sys.stdout.write(reference())
