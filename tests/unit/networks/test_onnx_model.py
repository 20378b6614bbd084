"""Models are read from bytes, checked before use, and refused with what to do."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

from stridewire_engine.networks import onnx_model
from stridewire_engine.networks.onnx_model import ModelError, OnnxModel, shipped_model


def _shipped() -> bytes:
    return (onnx_model.files(onnx_model.WEIGHTS) / "blend.onnx").read_bytes()


def test_bytes_that_are_no_model_are_refused() -> None:
    """The message says so, and what to do."""
    with pytest.raises(ModelError, match=r"no ONNX model .* export it again"):
        OnnxModel("blend.onnx", b"nonsense")


def test_a_model_of_other_features_is_refused() -> None:
    """A fact that differs is named, with both values."""
    with pytest.raises(ModelError, match="features '1', this code '2'"):
        OnnxModel("blend.onnx", _shipped()).require({"features": "2"})


def test_the_shipped_model_has_the_listed_hash() -> None:
    """`SHA256SUMS` beside the weights lists the file that is loaded."""
    assert shipped_model("blend").hash == hashlib.sha256(_shipped()).hexdigest()


def test_an_exchanged_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that is not the listed one does not serve."""
    (tmp_path / "blend.onnx").write_bytes(_shipped())
    (tmp_path / onnx_model.SUMS).write_text(f"{'0' * 64}  blend.onnx\n")
    monkeypatch.setattr(onnx_model, "files", lambda package: tmp_path)
    with pytest.raises(ModelError, match="damaged or was exchanged"):
        shipped_model("blend")


def test_a_missing_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The message names the file."""
    monkeypatch.setattr(onnx_model, "files", lambda package: tmp_path)
    with pytest.raises(ModelError, match=r"blend\.onnx is not in this installation"):
        shipped_model("blend")


def test_rows_do_not_depend_on_their_batch(rng: np.random.Generator) -> None:
    """A row alone and among others gives the same numbers."""
    model = OnnxModel("blend.onnx", _shipped())
    rows = rng.normal(size=(40, model.inputs)).astype(np.float32)
    together = model.run(rows)[0]
    alone = np.concatenate([model.run(row[None])[0] for row in rows])
    np.testing.assert_allclose(together, alone, atol=1e-5)
