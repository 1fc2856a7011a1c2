"""Who may ask for what."""

from __future__ import annotations

import asyncio
import hmac
import json
import re
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from starlette.routing import Route

from planner.serve.app import application
from planner.serve.guard import Guard
from planner.serve.house import House
from tests.serve.served import SQUARE, Server

JSON = {"Content-Type": "application/json"}
BYTES = {"Content-Type": "application/octet-stream"}


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    with Server(tmp_path_factory.mktemp("house"), "--demo") as running:
        yield running


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "", "10.0.0.7:8200", "[::1"]
)
def test_names_of_others_are_not_served(server: Server, host: str) -> None:
    assert server.answer("GET", "/api/state", headers={"Host": host})[0] == 421


@pytest.mark.parametrize("host", ["localhost", "127.0.0.1", "[::1]:80", "LOCALHOST:9"])
def test_names_of_this_machine_are(server: Server, host: str) -> None:
    assert server.answer("GET", "/api/state", headers={"Host": host})[0] == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:1"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
    ],
)
def test_pages_of_others_change_nothing(server: Server, headers: dict[str, str]) -> None:
    assert server.answer("POST", "/api/run/stop", b"{}", JSON | headers)[0] == 403


@pytest.mark.parametrize(
    "kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x", ""]
)
def test_forms_change_nothing(server: Server, kind: str) -> None:
    assert server.answer("POST", "/api/jobs?name=a.svg", SQUARE, {"Content-Type": kind})[0] == 415


READ = {
    "/",
    "/api/state",
    "/api/events",
    "/api/ports",
    "/api/arms/{name}",
    "/api/jobs/{id}/lines",
    "/api/jobs/{id}/motion",
    "/api/jobs/{id}/trajectory",
    "/api/calibration/sheet",
    "/api/calibration/reading",
    "/static/film_reader.js",
}


def test_asking_by_get_changes_nothing(tmp_path: Path, server: Server) -> None:
    routes = [route for route in application(House(tmp_path), frozenset(), None).routes if isinstance(route, Route)]
    for route in routes:
        assert route.methods in ({"GET", "HEAD"}, {"POST"}, {"DELETE"}), route
    assert {route.path for route in routes if route.methods == {"GET", "HEAD"}} == READ
    assert server.answer("GET", "/api/run/stop")[0] == 405


@pytest.mark.parametrize("path", ["/", "/static/app.js", "/api/state", "/api/nothing", "/api/run/stop"])
@pytest.mark.parametrize("host", ["localhost", "evil.example"])
def test_every_answer_tells_browsers_to_load_and_frame_nothing_of_others(server: Server, path: str, host: str) -> None:
    headers = server.answer("GET", path, headers={"Host": host})[1]
    policy = dict(rule.split(" ", 1) for rule in headers["content-security-policy"].split("; "))
    assert policy.pop("img-src") == "'self' data: blob:"
    for rule in ("default-src", "form-action", "base-uri", "frame-ancestors"):
        assert policy.pop(rule) == "'none'"
    assert set(policy.values()) == {"'self'"}
    assert headers["x-content-type-options"] == "nosniff" and headers["referrer-policy"] == "no-referrer"
    for who in ("opener", "resource"):
        assert headers[f"cross-origin-{who}-policy"] == "same-origin"
    assert headers["cache-control"] == "no-store"


@pytest.mark.parametrize(
    "path",
    [
        "/static/../app.py",
        "/static/%2e%2e/app.py",
        "/static/..%2f..%2fhouse.py",
        "/api/jobs/..%2f..%2fetc/lines",
        "/api/jobs/../../lines",
        "/api/arms/..%2fso101",
        "/api/arms/%2fetc%2fpasswd",
        "//etc/passwd",
    ],
)
def test_nothing_else_of_this_machine_is_read(server: Server, path: str) -> None:
    status, _, body = server.answer("GET", path)
    assert status in (400, 404, 405) and b"root:" not in body and b"import" not in body


@pytest.mark.parametrize(
    "name", ["../../x.svg", "..\\..\\x.svg", "/etc/x.svg", "a b\n;rm.svg", "é\u202e.svg", "." * 300 + ".svg"]
)
def test_names_of_files_stay_in_their_folder(server: Server, name: str) -> None:
    from urllib.parse import quote

    status, _, body = server.answer(
        "POST", f"/api/jobs?name={quote(name)}", SQUARE, {"Content-Type": "application/octet-stream"}
    )
    assert status == 201 and not re.search("etc|[.][.]", json.loads(body)["name"])


@pytest.mark.parametrize(
    ("name", "content", "status"),
    [
        ("x.exe", b"MZ", 400),
        ("", SQUARE, 400),
        ("svg", SQUARE, 400),
        ("x.svg", b"", 400),
        ("x.svg", b" " * (33 << 20), 413),
    ],
)
def test_uploads_are_bounded(server: Server, name: str, content: bytes, status: int) -> None:
    for path in ("jobs", "calibration/photo"):
        try:
            given, _, _ = server.answer("POST", f"/api/{path}?name={name}", content, BYTES)
        except (BrokenPipeError, ConnectionResetError):  # refused before all of it was sent
            given = 413
        assert given == status
    assert server.get("/api/state")


def test_a_token_is_asked_for_where_others_can_reach_the_page(tmp_path: Path) -> None:
    with Server(tmp_path, "--demo", "--host", "127.0.0.1", "--token", "correct-horse") as server:
        assert server.address.endswith("/?token=correct-horse")
        for headers in (
            {},
            {"Authorization": "Bearer wrong"},
            {"Cookie": "plan_token=correct-hors"},
            {"Cookie": ";;=,"},
        ):
            assert server.answer("GET", "/api/state", headers=headers)[0] == 401
        assert server.answer("GET", "/api/state?token=correct-horse")[0] == 401  # the address of the page alone
        assert server.answer("GET", "/?token=wrong")[0] == 401
        status, headers, _ = server.answer("GET", "/?token=correct-horse")
        assert status == 303 and headers["location"] == "/"
        cookie = headers["set-cookie"]
        assert "HttpOnly" in cookie and "samesite=strict" in cookie.lower()
        for headers in ({"Cookie": cookie.split(";")[0]}, {"Authorization": "Bearer correct-horse"}):
            assert server.answer("GET", "/api/state", headers=headers)[0] == 200


def test_whoever_else_can_reach_the_page_needs_a_token(tmp_path: Path) -> None:
    with Server(tmp_path, "--demo", "--host", "0.0.0.0") as server:
        token = server.address.partition("/?token=")[2]
        assert len(token) >= 32
        assert server.answer("GET", "/api/state")[0] == 401
        assert server.answer("GET", "/api/state", headers={"Authorization": f"Bearer {token}"})[0] == 200


def test_a_token_is_compared_in_constant_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    compared = list[tuple[bytes, bytes]]()

    def compare(given: bytes, wanted: bytes) -> bool:
        compared.append((given, wanted))
        return given == wanted

    monkeypatch.setattr(hmac, "compare_digest", compare)
    told = list[Any]()

    async def send(message: Any) -> None:
        told.append(message)

    async def receive() -> Any:
        raise AssertionError

    headers = [(b"host", b"localhost"), (b"authorization", b"Bearer correct-hors")]
    scope = {"type": "http", "method": "GET", "path": "/", "query_string": b"", "headers": headers}
    guarded = Guard(application(House(tmp_path), frozenset(), None), frozenset({"localhost"}), "correct-horse")
    asyncio.run(guarded(scope, receive, send))
    assert told[0]["status"] == 401 and (b"correct-hors", b"correct-horse") in compared


def test_nothing_speaks_by_web_sockets(server: Server) -> None:
    asks = {
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
    }
    assert server.answer("GET", "/api/state", headers=asks)[0] in (200, 403)


def test_options_are_bounded(server: Server) -> None:
    body = b'{"layers": "' + b"x" * (1 << 20) + b'"}'
    assert server.answer("POST", "/api/jobs/0123456789abcdef/plan", body, JSON)[0] == 404
    assert server.answer("POST", f"/api/jobs/{server.upload()['id']}/plan", body, JSON)[0] == 413


def test_other_machines_cannot_reach_it_unless_asked(server: Server) -> None:
    own = socket.gethostbyname(socket.gethostname())
    if own.startswith("127."):
        own = "127.0.0.2"
    with pytest.raises(ConnectionRefusedError), socket.create_connection((own, server.port), timeout=2):
        pass


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=300))
def test_no_body_breaks_the_server(server: Server, body: bytes) -> None:
    for path in ("/api/jobs/0123456789abcdef/plan", "/api/run/pause"):
        assert server.answer("POST", path, body, JSON)[0] in (400, 404)
