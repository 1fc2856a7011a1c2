"""`--report DIR`: the page, as a browser would read it, and when it is refused."""

from __future__ import annotations

import base64
import hashlib
import io
import re
import shlex
from pathlib import Path

import matplotlib.image
import pytest

from planner.cli import main
from tests.report.test_markup import Reader

NAME = "a<b>&'c\".svg"
SVG = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20">
<g fill="none" stroke="black"><path d="M5 5 L20 6 L12 15"/><path d="M30 8 a4 4 0 1 1 1 0"/>
<path d="M25 15 h0" stroke-linecap="round"/></g><image width="9" height="9" href="data:image/png;base64,AAAA"/></svg>"""


def test_a_page_in_the_place_of_another(tmp_path: Path) -> None:
    """One plan, as it takes seconds; all that the page owes is asked of it."""
    (tmp_path / NAME).write_text(SVG)
    page = tmp_path / "deep" / "er" / "index.html"
    page.parent.mkdir(parents=True)
    page.write_text("what was here before")
    command = [
        str(tmp_path / NAME),
        "-o",
        str(tmp_path / "traj.csv"),
        "--report",
        str(page.parent),
        "--speed",
        "40",
        "--quiet",
    ]
    assert main(command) == 0
    assert [path.name for path in page.parent.iterdir()] == ["index.html"]
    text = page.read_text(encoding="utf-8")
    seen = Reader(text)
    assert not seen.open
    _asks_for_nothing(seen, text)
    _has_pictures_for_light_and_dark(seen)
    _styles_every_class(seen, text)
    _links_lead_to_every_section(seen)
    _has_the_film(seen)
    _opens_with_what_is_asked_first(seen.text)
    _tells_what_was_planned(seen.text, shlex.join(["plan", *command]))


def _asks_for_nothing(page: Reader, text: str) -> None:
    assert not {tag for tag, _ in page.tags} & {"script", "link", "object"}
    addresses = [
        value for _, attributes in page.tags for name, value in attributes.items() if name in {"src", "srcset"}
    ]
    assert addresses
    assert all(value is not None and value.startswith("data:image/png;base64,") for value in addresses)
    assert "url(" not in text
    assert "@import" not in text


def _links_lead_to_every_section(page: Reader) -> None:
    links = [attributes["href"] for tag, attributes in page.tags if tag == "a"]
    sections = [f"#{attributes['id']}" for tag, attributes in page.tags if tag == "section" and "id" in attributes]
    assert links == sections and len(set(sections)) == len(sections) > 10


def _has_the_film(page: Reader) -> None:
    """In a frame that can do no more than run the one script that the page's policy names."""
    (frame,) = (attributes for tag, attributes in page.tags if tag == "iframe")
    assert frame["sandbox"] == "allow-scripts"
    film = frame["srcdoc"] or ""
    inner = Reader(film)
    assert [tag for tag, attributes in inner.tags if {"src", "href", "srcset"} & set(attributes)] == []
    (script,) = re.findall(r"<script>(.*?)</script>", film, flags=re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = next(attributes["content"] for tag, attributes in page.tags if "http-equiv" in attributes)
    assert policy is not None and policy.endswith(f"script-src 'sha256-{digest}'")


def _opens_with_what_is_asked_first(told: list[str]) -> None:
    asked = ["Where to lay it", "How long it takes", "How large it is", "Which pens", "How accurate it becomes"]
    places = [told.index(line) for line in [*asked, "The plan", "Contents", "Warnings (1)"]]
    assert places == sorted(places)
    assert told[places[0] + 1].startswith("lay paper ")


def _styles_every_class(page: Reader, text: str) -> None:
    """A class that no rule of the page knows is a misprint; cells of text look as cells do anyhow."""
    used = {name for _, attributes in page.tags for name in (attributes.get("class") or "").split()}
    styled = set(re.findall(r"\.([a-z][a-z-]*)", text.partition("</style>")[0]))
    assert used - styled == {"text"}


def _has_pictures_for_light_and_dark(page: Reader) -> None:
    light = [attributes["src"] for tag, attributes in page.tags if tag == "img"]
    dark = [attributes["srcset"] for tag, attributes in page.tags if tag == "source"]
    assert len(light) == len(dark) == 8
    for pair in zip(light, dark, strict=True):
        grounds = []
        for address in pair:
            assert address is not None
            pixels = matplotlib.image.imread(io.BytesIO(base64.b64decode(address.partition(",")[2])))
            assert pixels.shape[1] > 1000
            assert pixels[..., :3].std() > 0.01
            grounds.append(float(pixels[0, 0, :3].mean()))
        assert grounds[0] > 0.9
        assert grounds[1] < 0.2


def _tells_what_was_planned(told: list[str], command: str) -> None:
    assert NAME in told
    assert command in told
    assert any(line.startswith("passed: ") for line in told)
    assert "Warnings (1)" in told
    assert any("1 image" in line for line in told)
    assert "The first 3 of 3" in told
    assert told.count("tap") == 2  # among the first and among the costly
    for line in ("q5", "40 mm/s", "0.05 mm", "nothing missing", "jerk", "casadi"):
        assert line in told, line


@pytest.mark.parametrize("in_the_way", ["a file", "a file in between", "a folder of the page's name", "the trajectory"])
def test_a_page_that_cannot_be_written_is_refused_before_planning(
    in_the_way: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drawing, folder, target = tmp_path / "drawing.svg", tmp_path / "report", tmp_path / "traj.csv"
    drawing.write_text("not read")
    match in_the_way:
        case "a file":
            folder.write_text("in the way")
        case "a file in between":
            folder.write_text("in the way")
            folder /= "deep"
        case "a folder of the page's name":
            (folder / "index.html").mkdir(parents=True)
        case _:
            folder.mkdir()
            target = folder / "index.html"
    assert main([str(drawing), "-o", str(target), "--report", str(folder)]) == 2
    assert "report" in capsys.readouterr().err
    assert not target.is_file()


def test_a_drawing_that_cannot_be_planned_leaves_no_folder(tmp_path: Path) -> None:
    (tmp_path / "empty.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    assert main([str(tmp_path / "empty.svg"), "-o", str(tmp_path / "t.csv"), "--report", str(tmp_path / "r")]) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["empty.svg"]
