"""Services that the contract has and a later version fills."""

from typing import Any, NoReturn

from stridewire._errors import NotImplementedYetError
from stridewire.v1.stitch_pb2_grpc import StitchServiceServicer


class StitchService(StitchServiceServicer):
    """Will make one natural motion of several clips."""

    async def Stitch(self, request: Any, context: Any) -> NoReturn:
        """Refuse."""
        raise _later("StitchService.Stitch")


def _later(method: str) -> NotImplementedYetError:
    return NotImplementedYetError(
        f"{method} is not implemented yet; this server streams characters (AnimationService), "
        "searches libraries (MatchService) and blends postures (BlendService)"
    )
