"""Jogging by the server: one joint at a time, one thing that moves the arm at a time, and arms that come of it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from planner.arms.arm_file import load_arm
from tests.serve.served import Server


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("house")


@pytest.fixture(scope="module")
def server(folder: Path) -> Iterator[Server]:
    with Server(folder, "--demo") as running:
        yield running


@pytest.fixture(scope="module")
def planned(server: Server) -> str:
    """The key of a drawing that is planned, for another arm than those that are jogged."""
    return str(server.planned()["id"])


def jog(server: Server, stand: str) -> dict[str, Any]:
    return server.until(lambda: server.get("/api/state")["jog"], lambda jog: jog["stand"] == stand)


def do(server: Server, command: str, **more: object) -> dict[str, Any]:
    server.post("/api/jog/do", {"command": command, **more})
    return jog(server, "ready")


def test_what_is_found_becomes_an_arm_that_draws(server: Server, planned: str, folder: Path) -> None:
    server.post("/api/jog", {"arm": "drawing_arm_2022", "target": "mine"})
    before = jog(server, "ready")
    name, here = before["joints"][1]["name"], before["joints"][1]["at"]
    assert do(server, "move", joint=name, number=-2)["joints"][1]["at"] == pytest.approx(here - 2, abs=1e-3)
    assert name in do(server, "move", number=500)["refused"]
    assert not do(server, "low")["saved"]
    asked = {"command": "move", "number": 1, "joint": f"{name}\nsave"}
    assert "no joint" in server.post("/api/jog/do", asked, status=400)["error"]
    assert "drawing" not in server.get("/api/state")["run"]["stand"]
    assert "jogged" in server.post(f"/api/jobs/{planned}/run", status=400)["error"]
    assert do(server, "save")["saved"]
    server.post("/api/jog/do", {"command": "quit"})
    assert jog(server, "idle")["ended"].startswith("done")

    assert "mine" in server.get("/api/state")["arms"]
    saved = load_arm(str(folder / "arms" / "mine.toml"))
    assert saved.minimum[1] > load_arm("drawing_arm_2022").minimum[1]
    assert server.get("/api/arms/mine")["canvas_mm"]
    job = server.planned(arm="mine")
    assert job["state"] == "planned", job["error"]
    assert str(folder / "arms" / "mine.toml") in job["command"]
    server.post(f"/api/jobs/{job['id']}/run", {"fast": True})
    assert server.run("idle")["complete"]

    server.post("/api/jog", {"arm": "mine", "target": "mine"})  # its own file may be written again
    jog(server, "ready")
    server.post("/api/jog/stop")
    assert "holds" in jog(server, "idle")["ended"]


def test_a_run_and_jogging_keep_out_of_each_others_way(server: Server, planned: str) -> None:
    server.post(f"/api/jobs/{planned}/run")
    assert "stop that first" in server.post("/api/jog", {"arm": "so101", "target": "x"}, status=400)["error"]
    server.post("/api/run/hold")
    server.run("idle")
    server.post("/api/jog", {"arm": "so101", "target": "x"})
    server.post("/api/jog/stop")  # before it has even begun
    jog(server, "idle")
    server.post(f"/api/jobs/{planned}/run", {"fast": True})
    assert server.run("idle")["complete"]


@pytest.mark.parametrize(
    ("asked", "word"),
    [
        ({"arm": "/etc/passwd", "target": "x"}, "no arm"),
        ({"arm": ["so101"], "target": "x"}, "no arm"),
        ({"arm": "so101", "target": "../x"}, "letters"),
        ({"arm": "so101", "target": ""}, "letters"),
        ({"arm": "so101", "target": "so101"}, "already"),
        ({"arm": "so101"}, "letters"),
        ({"arm": "so101", "target": "x", "driver": "maestro"}, "no driver"),
        ({"arm": "so101", "target": "x", "port": 3}, "port"),
        ({"arm": "so101", "target": "x", "port": "a\0b"}, "port"),
    ],
)
def test_what_means_nothing_is_refused(server: Server, asked: object, word: str) -> None:
    assert word in server.post("/api/jog", asked, status=400)["error"]


@pytest.mark.parametrize(
    "asked",
    [
        {},
        {"command": "explode"},
        {"command": "move"},
        {"command": "move", "number": True},
        {"command": "move", "number": 10**400},
        {"command": "low"},
        {"command": "move", "number": 1, "joint": "q1\nsave"},
    ],
)
def test_commands_that_mean_nothing_or_come_too_early_are_refused(server: Server, asked: object) -> None:
    status, _, body = server.answer(
        "POST", "/api/jog/do", json.dumps(asked).encode(), {"Content-Type": "application/json"}
    )
    assert status == 400, body


def test_a_server_that_ends_holds_the_arm(tmp_path: Path) -> None:
    with Server(tmp_path) as server:
        server.post("/api/jog", {"arm": "so101", "target": "x"})
        jog(server, "ready")
        assert server.end() == 0
