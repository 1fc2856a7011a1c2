"""The single-line faces: whole, with the letters that were promised, and with their licences."""

from __future__ import annotations

import re
import unicodedata
from importlib.resources import files

import numpy as np
import pytest

from planner.drawing.text.faces import FACES, STAND_IN, face_with, load_face
from planner.drawing.text.specimen import PANGRAM, coverage, written

PROMISED = [
    *map(chr, range(0x21, 0x7F)),
    *map(chr, (code for code in range(0xA1, 0x180) if code != 0xAD)),
    *"ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩαβγδεζηθικλμνξοπρστυφχψωςάέήίόύώϊϋΐΰΆΈΉΊΌΎΏ",
    *map(chr, range(0x400, 0x460)),
    *"ҐґȘșȚț",
    *"–—…‘’“”„‹›•†‡‰€←→↑↓",
]


@pytest.mark.parametrize("file", FACES.values())
def test_every_glyph_parses_and_stays_near_its_room(file: str) -> None:
    face = load_face(file)
    for character in face.lines:
        glyph = face.glyph(character)
        assert glyph.advance >= 0.0
        for subpath in glyph.subpaths:
            beziers = subpath.beziers
            assert np.isfinite(beziers).all()
            assert np.array_equal(beziers[1:, 0], beziers[:-1, 3])
            assert beziers[..., 1].max() < 2.1 * face.cap_height
            assert beziers[..., 1].min() > -1.3 * face.cap_height
    assert face.glyph("H").subpaths
    assert not face.glyph(" ").subpaths


@pytest.mark.parametrize("file", FACES.values())
def test_every_promised_character_is_there_and_shows_ink(file: str) -> None:
    face = load_face(file)
    for character in PROMISED:
        source = face_with(character, face)
        assert source is not None, f"U+{ord(character):04X}"
        assert source.glyph(character).subpaths, f"U+{ord(character):04X}"


@pytest.mark.parametrize("file", FACES.values())
def test_accents_are_drawn_over_or_under_the_letter(file: str) -> None:
    face = load_face(file)
    for letter, accented in ("aā", "cć", "zż", "eě", "uű", "aą", "SȘ"):
        plain, marked = (
            np.concatenate([one.beziers.reshape(-1, 2) for one in face.glyph(name).subpaths])
            for name in (letter, accented)
        )
        is_below = unicodedata.normalize("NFD", accented)[1] in "\u0327\u0328\u0326"
        if is_below:
            assert marked[:, 1].min() < plain[:, 1].min() - 0.05 * face.cap_height
        else:
            assert marked[:, 1].max() > plain[:, 1].max() + 0.05 * face.cap_height


def test_advances_are_those_of_the_fonts() -> None:
    advances = {file: [load_face(file).glyph(letter).advance for letter in "AMi."] for file in FACES.values()}
    assert advances == {
        "relief": [676.0, 862.0, 280.0, 301.0],
        "nixish": [728.0, 976.0, 309.0, 261.0],
        "allure": [1062.0, 1351.0, 249.0, 224.0],
        "newstroke": [780.0, 780.0, 266.0, 266.0],
    }


def test_smooth_curves_pass_through_the_points_of_the_font_and_keep_its_corners() -> None:
    face = load_face(STAND_IN)
    points = np.array(re.findall(r"(-?\d+),(-?\d+)", face.lines["O"]), dtype=float)
    (ring,) = face.glyph("O").subpaths
    on_curve = np.concatenate((ring.beziers[:, 0], ring.beziers[-1:, 3]))
    assert all(np.hypot(*(on_curve - point).T).min() < 1e-9 for point in points)
    assert np.allclose(_directions(ring.beziers, 3, 2)[:-1], _directions(ring.beziers, 1, 0)[1:])
    sharp = face.glyph("V").subpaths[0].beziers
    assert not np.allclose(_directions(sharp, 3, 2)[:-1], _directions(sharp, 1, 0)[1:])


def _directions(beziers: np.ndarray, to: int, come: int) -> np.ndarray:
    along = beziers[:, to] - beziers[:, come]
    return along / np.hypot(*along.T)[:, None]


@pytest.mark.parametrize("file", FACES.values())
def test_each_face_brings_its_licence(file: str) -> None:
    name, _, licence = load_face(file).licence.partition(", ")
    text = (files("planner.drawing.text") / "faces" / "licences" / licence).read_text(encoding="utf-8")
    assert ("CC0 1.0" if name.startswith("CC0") else "SIL OPEN FONT LICENSE Version 1.1") in text


def test_the_pangrams_need_no_face_that_is_not_there() -> None:
    for line in PANGRAM:
        assert written(line, load_face(FACES["sans"])).missing == ""


def test_coverage_counts_what_a_face_has_itself() -> None:
    assert coverage(load_face(STAND_IN))["Cyrillic"] == (96, 96)
    assert coverage(load_face(FACES["serif"]))["Greek"][0] == 0
