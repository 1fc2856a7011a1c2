"""Any sequence of what people do at pages leaves a server that is ready for the next."""

from __future__ import annotations

import json
import time

from hypothesis import strategies as st

from tests.serve.served import Server

_ASKED: dict[str, dict[str, bool]] = {
    "run": {},
    "fast": {"fast": True},
    "resume": {"resume": True, "fast": True},
    "frame": {"frame": True, "fast": True},
}
_WISHES = {"pause": "pause", "go on": "resume", "stop": "stop", "hold": "hold", "pen": "pen"}
NAMES = (*_ASKED, *_WISHES, "plan", "cancel", "reload", "wait")
STEPS = st.lists(st.sampled_from(NAMES), min_size=1, max_size=8)
_JSON = {"Content-Type": "application/json"}


def follow(server: Server, key: str, steps: list[str]) -> None:
    """Take the steps with a planned job, whatever is refused, and see that nothing is stuck."""
    for step in steps:
        if step in _ASKED:
            path, body = f"/api/jobs/{key}/run", _ASKED[step]
        elif step in _WISHES:
            path, body = f"/api/run/{_WISHES[step]}", {}
        elif step == "plan":
            path, body = f"/api/jobs/{key}/plan", {}
        elif step == "cancel":
            path, body = f"/api/jobs/{key}/cancel", {}
        else:
            time.sleep(0.3 if step == "wait" else 0.0)
            server.get("/api/state")
            continue
        status, _, answer = server.answer("POST", path, json.dumps(body).encode(), _JSON)
        assert status in (200, 202, 400), (step, answer)
    if server.get("/api/state")["run"]["stand"] != "idle":
        server.answer("POST", "/api/run/stop", b"{}", _JSON)
        server.run("idle")
    if server.settled(key)["state"] != "planned":
        server.post(f"/api/jobs/{key}/plan")
        assert server.settled(key)["state"] == "planned"
    server.post(f"/api/jobs/{key}/run", {"fast": True})
    assert server.run("idle")["complete"]
