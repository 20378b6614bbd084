"""Replaying: a recorded session's controls through a runtime, without a clock."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from stridewire._messages import CharacterSpec, Edit, Frame, Open
from stridewire.formats.session_file import Advance, Control, SessionFile
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime


@dataclass(frozen=True)
class Variant:
    """What is to be different from the recorded session."""

    stitcher: str = ""
    """Of all characters; empty means what was recorded."""
    weights: Mapping[str, float] = field(default_factory=dict)
    """Of channels, for all characters; others keep what was recorded."""

    def changed(self, spec: CharacterSpec) -> CharacterSpec:
        """Return a character as it is to be."""
        weights = {**spec.weights, **self.weights}
        return replace(spec, stitcher=self.stitcher or spec.stitcher, weights=weights)


AS_RECORDED = Variant()


def recorded(file: SessionFile) -> Iterator[Frame]:
    """Yield the frames that were recorded."""
    return (entry for entry in file.entries() if isinstance(entry, Frame))


def replay(
    file: SessionFile,
    library: Library,
    variant: Variant = AS_RECORDED,
    watch: Callable[[], None] = lambda: None,
) -> Iterator[Frame]:
    """Yield the frames that the recorded controls make, one for each time that they made one.

    Args:
        file: The session.
        library: That its characters move by.
        variant: What is to be different.
        watch: Called after each frame.

    Raises:
        InvalidRequestError: If the library has no tag or the runtime no stitcher of that name.
        SessionFileError: If the file is damaged.
    """
    runtime = Runtime([library])
    session = runtime.open(_opening(file.opening, variant))
    for entry in file.entries():
        match entry:
            case Control(step):
                runtime.control(session, step)
            case Advance(step, level):
                ((frame, _),) = runtime.advance([(session, step)], level)
                yield frame
                watch()
            case Edit():
                runtime.edit(session, _edit(entry, variant))


def _opening(opening: Open, variant: Variant) -> Open:
    return replace(
        opening,
        library="",
        characters=tuple(map(variant.changed, opening.characters)),
        resume_token="",
    )


def _edit(edit: Edit, variant: Variant) -> Edit:
    updates = (replace(update, spec=variant.changed(update.spec)) for update in edit.update)
    return replace(edit, add=tuple(map(variant.changed, edit.add)), update=tuple(updates))
