"""What stands around every method: errors become statuses, faults are logged and not leaked."""

from collections.abc import Awaitable, Callable
from typing import Any

import grpc

from stridewire._codec.status import DETAILS_KEY, encode_details
from stridewire_server.faults import as_error

Method = Callable[[Any, Any], Awaitable[Any]]


class ErrorInterceptor(grpc.aio.ServerInterceptor):  # type: ignore[type-arg]
    """Turns our errors into statuses with details, and anything else into INTERNAL with an id."""

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
        return handler._replace(**{kind: _guarded(getattr(handler, kind), details.method)})


def _guarded(method: Method, name: str) -> Method:
    async def guarded(request: Any, context: Any) -> Any:
        try:
            return await method(request, context)
        except grpc.aio.AbortError:
            raise
        except Exception as caught:
            error = as_error(caught, name)
            metadata = ((DETAILS_KEY, encode_details(error)),)
            await context.abort(grpc.StatusCode[error.code], str(error), metadata)

    return guarded
