"""The reference says what contract and commands say now."""

from tests.docs.reference import ROOT, reference


def test_the_reference_is_up_to_date() -> None:
    """`make reference` would change nothing."""
    assert (ROOT / "docs" / "reference.md").read_text() == reference(), "run `make reference`"


def test_the_reference_has_every_method_and_command() -> None:
    """Methods by name, commands by path."""
    text = reference()
    for word in (
        "**Animate**",
        "**Search**",
        "**GetClip**",
        "stridewire replay",
        "stridewire serve",
    ):
        assert word in text
