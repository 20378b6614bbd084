"""What `make show-page` shows of files, engines and documents; its stages are in page.py."""

import importlib.util
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from points import ROOT, Point

from external import node_example, validate_gltf
from gltf_matrices import by_matrices
from stridewire import Client
from stridewire.formats.bvh import read_bvh
from stridewire.formats.gltf import read_gltf
from stridewire.testing import serve

SECONDS = 5.0
OFFSCREEN = "load-display p3tinydisplay\nwindow-type offscreen\naudio-library-name null\n"
QUIET = "notify-level-display fatal\nnotify-level-device fatal\n"


def files() -> Iterator[Point]:
    """One walk as BVH and GLB: validator, two readers, and Blender where it is at hand."""
    with tempfile.TemporaryDirectory() as folder:
        glb, bvh = Path(folder) / "walk.glb", Path(folder) / "walk.bvh"
        with serve() as address:
            drive = ["--seconds", str(SECONDS), "--no-realtime", "--address", address]
            _stridewire("stream", *drive, "--out", str(glb))
        _stridewire("convert", str(glb), str(bvh), "--to-unit", "cm")
        issues = validate_gltf(glb)["issues"]
        warned = ", ".join(m["code"] for m in issues["messages"])
        figure = f"{issues['numErrors']} errors, {issues['numWarnings']} warnings ({warned})"
        yield Point("the Khronos validator on a GLB", figure, "no errors", not issues["numErrors"])
        written = 0.01 * read_bvh(bvh).global_poses()[0]
        for name, places in {
            "read by stridewire.formats.gltf": read_gltf(glb).global_poses()[0],
            "read by the specification's matrices": by_matrices(glb),
        }.items():
            apart = 1e3 * float(np.abs(places - written).max())
            yield Point(f"BVH and GLB, {name}: joints apart", f"{apart:.4f} mm", "1 mm", apart < 1)
        yield _in_blender(bvh, glb)


def _in_blender(bvh: Path, glb: Path) -> Point:
    python = os.environ.get("BLENDER_PYTHON")
    what = "BVH and GLB in Blender: joints apart"
    if python is None:
        return Point(what, "not asked: BLENDER_PYTHON names no Python that has bpy")
    script = str(ROOT / "tests" / "show" / "in_blender.py")
    said = subprocess.run(
        [python, script, str(bvh), str(glb)], capture_output=True, text=True, check=True
    ).stdout
    line = next(line for line in said.splitlines() if line.startswith("largest difference"))
    return Point(what, line.partition(": ")[2], "1 mm", float(line.split()[2]) < 1.0)


def animation() -> Iterator[Point]:
    """The README's animation, drawn anew by the command that it names."""
    picture = ROOT / "docs" / "images" / "run.webp"
    shown = f"docs/images/{picture.name}" in (ROOT / "README.md").read_text()
    yield Point("an animation in the README", f"{picture.stat().st_size // 1000} kB",
                "made by a command", shown)  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        bvh, out = Path(folder) / "run.bvh", Path(folder) / "run.webp"
        with serve() as address:
            drive = ["--script", "zigzag", "--seconds", "2", "--no-realtime", "--address", address]
            _stridewire("stream", *drive, "--out", str(bvh))
        _stridewire("render", str(bvh), "--animate", str(out))
        made = out.read_bytes()[8:12] == b"WEBP"
        yield Point("stridewire render --animate", f"{out.stat().st_size // 1000} kB for 2 s",
                    "made by a command", made)  # fmt: skip


def engines() -> Iterator[Point]:
    """Panda3D without a window and Node, at 60 frames a second: what they saw."""
    with serve() as address:
        frames, waits_ms, walked = _panda(address)
        rate = f"{frames / SECONDS:.1f} frames a second, walked {walked:.2f} m in {SECONDS:g} s"
        yield Point("Panda3D moves an Actor", rate, "it walks", walked > 0.5 * 1.4 * SECONDS)
        p50, p99 = np.percentile(waits_ms, (50, 99))
        yield Point("Panda3D: control to frame", f"p50 {p50:.2f} ms, p99 {p99:.2f} ms")
        seen = node_example(address, SECONDS)
        rate = f"{seen['frames'] / SECONDS:.1f} frames a second, walked {seen['walked_m']:.2f} m"
        yield Point("Node", rate, "it walks", seen["walked_m"] > 0.5 * 1.3 * SECONDS)
        latency = f"p50 {seen['p50_ms']:.2f} ms, p99 {seen['p99_ms']:.2f} ms"
        yield Point("Node: control to frame", latency)
    for name in ("test_panda3d.py", "test_browser_example.py", "test_node.py"):
        yield _passes(f"tests/end_to_end/{name}")
    yield _passes("tests/contract/test_engine_sources.py")


def _panda(address: str) -> tuple[int, list[float], float]:
    """Run the example in real time; returns frames, waits for a frame in ms, metres walked."""
    from panda3d.core import loadPrcFileData

    loadPrcFileData("", OFFSCREEN + QUIET)
    module = _module(ROOT / "examples" / "panda3d" / "walk.py")
    waits: list[float] = []
    with Client(address) as client, client.open_session() as session:
        game: Any = module.Game(session)
        game.taskMgr.remove("update")
        begin = before = time.perf_counter()
        while (now := time.perf_counter()) - begin < SECONDS:
            game.character.step((0.0, 1.4), now - before)
            before = now
            waits.append(1e3 * (time.perf_counter() - now))
            game.graphicsEngine.renderFrame()
            time.sleep(max(0.0, begin + len(waits) / 60 - time.perf_counter()))
        walked = -float(game.character.actor.getY())
        game.destroy()
    return len(waits), waits, walked


def site() -> Iterator[Point]:
    """The documents as a site, strictly."""
    with tempfile.TemporaryDirectory() as folder:
        _module(ROOT / "docs" / "site" / "build.py").build(Path(folder))
        pages = len(list(Path(folder).rglob("*.html")))
        yield Point("make site: pages without a dead link", str(pages), "links checked", pages > 10)


def _passes(test: str) -> Point:
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", test]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    said = done.stdout.strip().splitlines()
    skipped = any(line.startswith("SKIPPED") for line in said)
    outcome = "skipped" if skipped else "passed" if done.returncode == 0 else said[-1]
    return Point(test, outcome, "green", outcome == "passed")


def _module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"shown_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _stridewire(*arguments: str) -> str:
    command = [sys.executable, "-m", "stridewire", *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
