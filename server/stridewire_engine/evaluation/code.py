"""The code that a measurement depends on: what changes in it, makes measurements stale."""

import ast
import hashlib
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path

_OURS = ("stridewire", "stridewire_engine")


@cache
def code_hash(source: Path) -> str:
    """Hash a module and all of ours that it imports, by way of others too.

    Commands, documents, importers and drawing are not among them, so that a change there does not
    make anything be measured again.

    Args:
        source: File of the module.
    """
    digest = hashlib.sha256()
    for path in sorted(_reached(source)):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _reached(source: Path) -> set[Path]:
    found: set[Path] = set()
    waiting = [source]
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        found.add(path)
        waiting += [p for name in _imports(path) for p in _files(name)]
    return found


def _imports(path: Path) -> Iterator[str]:
    """Yield the modules that a file imports, and what may be one."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _files(name: str) -> Iterator[Path]:
    """Yield the files of a module of ours and of the packages that it lies in."""
    words = name.split(".")
    if words[0] not in _OURS:
        return
    root = find_spec(words[0])
    if root is None or root.origin is None:
        return
    folder = Path(root.origin).parent
    yield folder / "__init__.py"
    for word in words[1:]:
        if (folder / word).is_dir():
            folder = folder / word
            yield folder / "__init__.py"
        elif (file := folder / f"{word}.py").is_file():
            yield file
            return
        else:
            return  # the name of a thing within the module
