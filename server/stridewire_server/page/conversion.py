"""Frames that a page has kept, made into a motion file.

The page sends what it was sent: Opened, the frames, and an empty message for the end. It gets the
file as one message.
"""

import asyncio
from pathlib import Path
from tempfile import TemporaryDirectory

from websockets.asyncio.server import ServerConnection

from stridewire._codec.responses import decode_response
from stridewire._errors import ExhaustedError, InvalidRequestError, ServerError
from stridewire._messages import Frame, Opened
from stridewire.formats.writing import write_clip
from stridewire.recording import Recording
from stridewire.v1 import animation_pb2 as pb
from stridewire_server.websocket.door import OPEN_S, Talk

FORMATS = ("bvh", "glb")
MOST_BYTES = 96 << 20
"""Most that one recording may take, as it was sent."""


def convert(kind: str) -> Talk:
    """Return what is talked to get a file of a kind."""

    async def talk(connection: ServerConnection) -> None:
        messages = await _gather(connection)
        await connection.send(await asyncio.to_thread(_file, messages, kind))

    return talk


async def _gather(connection: ServerConnection) -> list[bytes]:
    messages: list[bytes] = []
    taken = 0
    while True:
        try:
            async with asyncio.timeout(OPEN_S):
                data = await connection.recv()
        except TimeoutError:
            raise InvalidRequestError("an empty message must tell the end") from None
        if isinstance(data, str):
            raise InvalidRequestError("a text message; send messages as they came")
        if not data:
            return messages
        taken += len(data)
        if taken > MOST_BYTES:
            raise ExhaustedError(f"a recording may take {MOST_BYTES >> 20} MiB; keep a shorter one")
        messages.append(data)


def _file(messages: list[bytes], kind: str) -> bytes:
    """Return the content of a file with the motion of the first character."""
    try:
        decoded = [decode_response(pb.AnimateResponse.FromString(data)) for data in messages]
    except ServerError:
        raise InvalidRequestError("the messages must be those that a session sent") from None
    if not decoded or not isinstance(decoded[0], Opened):
        raise InvalidRequestError("the first message must be Opened")
    recording = Recording(decoded[0].skeleton)
    for message in decoded[1:]:
        if not isinstance(message, Frame):
            raise InvalidRequestError("all messages after the first must be frames")
        recording.add(message)
    if not recording.characters:
        raise InvalidRequestError("no frame was sent; let the character move first")
    clip = recording.clip(recording.characters[0], "stridewire", decoded[0].settings.rate_hz)
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"stridewire.{kind}"
        write_clip(path, clip)
        return path.read_bytes()
