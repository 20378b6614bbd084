"""ONNX models: read from bytes, checked, run on one thread, on two where there is much to do."""

import hashlib
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from importlib.resources import files
from typing import Any

import numpy as np
import onnxruntime

from stridewire.motion.array_types import Floats

WEIGHTS = "stridewire_models.weights"
SUMS = "SHA256SUMS"
_MUCH = 20_000
"""From so many numbers on, another thread takes half of the rows."""


class ModelError(ValueError):
    """A model is damaged or made for other code; the message says what to do."""


class OnnxModel:
    """A model with one input; safe to share between threads."""

    def __init__(self, name: str, data: bytes) -> None:
        """Open a model.

        Args:
            name: In messages.
            data: The file.

        Raises:
            ModelError: If it is no ONNX model.
        """
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        options.execution_mode = onnxruntime.ExecutionMode.ORT_SEQUENTIAL
        # idle threads that spin would starve the tick
        options.add_session_config_entry("session.intra_op.allow_spinning", "0")
        options.log_severity_level = 3
        try:
            self._session = onnxruntime.InferenceSession(
                data, options, providers=["CPUExecutionProvider"]
            )
        except Exception as error:
            raise ModelError(
                f"{name} is no ONNX model that this runtime reads ({error}); export it again"
            ) from error
        self._input = self._session.get_inputs()[0].name
        self._other = ThreadPoolExecutor(1, thread_name_prefix="stridewire-network")
        self.name = name
        self.hash = hashlib.sha256(data).hexdigest()
        """Hexadecimal digest of the file."""

    @property
    def facts(self) -> Mapping[str, str]:
        """What the export wrote into the model."""
        facts: Mapping[str, str] = self._session.get_modelmeta().custom_metadata_map
        return facts

    @property
    def inputs(self) -> int:
        """Numbers that it reads of one row."""
        size: Any = self._session.get_inputs()[0].shape[-1]
        return int(size)

    def require(self, facts: Mapping[str, str]) -> None:
        """Check what the export wrote.

        Raises:
            ModelError: If a fact is missing or another.
        """
        for key, expected in facts.items():
            found = self.facts.get(key)
            if found != expected:
                raise ModelError(
                    f"{self.name} has {key} {found!r}, this code {expected!r}; train and export it "
                    "again, or install the release that it came with"
                )

    def run(self, rows: Floats) -> list[Floats]:
        """Return the outputs for rows `(N, inputs)`."""
        rows = rows.astype(np.float32, copy=False)
        if rows.size < _MUCH:
            return self._run(rows)
        half = len(rows) // 2
        other = self._other.submit(self._run, rows[half:])
        both = zip(self._run(rows[:half]), other.result(), strict=True)
        return [np.concatenate(parts) for parts in both]

    def _run(self, rows: Floats) -> list[Floats]:
        outputs: list[Floats] = self._session.run(None, {self._input: rows})
        return outputs


def shipped_model(name: str) -> OnnxModel:
    """Open a model that comes with the package.

    Args:
        name: Of its file, without ending.

    Raises:
        ModelError: If it is not there, or not the file whose hash `SHA256SUMS` lists.
    """
    folder = files(WEIGHTS)
    file = f"{name}.onnx"
    try:
        data = (folder / file).read_bytes()
        listed = (folder / SUMS).read_text()
    except FileNotFoundError as error:
        raise ModelError(
            f"the model {file} is not in this installation ({error}); install stridewire again"
        ) from error
    sums = {line.split()[1]: line.split()[0] for line in listed.splitlines()}
    model = OnnxModel(file, data)
    if sums.get(file) != model.hash:
        raise ModelError(
            f"{file} is not the file that {SUMS} lists: it is damaged or was exchanged; install "
            "stridewire again, or export it with `stridewire export`"
        )
    return model


def is_listed(name: str) -> bool:
    """Tell whether a model is among those that come with the package.

    Args:
        name: Of its file, without ending.
    """
    listed = files(WEIGHTS) / SUMS
    return listed.is_file() and f"{name}.onnx" in listed.read_text().split()
