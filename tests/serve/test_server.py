"""What the server does for pages: it keeps drawings, plans them as the command line does, and runs one at a time."""

from __future__ import annotations

import shlex
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from planner.cli import main
from tests.serve.served import SQUARE, Server


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    with Server(tmp_path_factory.mktemp("house"), "--demo") as running:
        yield running


@pytest.fixture(scope="module")
def read(server: Server) -> str:
    """The key of a drawing that nobody plans."""
    return str(server.upload()["id"])


@pytest.fixture(scope="module")
def planned(server: Server) -> dict[str, Any]:
    """A job that is planned, and that nobody throws away."""
    return server.planned()


@pytest.mark.parametrize(
    "asked",
    [
        {},
        {"arm": "so101", "rotate": -30, "mirror": True, "paper": "a5"},
        {"at": [-3.5, 20], "scale": 0.5, "fill": "hatch", "by": "colour", "tolerance": 0.1},
    ],
)
def test_a_plan_is_that_of_the_command_line_to_the_byte(
    server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asked: dict[str, object]
) -> None:
    if "at" in asked:
        asked = asked | {"at": [3.5, 20]}
    job = server.planned(**asked)
    assert job["state"] == "planned", job["error"]
    monkeypatch.chdir(tmp_path)
    Path(job["name"]).write_bytes(SQUARE)
    words = shlex.split(job["command"])
    assert words[0] == "plan" and main([*words[1:], "--quiet"]) == 0
    _, headers, content = server.answer("GET", f"/api/jobs/{job['id']}/trajectory")
    assert content == Path(job["trajectory"]).read_bytes()
    assert job["trajectory"] in headers["content-disposition"]


def test_a_drawing_that_cannot_be_drawn_says_why(server: Server) -> None:
    broken = server.upload(b"<svg", "broken.svg")
    assert broken["state"] == "failed" and "broken.svg" in broken["error"]
    job = server.upload()
    server.post(f"/api/jobs/{job['id']}/plan", {"scale": 50})
    failed = server.settled(job["id"])
    assert failed["state"] == "failed" and "canvas" in failed["error"]
    server.post(f"/api/jobs/{job['id']}/plan", {"scale": 1})
    assert server.settled(job["id"])["state"] == "planned"


@pytest.mark.parametrize(
    ("asked", "word"),
    [
        ({"arm": "/etc/passwd"}, "arm"),
        ({"arm": "../x.toml"}, "arm"),
        ({"font": "/etc/passwd"}, "font"),
        ({"pens": "x.toml"}, "pens"),
        ({"output": "/tmp/x"}, "output"),
        ({"rotate": "1 --report=/tmp/x"}, "rotate"),
        ({"rotate": {"a": 1}}, "rotate"),
        ({"at": [1]}, "at"),
        ({"tolerance": -1}, "tolerance"),
        ({"at": [10**400, 0]}, "number"),
        ({"layers": "a\0b"}, "layers"),
        ({"layers": "\ud800"}, "JSON"),
        ({"mirror": "\ud800"}, "JSON"),
        ({"mirror": float("nan")}, "JSON"),
        ({"mirror": "x" * 1000}, "mirror"),
        ([1], "JSON"),
    ],
)
def test_options_that_mean_nothing_here_are_refused(server: Server, read: str, asked: object, word: str) -> None:
    assert word in server.post(f"/api/jobs/{read}/plan", asked, status=400)["error"]
    assert server.job(read)["state"] == "read"


def test_what_the_page_shows_is_there(server: Server, planned: dict[str, Any]) -> None:
    lines = server.get(f"/api/jobs/{planned['id']}/lines")
    assert lines["page_mm"] == [60, 60] and lines["has_page"] and len(lines["lines"]) == 2
    film = server.get(f"/api/jobs/{planned['id']}/motion")
    assert film["arm"] == "drawing_arm" and len(film["joints"]) == 5 and film["end"] > 1
    arm = server.get("/api/arms/drawing_arm")
    assert len(arm["canvas_mm"]) == 4 and len(arm["home"]) == 5
    for path in ("/", "/static/app.js", "/static/vendor/three.js", "/static/style.css"):
        status, headers, content = server.answer("GET", path)
        assert status == 200 and content and "default-src 'none'" in headers["content-security-policy"]


def test_a_run_pauses_goes_on_and_stops_and_another_resumes_it(server: Server, planned: dict[str, Any]) -> None:
    job = planned
    server.post(f"/api/jobs/{job['id']}/run")
    assert "stop that first" in server.post(f"/api/jobs/{job['id']}/run", status=400)["error"]
    server.run("playing")
    server.post("/api/run/pause")
    server.run("paused")
    server.post("/api/run/resume")
    server.run("playing")
    server.post("/api/run/stop")
    run = server.run("idle")
    assert run["ended"] == "stopped" and not run["complete"] and any("parked" in line for line in run["lines"])
    assert server.job(job["id"])["resumable"] == "sim"
    server.post(f"/api/jobs/{job['id']}/run", {"resume": True, "fast": True})
    run = server.run("idle")
    assert run["ended"] == "played" and run["complete"]
    assert not server.job(job["id"])["resumable"]
    drawn = server.job(job["id"])["drawn"][-2:]
    assert [(run["driver"], run["how"]) for run in drawn] == [("sim", "stopped"), ("sim", "played")]
    assert time.time() - 60 < drawn[0]["at"] <= drawn[1]["at"] <= time.time()


@pytest.mark.parametrize(
    ("asked", "word"),
    [
        ({"port": "a\0b"}, "port"),
        ({"port": "\ud800"}, "JSON"),
        ({"port": "x" * 1000}, "port"),
        ({"speed-factor": float("inf")}, "JSON"),
        ({"speed-factor": 10**400}, "speed-factor"),
        ({"driver": ["sim"]}, "driver"),
    ],
)
def test_runs_that_mean_nothing_are_refused(server: Server, planned: dict[str, Any], asked: object, word: str) -> None:
    assert word in server.post(f"/api/jobs/{planned['id']}/run", asked, status=400)["error"]
    assert server.get("/api/state")["run"]["stand"] == "idle"


def test_hold_holds_at_once(server: Server, planned: dict[str, Any]) -> None:
    server.post(f"/api/jobs/{planned['id']}/run")
    server.until(lambda: server.get("/api/state")["run"], lambda run: run["stroke"] >= 0)
    server.post("/api/run/hold")
    assert server.run("idle")["ended"] == "emergency stop"


def test_nothing_is_stopped_that_does_not_run_and_nothing_thrown_away_that_does(server: Server) -> None:
    assert "nothing" in server.post("/api/run/stop", status=400)["error"]
    server.post("/api/run/explode", status=404)
    job = server.planned()
    server.post(f"/api/jobs/{job['id']}/run")
    for method, path in (("DELETE", ""), ("POST", "/plan")):
        status, _, body = server.answer(
            method, f"/api/jobs/{job['id']}{path}", b"{}", {"Content-Type": "application/json"}
        )
        assert status == 400 and b"being drawn" in body
    server.post("/api/run/stop")
    server.run("idle")
    assert server.answer("DELETE", f"/api/jobs/{job['id']}", None, {"Content-Type": "application/json"})[0] == 200
    assert server.answer("GET", f"/api/jobs/{job['id']}/lines")[0] == 404


def test_a_real_arm_is_none_of_a_demonstration(server: Server, planned: dict[str, Any]) -> None:
    refused = server.post(f"/api/jobs/{planned['id']}/run", {"driver": "maestro", "port": "/dev/null"}, status=400)
    assert "no driver" in refused["error"]


def test_cancelled_plans_leave_the_drawing(server: Server) -> None:
    job = server.upload()
    server.post(f"/api/jobs/{job['id']}/plan", {"tolerance": 0.01})
    server.post(f"/api/jobs/{job['id']}/cancel")
    assert server.settled(job["id"])["state"] == "read"


def test_a_plan_takes_the_place_of_the_one_before(server: Server) -> None:
    job = server.upload()
    for rotate in (1, 2, 3):
        server.post(f"/api/jobs/{job['id']}/plan", {"rotate": rotate})
    settled = server.settled(job["id"])
    assert settled["state"] == "planned" and "--rotate=3" in settled["command"]


def test_a_server_that_is_killed_leaves_an_arm_that_parks_and_a_run_that_goes_on(tmp_path: Path) -> None:
    with Server(tmp_path) as first:
        job = first.planned()
        first.post(f"/api/jobs/{job['id']}/run")
        first.run("playing")
        first.process.kill()
    with Server(tmp_path) as second:
        kept = second.until(lambda: second.job(job["id"]), lambda job: job["resumable"] == "sim")
        assert kept["state"] == "planned" and kept["command"] == job["command"]
        second.until(
            lambda: {"text": (tmp_path / "jobs" / job["id"] / f"{job['trajectory']}.sim.journal").read_text()},
            lambda journal: "stopped" in journal["text"],
        )
        second.post(f"/api/jobs/{job['id']}/run", {"resume": True, "fast": True})
        assert second.run("idle")["complete"]


def test_a_server_that_ends_parks_the_arm_first(tmp_path: Path) -> None:
    with Server(tmp_path) as server:
        job = server.planned()
        server.post(f"/api/jobs/{job['id']}/run")
        server.run("playing")
        assert server.end() == 0
    journal = (tmp_path / "jobs" / job["id"] / f"{job['trajectory']}.sim.journal").read_text()
    assert '"stopped"' in journal
