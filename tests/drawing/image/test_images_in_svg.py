"""Pictures in an SVG are drawn where a browser shows them, and only from where they may come."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
import pytest
import shapely
from shapely.affinity import affine_transform

from planner.drawing.drawing import Drawing
from planner.drawing.flatten import flatten_all
from planner.drawing.image.lines import with_images
from planner.drawing.image_options import ImageOptions, ImageStyle, image_options
from planner.drawing.options import ReadingOptions
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing
from planner.errors import DrawingError, UsageError
from planner.polyline_length import polyline_length
from tests.drawing.image.pictures import file_of

BLACK = file_of(np.zeros((30, 40), dtype=np.uint8))
EMBEDDED = "data:image/png;base64," + base64.b64encode(BLACK).decode()
TRACE = ReadingOptions(image=ImageOptions(ImageStyle.TRACE, 0.2))
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" width="100mm" height="100mm">'


def read(body: str, options: ReadingOptions = TRACE) -> Drawing:
    drawing = read_drawing(SvgInMemory("drawn.svg", f"{HEAD}{body}</svg>".encode()), options=options)
    return with_images(drawing, drawing.user_to_page)


def image(attributes: str = 'x="20" y="30" width="40" height="30"') -> str:
    return f'<image href="{EMBEDDED}" {attributes}/>'


DAMAGED = "image that cannot be used: it is no whole picture that can be read (save it anew, as a PNG)"
PLAIN = shapely.box(20, 30, 60, 60)


@pytest.mark.parametrize(
    ("body", "corners"),
    [
        (image(), PLAIN),
        (image('x="20" y="30" width="40"'), PLAIN),
        (image('x="20" y="30" height="30"'), PLAIN),
        (image('x="10" y="20" width="40" height="60"'), shapely.box(10, 35, 50, 65)),
        (image('x="10" y="20" width="40" height="60" preserveAspectRatio="xMidYMax"'), shapely.box(10, 50, 50, 80)),
        (image('x="10" y="20" width="40" height="60" preserveAspectRatio="none"'), shapely.box(10, 20, 50, 80)),
        (image('x="10" y="20" width="40" height="60" preserveAspectRatio="xMinYMid slice"'),
         shapely.box(10, 20, 50, 80)),
        (f'<g transform="matrix(.8 .3 -.4 .6 30 5)">{image()}</g>',
         affine_transform(PLAIN, [0.8, -0.4, 0.3, 0.6, 30, 5])),
        (f'<svg x="10" y="5" width="50" height="50" viewBox="0 0 100 100">{image()}</svg>',
         shapely.box(20, 20, 40, 35)),
        (f'<clipPath id="c"><path d="M25 0h20v100h-20z"/></clipPath><g clip-path="url(#c)">{image()}</g>',
         shapely.box(25, 30, 45, 60)),
        (image('x="80" y="80" width="40" height="30"'), shapely.box(80, 80, 100, 100)),
        (f'{image()}<rect x="40" y="0" width="60" height="100" fill="white"/>', shapely.box(20, 30, 40, 60)),
    ],
)  # fmt: skip
def test_a_picture_is_where_its_corners_are(body: str, corners: shapely.Polygon) -> None:
    drawing = read(body)
    own = read(body, ReadingOptions()).outlines if "rect" in body else ()
    lines = flatten_all(drawing.outlines[len(own) :], drawing.user_to_page, 0.001)
    edges = shapely.multilinestrings(lines)
    assert edges.difference(corners.boundary.buffer(0.4)).length < 1.0  # corners are rounded, by pixels of up to 2 mm
    # Where something cuts the picture there is no edge of what is dark: the lines end there, at the corners.
    low, high = np.array(edges.bounds).reshape(2, 2)
    assert np.concatenate((low, high)) == pytest.approx(corners.bounds, abs=0.4)


def test_opacity_is_less_ink() -> None:
    def length(opacity: str) -> float:
        hatch = ReadingOptions(image=ImageOptions(ImageStyle.HATCH))
        drawing = read(image(f'width="40" height="30" {opacity}'), hatch)
        lines = flatten_all(drawing.outlines, drawing.user_to_page, 0.01)
        return sum(map(polyline_length, lines))

    # Half of black over white is a grey of 0.5, which sends back 21 % of the light.
    assert length('opacity=".5"') == pytest.approx(0.786 * length(""), rel=0.05)


def test_without_a_style_pictures_are_left_out_as_ever() -> None:
    with pytest.raises(DrawingError, match="draw pictures with --image hatch"):
        read(image(), ReadingOptions())
    assert read(image() + '<path d="M1 1h5" stroke="red"/>', ReadingOptions()).skipped == {"image": 1}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    inside = tmp_path / "drawings"
    (inside / "pictures").mkdir(parents=True)
    for place in (inside / "pictures" / "a b.png", inside / "near.png", tmp_path / "outside.png"):
        place.write_bytes(BLACK)
    (inside / "not.png").write_bytes(b"\x89PNG nothing of the kind")
    (inside / "white.png").write_bytes(file_of(np.full((9, 9), 255, dtype=np.uint8)))
    (inside / "link.png").symlink_to(tmp_path / "outside.png")
    return inside


@pytest.mark.parametrize(
    ("href", "counted"),
    [
        ("near.png", None),
        ("./pictures/a%20b.png", None),
        ("pictures/../near.png", None),
        ("../outside.png", "image outside of the drawing's folder"),
        ("/etc/hostname", "image outside of the drawing's folder"),
        ("link.png", "image outside of the drawing's folder"),
        ("none.png", "image that is not there"),
        ("pictures", "image that is not there"),
        ("https://example.org/a.png", "image on a network"),
        ("//example.org/a.png", "image on a network"),
        ("not.png", DAMAGED),
        ("white.png", "image without ink"),
        ("data:image/png;base64,AAAA", DAMAGED),
    ],
)
def test_linked_pictures_come_from_the_drawings_folder_alone(folder: Path, href: str, counted: str | None) -> None:
    file = folder / "drawing.svg"
    file.write_text(f'{HEAD}<image href="{href}" width="40" height="30"/><path d="M1 90h5" stroke="red"/></svg>')
    drawing = read_drawing(file, options=TRACE)
    assert drawing.skipped == ({} if counted is None else {counted: 1})
    assert len(with_images(drawing, drawing.user_to_page).outlines) == (2 if counted is None else 1)


def test_a_drawing_in_memory_has_no_folder() -> None:
    with pytest.raises(DrawingError, match="image in a file, of a drawing that is in none"):
        read('<image href="near.png" width="40" height="30"/>')


def test_options_are_one_line_and_read_as_they_were_written() -> None:
    for options in (ImageOptions(), ImageOptions(ImageStyle.TRACE, 0.3, 1.5, 4, -12.5, 0.25)):
        assert image_options(str(options)) == options
    for text in ("", "hatch", "hatch,a,,1,0,1", "hatch,0.5,,1.5,0,1", "stars,0.5,,1,0,1", "hatch,0.5,,99,0,1"):
        with pytest.raises(UsageError):
            image_options(text)
