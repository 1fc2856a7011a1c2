"""Reading SVG: every feature that draws, and what each kind of unusable file is told."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing
from planner.drawing.flatten import extent
from planner.drawing.options import ReadingOptions
from planner.drawing.source import SIZE_LIMIT_BYTES
from planner.drawing.svg import read_drawing
from planner.errors import DrawingError

WHOLE = ReadingOptions(text="skip", crop="none")
IDENTITY = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
ROOT = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100">'


def drawing(folder: Path, body: str, root: str = ROOT) -> Drawing:
    path = folder / "drawing.svg"
    path.write_text(f"{root}{body}</svg>", encoding="utf-8")
    return read_drawing(path, options=WHOLE)


def refusal(folder: Path, data: bytes) -> str:
    path = folder / "bad.svg"
    path.write_bytes(data)
    with pytest.raises(DrawingError) as caught:
        read_drawing(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith("bad.svg: ")
    assert caught.value.exit_code == 2
    return message


def corners(found: Drawing) -> list[list[tuple[float, float]]]:
    """The ends of all curves of each outline."""
    result = []
    for outline in found.outlines:
        points = np.concatenate([outline.beziers[:1, 0], outline.beziers[:, 3]])
        result.append([(float(x), float(y)) for x, y in np.round(points, 6)])
    return result


def along(found: Drawing) -> FloatArray:
    """Many points on all curves."""
    control = np.concatenate([outline.beziers for outline in found.outlines])[:, np.newaxis]
    t = np.linspace(0.0, 1.0, 33)[:, np.newaxis]
    points: FloatArray = (
        (1 - t) ** 3 * control[:, :, 0]
        + 3 * (1 - t) ** 2 * t * control[:, :, 1]
        + 3 * (1 - t) * t**2 * control[:, :, 2]
        + t**3 * control[:, :, 3]
    )
    return points.reshape(-1, 2)


LINE = '<path stroke="red" d="M1 2L3 4" {}/>'


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<path stroke="red" d="M1 2L3 4"/>', [[(1, 2), (3, 4)]]),
        ('<path fill="none" stroke="red" d="m1 2 3 4h1v1H0V0"/>', [[(1, 2), (4, 6), (5, 6), (5, 7), (0, 7), (0, 0)]]),
        ('<path fill="none" stroke="red" d="M.5.5 1e1-3"/>', [[(0.5, 0.5), (10, -3)]]),
        ('<path fill="none" stroke="red" d="M 0. 0. L 5. 6."/>', [[(0, 0), (5, 6)]]),
        (
            '<path fill="none" stroke="red" d="M1 1L2 1 2 2zm3 0l1 0"/>',
            [[(1, 1), (2, 1), (2, 2), (1, 1)], [(4, 1), (5, 1)]],
        ),
        ('<path fill="none" stroke="red" d="M1 1L2 1 2 2 1 1z"/>', [[(1, 1), (2, 1), (2, 2), (1, 1)]]),
        ('<path fill="none" stroke="red" d="M1 1L2 2 M9 9"/>', [[(1, 1), (2, 2)]]),
        ('<path fill="none" stroke="red" d="M1 1L2 2 3"/>', [[(1, 1), (2, 2)]]),
        ('<path fill="none" stroke="red" d="M1 1Q2 2 3 1T5 1"/>', [[(1, 1), (3, 1), (5, 1)]]),
        ('<path fill="none" stroke="red" d="M1 1C1 2 3 2 3 1S5 0 5 1"/>', [[(1, 1), (3, 1), (5, 1)]]),
        ('<line x1="1" y1="2" x2="3" y2="4" stroke="red"/>', [[(1, 2), (3, 4)]]),
        ('<polyline fill="none" stroke="red" points="1,1 2,2 3,1"/>', [[(1, 1), (2, 2), (3, 1)]]),
        ('<polygon points="1,1 2,2 3,1"/>', [[(1, 1), (2, 2), (3, 1), (1, 1)]]),
        ('<rect x="1" y="2" width="3" height="4"/>', [[(1, 2), (4, 2), (4, 6), (1, 6), (1, 2)]]),
        (
            '<rect x="10%" y="20%" width="10%" height="10mm" rx="0"/>',
            [[(10, 20), (20, 20), (20, 57.795276), (10, 57.795276), (10, 20)]],
        ),
        ('<rect x="1rem" width="25.4Q" height="1"/>', [[(16, 0), (40, 0), (40, 1), (16, 1), (16, 0)]]),
        ('<rect width="3" height="4" rx="-1"/>', [[(0, 0), (3, 0), (3, 4), (0, 4), (0, 0)]]),
        (
            '<g transform="translate(10 20) scale(2)"><path transform="rotate(90)" stroke="red" d="M1 0L2 0"/></g>',
            [[(10, 22), (10, 24)]],
        ),
        (
            '<defs><path id="p" stroke="red" d="M1 2L3 4"/></defs><use href="#p" x="10"/><use xlink:href="#p" y="1"/>',
            [[(11, 2), (13, 4)], [(1, 3), (3, 5)]],
        ),
        (
            '<symbol id="s" viewBox="0 0 1 1"><path fill="none" stroke="red" d="M0 0L1 1"/></symbol>'
            '<use href="#s" width="10" height="10"/>',
            [[(0, 0), (10, 10)]],
        ),
        (
            '<svg x="10" y="10" width="20" height="20" viewBox="0 0 2 2">'
            '<path fill="none" stroke="red" d="M0 0L2 2"/></svg>',
            [[(10, 10), (30, 30)]],
        ),
        (
            '<switch><path systemLanguage="xx" d="M8 8L9 9"/><path stroke="red" d="M1 2L3 4"/></switch>',
            [[(1, 2), (3, 4)]],
        ),
        (
            '<style>.a{display:none} g > .b{visibility:hidden}</style><path class="a" d="M8 8L9 9"/>'
            '<g><path class="b" d="M8 8L9 9"/></g><path stroke="red" d="M1 2L3 4"/>',
            [[(1, 2), (3, 4)]],
        ),
        (
            '<g visibility="hidden"><path stroke="red" d="M8 8L9 9"/>'
            '<path visibility="visible" stroke="red" d="M1 2L3 4"/></g>',
            [[(1, 2), (3, 4)]],
        ),
        ('<g opacity="0"><path stroke="red" d="M8 8L9 9"/></g>' + LINE.format(""), [[(1, 2), (3, 4)]]),
        ('<path fill="none" d="M8 8L9 9"/>' + LINE.format(""), [[(1, 2), (3, 4)]]),
        ('<path fill="none" stroke="red" stroke-width="0" d="M8 8L9 9"/>' + LINE.format(""), [[(1, 2), (3, 4)]]),
        ('<path fill-opacity="0" d="M8 8L9 9"/>' + LINE.format(""), [[(1, 2), (3, 4)]]),
        (
            '<marker id="m"><path stroke="red" d="M0 0L1 0"/></marker>'
            '<path marker-end="url(#m)" stroke="red" d="M1 2L3 4"/>',
            [[(1, 2), (3, 4)], [(3, 4), (4, 4)]],
        ),
        (
            '<circle r="-1"/><ellipse rx="-1" ry="-1"/><rect width="-1" height="2"/>' + LINE.format(""),
            [[(1, 2), (3, 4)]],
        ),
        ('<path fill="none" stroke="red" d=""/><path/><circle/>' + LINE.format(""), [[(1, 2), (3, 4)]]),
    ],
)
def test_what_is_visible_becomes_outlines(tmp_path: Path, body: str, expected: list[list[tuple[float, float]]]) -> None:
    found = drawing(tmp_path, body)
    assert corners(found) == expected
    assert not found.skipped


@pytest.mark.parametrize("data", ["M5 6h0", "M5 6z", "M5 6L5 6 5 6", "M5 6h0z"])
def test_a_subpath_of_no_length_is_a_tap(tmp_path: Path, data: str) -> None:
    (outline,) = drawing(tmp_path, f'<path d="{data}" stroke="red" stroke-linecap="round"/>').outlines
    assert outline.beziers.tolist() == [[[5.0, 6.0]] * 4]


def test_curves_of_an_outline_follow_each_other(tmp_path: Path) -> None:
    found = drawing(
        tmp_path,
        '<rect x="3" y="4" width="20" height="10" rx="3"/>'
        '<path fill="none" stroke="red" d="M1 1Q5 5 9 1A3 4 5 0 1 20 30z"/>',
    )
    for outline in found.outlines:
        assert np.array_equal(outline.beziers[1:, 0], outline.beziers[:-1, 3])
        assert np.array_equal(outline.beziers[0, 0], outline.beziers[-1, 3])


@pytest.mark.parametrize("transform", ["", "skewX(40)", "rotate(30) scale(3 .5)", "matrix(1 2 -.7 .4 5 6)"])
@pytest.mark.parametrize(
    ("body", "radii"),
    [
        ('<circle cx="3" cy="4" r="7"/>', (7.0, 7.0)),
        ('<ellipse cx="3" cy="4" rx="7px" ry="2"/>', (7.0, 2.0)),
        ('<path fill="none" stroke="red" d="M10 4A7 2 0 1 1-4 4 7 2 0 0110 4z"/>', (7.0, 2.0)),
        ('<path fill="none" stroke="red" d="m10 4a7 2 0 00-14 0a.7.2 0 0014 0"/>', (7.0, 2.0)),
    ],
)
def test_arcs_stay_ellipses_under_any_transform(
    tmp_path: Path, body: str, radii: tuple[float, float], transform: str
) -> None:
    body = f'<path fill="none" d="M0 0L1 0M0 0L0 1" stroke="red"/>{body}'
    found = drawing(tmp_path, f'<g transform="{transform}">{body}</g>' if transform else body)
    axis_x, axis_y, *curves = found.outlines
    origin = axis_x.beziers[0, 0]
    frame = np.stack([axis_x.beziers[0, 3] - origin, axis_y.beziers[0, 3] - origin], axis=1)
    points = along(Drawing("", tuple(curves), IDENTITY, (1, 1)))
    local = np.linalg.solve(frame, (points - origin).T).T
    assert np.allclose(np.hypot(*((local - (3.0, 4.0)) / radii).T), 1.0, rtol=0, atol=1e-5 / 4)


def test_rotated_arc_has_the_radii_and_sweep_of_the_specification(tmp_path: Path) -> None:
    # From (0, 0) to (10, 0) the radii are too small: the chord becomes a diameter, above it where sweep is 1.
    found = drawing(
        tmp_path,
        '<path fill="none" stroke="red" d="M0 0A1 1 30 0 1 10 0"/>'
        '<path fill="none" stroke="red" d="M0 0A1 1 0 0 0 10 0"/>',
    )
    over, under = (along(Drawing("", (outline,), IDENTITY, (1, 1))) for outline in found.outlines)
    for points in (over, under):
        assert np.allclose(np.hypot(points[:, 0] - 5.0, points[:, 1]), 5.0, atol=5e-6)
    assert over[:, 1].min() == pytest.approx(-5.0, abs=1e-5)
    assert under[:, 1].max() == pytest.approx(5.0, abs=1e-5)


def test_zero_radius_arc_is_a_line_and_reflection_stops_at_an_arc(tmp_path: Path) -> None:
    assert corners(drawing(tmp_path, '<path fill="none" stroke="red" d="M1 1A0 5 0 0 1 9 9"/>')) == [[(1, 1), (9, 9)]]
    found = drawing(tmp_path, '<path fill="none" stroke="red" d="M0 0A5 5 0 0 1 10 0S20 0 20 10"/>')
    assert np.allclose(found.outlines[0].beziers[-1], [[10, 0], [10, 0], [20, 0], [20, 10]])


def test_rounded_rectangle_clamps_its_radii(tmp_path: Path) -> None:
    found = drawing(tmp_path, '<rect x="10" y="20" width="40" height="20" rx="99"/>')
    low, high = extent(found.outlines, IDENTITY)
    assert low.tolist() == pytest.approx([10, 20])
    assert high.tolist() == pytest.approx([50, 40])
    points = along(found)
    assert np.allclose(np.hypot((points[:, 0] - 30) / 20, (points[:, 1] - 30) / 10), 1.0, atol=1e-6)


def test_style_sheets_that_tell_shapes_apart_still_do(tmp_path: Path) -> None:
    found = drawing(tmp_path, '<style>circle{display:none}</style><circle r="5"/><path stroke="red" d="M1 2L3 4"/>')
    assert corners(found) == [[(1, 2), (3, 4)]]
    found = drawing(
        tmp_path, '<style>path{display:none}</style><circle cx="9" r="5"/><path stroke="red" d="M1 2L3 4"/>'
    )
    low, high = extent(found.outlines, IDENTITY)
    assert (high - low).tolist() == pytest.approx([10, 10])


SVG = '<svg xmlns="http://www.w3.org/2000/svg" {}>'


@pytest.mark.parametrize(
    ("attributes", "page_px", "user_to_px"),
    [
        ('width="96" height="192"', (96, 192), [[1, 0, 0], [0, 1, 0]]),
        ('width="1in" height="50.8mm"', (96, 192), [[1, 0, 0], [0, 1, 0]]),
        ('width="72pt" height="12pc"', (96, 192), [[1, 0, 0], [0, 1, 0]]),
        ('viewBox="10 20 30 40"', (30, 40), [[1, 0, -10], [0, 1, -20]]),
        ('width="60" viewBox="10 20 30 40"', (60, 80), [[2, 0, -20], [0, 2, -40]]),
        ('height="80" viewBox="10 20 30 40"', (60, 80), [[2, 0, -20], [0, 2, -40]]),
        ('width="60" height="40" viewBox="0 0 30 40"', (60, 40), [[1, 0, 15], [0, 1, 0]]),
        (
            'width="60" height="40" viewBox="0 0 30 40" preserveAspectRatio="xMaxYMin"',
            (60, 40),
            [[1, 0, 30], [0, 1, 0]],
        ),
        ('width="60" height="40" viewBox="0 0 30 40" preserveAspectRatio="none"', (60, 40), [[2, 0, 0], [0, 1, 0]]),
        (
            'width="60" height="40" viewBox="0 0 30 40" preserveAspectRatio="xMidYMax slice"',
            (60, 40),
            [[2, 0, 0], [0, 2, -40]],
        ),
        ('width="2em" height="32" viewBox="0 0 1 1"', (32, 32), [[32, 0, 0], [0, 32, 0]]),
        ("", (30, 40), [[1, 0, 0], [0, 1, 0]]),
    ],
)
def test_page(tmp_path: Path, attributes: str, page_px: tuple[float, float], user_to_px: list[list[float]]) -> None:
    found = drawing(tmp_path, '<path fill="none" stroke="red" d="M0 0L30 40"/>', SVG.format(attributes))
    assert np.allclose(np.array(found.page_mm) / 25.4 * 96, page_px, rtol=1e-12)
    assert np.allclose(found.user_to_page / 25.4 * 96, user_to_px, rtol=1e-12, atol=1e-10)
    assert corners(found) == [[(0, 0), (30, 40)]]


@pytest.mark.parametrize(
    ("body", "skipped"),
    [
        ("<text>a</text><text> </text>", {"text": 1}),
        ('<g display="none"><text>a</text></g><defs><text>a</text></defs>', {}),
        ('<defs><text id="t">a</text></defs><use href="#t"/><use href="#t"/>', {"text": 2}),
        (
            '<image href="file:///etc/passwd" width="9" height="9"/><image xlink:href="http://x.invalid/"/>',
            {"image": 2},
        ),
        ("<foreignObject width='9' height='9'><p>a</p></foreignObject>", {"foreignObject": 1}),
        ('<path d="M1 1L9 9" stroke="red" filter="blur(2px)"/>', {"filter": 1}),
        (
            '<clipPath id="c"><rect width="5" height="5"/></clipPath>'
            '<path clip-path="url(#c)" stroke="red" d="M1 1L4 4"/>',
            {},
        ),
        (
            '<g transform="rotate(9)"><svg width="5" height="5"><path stroke="red" d="M1 1L4 4"/></svg></g>',
            {},
        ),
        (
            '<mask id="m"><rect width="5" height="5" fill="#888"/></mask>'
            '<path mask="url(#m)" stroke="red" d="M1 1L9 9"/>',
            {"mask with greys": 1},
        ),
        ('<path fill="none" stroke="red" d="M1 1L1e300 5"/>', {"path with unusable numbers": 1}),
        ('<polygon points="1,1 1e300,5 3,3"/>', {"path with unusable numbers": 1}),
        ('<path fill="none" stroke="red" d="M1 1L2 2L NaN 5"/>', {"path with unreadable data": 1}),
    ],
)
def test_what_cannot_be_drawn_is_counted(tmp_path: Path, body: str, skipped: dict[str, int]) -> None:
    assert drawing(tmp_path, LINE.format("") + body).skipped == skipped


def test_nothing_outside_is_used(tmp_path: Path) -> None:
    (tmp_path / "other.svg").write_text(f'{ROOT}<path id="p" stroke="red" d="M8 8L9 9"/></svg>')
    body = (
        '<?xml-stylesheet href="other.css"?><style>@import url("other.css");</style>'
        '<use href="other.svg#p"/><image href="other.svg"/>'
    )
    assert corners(drawing(tmp_path, body + LINE.format(""))) == [[(1, 2), (3, 4)]]


def test_public_document_type_without_subset_is_ignored(tmp_path: Path) -> None:
    found = drawing(
        tmp_path,
        LINE.format(""),
        '<?xml version="1.0" encoding="ISO-8859-1"?><!DOCTYPE svg PUBLIC '
        '"-//W3C//DTD SVG 1.1//EN" "http://unreachable.invalid/svg11.dtd">' + ROOT,
    )
    assert corners(found) == [[(1, 2), (3, 4)]]


def test_zipped_and_unnamespaced_files(tmp_path: Path) -> None:
    path = tmp_path / "drawing.svgz"
    path.write_bytes(gzip.compress(b'<svg viewBox="0 0 9 9"><path stroke="red" d="M1 2L3 4"/></svg>'))
    assert corners(read_drawing(path)) == [[(1, 2), (3, 4)]]


BILLION = "".join(f'<g id="g{i}">' + f'<use href="#g{i - 1}"/>' * 10 + "</g>" for i in range(1, 12))


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "empty"),
        (b" \n", "empty"),
        (b"%PDF-1.4 nonsense", "this is a PDF, not an SVG"),
        (b"\x00\x01\x02\xff", "not well-formed XML"),
        (b'<?xml version="1.0" encoding="no-such"?><svg/>', "XML"),
        (f"{ROOT}<path stroke='red' d='M1 1".encode(), "not well-formed XML"),
        (f"{ROOT}<g>".encode(), "line 1"),
        (b"<html><body/></html>", "outermost element is <html>"),
        (b'<svg xmlns="urn:other"/>', "not an SVG"),
        (f'{ROOT}<use id="u" href="#u"/></svg>'.encode(), "1 reference to itself"),
        (f'{ROOT}<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g></svg>'.encode(), "reference to itself"),
        (f'{ROOT}<path id="g0" d="M0 0L1 1"/>{BILLION}</svg>'.encode(), "multiply"),
        ((ROOT + "<g>" * 5000 + "</g>" * 5000 + "</svg>").encode(), "deep"),
        (
            b'<svg xmlns="http://www.w3.org/2000/svg" width="0" height="5">'
            b'<path fill="none" stroke="red" d="M0 0L1 1"/></svg>',
            "width, height",
        ),
        (b"\x1f\x8b" + b"x" * 50, "gzip"),
        (gzip.compress(b"<svg/>" * 100)[:-12], "gzip"),
        (gzip.compress(b" " * (SIZE_LIMIT_BYTES + 5)), f"limit of {SIZE_LIMIT_BYTES} bytes"),
        (b" " * (SIZE_LIMIT_BYTES + 5), f"limit of {SIZE_LIMIT_BYTES} bytes"),
        (f"{ROOT}</svg>".encode(), "nothing to draw: it has no shapes"),
        (
            f'{ROOT}<path display="none" d="M0 0L1 1"/><circle r="-2"/>'
            '<image width="5" height="5" href="a.png"/>'
            "</svg>".encode(),
            "it has 2 shapes, none of them visible and of any size; skipped: 1 image",
        ),
        (f'{ROOT}<path fill="none" stroke="red" d="M0 0L1e300 1"/></svg>'.encode(), "1 path with unusable numbers"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_unusable_files_are_refused_in_one_line(tmp_path: Path, data: bytes, words: str) -> None:
    assert words in refusal(tmp_path, data)


def test_missing_files_and_folders(tmp_path: Path) -> None:
    with pytest.raises(DrawingError, match="no such file"):
        read_drawing(tmp_path / "none.svg")
    with pytest.raises(DrawingError, match="folder"):
        read_drawing(tmp_path)
