"""The refined share: of the transitions of a session, how many a network really guided."""

from dataclasses import dataclass, field

from stridewire._messages import Event, FallbackReason, Transition, TransitionReason

REFINED_FRAMES = 8
"""A transition is refined if a network guided the feet for so many frames."""


@dataclass
class RefinedShare:
    """Counts transitions by what came of them, as the character's next transition tells."""

    ended: int = 0
    """Transitions that another one ended; beginnings are none."""
    refined: int = 0
    reasons: dict[FallbackReason, int] = field(default_factory=dict)
    """Why `stance` hid transitions that `refine` should have hidden."""
    _since: dict[int, TransitionReason] = field(default_factory=dict)

    def take(self, event: Event) -> None:
        """Note what happened to a character; events of one character come in order."""
        if not isinstance(event, Transition):
            return
        if self._since.get(event.character, TransitionReason.START) is not TransitionReason.START:
            self.ended += 1
            self.refined += event.refined_frames >= REFINED_FRAMES
        if event.fallback is not None:
            self.reasons[event.fallback] = self.reasons.get(event.fallback, 0) + 1
        self._since[event.character] = event.reason

    @property
    def percent(self) -> float:
        """Share of the refined among those that ended; 0 where none did."""
        return 100.0 * self.refined / max(1, self.ended)
