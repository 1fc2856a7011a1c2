"""Makes the faces in this folder from the fonts as their authors publish them.

    python make_faces.py RELIEF.svg EMS_NIXISH.svg EMS_ALLURE.svg NEWSTROKE.bene

The first three are SVG fonts, the last is in the FontoBene format; `README.md` says where they are from. Letters with
accents that a face lacks are composed of its own letter and the marks of NewStroke.
"""

from __future__ import annotations

import itertools
import re
import sys
import unicodedata
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

Stroke = tuple[str, np.ndarray]  # "L" with its points, or "C" with four for each curve: a + 3 n points in all

LATIN = [*range(0xC0, 0x123), *range(0x124, 0x180), 0x218, 0x219, 0x21A, 0x21B]
"""What may be composed; the cedilla of a small g would run into the letter."""
BELOW = {0x327, 0x328, 0x326}
"""Combining cedilla, ogonek and comma below."""


@dataclass
class Source:
    """A font on its way: glyphs have an advance and strokes, in units of the font, y up."""

    cap_height: float
    x_height: float
    glyphs: dict[int, tuple[float, list[Stroke]]] = field(default_factory=dict)


def svg_font(path: Path) -> Source:
    """Of an SVG font, the heights measured: those that EMS fonts state are all the same, and wrong."""
    root = ElementTree.parse(path).getroot()  # noqa: S314  # a file that a maintainer chose
    font = next(e for e in root.iter() if e.tag.endswith("}font"))
    source = Source(0.0, 0.0)
    for glyph in (e for e in font if e.tag.endswith("}glyph")):
        name = glyph.get("unicode", "")
        if len(name) == 1:
            advance = float(glyph.get("horiz-adv-x", font.get("horiz-adv-x", "0")))
            source.glyphs[ord(name)] = (advance, list(strokes_of(glyph.get("d", ""))))
    source.cap_height, source.x_height = (height(source, letter) for letter in "Hx")
    return source


def strokes_of(path: str) -> Iterator[Stroke]:
    """Strokes of path data made of M, L, H, V, C and S, relative or not: all that these fonts have."""
    tokens = re.findall(r"[A-Za-z]|-?[\d.]+(?:e-?\d+)?", path)
    here, start, control = np.zeros(2), np.zeros(2), np.zeros(2)
    points: list[np.ndarray] = []
    kind, command = "L", ""
    position = 0

    def numbers(count: int) -> np.ndarray:
        nonlocal position
        position += count
        return np.array([float(token) for token in tokens[position - count : position]])

    while position < len(tokens):
        if tokens[position].isalpha():
            command, position = tokens[position], position + 1
        base = here if command.islower() else np.zeros(2)
        if command in "Mm":
            if points:
                yield kind, np.array(points)
            here = start = base + numbers(2)
            points, kind, control = [here], "L", here
            command = "l" if command == "m" else "L"
            continue
        if command in "Zz":
            new = [start]
        elif command in "Ll":
            new = [base + numbers(2)]
        elif command in "Hh":
            new = [np.array([base[0] + numbers(1)[0], here[1]])]
        elif command in "Vv":
            new = [np.array([here[0], base[1] + numbers(1)[0]])]
        elif command in "Cc":
            new = list(base + numbers(6).reshape(3, 2))
        elif command in "Ss":
            new = [2 * here - control, *(base + numbers(4).reshape(2, 2))]
        else:
            raise ValueError(f"no such command is expected: {command}")
        if len(new) == 3 and kind == "L":
            points, kind = as_curves(points), "C"
        elif len(new) == 1 and kind == "C":
            new = as_curves([here, *new])[1:]
        control = new[-2] if command in "CcSs" else new[-1]
        points.extend(new)
        here = new[-1]
    if points:
        yield kind, np.array(points)


def as_curves(points: list[np.ndarray]) -> list[np.ndarray]:
    curved = points[:1]
    for a, b in itertools.pairwise(points):
        curved += [a + (b - a) / 3, b - (b - a) / 3, b]
    return curved


def fontobene(path: Path) -> Source:
    """Of a FontoBene font: half the letter spacing goes to each side of a glyph."""
    text = path.read_text(encoding="utf-8")
    found = re.search(r"letter_spacing = ([\d.]+)", text)
    spacing = float(found[1]) if found else 0.0
    source = Source(9.0, 6.0)
    for code, body in re.findall(r"^\[([0-9A-F]{4,6})\].*\n((?:(?!\[).+\n?)*)", text, re.MULTILINE):
        lines = body.split()
        space = sum(float(line[1:]) for line in lines if line.startswith("~"))
        drawn = [
            np.array([[float(number or 0) for number in point.split(",")[:2]] for point in line.split(";")])
            for line in lines
            if line[0] not in "~@"
        ]
        width = max((float(points[:, 0].max()) for points in drawn), default=0.0)
        strokes = [("L", points + np.array([spacing / 2, 0.0])) for points in drawn]
        source.glyphs[int(code, 16)] = (space or width + spacing, strokes)
    return source


def height(source: Source, letter: str) -> float:
    return max(float(points[:, 1].max()) for _, points in source.glyphs[ord(letter)][1])


def marks(source: Source) -> dict[int, list[Stroke]]:
    """The strokes of each combining mark: what an accented letter has and its base has not."""
    found: dict[int, list[Stroke]] = {}
    for code in LATIN:
        base, mark = decomposed(code)
        if code not in source.glyphs or base not in source.glyphs or mark in found:
            continue
        own = [points.tolist() for _, points in source.glyphs[base][1]]
        rest = [stroke for stroke in source.glyphs[code][1] if stroke[1].tolist() not in own]
        if len(rest) < len(source.glyphs[code][1]):
            found[mark] = rest
    return found


def decomposed(code: int) -> tuple[int, int]:
    """Base letter and mark; an i or j without its dot under a mark; (0, 0) where there is no such thing."""
    parts = unicodedata.decomposition(chr(code)).split()
    if len(parts) != 2 or parts[0].startswith("<"):
        return 0, 0
    base, mark = (int(part, 16) for part in parts)
    if mark not in BELOW and base == ord("i"):
        base = 0x131
    return base, mark


def compose(source: Source, donor: Source) -> None:
    """Adds the accented letters of Latin-1 and Latin Extended-A, and those of Romanian, that the source lacks."""
    found = marks(donor)
    scale = source.cap_height / donor.cap_height
    for code in LATIN:
        base, mark = decomposed(code)
        if code in source.glyphs or base not in source.glyphs or mark not in found:
            continue
        advance, strokes = source.glyphs[base]
        letter = np.concatenate([points for _, points in strokes])
        sign = np.concatenate([points for _, points in found[mark]]) * scale
        gap = 0.09 * source.cap_height
        if mark == 0x30C and chr(base) in "dtlL":  # looks like an apostrophe beside it
            found_mark = [("L", np.array([[0.0, 0.0], [-0.06, -0.22]]) * source.cap_height / scale)]
            shift = np.array([letter[:, 0].max() + gap, max(letter[:, 1].max(), source.cap_height)])
        elif mark in BELOW:
            found_mark = found[mark]
            foot = letter[letter[:, 1] <= letter[:, 1].min() + 0.05 * source.cap_height]
            x = foot[:, 0].max() if mark == 0x328 else (letter[:, 0].min() + letter[:, 0].max()) / 2
            shift = np.array([x - (sign[:, 0].min() + sign[:, 0].max()) / 2, 0.0])
        else:
            found_mark = found[mark]
            middle = (letter[:, 0].min() + letter[:, 0].max() - sign[:, 0].min() - sign[:, 0].max()) / 2
            shift = np.array([middle, letter[:, 1].max() + gap - sign[:, 1].min()])
        source.glyphs[code] = (advance, strokes + [(kind, points * scale + shift) for kind, points in found_mark])
    for code, base in ((0x141, ord("L")), (0x142, ord("l"))):
        if code not in source.glyphs:
            advance, strokes = source.glyphs[base]
            letter = np.concatenate([points for _, points in strokes])
            stem = letter[:, 0].min() if base == ord("L") else letter[:, 0].mean() - 0.05 * source.cap_height
            bar = np.array([[-0.14, 0.40], [0.26, 0.62]]) * source.cap_height + (stem, 0.0)
            source.glyphs[code] = (advance, [*strokes, ("L", bar)])


def drop_flaws(source: Source) -> None:
    """Drops signs that reach far out of their own room, and Greek letters: the sources have capitals in their place."""
    for code, (advance, strokes) in list(source.glyphs.items()):
        right = max((float(points[:, 0].max()) for _, points in strokes), default=0.0)
        is_sign = unicodedata.category(chr(code))[0] != "L"
        if (is_sign and right > 1.15 * advance and code > 0x7F) or 0x370 <= code < 0x400:
            del source.glyphs[code]


def straighten(source: Source) -> None:
    """Gives NewStroke the printed form of the letter de, in the place of the written one."""
    advance, strokes = source.glyphs[ord("Д")]
    small = source.x_height / source.cap_height
    source.glyphs[ord("д")] = (advance * small, [(kind, points * small) for kind, points in strokes])


def write(source: Source, path: Path, name: str, licence: str, is_smooth: bool, scale: float) -> None:
    lines = [
        f"# name: {name}",
        f"# licence: {licence}",
        f"# cap_height: {round(source.cap_height * scale)}",
        f"# x_height: {round(source.x_height * scale)}",
        f"# smooth: {'yes' if is_smooth else 'no'}",
    ]
    for code, (advance, strokes) in sorted(source.glyphs.items()):
        path_data = " ".join(
            kind + " ".join(f"{x},{y}" for x, y in np.rint(points * scale).astype(int).tolist())
            for kind, points in strokes
        )
        lines.append(f"{code:04X} {round(advance * scale)} {path_data}".rstrip())
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def main() -> None:
    folder = Path(__file__).parent
    relief, nixish, allure = (svg_font(Path(name)) for name in sys.argv[1:4])
    newstroke = fontobene(Path(sys.argv[4]))
    straighten(newstroke)
    for face in (relief, nixish, allure):
        drop_flaws(face)
        compose(face, newstroke)
    write(relief, folder / "relief.txt", "Relief SingleLine", "SIL OFL 1.1, relief.txt", False, 1.0)
    write(nixish, folder / "nixish.txt", "EMS Nixish", "SIL OFL 1.1, ems.txt", True, 1.0)
    write(allure, folder / "allure.txt", "EMS Allure", "SIL OFL 1.1, ems.txt", True, 1.0)
    write(newstroke, folder / "newstroke.txt", "NewStroke", "CC0 1.0, newstroke.txt", True, 100.0)


if __name__ == "__main__":
    main()
