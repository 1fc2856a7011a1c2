"""The page in a real browser: from a drawing that is dropped to one that is drawn."""

from __future__ import annotations

import io
import json
import os
import re
from collections.abc import Iterator
from dataclasses import replace
from importlib import resources
from math import radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, ConsoleMessage, Page, Route, expect, sync_playwright

from benchmarks.browser.chromium import executable
from planner.arms.arm_file import load_arm
from planner.arms.arm_text import arm_toml
from planner.arms.paper_pose import PaperPose
from planner.cli import main as command
from planner.serve.asked import arguments_of
from planner.trajectory import read_trajectory
from tests.drawn_shapes import lines_svg
from tests.serve.served import PAGE, SQUARE, Server

TWO_PENS = (
    b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 60" width="60mm" height="60mm" fill="none">'
    b'<path d="M10 10 H13" stroke="#0050c8"/><path d="M10 13 H13" stroke="#c02000"/></svg>'
)
LAYERS = (
    b'<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    b'viewBox="0 0 60 60" width="60mm" height="60mm" fill="none"><g inkscape:groupmode="layer" inkscape:label="sea">'
    b'<path d="M10 10 H50" stroke="#0050c8"/></g><g inkscape:groupmode="layer" inkscape:label="2 land">'
    b'<path d="M10 30 H50" stroke="#c02000"/></g><g inkscape:groupmode="layer" inkscape:label="%notes">'
    b'<path d="M10 50 H50" stroke="#208020"/></g></svg>'
)
TICK = lines_svg('<path d="M30 30 l2 2"/>', PAGE).encode()
FLAGS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",  # three dimensions alone go through the graphics card that there is not
]
PHONE = {"width": 360, "height": 740}
AXE = resources.files("axe_playwright_python").joinpath("axe.min.js").read_text(encoding="utf-8")
SLOW_MS = 60_000
"""How long anything may take on a machine that is busy: who waits goes on as soon as it has happened."""
expect.set_options(timeout=SLOW_MS)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    program = executable()
    if program is None:
        assert not os.environ.get("CI"), "chromium is not installed"
        pytest.skip("chromium is not installed")
    with sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=program, args=FLAGS)
        yield running
        running.close()


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    with Server(tmp_path_factory.mktemp("house"), "--demo") as running:
        yield running


@pytest.fixture(scope="module")
def kept(server: Server) -> str:
    """The name of a drawing that is planned, and that nobody changes or draws."""
    job = server.upload(name="kept.svg")
    server.post(f"/api/jobs/{job['id']}/plan", {"arm": "drawing_arm"})
    assert server.settled(job["id"])["state"] == "planned"
    return "kept"


_EXPECTED = re.compile(r"400 \(Bad Request\)|404 \(Not Found\) at \S+/api/jobs/\w+/(lines|motion)$")
"""What was refused, as it should be; and what was there when the page heard of it, and was planned anew since."""


def _told(said: ConsoleMessage) -> str:
    return f"{said.text} at {said.location['url']}"


@pytest.fixture(scope="module")
def opened(browser: Browser, server: Server) -> Iterator[tuple[Page, list[str]]]:
    """A page of the browser, and what its console complains of."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda said: complaints.append(_told(said)) if said.type == "error" else None)
    page.on("request", lambda request: complaints.append(request.url) if is_elsewhere(server, request.url) else None)
    page.set_default_timeout(SLOW_MS)
    yield page, complaints
    page.close()


@pytest.fixture
def page(opened: tuple[Page, list[str]], server: Server) -> Iterator[Page]:
    """The page, loaded anew; what its console complains of fails the test."""
    page, complaints = opened
    complaints.clear()
    visit(page, server)
    yield page
    page.unroute_all()
    page.goto("about:blank")
    assert not [complaint for complaint in complaints if not _EXPECTED.search(complaint)]


@pytest.fixture(scope="module")
def in_the_hand(browser: Browser) -> Iterator[Page]:
    page = browser.new_page(viewport=PHONE, color_scheme="dark")
    page.set_default_timeout(SLOW_MS)
    yield page
    page.close()


@pytest.fixture
def phone(in_the_hand: Page, server: Server) -> Iterator[Page]:
    """The page on a phone where it is dark, loaded anew."""
    visit(in_the_hand, server)
    yield in_the_hand
    in_the_hand.goto("about:blank")


def is_elsewhere(server: Server, url: str) -> bool:
    return not url.startswith((f"http://127.0.0.1:{server.port}/", "data:", "blob:"))


def visit(page: Page, server: Server) -> None:
    """The page, once it knows what the server does."""
    page.goto(server.address)
    expect(page.locator("#arm option")).not_to_have_count(0)


def give(page: Page, content: bytes = SQUARE, name: str = "square.svg") -> None:
    jobs = page.locator("#jobs .job")
    before = jobs.count()
    page.set_input_files("#file", {"name": name, "mimeType": "image/svg+xml", "buffer": content})
    expect(jobs).to_have_count(before + 1)
    expect(jobs.first).to_have_attribute("aria-current", "true")
    expect(jobs.first).to_contain_text("not planned yet")
    expect(page.locator("#sheet-says")).to_contain_text("mm")


def choose(page: Page, name: str) -> None:
    """One that is planned."""
    page.locator("#jobs .job", has_text=f"{name}.svg").click()
    is_planned(page)


def plan(page: Page) -> None:
    page.click("#plan")
    is_planned(page)


def is_planned(page: Page) -> None:
    expect(page.locator("#plan-says")).to_have_class("good")
    expect(page.locator("#film")).to_be_visible()


def settle(page: Page) -> None:
    """What was to be painted is."""
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def test_from_a_dropped_drawing_to_a_drawn_one(page: Page, server: Server) -> None:
    give(page)
    plan(page)
    assert page.locator("#command").inner_text() == "plan square.svg --arm=drawing_arm -o square.csv"
    page.click("#tab-arm")
    page.fill("#time", "1")
    expect(page.locator("#time-says")).to_contain_text("1.0 of")
    page.click("#play")
    expect(page.locator("#time-says")).not_to_contain_text(re.compile(r"^1\.[0-4] "))
    page.select_option("#speed-factor", "0.25")  # it is still at it when it is asked to stop
    page.click("#run")
    expect(page.locator("#standing")).to_contain_text("drawing")
    page.click("#pause")
    expect(page.locator("#standing")).to_contain_text("paused")
    page.reload()  # a run does not mind
    expect(page.locator("#standing")).to_contain_text("paused")
    page.click("#pause")
    expect(page.locator("#standing")).to_contain_text("drawing")
    page.click("#stop")
    expect(page.locator("#standing")).to_contain_text("stopped")
    page.select_option("#speed-factor", "1")
    page.click("#resume")
    expect(page.locator("#standing")).to_contain_text("played")


def test_a_drawing_that_comes_before_the_server_has_answered_waits_for_it(page: Page) -> None:
    late: list[Route] = []
    page.route("**/api/events", lambda route: late.append(route))
    page.reload()
    page.set_input_files("#file", {"name": "early.svg", "mimeType": "image/svg+xml", "buffer": SQUARE})
    settle(page)
    for route in late:
        route.continue_()
    expect(page.locator("#jobs .job").first).to_contain_text("early.svg")
    expect(page.locator("#sheet-says")).to_contain_text("mm")


def test_a_drawing_is_moved_sized_and_turned_by_hand_and_lands_there(page: Page, server: Server) -> None:
    give(page)
    box = page.locator("#sheet").bounding_box()
    assert box
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] * 0.45
    before = placement(page)
    page.mouse.move(*middle)
    page.mouse.down()
    page.mouse.move(middle[0] + 60, middle[1], steps=5)
    page.mouse.up()
    moved = placement(page)
    assert moved["at-x"] > 0 and not before["at-x"]
    page.focus("#sheet")
    page.keyboard.press("-")
    page.keyboard.press("-")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("]")
    now = placement(page)
    assert now["scale"] < moved["scale"] and now["rotate"] == 1
    plan(page)
    job = server.get("/api/state")["jobs"][-1]
    assert job["options"]["at"] == [now["at-x"], now["at-y"]]
    assert abs(100 * job["options"]["scale"] - now["scale"]) < 0.01
    film = server.get(f"/api/jobs/{job['id']}/motion")
    assert film["end"] > 1
    page.click("#fit")
    assert placement(page)["at-x"] is None


def test_what_has_changed_since_it_was_planned_is_not_drawn(kept: str, page: Page) -> None:
    choose(page, kept)
    expect(page.locator("#command")).to_have_text("plan kept.svg --arm=drawing_arm -o kept.csv")
    page.focus("#sheet")
    page.keyboard.press("ArrowLeft")
    expect(page.locator("#plan-stale")).to_be_visible()
    expect(page.locator("#run")).to_be_disabled()
    expect(page.locator("#plan-box")).to_be_hidden()
    expect(page.locator("#command")).to_contain_text(" --at ")
    page.click("#unchange")
    expect(page.locator("#plan-stale")).to_be_hidden()
    expect(page.locator("#run")).to_be_enabled()
    expect(page.locator("#film")).to_be_visible()
    expect(page.locator("#command")).not_to_contain_text(" --at ")


def test_an_arm_that_is_worked_out_late_does_not_undo_its_plan(page: Page) -> None:
    late: list[Route] = []
    page.route("**/api/arms/scara", lambda route: late.append(route))
    give(page)
    page.select_option("#arm", "scara")
    page.fill("[name=rotate]", "5")
    expect(page.locator("#sheet-says")).to_contain_text("Working out what scara reaches")
    page.click("#plan")
    expect(page.locator("#plan-says")).to_have_class("good")
    for route in late:
        route.continue_()
    expect(page.locator("#sheet-says")).to_contain_text("of its size")
    is_planned(page)
    settle(page)
    expect(page.locator("#run")).to_be_enabled()
    expect(page.locator("#film")).to_be_visible()


def test_joints_are_shown_under_the_arm_with_their_extremes_and_limits(kept: str, page: Page) -> None:
    choose(page, kept)
    expect(page.locator("#joints-view")).to_be_hidden()
    page.click("#tab-arm")
    expect(page.locator("#joints-view")).to_be_visible()
    rows = page.locator("#joints-table tr")
    assert rows.count() == len(load_arm("drawing_arm").joints)
    for cell in rows.first.locator("td").all_inner_texts()[1:]:
        most, limit = re.findall(r"[0-9.]+", cell)
        assert 0 < float(most) <= float(limit)
    before = page.locator("#joints-view").screenshot()
    page.select_option("#quantity", "speed")
    settle(page)
    assert page.locator("#joints-view").screenshot() != before


def test_the_command_is_copied(page: Page) -> None:
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    give(page)
    expect(page.locator("#command")).to_contain_text("plan square.svg")
    page.click("#command-box .copy")
    expect(page.locator("#command-box .copied")).to_have_text("copied")
    assert page.evaluate("navigator.clipboard.readText()") == page.locator("#command").inner_text()


def test_a_run_is_told_of_its_own_drawing_and_drawn_again(kept: str, page: Page) -> None:
    give(page, TICK, "tick.svg")
    plan(page)
    page.click("#run")
    expect(page.locator("#run-says")).to_contain_text("played")
    expect(page.locator("#run")).to_have_text("Draw again")
    expect(page.locator("#runs li")).to_have_text(re.compile("sim: played"))
    choose(page, kept)
    expect(page.locator("#run-says")).to_have_text("")
    expect(page.locator("#run")).to_have_text("Draw")


def placement(page: Page) -> dict[str, Any]:
    return {
        name: float(value) if (value := page.input_value(f"[name={name}]")) else None
        for name in ("at-x", "at-y", "scale", "rotate")
    }


WHERE = """async ([key, arm, options]) => {
  const { canvasOf, placed, turned } = await import("/static/placement.js");
  const [lines, told] = await Promise.all([`/api/jobs/${key}/lines`, `/api/arms/${arm}`].map(
    (path) => fetch(path).then((response) => response.json())));
  lines.hull = lines.lines.flatMap((line) => line.points);
  const canvas = canvasOf(told);
  const { turn, box, factor, corner, over } = placed(lines, canvas, options);
  return [over, [[0, 0], [1, 0], [0, 1]].map((point) => {
    const [x, y] = turned(turn, point);
    return [canvas.far - (corner[1] + factor * (y - box.top)), canvas.left - (corner[0] + factor * (x - box.left))];
  })];
}"""
"""Where the page shows three points of the drawing, in arm mm, and how far ink would be over the edge."""


PLACES: list[tuple[bool, dict[str, Any]]] = [
    (True, {}),
    (False, {"arm": "so101", "rotate": 30}),
    (True, {"paper": "a4", "rotate": 90, "arm": "so101"}),
    (False, {"margin": 12, "mirror": True, "paper": "a6"}),
    (True, {"scale": 0.7, "rotate": -75, "mirror": True}),
    (True, {"at": [12.5, 7], "scale": 0.5, "rotate": 10, "paper": "a6"}),
    (False, {"at": [3, 4]}),
    (True, {"scale": 3}),
]


def test_the_sheet_shows_where_the_planner_puts_a_drawing(
    page: Page, server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    keys: dict[bool, str] = {}
    for has_page in (True, False):
        content = SQUARE if has_page else SQUARE.replace(PAGE.encode(), b"")
        Path(f"{has_page}.svg").write_bytes(content)
        keys[has_page] = server.upload(content)["id"]
    for has_page, options in PLACES:
        usual = {"rotate": 0, "mirror": False, "at": None, "scale": None, "margin": None, "paper": ""}
        arm = options.get("arm", "drawing_arm")
        over, shown = page.evaluate(WHERE, [keys[has_page], arm, usual | options])
        code = command([f"{has_page}.svg", *arguments_of(options, str), "-o", "traj.csv", "--quiet"])
        assert (over <= 0.01) == (code == 0), options
        if code == 0:
            a, b, c, d, e, f = read_trajectory(Path("traj.csv")).svg_to_arm_mm
            mm = 1.0 if has_page else 96.0 / 25.4  # of a drawing without a page, units are pixels
            wanted = [[e, f], [e + mm * a, f + mm * b], [e + mm * c, f + mm * d]]
            assert shown == [pytest.approx(point, abs=2e-3) for point in wanted], options


STANDS = """async (key) => {
  const [{ ArmView }, { unpacked }, { Vector3 }] = await Promise.all(
    ["arm_view.js", "film.js", "vendor/three.js"].map((name) => import(`/static/${name}`)));
  const film = await fetch(`/api/jobs/${key}/motion`).then((response) => response.json());
  const canvas = document.body.appendChild(document.createElement("canvas"));
  canvas.style.height = "300px";
  const view = new ArmView(canvas, null);
  view.show(unpacked(film), null);
  view.at(film.end / 2, film.n_samples / 2);
  for (let k = 0; k < 3; k++) await new Promise(requestAnimationFrame); // it is laid out, and then seen
  view.scene.updateMatrixWorld(true);
  const out = (object) => new Vector3(0, 0, 1).transformDirection(object.matrixWorld).toArray();
  const [floor] = view.world.children.filter(({ type }) => type === "GridHelper");
  const inWorld = (z) => view.onPaper.localToWorld(new Vector3(...film.paper[0], z));
  const seen = (z) => inWorld(z).project(view.camera);
  canvas.remove();
  return {
    normal: out(view.onPaper),
    floor: floor.position.z,
    lowest: Math.min(...film.paper.map(([x, y]) => view.onPaper.localToWorld(new Vector3(x, y, 0)).z)),
    in_sight: Math.max(...["x", "y"].map((axis) => Math.abs(seen(0)[axis]))),
    is_seen_from_the_front: seen(10).z < seen(0).z,
    last_link_at: view.pen[1].getWorldPosition(new Vector3()).toArray(),
  };
}"""
"""How the arm and its paper stand in the three dimensional view halfway through a plan."""


@pytest.mark.parametrize("tilt", [0.0, -40.0, -90.0, -180.0])
def test_the_paper_stands_on_the_floor_as_in_the_world(page: Page, server: Server, tilt: float) -> None:
    paper = (
        PaperPose(100.0, 0.0, 230.0, tilt_y_rad=radians(tilt))
        if tilt == -180
        else (PaperPose(190.0, 0.0, 80.0, tilt_y_rad=radians(tilt)) if tilt else PaperPose())
    )
    arm = replace(load_arm("six_joint"), name=f"tilted{abs(tilt):.0f}", paper=paper)
    (server.folder / "arms" / f"{arm.name}.toml").write_text(arm_toml(arm), encoding="utf-8")
    job = server.planned(arm=arm.name)
    assert job["state"] == "planned", job["error"]
    seen = page.evaluate(STANDS, job["id"])
    server.remove(job["id"])  # pages show the newest
    assert seen["normal"] == pytest.approx(paper.normal.tolist(), abs=1e-6)
    assert seen["floor"] < min(0.0, seen["lowest"]) + 1e-6
    assert seen["in_sight"] < 1 and seen["is_seen_from_the_front"]
    tip = np.linalg.inv(paper.T_base_paper) @ [*seen["last_link_at"], 1.0]
    assert 0.0 < tip[2] < 60.0  # the pen, over the paper


def test_pens_are_asked_for_and_put_in(page: Page) -> None:
    give(page, TWO_PENS, "two.svg")
    page.select_option("[name=by]", "colour")
    plan(page)
    page.click("#run")
    expect(page.locator("#pen")).to_be_visible()
    page.click("#pen")
    expect(page.locator("#standing")).to_contain_text("played")


def test_layers_are_chosen_and_their_pens_are_shown(page: Page, server: Server) -> None:
    give(page, LAYERS, "map.svg")
    boxes = {name: page.get_by_role("checkbox", name=name, exact=True) for name in ("sea", "2 land", "%notes")}
    assert [box.is_checked() for box in boxes.values()] == [True, True, False]
    boxes["sea"].uncheck()
    boxes["%notes"].check()
    page.select_option("[name=by]", "layer")
    plan(page)
    job = server.get("/api/state")["jobs"][-1]
    assert job["options"]["layers"] == "2 land,%notes"
    expect(page.locator("#pens li")).to_have_text(["2 land", "%notes"])
    page.reload()
    expect(page.get_by_role("checkbox", name="sea", exact=True)).not_to_be_checked()
    expect(page.get_by_role("checkbox", name="%notes", exact=True)).to_be_checked()


def test_the_map_says_what_it_shows(page: Page) -> None:
    page.check("#show-map")
    page.select_option("#arm", "scara")
    expect(page.locator("#map-of")).to_contain_text("each degree")
    page.select_option("#arm", "drawing_arm_2022")
    expect(page.locator("#map-of")).to_contain_text("expected")
    least, most = (float(page.locator(f"#map-{end}").inner_text().split()[0]) for end in ("least", "most"))
    assert 1 < least < most < 20


def test_a_picture_is_dropped_and_drawn(page: Page, server: Server) -> None:
    shades = np.tile(np.linspace(0, 255, 40, dtype=np.uint8), (30, 1))
    picture = io.BytesIO()
    Image.fromarray(shades).save(picture, "PNG")
    give(page, picture.getvalue(), "shades.png")
    expect(page.locator("#picture-box")).to_be_visible()
    page.select_option("[name=image]", "stipple")
    page.fill("[name=image-line]", "2")
    page.fill("[name=scale]", "200")
    plan(page)
    assert server.get("/api/state")["jobs"][-1]["options"]["image"] == "stipple"


def test_joints_are_jogged_and_held_at_once_from_every_page(page: Page, phone: Page) -> None:
    page.click("text=Jog")
    page.select_option("#jog-arm", "so101")
    page.fill("#jog-target", "found")
    page.click("#jog-start")
    joint = page.locator("#jog-joints li").first
    expect(joint).to_be_visible()
    before = joint.locator(".at").inner_text()
    page.select_option("#jog-step", "5")
    joint.get_by_role("button", name="more").click()
    expect(joint.locator(".at")).not_to_have_text(before)
    joint.get_by_role("button", name="upper limit").click()
    expect(page.locator("#jog-says")).to_contain_text("not saved")
    joint.get_by_role("button", name="more").click()
    expect(page.locator("#jog-says")).to_have_class("bad")
    page.click("text=Save the arm")
    expect(page.locator("#arm")).to_contain_text("found")
    phone.locator("#hold").click()
    expect(page.locator("#jog-says")).to_contain_text("holds where it is")


def test_the_calibration_walk_begins_and_leads_on(page: Page) -> None:
    page.click("text=Calibrate")
    page.select_option("#walk-arm", "drawing_arm_2022")
    page.fill("#walk-count", "12")
    expect(page.locator("#walk-draw")).to_be_disabled()
    page.click("text=Make a pattern")
    expect(page.locator("#walk-sheet")).to_be_visible()
    page.click("#walk-draw")
    expect(page.locator("#walk-drawn")).to_contain_text("played")
    page.set_input_files("#walk-photo", {"name": "x.png", "mimeType": "image/png", "buffer": b"no picture"})
    expect(page.locator("#walk-says")).to_have_class("bad")


def test_a_second_page_sees_and_stops_what_the_first_began(page: Page, phone: Page) -> None:
    give(page)
    plan(page)
    page.select_option("#speed-factor", "0.25")  # it is still at it when it is asked to stop
    page.click("#run")
    expect(phone.locator("#standing")).to_contain_text("drawing")
    phone.click("#stop")
    expect(page.locator("#standing")).to_contain_text("stopped")


def test_what_goes_wrong_is_said(page: Page) -> None:
    page.set_input_files("#file", {"name": "notes.txt", "mimeType": "text/plain", "buffer": b"hello"})
    expect(page.locator("#plan-says")).to_contain_text("not a drawing")
    page.set_input_files("#file", {"name": "bad.svg", "mimeType": "image/svg+xml", "buffer": b"<svg"})
    expect(page.locator("#plan-says")).to_contain_text("bad.svg")
    give(page)
    page.fill("[name=scale]", "900")
    expect(page.locator("#sheet-says")).to_contain_text("over the edge")
    page.click("#plan")
    expect(page.locator("#plan-says")).to_have_class("bad")


@pytest.mark.parametrize("seen_on", ["page", "phone"])
def test_people_with_any_senses_can_use_it(request: pytest.FixtureRequest, kept: str, seen_on: str) -> None:
    page: Page = request.getfixturevalue(seen_on)
    choose(page, kept)
    page.evaluate(AXE)
    for view in ("#tab-sheet", "#tab-arm", "text=Jog", "text=Calibrate"):
        page.click(view)
        if view == "text=Jog":
            page.click("#jog-start")
            expect(page.locator("#jog-joints li").first).to_be_visible()
        found = page.evaluate("axe.run({ resultTypes: ['violations'] })")
        serious = [fault for fault in found["violations"] if fault["impact"] in ("serious", "critical")]
        assert not serious, json.dumps(serious, indent=1)[:3000]
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), view
    page.click("#hold")
    expect(page.locator("#standing")).not_to_contain_text("jogging")
