"""The site: built files, what is told about the server, files to look at, conversion."""

import json
from collections.abc import Mapping
from importlib import resources
from typing import Any

from websockets.http11 import Response

from stridewire._messages import InfoQuery
from stridewire_engine.runtime import Runtime
from stridewire_server.page.conversion import FORMATS, convert
from stridewire_server.websocket.door import Talk, found

_KINDS = {
    "index.html": "text/html; charset=utf-8",
    "page.css": "text/css; charset=utf-8",
    "page.js": "text/javascript; charset=utf-8",
    "icon.svg": "image/svg+xml",
    "LICENSES.txt": "text/plain; charset=utf-8",
}

POLICY = "default-src 'self'; img-src 'self' blob:; base-uri 'none'; frame-ancestors 'none'"
"""What the page may load and reach: nothing but the server that it came from."""


class Site:
    """What the WebSocket door serves to the page.

    Args:
        about: What the page is told at its begin.
        blobs: Arrays as bytes by their path.
    """

    def __init__(self, about: Mapping[str, Any], blobs: Mapping[str, bytes] | None = None) -> None:
        self._about = json.dumps(about).encode()
        self._blobs = blobs or {}
        self._built = resources.files("stridewire_server.page") / "built"
        self.talks: dict[str, Talk] = {f"/page/convert/{name}": convert(name) for name in FORMATS}
        """What is talked over WebSockets of the page's own."""

    def find(self, path: str) -> Response | None:
        """Return what lies at a path."""
        if path == "/page/about.json":
            return found(self._about, "application/json")
        if path in self._blobs:
            return found(self._blobs[path], "application/octet-stream")
        name = path.removeprefix("/") or "index.html"
        if name not in _KINDS:
            return None
        response = found((self._built / name).read_bytes(), _KINDS[name])
        response.headers["Content-Security-Policy"] = POLICY
        return response


def about(runtime: Runtime) -> dict[str, Any]:
    """Return what the page is told about a server."""
    info = runtime.ask(InfoQuery())
    return {
        "version": info.version,
        "stitchers": list(info.stitchers),
        "libraries": [
            {
                "name": name,
                "synthetic": library.info().synthetic,
                "credit": library.info().credit,
                "tags": list(library.tag_names),
                "channels": {
                    channel["name"]: channel["weight"]
                    for channel in library.manifest.schema["channels"]
                },
            }
            for name, library in runtime.libraries.items()
        ],
        "files": [],
    }
