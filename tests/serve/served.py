"""A real server in a process of its own, and what a page would ask of it."""

from __future__ import annotations

import http.client
import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.drawn_shapes import lines_svg

PAGE = 'viewBox="0 0 60 60" width="60mm" height="60mm"'
SQUARE = lines_svg('<path d="M10 10 H50 V50 H10 Z"/><path d="M20 20 L40 40"/>', PAGE).encode()
PATIENCE_S = 60.0


class Server:
    """`plan serve` on a free port, with a folder of its own."""

    def __init__(self, folder: Path, *options: str) -> None:
        self.folder = folder
        self.process = subprocess.Popen(
            [sys.executable, "-m", "planner", "serve", "--port", "0", "--folder", str(folder), *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().strip()
        assert self.address, self.process.communicate()
        self.port = int(self.address.split(":")[2].split("/")[0])

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def end(self) -> int:
        """As Ctrl-C does."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(PATIENCE_S)

    def answer(
        self, method: str, path: str, body: bytes | None = None, headers: dict[str, str] | None = None
    ) -> tuple[int, dict[str, str], bytes]:
        """Status, headers and body, whatever was asked."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        try:
            connection.request(method, path, body, headers or {})
            response = connection.getresponse()
            return response.status, {key.lower(): value for key, value in response.getheaders()}, response.read()
        finally:
            connection.close()

    def get(self, path: str) -> Any:
        status, _, body = self.answer("GET", path)
        assert status == 200, body
        return json.loads(body)

    def post(self, path: str, asked: object = None, *, status: int | None = None) -> Any:
        given, _, body = self.answer(
            "POST", path, json.dumps(asked or {}).encode(), {"Content-Type": "application/json"}
        )
        assert given == status if status else given < 300, body
        return json.loads(body)

    def upload(self, content: bytes = SQUARE, name: str = "square.svg") -> dict[str, Any]:
        status, _, body = self.answer(
            "POST", f"/api/jobs?name={name}", content, {"Content-Type": "application/octet-stream"}
        )
        assert status == 201, body
        return self.settled(json.loads(body)["id"])

    def remove(self, key: str) -> None:
        status, _, body = self.answer("DELETE", f"/api/jobs/{key}", None, {"Content-Type": "application/json"})
        assert status == 200, body

    def job(self, key: str) -> dict[str, Any]:
        return next(job for job in self.get("/api/state")["jobs"] if job["id"] == key)

    def settled(self, key: str) -> dict[str, Any]:
        """The job, once it is neither being read nor planned."""
        return self.until(lambda: self.job(key), lambda job: job["state"] not in ("reading", "planning"))

    def planned(self, **asked: object) -> dict[str, Any]:
        job = self.upload()
        self.post(f"/api/jobs/{job['id']}/plan", asked)
        return self.settled(job["id"])

    def run(self, stand: str) -> dict[str, Any]:
        """The run, once it stands so."""
        return self.until(lambda: self.get("/api/state")["run"], lambda run: run["stand"] == stand)

    def until(self, look: Callable[[], dict[str, Any]], is_so: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        end = time.monotonic() + PATIENCE_S
        while not is_so(seen := look()):
            assert time.monotonic() < end, seen
            time.sleep(0.05)
        return seen
