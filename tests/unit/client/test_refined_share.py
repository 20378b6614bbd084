"""The refined share, from transitions as they come."""

from stridewire._messages import FallbackReason, Transition, TransitionReason
from stridewire.refined_share import RefinedShare


def jump(
    frame: int,
    refined_frames: int = 0,
    reason: TransitionReason = TransitionReason.BETTER_MATCH,
    fallback: FallbackReason | None = None,
) -> Transition:
    """Return a transition of character 3."""
    return Transition(
        3, frame, "a", 0.0, "b", 0.0, reason, fallback=fallback, refined_frames=refined_frames
    )


def test_only_transitions_that_ended_count() -> None:
    """Of five, a beginning and one that still runs do not count; one of the others was cut off."""
    share = RefinedShare()
    for event in (
        jump(1, reason=TransitionReason.START),
        jump(20),
        jump(60, refined_frames=40),
        jump(67, refined_frames=7, fallback=FallbackReason.BUSY),
        jump(99),
    ):
        share.take(event)
    assert (share.ended, share.refined) == (3, 1)
    assert share.reasons == {FallbackReason.BUSY: 1}


def test_nothing_is_refined_where_nothing_happened() -> None:
    """No transition, no division by zero."""
    assert RefinedShare().percent == 0.0
