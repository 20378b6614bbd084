"""Events of a frame: transitions, contacts, clip ends, tags."""

from typing import assert_never

from stridewire._codec.matches import (
    decode_excluded,
    decode_match,
    encode_excluded,
    encode_match,
)
from stridewire._codec.shared import decode_channels, encode_channels
from stridewire._errors import ServerError
from stridewire._messages import (
    ClipEnd,
    ContactChange,
    Event,
    FallbackReason,
    TagEntered,
    Transition,
    TransitionReason,
)
from stridewire.v1 import animation_pb2 as pb
from stridewire.v1 import pose_pb2


def encode_event(event: Event) -> pb.Event:
    """Encode what happened to a character."""
    wire = pb.Event(character=event.character, frame=event.frame)
    match event:
        case Transition():
            wire.transition.CopyFrom(_encode_transition(event))
        case ContactChange():
            wire.contact.joint, wire.contact.planted = event.joint, event.planted
            wire.contact.SetInParent()
        case ClipEnd():
            wire.clip_end.clip = event.clip
            wire.clip_end.SetInParent()
        case TagEntered():
            wire.tag_entered.tag = event.tag
            wire.tag_entered.SetInParent()
        case _:
            assert_never(event)
    return wire


def decode_event(wire: pb.Event) -> Event:
    """Decode what happened to a character.

    Raises:
        ServerError: If the event is none that is known.
    """
    match wire.WhichOneof("event"):
        case "transition":
            return _decode_transition(wire)
        case "contact":
            return ContactChange(
                wire.character, wire.frame, wire.contact.joint, wire.contact.planted
            )
        case "clip_end":
            return ClipEnd(wire.character, wire.frame, wire.clip_end.clip)
        case "tag_entered":
            return TagEntered(wire.character, wire.frame, wire.tag_entered.tag)
    raise ServerError("the server sent an event of an unknown kind; update this client")


def _encode_transition(event: Transition) -> pb.Transition:
    fallback = "UNSPECIFIED" if event.fallback is None else event.fallback.name
    wire = pb.Transition(
        to=pose_pb2.ClipTime(clip=event.to_clip, time_s=event.to_time_s),
        cost=event.cost,
        stay_cost=event.stay_cost,
        channels=encode_channels(event.channels),
        reason=f"TRANSITION_REASON_{event.reason.name}",
        bias=event.bias,
        runners_up=map(encode_match, event.runners_up),
        excluded=map(encode_excluded, event.excluded),
        fallback=f"FALLBACK_REASON_{fallback}",
        refined_frames=event.refined_frames,
    )
    if event.from_clip:
        # `from` is a keyword of Python, so that the generated attribute can only be named so.
        getattr(wire, "from").CopyFrom(
            pose_pb2.ClipTime(clip=event.from_clip, time_s=event.from_time_s)
        )
    return wire


def _decode_transition(wire: pb.Event) -> Transition:
    transition = wire.transition
    origin: pose_pb2.ClipTime = getattr(transition, "from")
    return Transition(
        character=wire.character,
        frame=wire.frame,
        from_clip=origin.clip,
        from_time_s=origin.time_s,
        to_clip=transition.to.clip,
        to_time_s=transition.to.time_s,
        reason=TransitionReason(transition.reason),
        cost=transition.cost,
        stay_cost=transition.stay_cost,
        channels=decode_channels(transition.channels),
        bias=transition.bias,
        runners_up=tuple(map(decode_match, transition.runners_up)),
        excluded=tuple(map(decode_excluded, transition.excluded)),
        fallback=FallbackReason(transition.fallback) if transition.fallback else None,
        refined_frames=transition.refined_frames,
    )
