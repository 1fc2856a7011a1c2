"""Chromium without a window, spoken to over the pipe of its DevTools protocol: one browser for any number of drawings.

It sees nothing but the drawing: every request is answered here, and there is no network.
"""

from __future__ import annotations

import base64
import itertools
import json
import os
import shutil
import subprocess
import tempfile
from math import ceil
from types import TracebackType
from typing import Any, Self

_FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-pipe",
    "--hide-scrollbars",
)
_HOST = "http://drawing.invalid/"
_PAGE_PAD_PX = 64.0
_LONGEST_PAPER_PX = 19000.0
_PX_PER_INCH = 96.0
_MOST_PIXELS = 4096.0


def executable() -> str | None:
    """Where Chromium is, if it is."""
    return next(filter(None, map(shutil.which, ("chromium", "google-chrome", "chromium-browser"))), None)


class Chromium:
    """Shows one drawing at a time, in a frame of the size of its page. Errors: OSError where there is no browser,
    RuntimeError for what it refuses."""

    def __init__(self) -> None:
        program = executable()
        if program is None:
            raise FileNotFoundError("chromium is not installed (on Debian: apt install chromium)")
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self._to = os.pipe()
        self._from, from_browser = os.pipe()
        # The browser reads from its descriptor 3 and writes to 4; a shell puts them there, whatever they are here.
        shell = f'exec "$@" 3<&{to_browser} 4>&{from_browser}'
        self._process = subprocess.Popen(
            ["/bin/bash", "-c", shell, "chromium", program, *_FLAGS, f"--user-data-dir={self._profile.name}"],
            pass_fds=(to_browser, from_browser),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        self._buffer = b""
        self._numbers = itertools.count(1)
        self._session: str | None = None
        self._drawing = b""
        self._size_px = (0.0, 0.0)
        self._is_loaded = False
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for method in ("Page.enable", "Runtime.enable"):
            self.call(method)
        self.call("Fetch.enable", patterns=[{"urlPattern": "*"}])
        self.call("Emulation.setEmulatedMedia", media="screen")
        self.call("Emulation.setDefaultBackgroundColorOverride", color={"r": 0, "g": 0, "b": 0, "a": 0})

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._process.terminate()
        self._process.wait()
        os.close(self._to)
        os.close(self._from)
        self._profile.cleanup()

    def show(self, drawing: bytes, size_px: tuple[float, float]) -> None:
        """Load an SVG into a frame of this size."""
        self._drawing, self._size_px, self._is_loaded = drawing, size_px, False
        self.call("Page.navigate", url=_HOST)
        while not self._is_loaded:
            self._take()

    def run(self, script: str) -> Any:
        """What an expression comes to, in which `svg` is the root element of the drawing and `view` its window."""
        wrapped = (
            "(() => { const view = document.querySelector('iframe').contentWindow;"
            f" const svg = view.document.documentElement; return ({script}); }})()"
        )
        found = self.call("Runtime.evaluate", expression=wrapped, returnByValue=True)
        if "exceptionDetails" in found:
            raise RuntimeError(found["exceptionDetails"]["exception"].get("description", "a script failed"))
        return found["result"].get("value")

    def pdf(self) -> bytes:
        """The page printed; its top left corner is that of the frame, 0.75 points are a pixel."""
        width, height = (min(side + _PAGE_PAD_PX, _LONGEST_PAPER_PX) / _PX_PER_INCH for side in self._size_px)
        margins = dict.fromkeys(("marginTop", "marginBottom", "marginLeft", "marginRight"), 0)
        printed = self.call("Page.printToPDF", paperWidth=width, paperHeight=height, printBackground=True, **margins)
        return base64.b64decode(printed["data"])

    def screenshot(self, scale: float) -> bytes:
        """A PNG with a transparent background, `scale` pixels for one of CSS."""
        width, height = (max(1, min(ceil(side), int(_MOST_PIXELS / scale))) for side in self._size_px)
        self.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=False
        )
        taken = self.call("Page.captureScreenshot", format="png")
        self.call("Emulation.clearDeviceMetricsOverride")
        return base64.b64decode(taken["data"])

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command and wait for its answer."""
        number = self._send(method, parameters)
        while True:
            message = self._take()
            if message.get("id") == number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']['message']}")
                result: dict[str, Any] = message["result"]
                return result

    def _send(self, method: str, parameters: dict[str, Any]) -> int:
        number = next(self._numbers)
        message: dict[str, Any] = {"id": number, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._to, data) :]
        return number

    def _take(self) -> dict[str, Any]:
        """The next message; requests are answered on the way."""
        while b"\0" not in self._buffer:
            data = os.read(self._from, 1 << 20)
            if not data:
                raise RuntimeError("chromium ended")
            self._buffer += data
        line, _, self._buffer = self._buffer.partition(b"\0")
        message: dict[str, Any] = json.loads(line)
        if message.get("method") == "Fetch.requestPaused":
            self._answer(message["params"])
        if message.get("method") == "Page.loadEventFired":
            self._is_loaded = True
        return message

    def _answer(self, request: dict[str, Any]) -> None:
        url = request["request"]["url"]
        width, height = (ceil(side) for side in self._size_px)  # a frame's viewport has whole pixels
        frame = f'<iframe src="drawing.svg" style="border:0;width:{width}px;height:{height}px;display:block"></iframe>'
        bodies = {
            _HOST: ("text/html", f"<!DOCTYPE html><body style='margin:0'>{frame}".encode()),
            _HOST + "drawing.svg": ("image/svg+xml", self._drawing),
        }
        kind, body = bodies.get(url, ("text/plain", b""))
        self._send(
            "Fetch.fulfillRequest",
            {
                "requestId": request["requestId"],
                "responseCode": 200 if url in bodies else 404,
                "responseHeaders": [{"name": "Content-Type", "value": kind}],
                "body": base64.b64encode(body).decode(),
            },
        )
