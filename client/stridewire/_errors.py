"""Errors of the public interface.

    StridewireError
    ├── InvalidRequestError (also ValueError)     INVALID_ARGUMENT: `.violations` say which fields
    ├── NotFoundError (also LookupError)          NOT_FOUND: no such library, clip, session
    ├── ProtocolError                             FAILED_PRECONDITION: messages out of order
    ├── ExhaustedError                            RESOURCE_EXHAUSTED: a limit, a reader too slow
    ├── NotImplementedYetError                    UNIMPLEMENTED: a field or method of a later
    version ├── UnavailableError                          UNAVAILABLE: no server there, or it is
    stopping └── ServerError                               INTERNAL and the rest: a fault of the
    server

Each carries `.code` (the gRPC code's name), `.violations` and `.retry_after_s`; `__cause__` is the
transport's own error where there is one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class Violation:
    """What is wrong with one field."""

    field: str
    """Path, for instance `step.velocity_xz[12]`."""
    description: str
    """What was given, what is allowed, what to do."""

    def __str__(self) -> str:
        return f"{self.field}: {self.description}"


class StridewireError(Exception):
    """Base of all errors of the public interface."""

    code: ClassVar[str] = "UNKNOWN"

    def __init__(
        self,
        message: str,
        violations: Sequence[Violation] = (),
        retry_after_s: float | None = None,
    ) -> None:
        super().__init__(message)
        self.violations = tuple(violations)
        """Fields that were refused."""
        self.retry_after_s = retry_after_s
        """When trying again may help; seconds; None where it won't or is not known."""


class InvalidRequestError(StridewireError, ValueError):
    """A field has a value that is not allowed."""

    code = "INVALID_ARGUMENT"

    @classmethod
    def of(cls, *violations: Violation) -> "InvalidRequestError":
        """Make the error's message out of its violations."""
        return cls("; ".join(map(str, violations)), violations)


class NotFoundError(StridewireError, LookupError):
    """There is no library, clip or session of that name."""

    code = "NOT_FOUND"


class ProtocolError(StridewireError):
    """Messages came in an order that is not allowed."""

    code = "FAILED_PRECONDITION"


class ExhaustedError(StridewireError):
    """A limit was reached, or the reader was too slow."""

    code = "RESOURCE_EXHAUSTED"


class NotImplementedYetError(StridewireError):
    """The field or method belongs to a later version; the message names it."""

    code = "UNIMPLEMENTED"


class UnavailableError(StridewireError):
    """There is no server there, or it is stopping."""

    code = "UNAVAILABLE"


class ServerError(StridewireError):
    """The server failed; its log holds the correlation id of the message."""

    code = "INTERNAL"


ERROR_BY_CODE: dict[str, type[StridewireError]] = {
    error.code: error
    for error in (
        InvalidRequestError,
        NotFoundError,
        ProtocolError,
        ExhaustedError,
        NotImplementedYetError,
        UnavailableError,
        ServerError,
    )
}
"""Which error a gRPC code becomes; codes that are absent become `ServerError`."""
