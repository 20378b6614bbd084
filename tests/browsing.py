"""A real browser for tests: Debian's Chromium, driven by Playwright, without a screen."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Page

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

SOFTWARE_GL = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
)
"""Draw on the processor: machines that run tests have no graphics card."""


def absent() -> str:
    """Return why there is no browser; empty where there is one."""
    try:
        import playwright  # noqa: F401
    except ImportError:
        return "needs Playwright: pip install playwright"
    return "" if CHROMIUM else "needs Chromium: apt-get install chromium"


needs_browser = pytest.mark.skipif(bool(absent()), reason=absent())


class Visit:
    """A page that is open, and what went on in it that should not."""

    def __init__(self, page: "Page") -> None:
        self.page = page
        self.wrong: list[str] = []
        self.requests: list[str] = []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("requestfailed", lambda request: self.wrong.append(f"failed: {request.url}"))
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("websocket", lambda socket: self.requests.append(socket.url))

    def ask(self, expression: str) -> Any:
        """Return the value of an expression in which `play` and `stage` are the page's own."""
        return self.page.evaluate(f"() => {{ const {{ play, stage }} = stridewire; {expression} }}")

    def wait(self, condition: str, timeout_s: float = 60.0) -> None:
        """Wait until a condition on `stridewire.play` and `stridewire.stage` holds."""
        self.page.wait_for_function(
            f"() => {{ const {{ play, stage }} = globalThis.stridewire ?? {{}};"
            f" return Boolean(play && ({condition})); }}",
            timeout=1e3 * timeout_s,
        )

    def _console(self, message: Any) -> None:
        if message.type in ("error", "warning") and "GPU stall" not in message.text:
            self.wrong.append(f"{message.type}: {message.text}")


@contextmanager
def visit(
    url: str, size: tuple[int, int] = (640, 400), quality: int = 3, **context: Any
) -> Iterator[Visit]:
    """Open a page in a fresh browser.

    Args:
        url: Of the page.
        size: Of its window; pixels.
        quality: Of the drawing: 0 with shadows, 3 the plainest.
        context: What else Playwright's contexts take.
    """
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=list(SOFTWARE_GL))
        viewport = {"width": size[0], "height": size[1]}
        page = browser.new_context(viewport=viewport, **context).new_page()  # type: ignore[arg-type]
        visiting = Visit(page)
        page.goto(f"{url}#quality={quality}")
        yield visiting
        browser.close()
