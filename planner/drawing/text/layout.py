"""Where the characters of a text stand: SVG 2, section 11.5, in the reading of Chromium.

The steps of that algorithm, one function each, change `u`, `v`, `advance`, `stretch` and `rise` of characters. The line
runs along u; v is across it, and grows downwards, or to the left where text is vertical.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.drawing.options import ReadingOptions
from planner.drawing.text.characters import Character, Span, Text
from planner.drawing.text.fonts import Metrics
from planner.drawing.text.row import Row
from planner.drawing.text.shaping import shape


@dataclass(frozen=True, slots=True)
class Chunk:
    """Characters first to stop, not with it: what `text-anchor` moves as one."""

    first: int
    stop: int


def lay_out(text: Text, options: ReadingOptions) -> None:
    """All but placing characters on a path, which is done as they are drawn: there u is counted from its beginning."""
    if not text.characters:
        return
    order = shape(text, options)
    known: dict[tuple[int, int], float] = {}
    for character in text.characters:
        key = id(character.span), id(character.font)
        if key not in known:
            known[key] = _rise(character, is_vertical=text.is_vertical)
        character.rise = known[key]
    _move_by_offsets(text)
    _adjust_lengths(text, order)
    chunks = _chunks(text)
    _move_to_positions(text, chunks)
    for chunk in chunks:
        _anchor(text, chunk)
    _continue_after_paths(text, chunks)


def _rise(character: Character, *, is_vertical: bool) -> float:
    """Of the alphabetic baseline above the line, by the baselines and shifts that its spans ask for."""
    metrics = character.metrics
    size = character.span.style.font_size
    baseline = "central" if is_vertical else "alphabetic"
    shift = 0.0
    spans = []
    span: Span | None = character.span
    while span is not None:
        spans.append(span)
        span = span.parent
    for span in reversed(spans):
        dominant = span.style["dominant-baseline"]
        if dominant != "auto":
            baseline = dominant
        aligned = span.style["alignment-baseline"]
        if aligned not in ("auto", "baseline"):
            baseline = aligned
        shift += _baseline_shift(span, metrics)
    return shift - _height(baseline, metrics) * size


def _height(baseline: str, metrics: Metrics) -> float:
    """Of a baseline above the alphabetic one, in em."""
    if baseline == "central":
        return (metrics.ascent - metrics.descent) / 2.0
    if baseline == "middle":
        return metrics.x_height / 2.0
    if baseline == "hanging":
        return metrics.ascent * 0.8
    if baseline == "mathematical":
        return metrics.ascent * 0.5
    if baseline in ("text-before-edge", "before-edge"):
        return metrics.ascent
    if baseline in ("text-after-edge", "after-edge", "ideographic"):
        return -metrics.descent
    return 0.0


def _baseline_shift(span: Span, metrics: Metrics) -> float:
    said = span.style["baseline-shift"]
    size = span.style.font_size
    if said in ("sub", "super"):
        return (metrics.ascent + metrics.descent) / 2.0 * size * (1.0 if said == "super" else -1.0)
    if said.endswith("%"):
        return float(said[:-1]) / 100.0 * size
    return span.style.in_units(said, "y") or 0.0


def _move_by_offsets(text: Text) -> None:
    """By `dx` and `dy`, which move all that follows as well."""
    u = v = 0.0
    for character in text.characters:
        if not character.is_middle:
            along, across = _in_line(text, character.dx, character.dy)
            u, v = u + along, v + across
        character.u += u
        character.v += v


def _in_line(text: Text, x: float, y: float) -> tuple[float, float]:
    return (y, -x) if text.is_vertical else (x, y)


def _adjust_lengths(text: Text, order: list[int]) -> None:
    """By `textLength`, inner elements first."""
    characters = text.characters
    asked = [(span, length) for span in text.spans if (length := _text_length(span)) is not None]
    if not asked:
        return
    row = Row(
        np.array([one.u for one in characters]),
        np.array([one.advance for one in characters]),
        np.array([not one.is_middle for one in characters]),
        np.array(order),
    )
    resolved: list[Span] = []  # of which none is in another
    for span, length in reversed(asked):
        inner = []
        while resolved and resolved[-1].stop <= span.stop:
            inner.append(resolved.pop())
        resolved.append(span)
        own = slice(span.first, span.stop)
        if span.element.attributes.get("lengthAdjust") == "spacingAndGlyphs":
            factor = row.stretch(own, length)
            for one in characters[own]:
                one.stretch *= factor
        else:
            row.space_out(own, [slice(one.first, one.stop) for one in inner], length)
    for one, u, advance in zip(characters, row.u.tolist(), row.advance.tolist(), strict=True):
        one.u, one.advance = u, advance


def _text_length(span: Span) -> float | None:
    if span.stop <= span.first or span.element.tag == "a":
        return None
    length = span.style.in_units(span.element.attributes.get("textLength", ""), "x")
    return length if length is not None and length > 0.0 else None


def _chunks(text: Text) -> list[Chunk]:
    """A chunk begins at an absolute position, and where a path begins or ends."""
    starts = [
        index
        for index, character in enumerate(text.characters)
        if index == 0
        or (not character.is_middle and (character.x is not None or character.y is not None))
        or character.span.path is not text.characters[index - 1].span.path
    ]
    return [Chunk(first, stop) for first, stop in zip(starts, [*starts[1:], len(text.characters)], strict=True)]


def _move_to_positions(text: Text, chunks: list[Chunk]) -> None:
    """To `x` and `y`. On a path u is counted from its beginning."""
    u = v = 0.0
    path = None
    for chunk in chunks:
        first = text.characters[chunk.first]
        x, y = first.x, first.y
        if first.span.path is not path:
            path = first.span.path
            u = v = 0.0
            if path is not None and not path.is_missing:
                x, y = (x, 0.0 if y is None else y) if text.is_vertical else (0.0 if x is None else x, y)
                v = _in_line(text, first.dx, first.dy)[1] - first.v
        dx, dy = first.dx, first.dy
        along, across = (y, x) if text.is_vertical else (x, y)
        if along is not None:
            u = along + (dy if text.is_vertical else dx) - first.u
        if across is not None:
            v = -(across + dx) - first.v if text.is_vertical else across + dy - first.v
        for character in text.characters[chunk.first : chunk.stop]:
            character.u += u
            character.v += v


def _anchor(text: Text, chunk: Chunk) -> None:
    """Moves a chunk so that its beginning, middle or end stands where its first character was put."""
    characters = text.characters[chunk.first : chunk.stop]
    span = characters[0].span
    left = min(min(one.u, one.u + one.advance) for one in characters)
    right = max(max(one.u, one.u + one.advance) for one in characters)
    anchor = span.style["text-anchor"]
    if anchor == "middle":
        shift = characters[0].u - (left + right) / 2.0
    elif (anchor == "end") != span.is_rtl:
        shift = characters[0].u - right
    else:
        shift = characters[0].u - left
    for character in characters:
        character.u += shift


def _continue_after_paths(text: Text, chunks: list[Chunk]) -> None:
    """Text that follows a path goes on where the path ends, until it is put elsewhere."""
    end: tuple[float, float] | None = None
    shift = (0.0, 0.0)
    path = None
    for chunk in chunks:
        first = text.characters[chunk.first]
        if first.span.path is not None:
            path = first.span.path
            continue
        if path is not None:
            end, path = (None if path.is_missing else path.end), None
            if end is not None:
                along, across = _in_line(text, *end)
                shift = (along - first.u, across - first.v)
        if first.x is not None or first.y is not None or end is None:
            end = None
            continue
        for character in text.characters[chunk.first : chunk.stop]:
            character.u += shift[0]
            character.v += shift[1]
