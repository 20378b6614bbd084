"""Matches: moments of a library that fit, and those that were not to be chosen."""

from stridewire._codec.shared import decode_channels, encode_channels
from stridewire._messages import ExcludedMatch, Match
from stridewire.v1 import match_pb2


def encode_match(match: Match) -> match_pb2.Match:
    """Encode a match."""
    return match_pb2.Match(
        clip=match.clip,
        time_s=match.time_s,
        tags=match.tags,
        cost=match.cost,
        channels=encode_channels(match.channels),
        bias=match.bias,
    )


def decode_match(wire: match_pb2.Match) -> Match:
    """Decode a match."""
    channels = decode_channels(wire.channels)
    return Match(wire.clip, wire.time_s, tuple(wire.tags), wire.cost, channels, wire.bias)


def encode_excluded(excluded: ExcludedMatch) -> match_pb2.ExcludedMatch:
    """Encode a match that was not to be chosen."""
    return match_pb2.ExcludedMatch(match=encode_match(excluded.match), reason=excluded.reason)


def decode_excluded(wire: match_pb2.ExcludedMatch) -> ExcludedMatch:
    """Decode a match that was not to be chosen."""
    return ExcludedMatch(decode_match(wire.match), wire.reason)
