"""The characters of a text element: white space collapsed, case applied, and what each was told about its place.

SVG 2, section 11.5, calls these the addressable characters: the lists of `x`, `y`, `dx`, `dy` and `rotate` count them.
"""

from __future__ import annotations

import math
import re
import unicodedata
from dataclasses import dataclass, field
from functools import cached_property

from planner.drawing.style.style import Style
from planner.drawing.style.units import Axis
from planner.drawing.text.context import TextContext
from planner.drawing.text.families import Request, split_families
from planner.drawing.text.fonts import USUAL, Font, Metrics, ShapedGlyph
from planner.drawing.text.on_path import TextPath, text_path
from planner.drawing.xml_tree import Element
from planner.errors import DrawingError

CHARACTER_LIMIT = 250_000
_PRESERVING = ("pre", "pre-wrap", "break-spaces")
_WEIGHTS = {"normal": 400.0, "bold": 700.0, "bolder": 700.0, "lighter": 300.0}
SMALL_CAPS = 0.7
"""Size of capitals that stand for small letters."""

_LISTS: dict[str, Axis] = {"x": "x", "y": "y", "dx": "x", "dy": "y"}


@dataclass(eq=False)
class Span:
    """An element of text with its computed style: characters first to stop, not with it, are in it or further in."""

    element: Element
    style: Style
    parent: Span | None
    request: Request
    path: TextPath | None
    first: int
    stop: int = 0

    @cached_property
    def letter_spacing(self) -> float:
        return self.style.length("letter-spacing", "x") or 0.0

    @cached_property
    def word_spacing(self) -> float:
        return self.style.length("word-spacing", "x") or 0.0

    @property
    def is_rtl(self) -> bool:
        return self.style["direction"] == "rtl"

    @property
    def is_small_caps(self) -> bool:
        return "small-caps" in (self.style["font-variant"], self.style["font-variant-caps"])


@dataclass(eq=False, slots=True)
class Character:
    """text: one code point. size: of its font. x, y: an absolute position that begins a chunk; None where it has none.
    is_middle: drawn by the character before it, as the second one of a ligature or a combining mark.

    Layout fills in the rest. u, v: where it begins along and across its line, v down; advance: the room that it takes
    along the line. stretch: what `lengthAdjust` makes of glyphs. rise: how far its alphabetic baseline stands above v.
    """

    text: str
    span: Span
    size: float
    x: float | None = None
    y: float | None = None
    dx: float = 0.0
    dy: float = 0.0
    rotate: float = 0.0
    is_middle: bool = False
    is_upright: bool = False
    font: Font | None = None
    glyphs: list[ShapedGlyph] = field(default_factory=list)
    u: float = 0.0
    v: float = 0.0
    advance: float = 0.0
    stretch: float = 1.0
    rise: float = 0.0

    @property
    def metrics(self) -> Metrics:
        """Of its font, or usual ones where none has it."""
        return USUAL if self.font is None else self.font.metrics


@dataclass(eq=False, slots=True)
class Text:
    """spans: in the order in which they begin, the text element first."""

    characters: list[Character]
    spans: list[Span]
    is_vertical: bool

    @property
    def root(self) -> Span:
        return self.spans[0]


def read_text(element: Element, style: Style, context: TextContext) -> Text:
    """Errors: DrawingError where a text has too many characters."""
    mode = style["writing-mode"]
    text = Text([], [], mode.startswith(("vertical", "tb", "sideways")))
    _Reader(text, context).read(element, style, None, None)
    _drop_trailing_space(text)
    _place(text, context)
    return text


class _Reader:
    """Walks through the elements. is_after_space: whether a space that collapses would vanish."""

    def __init__(self, text: Text, context: TextContext) -> None:
        self._text, self._context = text, context
        self._is_after_space = True

    def read(self, element: Element, style: Style, parent: Span | None, path: TextPath | None) -> None:
        span = Span(element, style, parent, _request(style), path, len(self._text.characters))
        self._text.spans.append(span)
        for item in element.content:
            if isinstance(item, str):
                self._add(item, span)
                continue
            if item.tag not in ("tspan", "a", "textPath") or (item.tag == "textPath" and path is not None):
                continue
            inner = self._context.styles.of(item, style, self._context.viewport)
            if inner["display"] == "none":
                continue
            found = text_path(item, inner, self._context) if item.tag == "textPath" else path
            self.read(item, inner, span, found)
        span.stop = len(self._text.characters)

    def _add(self, text: str, span: Span) -> None:
        characters = self._text.characters
        is_preserving = _is_preserving(span)
        size = span.style.font_size
        transform, is_small = span.style["text-transform"], span.is_small_caps
        for written in re.sub(r"[\t\r\n]", " ", text):
            if written == " " and not is_preserving:
                if self._is_after_space:
                    continue
                self._is_after_space = True
            else:
                self._is_after_space = False
            is_initial = not characters or not characters[-1].text.isalnum()
            for character in _in_case(written, transform, is_initial=is_initial):
                if is_small and character != (capital := character.upper()):
                    characters += [Character(one, span, size * SMALL_CAPS) for one in capital]
                else:
                    characters.append(Character(character, span, size))
        if len(characters) > CHARACTER_LIMIT:
            line = self._text.root.element.line
            raise DrawingError(
                self._context.document.source, f"line {line}: a text of more than {CHARACTER_LIMIT} characters"
            )


def _in_case(character: str, transform: str, *, is_initial: bool) -> str:
    if transform == "uppercase":
        return character.upper()
    if transform == "lowercase":
        return character.lower()
    return character.upper() if transform == "capitalize" and is_initial else character


def _is_preserving(span: Span) -> bool:
    """`white-space` of CSS counts more than `xml:space`."""
    white_space = span.style["white-space"]
    if white_space != "normal":
        return white_space in _PRESERVING
    element: Element | None = span.element
    while element is not None:
        if (said := element.attributes.get("xml:space")) is not None:
            return said == "preserve"
        element = element.parent
    return False


def _drop_trailing_space(text: Text) -> None:
    last = text.characters[-1] if text.characters else None
    if last is not None and last.text == " " and not _is_preserving(last.span):
        text.characters.pop()
        for span in text.spans:
            span.stop = min(span.stop, len(text.characters))


def _place(text: Text, context: TextContext) -> None:
    """Hands out the lists; an inner element's win over an outer one's."""
    for span in text.spans:
        if span.element.tag not in ("text", "tspan"):
            continue
        characters = text.characters[span.first : span.stop]
        for name, axis in _LISTS.items():
            is_across = name == ("x" if text.is_vertical else "y")
            for character, value in zip(characters, _lengths(span, name, axis), strict=False):
                if not (is_across and character.span.path is not None):
                    setattr(character, name, value)
        rotations = _numbers(span.element.attributes.get("rotate", ""))
        if rotations:
            for index, character in enumerate(characters):
                character.rotate = rotations[min(index, len(rotations) - 1)]


def _lengths(span: Span, name: str, axis: Axis) -> list[float]:
    """A list of lengths; empty where any of them is none, as browsers have it."""
    words = span.element.attributes.get(name, "").replace(",", " ").split()
    values = [span.style.in_units(word, axis) for word in words]
    return [] if None in values else [value for value in values if value is not None]


def _numbers(text: str) -> list[float]:
    try:
        values = [float(word) for word in text.replace(",", " ").split()]
    except ValueError:
        return []
    return values if all(map(math.isfinite, values)) else []


def _request(style: Style) -> Request:
    weight = style["font-weight"]
    return Request(
        split_families(style["font-family"]),
        _WEIGHTS[weight] if weight in _WEIGHTS else float(weight),
        style["font-style"].startswith(("italic", "oblique")),
        style["font-stretch"],
    )


def is_spaced(character: str) -> bool:
    """Whether `letter-spacing` follows it: not what is combined with another, nor what has no width at all."""
    return unicodedata.category(character) not in ("Mn", "Me", "Cf")
