"""Errors as gRPC statuses: code, message and the details of `google.rpc`."""

from google.protobuf.any_pb2 import Any
from google.protobuf.message import DecodeError
from google.rpc.code_pb2 import Code
from google.rpc.error_details_pb2 import BadRequest, RetryInfo
from google.rpc.status_pb2 import Status

from stridewire._errors import ERROR_BY_CODE, ServerError, StridewireError, Violation

DETAILS_KEY = "grpc-status-details-bin"
"""Trailing metadata that holds the details."""

MAX_VIOLATIONS = 100
"""Most violations that one error lists."""


def encode_details(error: StridewireError) -> bytes:
    """Return the details of an error for the trailing metadata."""
    status = Status(code=Code.Value(error.code), message=str(error))
    if error.violations:
        bad = BadRequest()
        for violation in error.violations[:MAX_VIOLATIONS]:
            bad.field_violations.add(field=violation.field, description=violation.description)
        _pack(status, bad)
    if error.retry_after_s is not None:
        retry = RetryInfo()
        retry.retry_delay.FromNanoseconds(round(error.retry_after_s * 1e9))
        _pack(status, retry)
    details: bytes = status.SerializeToString()
    return details


def decode_error(code: str, message: str, details: bytes | None) -> StridewireError:
    """Return the error that a status means.

    Args:
        code: Name of the gRPC code.
        message: The status message.
        details: The trailing metadata's details, where there are any.
    """
    violations: list[Violation] = []
    retry_after_s = None
    for part in _details(details):
        bad, retry = BadRequest(), RetryInfo()
        if part.Unpack(bad):
            violations += [Violation(v.field, v.description) for v in bad.field_violations]
        elif part.Unpack(retry):
            retry_after_s = retry.retry_delay.ToNanoseconds() / 1e9
    kind = ERROR_BY_CODE.get(code, ServerError)
    text = message if code in ERROR_BY_CODE else f"{code}: {message}"
    return kind(text, violations, retry_after_s)


def _pack(status: Status, detail: BadRequest | RetryInfo) -> None:
    packed = Any()
    packed.Pack(detail)
    status.details.append(packed)


def _details(data: bytes | None) -> list[Any]:
    """Return the details; none where a proxy on the way has spoiled them."""
    try:
        return list(Status.FromString(data or b"").details)
    except DecodeError:
        return []
