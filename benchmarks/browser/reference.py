"""The lines that a pen would draw of what Chromium paints: edges of fills and middles of strokes, where they are seen.

Chromium prints the drawing, and the paths of the print are the lines. What a print has no paths for is asked for
separately: dashes are printed once without and once with their gaps, pattern fills are written out tile by tile and
held against a screenshot of the original, and what masks, filters and opacity take away is taken from a transparent
screenshot. Boxes of glyphs come from a print of the text alone.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from math import floor
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from PIL import Image
from scipy.ndimage import maximum_filter

from planner.arrays import FloatArray

from .chromium import Chromium
from .painted import Painted, is_dot, painted, parts_of, trimmed

_SCRIPT = Path(__file__).with_name("page.js").read_text()
_ABOVE_ALL = ":not(#a#b#c#d)"
_SHAPES = f":is(path, rect, circle, ellipse, line, polyline, polygon):not(mask *){_ABOVE_ALL}"
_TEXT = f":is(text, tspan, textPath):not(mask *){_ABOVE_ALL}"
_UNFILTERED = f"*{_ABOVE_ALL} {{ filter: none !important; }}"
_PLAIN = (
    f":root{_ABOVE_ALL} {{ background: none !important; }}"
    + _UNFILTERED
    + f"*{_ABOVE_ALL} {{ mask: none !important; }}"
)
_WITHOUT_TEXT = _PLAIN + f"{_TEXT} {{ fill: none !important; stroke: none !important; }}"
_WITHOUT_SHAPES = _PLAIN + f"{_SHAPES} {{ fill: none !important; stroke: none !important; }}"
_ONLY_TEXT_HIDDEN = _UNFILTERED + f"{_TEXT} {{ fill: none !important; stroke: none !important; }}"
_SOLID = f"*{_ABOVE_ALL} {{ stroke-dasharray: none !important; }}"
_BUTT = f"*{_ABOVE_ALL} {{ stroke-linecap: butt !important; }}"
_LONGEST_SIDE_PIXELS = 1000.0
_SEEN_WITHIN_PIXELS = 2
_BLURRED_PIXELS = 6
_TOUCH = 0.08
"""Of the longer side of the page."""
_DRAWN = ("fill", "stroke")
_MUCH = 96.0
_SAME_PATTERN = 0.05
"""Share of the inked pixels that may differ where patterns are written out."""


@dataclass(eq=False, slots=True)
class Reference:
    """size_px: of the page. lines, text_boxes: in pixels of CSS from its corner. sure: those of the lines that are
    seen without doubt, without the short runs where a mask only touches. error: why there is nothing. notes: where
    the reference is less sure. has_to_be_said: what is shown that are no lines."""

    size_px: tuple[float, float]
    lines: list[FloatArray] = field(default_factory=list)
    sure: list[FloatArray] = field(default_factory=list)
    text_boxes: list[FloatArray] = field(default_factory=list)
    picture: bytes = b""
    error: str = ""
    notes: list[str] = field(default_factory=list)
    has_to_be_said: list[str] = field(default_factory=list)


def reference(browser: Chromium, drawing: bytes, size_px: tuple[float, float] = (300.0, 150.0)) -> Reference:
    """What Chromium shows of an SVG. size_px: the page of a drawing that does not say how large it is."""
    browser.show(drawing, size_px)
    try:
        facts = _ask(browser, "facts()")
    except RuntimeError as error:
        return Reference(size_px, error=str(error).splitlines()[0])
    if facts["error"]:
        return Reference(size_px, error="not well-formed, or no SVG")
    size = tuple(
        have if absolute else wanted
        for have, absolute, wanted in zip(facts["size"], facts["absolute"], size_px, strict=True)
    )
    if max(abs(a - b) for a, b in zip(size, size_px, strict=True)) > 0.01:
        browser.show(drawing, (max(size[0], 1.0), max(size[1], 1.0)))
    if not all(facts["absolute"]):
        _ask(browser, f"resize({list(size)})")
    found = Reference((float(size[0]), float(size[1])))
    scale = min(_LONGEST_SIDE_PIXELS / max(*size, 1e-3), 16.0)
    found.picture = browser.screenshot(scale)
    _ask(browser, f"sheet({_UNFILTERED!r})")
    if facts["filtered"] and _differing(found.picture, browser.screenshot(scale)) > 0.0:
        found.has_to_be_said.append("filter")
    if facts["patterns"]:
        _expand_patterns(browser, found, scale)
    seen = _alpha(browser.screenshot(scale))
    solid = _print(browser, _WITHOUT_TEXT + _SOLID, found.size_px)
    if any(thing.kind == "image" for thing in solid):
        found.has_to_be_said.append("image")
    solid = [thing for thing in solid if thing.kind in _DRAWN]
    lines, doubtful = _dashed(browser, solid, found) if facts["dashed"] else (_all(solid), [])
    if facts["text"]:
        texts = [_boxed(thing) for thing in _print(browser, _WITHOUT_SHAPES, found.size_px) if thing.kind != "image"]
        found.text_boxes = [part for thing in texts for part in thing.visible() if len(part) > 1]
    found.lines += doubtful
    uncut = _cut(browser, lines, found, scale) if facts["cut"] else lines
    for line in uncut:
        parts = _seen(line, seen, scale)
        found.sure += parts if _is_whole(parts, line) else _certain(parts, scale)
        found.lines += [line] if parts else []
    return found


def _ask(browser: Chromium, expression: str) -> Any:
    return browser.run(f"(() => {{ {_SCRIPT}\n return {expression}; }})()")


def _print(browser: Chromium, rules: str, size_px: tuple[float, float]) -> list[Painted]:
    """What is painted under these rules. Chromium stretches a drawing to whole pixels, which is undone."""
    _ask(browser, f"sheet({rules!r})")
    stretch = tuple(side / max(floor(side + 0.5), 1.0) for side in size_px)
    return [thing for thing in painted(browser.pdf(), (stretch[0], stretch[1])) if thing.alpha]


def _all(things: list[Painted]) -> list[FloatArray]:
    return [line for thing in things for line in thing.visible()]


def _dashed(browser: Chromium, solid: list[Painted], found: Reference) -> tuple[list[FloatArray], list[FloatArray]]:
    """The lines of a print with the gaps of dashes, and those that may be there too, under caps and around corners:
    where there are gaps, a stroke is printed as a fill."""
    lines: list[FloatArray] = []
    doubtful: list[FloatArray] = []
    known = {_key(thing) for thing in solid if thing.kind == "fill"}
    inks = []
    for rules in (_BUTT, ""):
        gapped = [thing for thing in _print(browser, _WITHOUT_TEXT + rules, found.size_px) if thing.kind in _DRAWN]
        fills = [thing for thing in gapped if thing.kind == "fill" and _key(thing) not in known]
        stroked = {_key(thing) for thing in gapped if thing.kind == "stroke"}
        inks.append((stroked, shapely.unary_union([thing.region() for thing in fills]).buffer(0.02)))
    (stroked, ink), (_, capped) = inks
    for thing in solid:
        parts = thing.visible()
        if thing.kind != "stroke" or _key(thing) in stroked:
            lines += parts
            continue
        dashes = [part for line in parts for part in parts_of(line, ink)]
        lines += [part for dash in dashes for part in trimmed(dash, thing.width / 2.0)]
        doubtful += dashes + [part for line in parts for part in parts_of(line, capped)]
    return lines, doubtful


def _key(thing: Painted) -> tuple[Any, ...]:
    """The same for equal things, whatever points lie on one another for the sake of caps."""
    apart = [line[np.append(True, np.any(np.diff(line, axis=0) != 0.0, axis=1))] for line in thing.lines]
    return (thing.kind, *(np.round(line, 2).tobytes() for line in apart))


def _boxed(thing: Painted) -> Painted:
    """The box of a path."""
    if thing.kind == "text" or not thing.lines:
        return thing
    points = np.concatenate(thing.lines)
    (left, top), (right, bottom) = points.min(axis=0), points.max(axis=0)
    box = np.array([[left, top], [right, top], [right, bottom], [left, bottom], [left, top]])
    return Painted("text", [box], thing.clip, thing.alpha)


def _cut(browser: Chromium, lines: list[FloatArray], found: Reference, scale: float) -> list[FloatArray]:
    """What masks, clips or opacity bear on goes to `found` where the screenshot shows something of it: runs so short
    that an edge of a mask may only touch there are not sure. The other lines are returned."""
    _ask(browser, f"sheet({_ONLY_TEXT_HIDDEN!r})")
    _ask(browser, "hideUncut()")
    seen = _alpha(browser.screenshot(scale))
    cut = {
        _line_key(line) for thing in _print(browser, _WITHOUT_TEXT + _SOLID, found.size_px) for line in thing.visible()
    }
    for line in lines:
        parts = _seen(line, seen, scale) if _line_key(line) in cut else []
        found.lines += parts
        long = [part for part in parts if np.ptp(part, axis=0).max() >= _TOUCH * max(found.size_px)]
        found.sure += parts if _is_whole(parts, line) else _certain(long, scale)
    return [line for line in lines if _line_key(line) not in cut]


def _is_whole(parts: list[FloatArray], line: FloatArray) -> bool:
    return len(parts) == 1 and parts[0] is line


def _certain(parts: list[FloatArray], scale: float) -> list[FloatArray]:
    """Parts without their ends, which a screenshot shows no better than by a few pixels."""
    return [part for line in parts for part in trimmed(line, _BLURRED_PIXELS / scale)]


def _line_key(line: FloatArray) -> bytes:
    return np.round(line, 1).tobytes()


def _expand_patterns(browser: Chromium, found: Reference, scale: float) -> None:
    before = browser.screenshot(scale)
    _, left = _ask(browser, "expandPatterns()")
    differing = _differing(before, browser.screenshot(scale))
    if left or differing > _SAME_PATTERN:
        found.notes.append(f"patterns are not sure ({left} left, {100 * differing:.1f} % of pixels differ)")


def _differing(one: bytes, other: bytes) -> float:
    """The share of the pixels where something is seen that differ much."""
    before, after = (np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"), float) for png in (one, other))
    if before.shape != after.shape:
        return 1.0
    seen = (before[:, :, 3] > _MUCH) | (after[:, :, 3] > _MUCH)
    differing = np.abs(before - after).max(axis=2) > _MUCH
    return float(differing.sum() / max(seen.sum(), 1))


def _alpha(png: bytes) -> FloatArray:
    """Whether anything is seen near each pixel."""
    pixels = np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"))[:, :, 3]
    return np.asarray(maximum_filter(pixels, 2 * _SEEN_WITHIN_PIXELS + 1) > 0)


def _seen(line: FloatArray, seen: FloatArray, scale: float) -> list[FloatArray]:
    """The parts of a line where something is seen."""
    points = line[:1] if is_dot(line) else shapely.get_coordinates(shapely.LineString(line).segmentize(0.5 / scale))
    at = np.floor(points * scale).astype(int)
    rows = np.clip(at[:, 1], 0, seen.shape[0] - 1)
    columns = np.clip(at[:, 0], 0, seen.shape[1] - 1)
    is_seen = seen[rows, columns]
    if is_seen.all():
        return [line]
    runs = np.split(points, np.flatnonzero(np.diff(is_seen)) + 1)
    firsts = np.concatenate(([0], np.flatnonzero(np.diff(is_seen)) + 1))
    return [run for run, first in zip(runs, firsts, strict=True) if is_seen[first]]
