"""SHA256SUMS: the list of hashes beside models, as `sha256sum -c` reads it."""

from pathlib import Path


def enter(sums: Path, name: str, digest: str) -> None:
    """Enter a file's hash into a list, in place of an older one."""
    lines = sums.read_text().splitlines() if sums.is_file() else []
    others = [line for line in lines if line.split()[1] != name]
    sums.write_text("\n".join(sorted([*others, f"{digest}  {name}"])) + "\n")
