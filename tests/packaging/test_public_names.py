"""The public names: there, documented, sorted, and no more than those."""

import importlib
import inspect

import pytest

import stridewire

MODULES = ["stridewire", "stridewire.drawing", "stridewire.scripts"]


@pytest.mark.parametrize("module", MODULES)
def test_every_public_name_is_there_and_documented(module: str) -> None:
    """Each name of `__all__` resolves; classes and functions say what they are."""
    loaded = importlib.import_module(module)
    for name in loaded.__all__:
        public = getattr(loaded, name)
        if inspect.isclass(public) or inspect.isfunction(public):
            assert inspect.getdoc(public), name


def test_public_names_are_those_of_dir() -> None:
    """What completion offers is what is public."""
    assert dir(stridewire) == stridewire.__all__ == sorted(stridewire.__all__)


def test_an_unknown_name_is_an_attribute_error() -> None:
    """Lazy loading does not hide typing mistakes."""
    with pytest.raises(AttributeError, match="Clinet"):
        stridewire.Clinet  # noqa: B018


def test_errors_are_all_public() -> None:
    """Everything that a client may raise can be caught by its public name."""
    from stridewire._errors import ERROR_BY_CODE

    assert {error.__name__ for error in ERROR_BY_CODE.values()} <= set(stridewire.__all__)
