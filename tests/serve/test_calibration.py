"""The calibration walk by the server, with a photo that a camera might have taken."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from docs.first_hour import photographed
from planner.arms.arm_file import load_arm
from tests.serve.served import SQUARE, Server

BYTES = {"Content-Type": "application/octet-stream"}


def walk(server: Server) -> dict[str, Any]:
    """Where it is, once nothing is at work."""
    return server.until(lambda: server.get("/api/state")["calibration"], lambda walk: not walk["busy"])


def photo(server: Server, content: bytes, name: str = "photo.jpg", bar: str = "") -> tuple[int, dict[str, Any]]:
    status, _, body = server.answer("POST", f"/api/calibration/photo?name={name}&bar={bar}", content, BYTES)
    return status, json.loads(body)


def test_from_a_pattern_to_an_arm_that_draws_better(tmp_path: Path) -> None:
    with Server(tmp_path, "--demo") as server:
        assert "no pattern" in server.post("/api/calibration/run", {}, status=400)["error"]
        assert "not drawn" in photo(server, b"x")[1]["error"]
        assert "measured" in server.post("/api/calibration/calibrate", {"target": "better"}, status=400)["error"]
        for asked, word in (({"arm": "../x"}, "no arm"), ({"arm": "so101", "count": "9"}, "count")):
            assert word in server.post("/api/calibration", asked, status=400)["error"]
        server.post("/api/calibration", {"arm": "so101", "count": 3})
        assert "number of marks" in walk(server)["error"]

        server.post("/api/calibration", {"arm": "drawing_arm_2022", "count": 25})
        assert walk(server)["has"] == ["pattern"]
        assert server.answer("GET", "/api/calibration/sheet")[2].startswith(b"%PDF")
        server.post("/api/calibration/run", {"fast": True})
        assert server.run("idle")["complete"]
        assert walk(server)["drawn"] == "played" and walk(server)["has"] == ["pattern", "drawn"]

        assert photo(server, b"x", "photo.exe")[0] == 400
        assert photo(server, SQUARE)[0] == 202
        failed = walk(server)
        assert failed["failed"] == "measure" and "photo.jpg" in failed["error"]
        photographed(tmp_path / "calibration")
        assert photo(server, (tmp_path / "calibration" / "photo.jpg").read_bytes(), bar="150")[0] == 202
        measured = walk(server)
        assert measured["has"][-1] == "measure", measured["error"]
        assert "of 25 marks found" in measured["said"]["measure"][0]
        assert server.answer("GET", "/api/calibration/reading")[2].startswith(b"\x89PNG")

        assert "already" in server.post("/api/calibration/calibrate", {"target": "so101"}, status=400)["error"]
        server.post("/api/calibration/calibrate", {"target": "better"})
        found = walk(server)
        assert found["has"][-1] == "calibrate", found["error"]
        assert found["target"] == "better" and found["found"]["predicted_rms_mm"] < 1.0
        assert "better" in server.get("/api/state")["arms"]
        assert load_arm(str(tmp_path / "arms" / "better.toml")).accuracy is not None
        kept = found
    with Server(tmp_path, "--demo") as again:
        assert walk(again) == kept
