"""What stands around every method: errors become statuses, faults are logged and not leaked."""

from collections.abc import Awaitable, Callable
from typing import Any

import grpc
from google.protobuf.message import Message

from stridewire._codec.status import DETAILS_KEY, encode_details
from stridewire._errors import ExhaustedError
from stridewire._messages import Limits
from stridewire_server.faults import as_error

Method = Callable[[Any, Any], Awaitable[Any]]

_TAKE_FILES = {"/stridewire.v1.StitchService/Stitch"}


class ErrorInterceptor(grpc.aio.ServerInterceptor):  # type: ignore[type-arg]
    """Turns our errors into statuses with details, and anything else into INTERNAL with an id.

    Args:
        limits: Of messages; methods that take motion files have a larger one of the transport.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits

    async def intercept_service(self, continuation: Any, details: Any) -> Any:
        """Wrap a method of ours; health and reflection answer for themselves."""
        handler = await continuation(details)
        if handler is None or not details.method.startswith("/stridewire."):
            return handler
        kind = next(
            kind
            for kind in ("unary_unary", "unary_stream", "stream_unary", "stream_stream")
            if getattr(handler, kind) is not None
        )
        most = None if details.method in _TAKE_FILES else self._limits.max_message_bytes
        return handler._replace(**{kind: _guarded(getattr(handler, kind), details.method, most)})


def check_size(message: Any, most: int) -> None:
    """Refuse a message that is too long.

    Raises:
        ExhaustedError: If it has more than `most` bytes.
    """
    size = message.ByteSize()
    if size > most:
        raise ExhaustedError(f"a message of {size} bytes; allowed are {most}")


def _guarded(method: Method, name: str, most: int | None) -> Method:
    async def guarded(request: Any, context: Any) -> Any:
        try:
            if most is not None and isinstance(request, Message):
                check_size(request, most)
            return await method(request, context)
        except grpc.aio.AbortError:
            raise
        except Exception as caught:
            error = as_error(caught, name)
            metadata = ((DETAILS_KEY, encode_details(error)),)
            await context.abort(grpc.StatusCode[error.code], str(error), metadata)

    return guarded
