"""Who imports whom, read from the source without importing anything."""

import ast
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]

PACKAGES = {
    "stridewire": "client",
    "stridewire_engine": "server",
    "stridewire_server": "server",
    "stridewire_models": "models",
    "stridewire_loadtest": "loadtest",
}
"""The importable packages and the folders that they lie in."""


@dataclass(frozen=True)
class Import:
    """One import statement's target."""

    module: str
    """Dotted name of the importing module."""
    target: str
    """Dotted name of what is imported: a module, or a name in one."""
    line: int

    def __str__(self) -> str:
        return f"{self.module} (line {self.line}) imports {self.target}"


def imports_of(package: str) -> list[Import]:
    """Return all imports of a package's modules, those within functions included."""
    folder = ROOT / PACKAGES[package] / package
    return [found for path in sorted(folder.rglob("*.py")) for found in _imports(path)]


def third_party(imports: list[Import]) -> set[str]:
    """Return the top-level names that are neither ours nor the standard library's."""
    tops = {found.target.partition(".")[0] for found in imports}
    return tops - set(PACKAGES) - set(sys.stdlib_module_names)


def within(name: str, *prefixes: str) -> bool:
    """Tell whether a dotted name is one of some modules or lies inside one."""
    return any(name == prefix or name.startswith(f"{prefix}.") for prefix in prefixes)


def _imports(path: Path) -> Iterator[Import]:
    module = _module(path)
    is_package = path.name == "__init__.py"
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(module, alias.name, node.lineno)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = module.split(".")
                kept = len(parts) - node.level + is_package
                base = ".".join([*parts[:kept], *([base] if base else [])])
            for alias in node.names:
                yield Import(module, f"{base}.{alias.name}", node.lineno)


def _module(path: Path) -> str:
    package = next(p for p, folder in PACKAGES.items() if path.is_relative_to(ROOT / folder / p))
    parts = path.relative_to(ROOT / PACKAGES[package]).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
