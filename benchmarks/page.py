"""The figures that the page has to keep, measured on a server of its own:

python benchmarks/page.py [DRAWING.svg] [--minutes 3]

DRAWING.svg: large, for what it takes to answer while that is planned (default: one of 10 000 points). Ready, answers
and pages should be measured on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import io
import math
import random
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Browser, CDPSession, Page, expect, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.browser.chromium import executable  # noqa: E402
from benchmarks.on_pins import PinClock, left_at_s  # noqa: E402
from benchmarks.soak.page import resident_mb  # noqa: E402
from hardware.compensation.servo_values import pulse_calibration  # noqa: E402
from planner.arms.arm_file import load_arm  # noqa: E402
from planner.cli import main as plan  # noqa: E402
from tests.hardware.controllers.lines import pty_line  # noqa: E402
from tests.hardware.controllers.maestro import MaestroModel  # noqa: E402
from tests.hardware.emulator.emulator import build, on_pty  # noqa: E402
from tests.serve.served import Server  # noqa: E402

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
ARM = "drawing_arm_2022"
_FIRMWARE_ARM = "drawing_arm"
"""Whose pulses the firmware makes: some of the other's are too short for it."""
_PATIENCE_MS = 120_000
_STARTS, _STOPS = 5, 10
_PAUSE_S = 0.05
_LONGEST_PLAN_S = 120.0
_DRAG_S = 4.0
_AHEAD_ROWS = 6
_QUARTER_US = 1.5
"""How far a set point may be from its row of the record before it is one of braking, in quarter us."""


def large_drawing(n_points: int = 10_000, each: int = 100) -> bytes:
    """Lines of so many points, that wander about a page of 200 mm by 200 mm."""
    chance = random.Random(1)  # noqa: S311
    paths = []
    for _ in range(n_points // each):
        x, y, angle = chance.uniform(20, 180), chance.uniform(20, 180), chance.uniform(0, 2 * math.pi)
        words = []
        for _ in range(each):
            angle += chance.gauss(0.0, 0.4)
            x, y = (min(max(at + step, 1.0), 199.0) for at, step in ((x, math.cos(angle)), (y, math.sin(angle))))
            words.append(f"{x:.2f} {y:.2f}")
        paths.append(f'<path d="M{" L".join(words)}"/>')
    head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 200" width="200mm" height="200mm" fill="none"'
    return f'{head} stroke="#0050c8">{"".join(paths)}</svg>'.encode()


def ready_s() -> list[float]:
    """From the command to the first page, in seconds."""
    times = []
    for _ in range(_STARTS):
        with tempfile.TemporaryDirectory() as folder:
            begin = time.monotonic()
            with Server(Path(folder), "--demo") as server:
                assert server.answer("GET", "/")[0] == 200
                times.append(time.monotonic() - begin)
    return times


def answers_ms(server: Server, drawing: bytes) -> list[float]:
    """What requests take while a drawing is planned, in ms, in the order of asking."""
    key = server.upload(drawing, "large.svg")["id"]
    server.post(f"/api/jobs/{key}/plan", {"arm": ARM})
    times: list[float] = []
    end = time.monotonic() + _LONGEST_PLAN_S
    asked = (
        lambda: server.get("/api/state"),
        lambda: server.answer("GET", "/"),
        lambda: server.answer("GET", "/static/app.js"),
        lambda: server.answer("POST", "/api/run/pause", b"{}", {"Content-Type": "application/json"}),
    )
    while server.job(key)["state"] == "planning" and time.monotonic() < end:
        for ask in asked:
            begin = time.monotonic()
            ask()
            times.append(1000 * (time.monotonic() - begin))
            time.sleep(_PAUSE_S)
    server.post(f"/api/jobs/{key}/cancel")
    return times


class _Stamped(MaestroModel):
    """Keeps every set point with its time."""

    def __init__(self) -> None:
        super().__init__()
        self.seen: list[tuple[float, dict[int, int]]] = []

    def receive(self, message: bytes) -> bytes:
        answer = super().receive(message)
        self.seen.append((time.time(), dict(self.positions)))
        return answer


CLICK = "(id) => { const now = Date.now(); document.getElementById(id).click(); return now / 1000; }"


def stops_ms(browser: Browser, folder: Path) -> tuple[list[float], list[float]]:
    """From a click to the first set point that brakes, on an emulated Maestro; and from one that holds to the end of
    the run on `sim`; both in ms."""
    braking, holding = [], []
    with Server(folder) as server:
        job = server.planned(arm=ARM)
        rows = 4 * np.genfromtxt(_record(folder, job, "maestro"), delimiter=",", skip_header=1)[:, 4:]
        page = browser.new_page()
        page.goto(server.address)
        for number in range(_STOPS):
            model = _Stamped()
            with pty_line(model) as line:
                server.post(f"/api/jobs/{job['id']}/run", {"driver": "maestro", "port": line.name})
                server.until(lambda: server.get("/api/state")["run"], lambda run: run["stroke"] >= 0)
                time.sleep(0.1 + 0.13 * number)
                clicked_s = page.evaluate(CLICK, "stop")
                server.run("idle")
            braking.append(1000 * (_first_off(model, rows) - clicked_s))
            server.post(f"/api/jobs/{job['id']}/run")
            server.until(lambda: server.get("/api/state")["run"], lambda run: run["stroke"] >= 0)
            with _told(page) as ended_s:
                clicked_s = page.evaluate(CLICK, "hold")
                server.run("idle")
            holding.append(1000 * (ended_s() - clicked_s))
    return braking, holding


def firmware_stops_ms(browser: Browser, folder: Path) -> tuple[list[float], list[float]]:
    """From a click on stop and on hold to the first pulse that is none of the run's, on the pins of the emulated
    firmware, in ms."""
    folder.mkdir()
    built, channels = build(folder), pulse_calibration(load_arm(_FIRMWARE_ARM)).addresses
    times: dict[str, list[float]] = {"stop": [], "hold": []}
    with Server(folder / "house") as server:
        job = server.planned(arm=_FIRMWARE_ARM)
        record = _record(folder / "house", job, "native")
        page = browser.new_page()
        page.goto(server.address)
        for number in range(2 * _STOPS):
            which = ("stop", "hold")[number % 2]
            (rig := folder / f"rig{number}").mkdir()
            emulator, line = on_pty(built, rig)
            with PinClock(emulator.pins) as clock:
                server.post(f"/api/jobs/{job['id']}/run", {"driver": "native", "port": str(line)})
                server.until(lambda: server.get("/api/state")["run"], lambda run: run["stroke"] >= 0)
                time.sleep(0.1 + 0.07 * number)
                clicked_s = page.evaluate(CLICK, which)
                server.run("idle")
            emulator.end()
            clicked_s = clock.at_s(clicked_s)
            times[which].append(1000 * (left_at_s(emulator, channels, record, clicked_s) - clicked_s))
    return times["stop"], times["hold"]


def _record(house: Path, job: dict[str, Any], driver: str) -> Path:
    """What a whole run would tell the servos."""
    record = house / "record.csv"
    dry = ["--driver", driver, "--dry-run", "--quiet", "--record", str(record)]
    with redirect_stdout(io.StringIO()):
        assert plan(["run", str(house / "jobs" / job["id"] / job["trajectory"]), *dry]) == 0
    return record


def _first_off(model: _Stamped, rows: np.ndarray) -> float:
    """When the first set point came that is not the next of the record."""
    at = 0
    for time_s, positions in model.seen:
        if len(positions) < rows.shape[1]:
            continue
        told = np.array([positions[channel] for channel in sorted(positions)])
        near = np.abs(rows[at : at + _AHEAD_ROWS] - told).max(axis=1) <= _QUARTER_US
        if not near.any():
            return time_s
        at += int(np.argmax(near))
    raise AssertionError("it never braked")


@contextmanager
def _told(page: Page) -> Iterator[Callable[[], float]]:
    """When the page has been told how the run ended, in its own clock."""
    page.evaluate("""() => {
      window.endedAt = new Promise((resolve) => {
        const source = new EventSource("/api/events");
        source.addEventListener("run", (event) => {
          if (!JSON.parse(event.data).ended) return;
          source.close();
          resolve(Date.now() / 1000);
        });
      });
    }""")
    yield lambda: page.evaluate("window.endedAt")


def memory_mb(server: Server, minutes: float) -> tuple[float, float, float, int]:
    """Of the server before and after runs as fast as `sim` goes, the hours that they stand for, and how many."""
    job = server.settled(server.upload(large_drawing(2000))["id"])
    server.post(f"/api/jobs/{job['id']}/plan", {"arm": ARM})
    assert server.settled(job["id"])["state"] == "planned"
    film = server.get(f"/api/jobs/{job['id']}/motion")
    lasts_s = film["end"] - film["begin"]

    def run() -> None:
        server.post(f"/api/jobs/{job['id']}/run", {"fast": True})
        assert server.run("idle")["complete"]

    run()
    before, end, count = resident_mb(server.process.pid), time.monotonic() + 60 * minutes, 0
    while time.monotonic() < end:
        run()
        count += 1
    return before, resident_mb(server.process.pid), count * lasts_s / 3600, count


def pages_s(browser: Browser, server: Server) -> float:
    """Three pages plan a drawing each at once, one of them runs; until all say so, in seconds, after the click."""
    pages = [browser.new_page() for _ in range(3)]
    for number, page in enumerate(pages):
        page.goto(server.address)
        page.set_input_files(
            "#file",
            {"name": f"page{number}.svg", "mimeType": "image/svg+xml", "buffer": large_drawing(200, 50)},
        )
        expect(page.locator("#sheet-says")).to_contain_text("% of its size", timeout=_PATIENCE_MS)
    for page in pages:
        page.click("#plan")
    for page in pages:
        expect(page.locator("#film")).to_be_visible(timeout=_PATIENCE_MS)
    begin = time.monotonic()
    pages[0].evaluate(CLICK, "run")
    for page in pages:
        expect(page.locator("#standing")).to_contain_text("drawing", timeout=_PATIENCE_MS)
    took = time.monotonic() - begin
    pages[2].evaluate(CLICK, "stop")
    for page in pages:
        expect(page.locator("#standing")).to_contain_text("stopped", timeout=_PATIENCE_MS)
        page.close()
    return took


DRAG = """async (lasts_ms) => {
  const canvas = document.getElementById("sheet");
  const box = canvas.getBoundingClientRect();
  const [x, y] = [box.left + box.width / 2, box.top + box.height * 0.42];
  const send = (name, dx, dy) => canvas.dispatchEvent(new PointerEvent(name, {
    pointerId: 1, clientX: x + dx, clientY: y + dy, bubbles: true, cancelable: true }));
  canvas.setPointerCapture = () => {};
  send("pointerdown", 0, 0);
  const begin = performance.now();
  let frames = 0;
  await new Promise((resolve) => {
    const step = (now) => {
      if (now - begin > lasts_ms) return resolve();
      send("pointermove", 20 * Math.sin(frames / 7), 20 * Math.cos(frames / 9));
      frames += 1;
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
  send("pointerup", 0, 0);
  return (1000 * frames) / (performance.now() - begin);
}"""


DOT = """async (lasts_ms) => {
  const context = document.getElementById("sheet").getContext("2d");
  const begin = performance.now();
  let frames = 0;
  await new Promise((resolve) => {
    const step = (now) => {
      if (now - begin > lasts_ms) return resolve();
      context.fillRect((frames += 1), 9, 1, 1);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
  return (1000 * frames) / (performance.now() - begin);
}"""
"""The most that this machine shows."""


def frames_a_second(browser: Browser, server: Server) -> tuple[float, float, float]:
    """While a drawing of 10 000 points is dragged, with software rendering, and while one dot is painted; and how many
    ms of each frame of the drag the page is at work."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.goto(server.address)
    page.set_input_files("#file", {"name": "dragged.svg", "mimeType": "image/svg+xml", "buffer": large_drawing()})
    expect(page.locator("#sheet-says")).to_contain_text("% of its size", timeout=_PATIENCE_MS)
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable")
    before_s = _at_work_s(session)
    dragged = page.evaluate(DRAG, 1000 * _DRAG_S)
    work_ms = 1000 * (_at_work_s(session) - before_s) / (dragged * _DRAG_S)
    most = page.evaluate(DOT, 1000 * _DRAG_S)
    assert page.input_value("[name=at-x]"), "it was not dragged"
    page.close()
    return dragged, most, work_ms


def _at_work_s(session: CDPSession) -> float:
    metrics = session.send("Performance.getMetrics")["metrics"]
    return next(float(metric["value"]) for metric in metrics if metric["name"] == "TaskDuration")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drawing", nargs="?", type=Path)
    parser.add_argument("--minutes", type=float, default=3.0, help="of runs, for the memory")
    options = parser.parse_args()
    drawing = options.drawing.read_bytes() if options.drawing else large_drawing()

    def tell(what: str, figure: str) -> None:
        print(f"{what}: {figure}", flush=True)

    starts = ready_s()
    tell("ready after the command", f"{np.median(starts):.2f} s (the longest of {_STARTS}: {max(starts):.2f} s)")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable(), args=FLAGS)
        braking, holding = stops_ms(browser, Path(folder) / "stops")
        stopped, held = firmware_stops_ms(browser, Path(folder) / "firmware")
        for what, times in (
            ("stop, to the first braking set point", braking),
            ("hold, to its end on sim", holding),
            ("stop, to the first braking pulse of the emulated firmware", stopped),
            ("hold, to the first held pulse of the emulated firmware", held),
        ):
            tell(what, f"{np.median(times):.0f} ms (the longest of {len(times)}: {max(times):.0f} ms)")
        with Server(Path(folder) / "house", "--demo") as server:
            frames, most, work_ms = frames_a_second(browser, server)
            tell(
                "dragging 10 000 points",
                f"{frames:.0f} frames a second, where a mere dot gets {most:.0f}; {work_ms:.1f} ms of work each",
            )
            tell("three pages at once", f"all see a run {pages_s(browser, server):.2f} s after the click")
            asked = answers_ms(server, drawing)
            tell(
                "answers while planning",
                f"{np.median(asked):.0f} ms, 95 % within {np.percentile(asked, 95):.0f} ms, all of {len(asked)} within "
                f"{max(asked):.0f} ms",
            )
            before, after, hours, runs = memory_mb(server, options.minutes)
            tell("memory", f"{before:.1f} MB before, {after:.1f} MB after {runs} runs, {hours:.1f} hours of drawing")
        browser.close()


if __name__ == "__main__":
    main()
