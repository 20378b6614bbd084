"""Faults: whatever goes wrong becomes an error of the contract; what is ours is logged."""

import logging
import uuid

from google.protobuf.message import DecodeError

from stridewire._errors import InvalidRequestError, ServerError, StridewireError

log = logging.getLogger("stridewire.server")


def as_error(error: Exception, where: str) -> StridewireError:
    """Return what a client is told; a fault of ours is logged under an id and not leaked.

    Args:
        error: That was caught, within the handler of the exception.
        where: Name of the method or endpoint.
    """
    if isinstance(error, StridewireError):
        return error
    if isinstance(error, DecodeError):
        return InvalidRequestError("the bytes are no message of this method")
    fault = uuid.uuid4().hex[:12]
    log.error("fault %s in %s", fault, where, exc_info=error)
    return ServerError(f"internal error; the server's log has it as {fault}")
