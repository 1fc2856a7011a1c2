"""The page as people see it, by a real browser: `make_figures.py` takes its pictures from here."""

from __future__ import annotations

import sys
from pathlib import Path

from first_hour import ARM, photographed
from playwright.sync_api import Browser, Page, expect, sync_playwright

from benchmarks.browser.chromium import executable
from tests.serve.served import Server

_FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_DESK, _PHONE = {"width": 1280, "height": 820}, {"width": 360, "height": 780}
_PATIENCE_MS = 120_000


def page_pictures(folder: Path, drawing: Path) -> None:
    """page-sheet.png, page-map.png, page-arm.png, page-phone.png, page-jog.png, page-calibrate.png."""
    with Server(folder / "house", "--demo") as server, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable(), args=_FLAGS)
        _draw(browser, server, folder, drawing)
        _jog(browser, server, folder)
        _calibrate(browser, server, folder)
        browser.close()


def _draw(browser: Browser, server: Server, folder: Path, drawing: Path) -> None:
    page = _opened(browser, server)
    page.set_input_files("#file", drawing)
    expect(page.locator("#jobs .job").first).to_contain_text("not planned yet", timeout=_PATIENCE_MS)
    page.select_option("#arm", "so101")
    page.select_option("[name=paper]", "a5")
    expect(page.locator("#sheet-says")).to_contain_text("% of its size", timeout=_PATIENCE_MS)
    _taken(page, folder, "sheet")
    page.check("#show-map")
    expect(page.locator("#map-legend")).to_be_visible(timeout=_PATIENCE_MS)
    _taken(page, folder, "map")
    page.uncheck("#show-map")
    page.click("#plan")
    expect(page.locator("#film")).to_be_visible(timeout=_PATIENCE_MS)
    page.click("#tab-arm")
    page.locator("#time").fill("24")
    page.set_viewport_size(_DESK | {"height": 1300})
    _taken(page, folder, "arm")
    phone = _opened(browser, server, phone=True)
    page.click("#run")
    expect(phone.locator("#standing")).to_contain_text("drawing", timeout=_PATIENCE_MS)
    phone.wait_for_timeout(6000)
    phone.locator("#tab-sheet").scroll_into_view_if_needed()
    _taken(phone, folder, "phone")
    page.click("#stop")
    expect(page.locator("#standing")).to_contain_text("stopped", timeout=_PATIENCE_MS)


def _jog(browser: Browser, server: Server, folder: Path) -> None:
    page = _opened(browser, server, "#jog")
    page.select_option("#jog-arm", ARM)
    page.click("#jog-start")
    joint = page.locator("#jog-joints li").first
    joint.get_by_role("button", name="more").click(timeout=_PATIENCE_MS)
    joint.get_by_role("button", name="upper limit").click()
    expect(page.locator("#jog-says")).to_contain_text("not saved", timeout=_PATIENCE_MS)
    _taken(page, folder, "jog")
    page.click("#hold")
    expect(page.locator("#jog-says")).to_contain_text("holds", timeout=_PATIENCE_MS)


def _calibrate(browser: Browser, server: Server, folder: Path) -> None:
    page = _opened(browser, server, "#calibrate")
    page.select_option("#walk-arm", ARM)
    page.click("#walk-begin button")
    expect(page.locator("#walk-sheet")).to_be_visible(timeout=_PATIENCE_MS)
    page.click("#walk-draw")
    expect(page.locator("#walk-drawn")).to_contain_text("played", timeout=_PATIENCE_MS)
    photographed(folder / "house" / "calibration")
    page.set_input_files("#walk-photo", folder / "house" / "calibration" / "photo.jpg")
    expect(page.locator("#walk-reading")).to_be_visible(timeout=_PATIENCE_MS)
    page.click("#walk-calibrate button")
    expect(page.locator("#walk-found")).to_contain_text("is an arm now", timeout=_PATIENCE_MS)
    page.locator("#step-measure").scroll_into_view_if_needed()
    page.set_viewport_size(_DESK | {"height": 1500})
    _taken(page, folder, "calibrate")


def _opened(browser: Browser, server: Server, where: str = "", *, phone: bool = False) -> Page:
    look = {"viewport": _PHONE, "color_scheme": "dark"} if phone else {"viewport": _DESK}
    page = browser.new_page(**look)  # type: ignore[arg-type]
    page.goto(server.address + where)
    page.wait_for_timeout(1000)
    return page


def _taken(page: Page, folder: Path, name: str) -> None:
    page.wait_for_timeout(1500)
    page.screenshot(path=folder / f"page-{name}.png")


if __name__ == "__main__":
    page_pictures(Path(sys.argv[1]).absolute(), Path(sys.argv[2]).absolute())
