"""Tools for agents that speak the Model Context Protocol: the jobs of the page, without the page."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from functools import wraps
from typing import Any

from mcp.server.mcpserver import Image, MCPServer
from mcp.server.mcpserver.exceptions import ToolError

from hardware.drivers.table import SIMULATORS
from planner import __version__
from planner.errors import PlannerError, UsageError
from planner.serve.child import listen, start
from planner.serve.house import House
from planner.serve.person import agrees
from planner.serve.run import Wish
from planner.serve.store import Job, State

_INSTRUCTIONS = """\
Plans SVG drawings for small robot arms that hold a pen, and draws them. Make a plan, look at its picture, check it, and
run it on the simulated arm. Lengths are millimetres. A line is drawn as it is; areas are drawn by their edges unless
the option fill says how to fill them."""
_LOOK_S = 0.1


def agent_server(house: House, *, real_arm: bool) -> MCPServer[None]:
    """real_arm: drivers beside the simulated ones may be asked for; a person at the terminal has to press a key for
    each run."""

    @asynccontextmanager
    async def lifespan(server: MCPServer[None]) -> AsyncIterator[None]:
        try:
            yield
        finally:
            await house.close()

    server = MCPServer("drawing-arm", version=__version__, instructions=_INSTRUCTIONS, lifespan=lifespan)
    tools = _Tools(house, real_arm)
    for tool in (tools.arms, tools.plan, tools.picture, tools.check, tools.run, tools.status, tools.stop):
        server.tool()(_plainly(tool))
    return server


def _plainly(tool: Callable[..., Awaitable[Any]]) -> Callable[..., Awaitable[Any]]:
    """What is refused becomes the sentence that says why."""

    @wraps(tool)
    async def answered(**asked: Any) -> Any:
        try:
            return await tool(**asked)
        except PlannerError as error:
            raise ToolError(str(error)) from error

    return answered


class _Tools:
    """Errors become what a tool answers: UsageError."""

    def __init__(self, house: House, real_arm: bool) -> None:
        self._house, self._real_arm = house, real_arm

    async def arms(self) -> list[dict[str, Any]]:
        """The arms that there are, with the width and height of what each can draw on."""
        found = []
        for name in self._house.arms.names():
            view = json.loads((await self._house.arms.view(name)).read_text(encoding="utf-8"))
            corners = view.get("canvas_mm") or [[0, 0]]
            x, y = ([corner[axis] for corner in corners] for axis in (0, 1))
            found.append({"name": name, "width_mm": max(y) - min(y), "height_mm": max(x) - min(x)})
        return found

    async def plan(self, svg: str, name: str = "drawing.svg", options: dict[str, Any] | None = None) -> dict[str, Any]:
        """Plan a drawing. svg: the text of the file. options: as of the command line without dashes, such as
        {"arm": "so101", "scale": 0.5, "fill": "hatch", "by": "colour", "tolerance": 0.1}. Answers with the job's id, a
        summary, warnings, and the same as a command."""
        job = self._house.add(name, svg.encode())
        await self._settled(job)
        if job.state is State.FAILED:
            raise UsageError(job.error)
        self._house.planning.plan(job, options or {})
        await self._settled(job)
        if job.state is not State.PLANNED:
            raise UsageError(job.error)
        return {"job": job.id, "summary": job.summary, "warnings": job.notes, "command": job.command}

    async def picture(self, job: str) -> Image:
        """What the arm is expected to draw: lines with the band that they stay in, and where ink may be missing."""
        planned = self._planned(job)
        target = self._house.store.of(planned) / "expected.png"
        code, said = await self._said(planned, ["predict", planned.trajectory_name, "--plot", target.name])
        if code:
            raise UsageError(said)
        return Image(data=target.read_bytes(), format="png")

    async def check(self, job: str) -> str:
        """Whether the trajectory keeps what it promises, by mathematics apart from the planner's."""
        planned = self._planned(job)
        return (await self._said(planned, ["check", planned.trajectory_name, "--drawing", planned.name]))[1]

    async def run(self, job: str, driver: str = "sim", port: str = "", fast: bool = True) -> dict[str, Any]:
        """Draw it, by default on the simulated arm, without waiting for its pace. A real arm takes the flag --real-arm
        at start, and a key that a person presses. Ask for the status then."""
        planned = self._planned(job)
        if driver not in SIMULATORS:
            if not self._real_arm:
                raise UsageError("this server moves simulated arms alone: it was started without --real-arm")
            if not await agrees(f"an agent asks to draw {planned.name} with {driver} at {port or 'its port'}"):
                raise UsageError("nobody at the terminal has agreed to that")
        self._house.run(planned, {"driver": driver, "port": port, "fast": fast and driver in SIMULATORS})
        return self._house.arm.state()

    async def status(self) -> dict[str, Any]:
        """What the arm does, or how its last run ended."""
        return self._house.arm.state()

    async def stop(self) -> dict[str, Any]:
        """The arm lifts its pen and parks."""
        self._house.arm.wish(Wish.STOP)
        return self._house.arm.state()

    def _planned(self, key: str) -> Job:
        try:
            job = self._house.store[key]
        except KeyError:
            raise UsageError(f"there is no job '{key:.40}'") from None
        if job.state is not State.PLANNED:
            raise UsageError(f"{job.name} is not planned: {job.error or job.state}")
        return job

    async def _settled(self, job: Job) -> None:
        while job.state in (State.READING, State.PLANNING):
            await asyncio.sleep(_LOOK_S)

    async def _said(self, job: Job, arguments: list[str]) -> tuple[int, str]:
        """Exit code of a command, and what it printed."""
        child = await start(arguments, self._house.store.of(job), behind=True)
        printed: list[str] = []
        code = await listen(child, printed.append)
        return code, "\n".join([*printed, *child.notes])
