"""Arrows run down only: every import statement of every package against the design's floors."""

import pytest

from source_imports import PACKAGES, ROOT, Import, imports_of, third_party, within

CLIENT_FOR_ENGINE = tuple(
    f"stridewire.{part}"
    for part in (
        "motion",
        "formats",
        "scripts",
        "drawing",
        "_transport",
        "_messages",
        "_errors",
        "__version__",
    )
)

ENGINE_FLOORS = {
    "commands": 5,
    "evaluation": 4,
    "in_process": 5,
    "answering": 4,
    "replaying": 4,
    "building": 3,
    "runtime": 3,
    "stitching": 3,
    "editing": 3,
    "inbetweening": 3,
    "matching": 2,
    "stitchers": 2,
    "blending": 2,
    "library": 1,
    "networks": 1,
    "rigs": 1,
    "compiled": 0,
}

THIRD_PARTY = {
    "stridewire": {
        "PIL",
        "click",
        "google",
        "grpc",
        "matplotlib",
        "mpl_toolkits",
        "numpy",
        "pygltflib",
        "uvloop",
    },
    "stridewire_engine": {
        "click",
        "faiss",
        "matplotlib",
        "numba",
        "numpy",
        "onnxruntime",
        "scipy",
        "sklearn",
        "threadpoolctl",
    },
    "stridewire_server": {
        "click",
        "google",
        "grpc",
        "grpc_health",
        "grpc_reflection",
        "grpc_status",
        "numpy",
        "prometheus_client",
        "websockets",
    },
    "stridewire_models": {
        "click",
        "matplotlib",
        "numpy",
        "onnx",
        "onnxruntime",
        "scipy",
        "torch",
    },
    "stridewire_loadtest": {"click", "grpc", "hdrh", "matplotlib", "numpy", "psutil"},
}

OWN = {
    "stridewire": {"stridewire"},
    "stridewire_engine": {"stridewire", "stridewire_engine"},
    "stridewire_server": {"stridewire", "stridewire_engine", "stridewire_server"},
    "stridewire_models": {"stridewire", "stridewire_engine", "stridewire_models"},
    "stridewire_loadtest": {"stridewire", "stridewire_loadtest"},
}


def listed(violations: list[Import]) -> str:
    """Return one violation a line."""
    return "\n" + "\n".join(map(str, violations))


@pytest.mark.parametrize("package", PACKAGES)
def test_packages_import_only_those_below(package: str) -> None:
    """The client knows nobody; engine, server, models and load test know who the design says."""
    wrong = [
        found
        for found in imports_of(package)
        if (top := found.target.partition(".")[0]) in PACKAGES and top not in OWN[package]
    ]
    assert not wrong, listed(wrong)


@pytest.mark.parametrize("package", PACKAGES)
def test_packages_import_only_their_dependencies(package: str) -> None:
    """No torch outside models, no grpc in the engine, nothing that no extra installs."""
    assert third_party(imports_of(package)) <= THIRD_PARTY[package]


def test_the_kernel_needs_numpy_alone() -> None:
    """`stridewire.motion` imports itself and numpy."""
    kernel = [i for i in imports_of("stridewire") if within(i.module, "stridewire.motion")]
    assert third_party(kernel) == {"numpy"}
    wrong = [
        i
        for i in kernel
        if within(i.target, "stridewire") and not within(i.target, "stridewire.motion")
    ]
    assert not wrong, listed(wrong)


@pytest.mark.parametrize("part", ["formats", "scripts", "drawing", "_messages", "_errors"])
def test_what_the_engine_takes_of_the_client_knows_no_wire(part: str) -> None:
    """None of it reaches stubs, codec, client or gRPC."""
    wrong = [
        i
        for i in imports_of("stridewire")
        if within(i.module, f"stridewire.{part}")
        and (within(i.target, "grpc", "google", "stridewire.v1", "stridewire._codec"))
    ]
    assert not wrong, listed(wrong)


def test_the_engine_takes_of_the_client_what_the_design_says() -> None:
    """Motion, formats, scripts, drawing, transport, messages, errors; never stubs or codec."""
    wrong = [
        i
        for i in imports_of("stridewire_engine")
        if within(i.target, "stridewire") and not within(i.target, *CLIENT_FOR_ENGINE)
    ]
    assert not wrong, listed(wrong)


def test_the_engine_imports_only_lower_floors() -> None:
    """Within the engine a part imports itself and parts of a lower floor."""
    wrong = []
    for found in imports_of("stridewire_engine"):
        if not within(found.target, "stridewire_engine"):
            continue
        own, other = (name.split(".")[1:2] for name in (found.module, found.target))
        if own and other and own != other and ENGINE_FLOORS[own[0]] <= ENGINE_FLOORS[other[0]]:
            wrong.append(found)
    assert not wrong, listed(wrong)


def test_only_reports_of_the_engine_draw_and_only_its_commands_ask() -> None:
    """Matplotlib stays within commands and evaluation, click within commands."""
    reports, commands = "stridewire_engine.evaluation", "stridewire_engine.commands"
    wrong = [
        i
        for i in imports_of("stridewire_engine")
        if (within(i.target, "matplotlib") and not within(i.module, reports, commands))
        or (within(i.target, "click") and not within(i.module, commands))
    ]
    assert not wrong, listed(wrong)


def test_every_part_of_the_engine_has_a_floor() -> None:
    """A new part must be given its floor here and in the design."""
    folder = ROOT / "server" / "stridewire_engine"
    parts = {path.stem for path in folder.glob("[a-z]*") if path.suffix in ("", ".py")}
    assert parts <= set(ENGINE_FLOORS)


def test_the_walk_finds_imports() -> None:
    """The walk itself works: it sees plain, aliased, relative-free and local imports."""
    found = {(i.module, i.target) for i in imports_of("stridewire")}
    assert ("stridewire.motion.kinematics", "stridewire.motion.quaternion") in found
    assert ("stridewire.drawing.contact_sheet", "matplotlib.figure.Figure") in found
