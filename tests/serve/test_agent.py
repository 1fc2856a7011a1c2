"""What an agent can do, by a client of the protocol over real pipes."""

from __future__ import annotations

import asyncio
import json
import os
import pty
import subprocess
import sys
from pathlib import Path
from typing import Any, TextIO

import pytest
from mcp import Client, ClientSession, StdioServerParameters, stdio_client

from planner.serve import arms
from planner.serve.agent import agent_server
from planner.serve.house import House
from tests.hardware.controllers.lines import pty_line
from tests.hardware.controllers.maestro import MaestroModel
from tests.serve.served import SQUARE


async def call(session: ClientSession, tool: str, **asked: object) -> Any:
    return await session.call_tool(tool, dict(asked))


def text(answer: Any) -> str:
    return "\n".join(part.text for part in answer.content if part.type == "text")


async def _draws(folder: Path) -> None:
    server = StdioServerParameters(command=sys.executable, args=["-m", "planner", "mcp", "--folder", str(folder)])
    async with stdio_client(server) as (read, write), ClientSession(read, write) as session:
        await session.initialize()
        assert {tool.name for tool in (await session.list_tools()).tools} == {
            "arms", "plan", "picture", "check", "run", "status", "stop",
        }  # fmt: skip
        planned = json.loads(
            text(await call(session, "plan", svg=SQUARE.decode(), options={"rotate": 5, "scale": 0.3}))
        )
        assert "--rotate=5" in planned["command"] and planned["summary"]
        job = planned["job"]
        (picture,) = (await call(session, "picture", job=job)).content
        assert picture.type == "image" and picture.mime_type == "image/png" and len(picture.data) > 10_000
        assert text(await call(session, "check", job=job)).startswith("passed")

        await call(session, "run", job=job)
        while json.loads(text(run := await call(session, "status")))["stand"] != "idle":
            await asyncio.sleep(0.1)
        assert json.loads(text(run))["complete"]

        for tool, asked, word in (
            ("plan", {"svg": "<svg"}, "drawing.svg"),
            ("plan", {"svg": SQUARE.decode(), "options": {"font": "/etc/passwd"}}, "font"),
            ("plan", {"svg": SQUARE.decode(), "name": "x.sh"}, "x.sh"),
            ("check", {"job": "../.."}, "no job"),
            ("run", {"job": job, "driver": "maestro", "port": "/dev/ttyACM0"}, "simulated"),
            ("stop", {}, "nothing"),
        ):
            refused = await call(session, tool, **asked)
            assert refused.is_error and word in text(refused), (tool, refused)


def test_an_agent_plans_looks_checks_and_runs_on_the_simulated_arm_alone(tmp_path: Path) -> None:
    asyncio.run(asyncio.wait_for(_draws(tmp_path), 240))


async def _lists_arms(house: House) -> Any:
    async with Client(agent_server(house, real_arm=False)) as client:
        return [json.loads(part.text) for part in (await client.call_tool("arms")).content if part.type == "text"]


def test_an_agent_is_told_of_every_arm_with_the_room_it_draws_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of two of them: each is worked out for it."""
    names = ("drawing_arm", "so101")
    monkeypatch.setattr(arms, "known_arms", lambda: names)
    found = asyncio.run(asyncio.wait_for(_lists_arms(House(tmp_path)), 240))
    assert [arm["name"] for arm in found] == list(names)
    assert all(20 < arm[side] < 1000 for arm in found for side in ("width_mm", "height_mm"))


async def _asks_for_a_real_arm(folder: Path, port: str, terminal: int, errlog: TextIO) -> list[Any]:
    """How a run ended that was refused, one that was let, and what the second came to."""
    arguments = ["-m", "planner", "mcp", "--real-arm", "--folder", str(folder)]
    server = StdioServerParameters(command=sys.executable, args=arguments)
    async with stdio_client(server, errlog=errlog) as (read, write), ClientSession(read, write) as session:
        await session.initialize()
        job = json.loads(text(await call(session, "plan", svg=SQUARE.decode(), options={"scale": 0.3})))["job"]
        answers = []
        for typed in (b"n\n", b"y\n"):
            os.write(terminal, b"y\n")  # before it is asked: that is no answer
            asking = asyncio.create_task(call(session, "run", job=job, driver="maestro", port=port))
            said = b""
            while b"type y" not in said:
                said += await asyncio.to_thread(os.read, terminal, 1000)
            os.write(terminal, typed)
            answers.append(await asking)
        while json.loads(text(run := await call(session, "status")))["stand"] != "idle":
            await asyncio.sleep(0.1)
        return [*answers, run]


def test_a_real_arm_moves_once_a_person_has_pressed_a_key(tmp_path: Path) -> None:
    model = MaestroModel()
    terminal, other_end = pty.openpty()
    with pty_line(model) as line, os.fdopen(other_end, "w") as errlog:
        asked = _asks_for_a_real_arm(tmp_path, line.name, terminal, errlog)
        refused, let, run = asyncio.run(asyncio.wait_for(asked, 240))
    os.close(terminal)
    assert refused.is_error and "agreed" in text(refused)
    assert not let.is_error and json.loads(text(run))["complete"], run
    assert len(model.positions) == 5


AGREES = """
import asyncio, sys
from planner.serve.person import agrees
sys.exit(0 if asyncio.run(agrees("draw it")) else 1)
"""


@pytest.mark.parametrize(("typed", "agreed"), [(b"y\n", True), (b"no\n", False), (b"\n", False)])
def test_a_person_at_the_terminal_has_to_agree(typed: bytes, agreed: bool) -> None:
    process, terminal = pty.fork()
    if process == 0:
        os.execv(sys.executable, [sys.executable, "-c", AGREES])
    said = b""
    while b"type y" not in said:
        said += os.read(terminal, 1000)
    os.write(terminal, typed)
    assert (os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == 0) is agreed
    os.close(terminal)


def test_nobody_agrees_where_there_is_no_terminal() -> None:
    ran = subprocess.run([sys.executable, "-c", AGREES], start_new_session=True, capture_output=True)
    assert ran.returncode == 1
