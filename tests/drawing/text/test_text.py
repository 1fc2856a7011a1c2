"""What texts look like: single lines, outlines, decorations, and what is said of the rest."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
import pytest

from planner.drawing.text.families import Request, fonts_for, split_families
from planner.drawing.text.text import text_box
from planner.errors import DrawingError
from tests.drawing.text.texts import Sample, ink

FONTS = Path(matplotlib.get_data_path()) / "fonts" / "ttf"


def _request(families: str, weight: float = 400.0, *, is_italic: bool = False) -> Request:
    return Request(split_families(families), weight, is_italic, "normal")


@pytest.mark.parametrize(
    ("families", "kind"),
    [
        ("", "sans"),
        ("Times New Roman, serif", "serif"),
        ("Courier", "mono"),
        ("'Brush Script MT', cursive", "script"),
        ("Helvetica", "sans"),
        ("Nobody Knows, monospace", "mono"),
        ("Noto Sans Mono", "mono"),
        ("Comic Sans MS", "script"),
        ("Georgia", "serif"),
    ],
)
def test_the_face_suits_the_family(families: str, kind: str) -> None:
    assert _request(families).kind == kind


def test_families_are_split_as_css_has_them() -> None:
    assert split_families(" 'A, b' ,\"C\"  , Two   words,") == ("A, b", "C", "Two words")


@pytest.mark.parametrize(("family", "width"), [("Helvetica", 2.278), ("Times", 2.222), ("Courier", 3.0)])
def test_the_fonts_of_every_printer_take_the_room_that_they_had(family: str, width: float) -> None:
    font = fonts_for(_request(family), needs_outlines=False)[0]
    glyphs = font.shape("Hello", 0, 5, is_rtl=False, is_vertical=False, has_ligatures=False)
    assert sum(glyph.advance for glyph in glyphs) == pytest.approx(width)


def test_single_lines_fill_the_room_and_the_height_of_the_font_that_was_asked_for() -> None:
    svg = '<text x="10" y="200" font-family="{}">HAMBURG</text>'
    for family in ("DejaVu Sans", "DejaVu Serif", "DejaVu Sans Mono"):
        single, outline = (ink(Sample(svg.format(family), mode).shapes()) for mode in ("single", "outline"))
        assert np.abs(single.min(axis=0) - outline.min(axis=0)).max() < 6.0
        assert np.abs(single.max(axis=0) - outline.max(axis=0)).max() < 6.0


def test_monospaced_text_keeps_its_columns() -> None:
    cells = [cell for cell in Sample('<text font-family="monospace">iWi.</text>').cells() if cell is not None]
    assert np.ptp([cell[2] for cell in cells]) < 1e-9


def test_single_lines_are_open_and_outlines_closed() -> None:
    (single,), (outline,) = (Sample('<text y="90">Hx</text>', mode).shapes() for mode in ("single", "outline"))
    assert single.is_single_line and not any(subpath.is_closed for subpath in single.subpaths)
    assert not outline.is_single_line and all(subpath.is_closed for subpath in outline.subpaths)


def test_spans_come_with_their_own_style() -> None:
    shapes = Sample('<text y="90">a<tspan fill="red">b</tspan>c</text>').shapes()
    assert [glyphs.style["fill"] for glyphs in shapes] == ["black", "red", "black"]


def test_italic_leans_and_upright_does_not() -> None:
    for style, lean in (("normal", 0.0), ("italic", np.tan(np.radians(12.0)))):
        stem = ink(Sample(f'<text y="90" font-style="{style}">|</text>').shapes())
        top, foot = stem[stem[:, 1].argmin()], stem[stem[:, 1].argmax()]
        assert (top[0] - foot[0]) / (foot[1] - top[1]) == pytest.approx(lean)


def test_a_base_and_a_mark_are_the_letter_with_an_accent() -> None:
    apart, whole = (ink(Sample(f'<text y="90">{text}</text>').shapes()) for text in ("e\u0301", "é"))
    assert apart == pytest.approx(whole)


def test_what_no_face_has_is_drawn_as_its_outline_and_said() -> None:
    sample = Sample('<text y="90">aש</text>')
    shapes = sample.shapes()
    assert [glyphs.is_single_line for glyphs in shapes] == [True, False]
    assert sample.skipped == {"glyph U+05E9 as a single line (its outline is drawn)": 1}


@pytest.mark.parametrize("mode", ["single", "outline"])
def test_what_nothing_has_is_named(mode: str) -> None:
    sample = Sample('<text y="90">a\U000e0101\U0001fa99b</text>', mode)  # type: ignore[arg-type]
    assert sample.shapes()
    assert sample.skipped == {"glyph U+1FA99": 1}


def test_a_dozen_missing_characters_are_named_and_the_others_counted() -> None:
    sample = Sample('<text y="90">' + "".join(chr(0x13000 + code) for code in range(20)) * 2 + "</text>")
    assert sample.shapes() == []
    assert sample.skipped["glyph U+13000"] == 2
    assert sample.skipped["other glyphs"] == 16
    assert len(sample.skipped) == 13


def test_arabic_is_joined_and_runs_from_right_to_left() -> None:
    text = Sample('<text x="10" y="90">سلام</text>', "outline").laid_out()
    starts = [one.u for one in text.characters if not one.is_middle]
    assert starts == sorted(starts, reverse=True)
    alone = Sample('<text x="10" y="90">س ل ا م</text>', "outline").laid_out()
    assert text.characters[0].glyphs[0].glyph != alone.characters[0].glyphs[0].glyph


def test_skipped_texts_are_counted_where_they_would_show() -> None:
    for svg, count in (("<text>a</text>", 1), ("<text> </text>", 0), ('<text visibility="hidden">a</text>', 0)):
        sample = Sample(svg, "skip")
        assert sample.shapes() == []
        assert sample.skipped["text"] == count


def test_a_font_of_a_file_is_used() -> None:
    serif, sans = (
        ink(Sample('<text y="90">I</text>', "outline", FONTS / name).shapes())
        for name in ("DejaVuSerif.ttf", "DejaVuSans.ttf")
    )
    assert len(serif) > len(sans)


@pytest.mark.parametrize("content", [None, b"", b"no font at all", b"\0\1\0\0" + bytes(100), b"OTTO" + bytes(9)])
def test_a_file_that_is_no_font_is_refused_in_a_sentence(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "odd.ttf"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(DrawingError, match=r"odd\.ttf"):
        Sample("<text>a</text>", "outline", path).shapes()


def test_decorations_run_below_over_and_through_and_belong_to_who_asked() -> None:
    sample = Sample(
        '<g text-decoration="underline" fill="red"><text y="200" fill="blue">a<tspan text-decoration="line-through'
        ' overline" fill="lime">b</tspan></text></g>'
    )
    shapes = sample.shapes()
    lines = [
        glyphs for glyphs in shapes if len(glyphs.subpaths) == 1 and np.ptp(glyphs.subpaths[0].beziers[..., 1]) == 0
    ]
    assert [glyphs.style["fill"] for glyphs in lines] == ["red", "lime", "lime"]
    heights = [float(glyphs.subpaths[0].beziers[0, 0, 1]) for glyphs in lines]
    assert heights[0] > 200.0 > heights[2] > heights[1]
    width = sum(cell[2] for cell in sample.cells() if cell is not None)
    assert np.ptp(lines[0].subpaths[0].beziers[..., 0]) == pytest.approx(width)
    assert shapes.index(lines[2]) == len(shapes) - 1


def test_a_decoration_is_as_thick_as_a_tenth_of_the_letters_that_it_runs_along() -> None:
    svg = '<text y="200" text-decoration="underline">a<tspan font-size="50">b</tspan></text>'
    boxes = Sample(svg, "outline").shapes()[0].subpaths
    assert [float(np.ptp(box.beziers[..., 1])) for box in boxes] == pytest.approx([10.0, 5.0])


def test_the_box_of_a_text_holds_its_cells() -> None:
    sample = Sample('<text x="10" y="200" font-family="DejaVu Sans">AB</text>')
    assert text_box(sample.element, sample.style, sample.context) == pytest.approx(
        (10.0, 107.2, 137.03, 116.4), abs=0.05
    )
    empty = Sample("<text> </text>")
    assert text_box(empty.element, empty.style, empty.context) is None


def test_a_text_of_too_many_characters_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("planner.drawing.text.characters.CHARACTER_LIMIT", 100)
    Sample(f"<text>{'ab' * 50}</text>").laid_out()
    with pytest.raises(DrawingError, match="line 1: a text of more than 100 characters"):
        Sample(f"<text>{'ab' * 51}</text>").laid_out()
