"""The paths that pages ask for, and what each answers."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from importlib.resources import files
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from planner.errors import PlannerError, UsageError
from planner.serve.calibration import KEY, READING, SHEET
from planner.serve.guard import Guard
from planner.serve.house import House
from planner.serve.planning import LINES, MOTION
from planner.serve.run import Wish
from planner.serve.store import Job

STATIC = Path(__file__).parent / "static"
FILM_READER = files("planner.plots").joinpath("film_reader.js")
"""What unpacks films, here and in their player."""
MOST_BYTES = 32 << 20
"""Of a drawing: what its reader takes."""
_MOST_ASKED = 64 << 10

Answer = Callable[[Request], Awaitable[Response]]


def application(house: House, names: frozenset[str], token: str | None) -> Starlette:
    """names, token: see `Guard`."""
    pages = _Pages(house)
    routes = [
        Route("/", pages.page),
        Route("/api/state", pages.state),
        Route("/api/events", pages.events),
        Route("/api/ports", pages.ports),
        Route("/api/arms/{name}", _plainly(pages.arm)),
        Route("/api/jobs", _plainly(pages.add), methods=["POST"]),
        Route("/api/jobs/{id}", _plainly(pages.remove), methods=["DELETE"]),
        Route("/api/jobs/{id}/lines", _plainly(pages.lines)),
        Route("/api/jobs/{id}/motion", _plainly(pages.motion)),
        Route("/api/jobs/{id}/trajectory", _plainly(pages.trajectory)),
        Route("/api/jobs/{id}/plan", _plainly(pages.plan), methods=["POST"]),
        Route("/api/jobs/{id}/command", _plainly(pages.command), methods=["POST"]),
        Route("/api/jobs/{id}/cancel", _plainly(pages.cancel), methods=["POST"]),
        Route("/api/jobs/{id}/run", _plainly(pages.run), methods=["POST"]),
        Route("/api/run/{wish}", _plainly(pages.wish), methods=["POST"]),
        Route("/api/jog", _plainly(pages.jog), methods=["POST"]),
        Route("/api/jog/do", _plainly(pages.jog_do), methods=["POST"]),
        Route("/api/jog/stop", _plainly(pages.jog_stop), methods=["POST"]),
        Route("/api/calibration", _plainly(pages.calibration), methods=["POST"]),
        Route("/api/calibration/run", _plainly(pages.calibration_run), methods=["POST"]),
        Route("/api/calibration/photo", _plainly(pages.calibration_photo), methods=["POST"]),
        Route("/api/calibration/calibrate", _plainly(pages.calibrate), methods=["POST"]),
        Route("/api/calibration/sheet", _plainly(pages.sheet)),
        Route("/api/calibration/reading", _plainly(pages.reading)),
        Route("/static/film_reader.js", pages.film_reader),
        Mount("/static", StaticFiles(directory=STATIC)),
    ]

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        yield
        await house.close()

    return Starlette(
        routes=routes,
        lifespan=lifespan,
        middleware=[
            Middleware(Guard, names=names, token=token),
            Middleware(GZipMiddleware, minimum_size=2000, compresslevel=3),
        ],
    )


class _Pages:
    def __init__(self, house: House) -> None:
        self._house = house

    async def page(self, request: Request) -> Response:
        return FileResponse(STATIC / "index.html", media_type="text/html")

    async def film_reader(self, request: Request) -> Response:
        return Response(FILM_READER.read_bytes(), media_type="text/javascript")

    async def state(self, request: Request) -> Response:
        return JSONResponse(self._house.state())

    async def events(self, request: Request) -> Response:
        return StreamingResponse(
            self._house.feed.messages(), media_type="text/event-stream", headers={"X-Accel-Buffering": "no"}
        )

    async def ports(self, request: Request) -> Response:
        from hardware.drivers.usb_ids import likely_controller
        from hardware.port import plugged_in

        return JSONResponse(
            [
                {"port": port.device, "description": port.description, "likely": likely_controller(port.usb_id)}
                for port in plugged_in()
            ]
        )

    async def arm(self, request: Request) -> Response:
        return FileResponse(await self._house.arms.view(request.path_params["name"]), media_type="application/json")

    async def add(self, request: Request) -> Response:
        content = await _body(request, MOST_BYTES)
        if not content:
            raise UsageError("the drawing is empty")
        job = self._house.add(request.query_params.get("name", ""), content)
        return JSONResponse(self._house.job_state(job), 201)

    async def remove(self, request: Request) -> Response:
        self._house.remove(self._job(request))
        return JSONResponse({})

    async def lines(self, request: Request) -> Response:
        return self._file(request, LINES, "application/json")

    async def motion(self, request: Request) -> Response:
        return self._file(request, MOTION, "application/json")

    async def trajectory(self, request: Request) -> Response:
        job = self._job(request)
        return self._file(request, job.trajectory_name, "text/csv", download=True)

    async def plan(self, request: Request) -> Response:
        job, asked = self._job(request), await _asked(request)
        self._house.refuse_while_drawn(job.id, job.name)
        self._house.planning.plan(job, asked)
        return JSONResponse(self._house.job_state(job), 202)

    async def command(self, request: Request) -> Response:
        return JSONResponse({"command": self._house.planning.command(self._job(request), await _asked(request))})

    async def cancel(self, request: Request) -> Response:
        self._house.planning.cancel(self._job(request))
        return JSONResponse({})

    async def run(self, request: Request) -> Response:
        self._house.run(self._job(request), await _asked(request))
        return JSONResponse(self._house.arm.state(), 202)

    async def wish(self, request: Request) -> Response:
        try:
            wish = Wish(request.path_params["wish"])
        except ValueError:
            raise _NotFound from None
        self._house.arm.wish(wish)
        return JSONResponse(self._house.arm.state())

    async def jog(self, request: Request) -> Response:
        self._house.jog.begin(await _asked(request))
        return JSONResponse(self._house.jog.state(), 202)

    async def jog_do(self, request: Request) -> Response:
        self._house.jog.do(await _asked(request))
        return JSONResponse(self._house.jog.state(), 202)

    async def jog_stop(self, request: Request) -> Response:
        self._house.jog.stop()
        return JSONResponse(self._house.jog.state())

    async def calibration(self, request: Request) -> Response:
        asked = await _asked(request)
        self._house.refuse_while_drawn(KEY, "the pattern")
        self._house.calibration.begin(asked)
        return JSONResponse(self._house.calibration.state(), 202)

    async def calibration_run(self, request: Request) -> Response:
        self._house.arm.begin(self._house.calibration.playable(), await _asked(request))
        return JSONResponse(self._house.arm.state(), 202)

    async def calibration_photo(self, request: Request) -> Response:
        content = await _body(request, MOST_BYTES)
        if not content:
            raise UsageError("the photo is empty")
        self._house.refuse_while_drawn(KEY, "the pattern")
        query = request.query_params
        self._house.calibration.read_photo(query.get("name", ""), content, query.get("bar", ""))
        return JSONResponse(self._house.calibration.state(), 202)

    async def calibrate(self, request: Request) -> Response:
        self._house.calibration.calibrate(await _asked(request))
        return JSONResponse(self._house.calibration.state(), 202)

    async def sheet(self, request: Request) -> Response:
        return _file(self._house.calibration.folder / SHEET, "application/pdf", name=SHEET)

    async def reading(self, request: Request) -> Response:
        return _file(self._house.calibration.folder / READING, "image/png")

    def _job(self, request: Request) -> Job:
        try:
            return self._house.store[request.path_params["id"]]
        except KeyError:
            raise _NotFound from None

    def _file(self, request: Request, name: str, kind: str, *, download: bool = False) -> Response:
        return _file(self._house.store.of(self._job(request)) / name, kind, name=name if download else None)


def _file(file: Path, kind: str, *, name: str | None = None) -> Response:
    """name: to save it under. Errors: _NotFound."""
    if not file.is_file():
        raise _NotFound
    return FileResponse(file, media_type=kind, filename=name)


class _NotFound(Exception):
    pass


class _TooLarge(Exception):
    def __init__(self, most: int) -> None:
        super().__init__()
        self.most = most


def _plainly(answer: Answer) -> Answer:
    """Errors become JSON with one sentence."""

    async def answered(request: Request) -> Response:
        try:
            return await answer(request)
        except _NotFound:
            return JSONResponse({"error": "there is no such thing here any more"}, 404)
        except _TooLarge as error:
            return JSONResponse({"error": f"that is more than {error.most / 2**20:g} MB"}, 413)
        except ClientDisconnect:
            return Response(status_code=400)
        except PlannerError as error:
            return JSONResponse({"error": str(error)}, 400)

    return answered


async def _body(request: Request, most: int) -> bytes:
    """Errors: _TooLarge, as soon as that is known."""
    content = bytearray()
    async for chunk in request.stream():
        content += chunk
        if len(content) > most:
            raise _TooLarge(most)
    return bytes(content)


async def _asked(request: Request) -> dict[str, Any]:
    """Errors: UsageError where it is no JSON object, or one that could not be told to other pages."""
    try:
        asked = json.loads(await _body(request, _MOST_ASKED) or b"{}")
        json.dumps(asked, ensure_ascii=False, allow_nan=False).encode()
    except (ValueError, RecursionError):
        asked = None
    if not isinstance(asked, dict):
        raise UsageError("options are a JSON object")
    return asked
