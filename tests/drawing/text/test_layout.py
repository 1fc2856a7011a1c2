"""Laws of text layout."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.drawing.text.bidi import levels, visual_order
from planner.drawing.text.frame import frame
from tests.drawing.text.texts import Sample, ink

WORDS = st.text("AVTo fi.é Жω", min_size=1, max_size=12).filter(lambda text: text.strip() == text)


def _cells(svg: str) -> list[FloatArray]:
    return [cell for cell in Sample(svg).cells() if cell is not None]


def _left(svg: str) -> float:
    return float(min(cell[0] for cell in _cells(svg)))


def _width(svg: str) -> float:
    cells = _cells(svg)
    return float(max(cell[0] + cell[2] for cell in cells) - min(cell[0] for cell in cells))


@settings(max_examples=25, deadline=None)
@given(WORDS, st.sampled_from(["ltr", "rtl"]))
def test_anchors_shift_by_half_and_whole_of_the_width(words: str, direction: str) -> None:
    def left(anchor: str) -> float:
        return _left(f'<text x="500" y="100" direction="{direction}" text-anchor="{anchor}">{words}</text>')

    width = _width(f'<text x="500" y="100" direction="{direction}">{words}</text>')
    start, middle, end = (left(anchor) for anchor in ("start", "middle", "end"))
    sign = 1.0 if direction == "ltr" else -1.0
    assert start - middle == pytest.approx(sign * width / 2.0)
    assert start - end == pytest.approx(sign * width)
    assert middle + width / 2.0 == pytest.approx(500.0)


@settings(max_examples=25, deadline=None)
@given(WORDS.filter(lambda text: len(text) > 1), st.floats(0.8, 3.0), st.sampled_from(["spacing", "spacingAndGlyphs"]))
def test_text_length_is_kept(words: str, factor: float, adjust: str) -> None:
    length = factor * _width(f"<text>{words}</text>")
    assert _width(f'<text textLength="{length}" lengthAdjust="{adjust}">{words}</text>') == pytest.approx(length)


@settings(max_examples=15, deadline=None)
@given(WORDS, st.floats(-180.0, 180.0))
def test_rotation_turns_each_character_about_its_own_origin(words: str, angle: float) -> None:
    plain, turned = (Sample(f'<text x="9" y="90" rotate="{turn}">{words}</text>').laid_out() for turn in (0, angle))
    for mine, theirs in zip(plain.characters, turned.characters, strict=True):
        one, other = frame(mine, is_vertical=False), frame(theirs, is_vertical=False)
        assert one is not None and other is not None
        assert other[:, 2] == pytest.approx(one[:, 2])
        assert np.degrees(np.arctan2(other[1, 0], other[0, 0])) == pytest.approx(angle)


def test_glyphs_stand_with_their_middle_on_the_path_and_the_rest_is_hidden() -> None:
    path = '<path id="p" d="M100 300L400 700L900 700"/>'
    text = Sample(
        path + '<text><textPath href="#p" startOffset="10%">Along a path and beyond its end</textPath></text>'
    )
    laid = text.laid_out()
    placed = [(one, frame(one, is_vertical=False)) for one in laid.characters]
    assert placed[0][1] is not None and placed[-1][1] is None
    for character, affine in placed:
        if affine is None:
            assert character.u + character.advance / 2.0 + 100.0 > 1000.0
            continue
        x, y = affine[:, :2] @ (character.advance / 2.0, 0.0) + affine[:, 2]
        on_first, on_second = abs((x - 100.0) * 4.0 - (y - 300.0) * 3.0) < 1e-6, abs(y - 700.0) < 1e-6
        assert on_first if x < 400.0 - 1e-6 else on_second


def test_lists_count_characters_across_elements_and_inner_ones_win() -> None:
    cells = _cells('<text x="1 2 3 4" y="100">a<tspan x="30 40">b</tspan>cd</text>')
    assert [cell[0] for cell in cells] == pytest.approx([1.0, 30.0, 3.0, 4.0])


@pytest.mark.parametrize(
    ("attributes", "text", "shown"),
    [
        ("", "\n  a \t b\n ", "a b"),
        ('xml:space="preserve"', " a\n b ", " a  b "),
        ('style="white-space:pre"', " a\n b ", " a  b "),
        ('xml:space="preserve" style="white-space:nowrap"', " a  b ", "a b"),
        ('style="text-transform:uppercase"', "straße", "STRASSE"),
        ('style="text-transform:capitalize"', "two words", "Two Words"),
        ("", "a<tspan> </tspan> b", "a b"),
        ("", "a<title>no</title><foo>no</foo><tspan display='none'>no</tspan>b", "ab"),
    ],
)
def test_white_space_and_case(attributes: str, text: str, shown: str) -> None:
    laid = Sample(f"<text {attributes}>{text}</text>").laid_out()
    assert "".join(one.text for one in laid.characters) == shown


def test_hidden_spans_keep_their_room_and_leave_no_ink() -> None:
    whole = Sample("<text y='100'>abc</text>").shapes()
    hidden = Sample("<text y='100'>a<tspan visibility='hidden'>b</tspan>c</text>")
    assert len(hidden.cells()) == 3
    drawn = ink(hidden.shapes())
    assert drawn[:, 0].max() == pytest.approx(ink(whole)[:, 0].max())
    assert len(drawn) < len(ink(whole))


def test_small_capitals_are_capitals_of_less_size() -> None:
    laid = Sample('<text style="font-variant:small-caps">Ab</text>').laid_out()
    assert [(one.text, one.size) for one in laid.characters] == [("A", 100.0), ("B", pytest.approx(70.0))]


@pytest.mark.parametrize(
    ("text", "is_rtl", "seen"),
    [
        ("abc", False, "abc"),
        ("אבג", False, "גבא"),
        ("abc אבג def", False, "abc גבא def"),
        ("abc אבג def", True, "def גבא abc"),
        ("אב 12 גד", True, "דג 12 בא"),
        ("אב 1,5% גד", False, "דג 1,5% בא"),
        ("abc (אב)", True, "(בא) abc"),
        ("سلام 12 ab", True, "ab 12 مالس"),
    ],
)
def test_bidirectional_text_is_seen_in_the_order_of_its_script(text: str, is_rtl: bool, seen: str) -> None:
    order = visual_order(levels(text, [None] * len(text), is_rtl=is_rtl))
    mirrored = str.maketrans("()", ")(") if "(" in text else {}
    assert "".join(text[index] for index in order).translate(mirrored) in (seen, seen.translate(mirrored))


@settings(max_examples=60, deadline=None)
@given(st.text("a1-, אب%", max_size=20), st.booleans())
def test_the_visual_order_is_a_permutation(text: str, is_rtl: bool) -> None:
    order = visual_order(levels(text, [None] * len(text), is_rtl=is_rtl))
    assert sorted(order) == list(range(len(text)))


VALUES = st.sampled_from(["", "5", "1 2,3", "-4 1e2", "50%", "1em 2ex", "x", "1e9", "nan", "0", "NaN 3", "3px"])
NAMES = st.sampled_from(
    re.findall(
        r"\S+",
        """x y dx dy rotate textLength lengthAdjust startOffset font-size letter-spacing word-spacing baseline-shift
        dominant-baseline writing-mode text-anchor font-family font-weight direction unicode-bidi""",
    )
)
WORDINGS = st.sampled_from(["spacingAndGlyphs", "tb", "vertical-rl", "middle", "end", "super", "central", "Courier, x"])
ATTRIBUTES = st.dictionaries(NAMES, st.one_of(VALUES, WORDINGS), max_size=4)


@settings(max_examples=30, deadline=None)
@given(
    st.lists(
        st.tuples(st.sampled_from(["tspan", "textPath", "a"]), ATTRIBUTES, st.text("ab אب\n中é\u0301", max_size=6))
    )
)
@example([("textPath", {"startOffset": "nan", "font-size": "1e9"}, "a"), ("tspan", {"x": "nan"}, "b")])
def test_whatever_a_text_says_it_is_laid_out_or_refused_in_a_sentence(
    parts: list[tuple[str, dict[str, str], str]],
) -> None:
    inside = "".join(
        f'<{tag} href="#p" {" ".join(f"{name}={value!r}" for name, value in said.items())}>{words}</{tag}>'
        for tag, said, words in parts
    )
    sample = Sample(f'<path id="p" d="M0 0L90 90M0 0"/><text>{inside}</text>')
    for glyphs in sample.shapes():
        assert all(np.isfinite(subpath.beziers).all() for subpath in glyphs.subpaths)
