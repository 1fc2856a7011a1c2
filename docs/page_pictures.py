"""The page as people see it, by a real browser: `make_figures.py` takes its pictures from here."""

from __future__ import annotations

import sys
from pathlib import Path

from playwright.sync_api import Page, expect, sync_playwright

from benchmarks.browser.chromium import executable
from tests.serve.served import Server

_FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_DESK, _PHONE = {"width": 1280, "height": 820}, {"width": 360, "height": 780}
_PATIENCE_MS = 60_000


def page_pictures(folder: Path, drawing: Path) -> None:
    """page-sheet.png, page-arm.png, page-joints.png, page-phone.png."""
    with Server(folder / "house", "--demo") as server, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable(), args=_FLAGS)
        page = browser.new_page(viewport=_DESK)
        page.goto(server.address)
        page.set_input_files("#file", drawing)
        expect(page.locator("#jobs .job").first).to_contain_text("not planned yet", timeout=_PATIENCE_MS)
        page.select_option("#arm", "so101")
        page.select_option("[name=paper]", "a5")
        expect(page.locator("#sheet-says")).to_contain_text("% of its size", timeout=_PATIENCE_MS)
        page.wait_for_timeout(500)
        page.screenshot(path=folder / "page-sheet.png")
        page.click("#plan")
        expect(page.locator("#film")).to_be_visible(timeout=_PATIENCE_MS)
        _view(page, "arm", folder)
        _view(page, "joints", folder)
        phone = browser.new_page(viewport=_PHONE, color_scheme="dark")
        phone.goto(server.address)
        page.click("#run")
        expect(phone.locator("#standing")).to_contain_text("drawing", timeout=_PATIENCE_MS)
        phone.wait_for_timeout(6000)
        phone.locator("#tab-sheet").scroll_into_view_if_needed()
        phone.screenshot(path=folder / "page-phone.png")
        page.click("#stop")
        expect(page.locator("#standing")).to_contain_text("stopped", timeout=_PATIENCE_MS)
        browser.close()


def _view(page: Page, name: str, folder: Path) -> None:
    page.click(f"#tab-{name}")
    page.locator("#time").fill("24")
    page.wait_for_timeout(1500)
    page.screenshot(path=folder / f"page-{name}.png")


if __name__ == "__main__":
    page_pictures(Path(sys.argv[1]).absolute(), Path(sys.argv[2]).absolute())
