"""Stridewire: drive characters from control inputs and get poses back, 60 times a second."""

from importlib import import_module
from typing import Any

_HOME = {
    "__version__": "_version",
    "AsyncClient": "aio",
    "Client": "client",
    **dict.fromkeys(
        (
            "BlendMethod",
            "BlendQuery",
            "BlendResult",
            "BvhText",
            "CharacterSpec",
            "CharacterUpdate",
            "ClipSpan",
            "ClipTime",
            "CorrectionMode",
            "DesiredMotion",
            "Detail",
            "Frame",
            "FrameFlag",
            "GroundPose",
            "Inside",
            "Pacing",
            "PoseFormat",
            "RootCorrection",
            "RootPath",
            "Seam",
            "Sparse",
            "StitchHeader",
            "StitchQuery",
            "StitchReport",
            "Stitched",
            "Trajectory",
        ),
        "_messages",
    ),
    **dict.fromkeys(
        (
            "ExhaustedError",
            "InvalidRequestError",
            "NotFoundError",
            "NotImplementedYetError",
            "ProtocolError",
            "ServerError",
            "StridewireError",
            "UnavailableError",
            "Violation",
        ),
        "_errors",
    ),
}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    """Load a public name when first asked for (PEP 562): the kernel loads without gRPC."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"stridewire.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
