"""The SVG that is handed to the normaliser: the same drawing without references to anything outside it, with
arcs as cubics, and with a placeholder for everything that a pen cannot draw.

Placeholders are one-pixel images: the normaliser keeps those that are rendered, and only those, so that they can be
counted in its result.
"""

from __future__ import annotations

import base64
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from xml.parsers import expat

from planner.drawing.arcs import ellipse_cubics
from planner.drawing.path_data import command, commands, has_foreign_characters, has_unusable_numbers
from planner.drawing.survey import SVG_NAMESPACE, Survey, href_of, local_name, parse
from planner.errors import DrawingError

PATH_LIMIT_BYTES = 64 << 20
"""Of path data with its arcs as cubics: an arc of twenty letters may take twelve times as many."""

# A PNG of one pixel.
_PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000"
    "000d4944415478da636460f85f0f0002870180eb47ba920000000049454e44ae426082"
)
_PLACEHOLDER_KINDS = ("text", "image", "foreignObject")
# The kind follows the end of the image data, where image readers do not look; its own letters tell the three apart.
PLACEHOLDERS = {base64.b64encode(_PIXEL + kind.encode()).decode(): kind for kind in _PLACEHOLDER_KINDS}
_HREFS = {kind: "data:image/png;base64," + data for data, kind in PLACEHOLDERS.items()}

_DROPPED = frozenset({"script", "metadata", "namedview", "animate", "animateTransform", "animateMotion", "set"})
_KEPT_PREFIXES = frozenset({"xml", "xmlns", "xlink"})
_TEXT_ATTRIBUTES = frozenset(
    {
        "id",
        "class",
        "style",
        "display",
        "visibility",
        "opacity",
        "systemLanguage",
        "requiredFeatures",
        "requiredExtensions",
    }
)
_GEOMETRY = {
    "circle": ("cx", "cy", "r"),
    "ellipse": ("cx", "cy", "rx", "ry"),
    "rect": ("x", "y", "width", "height", "rx", "ry"),
}
# Where a style sheet may tell a circle from a path, or set a radius, shapes stay as they are.
_SHAPE_SELECTORS = re.compile(r"\b(?:path|circle|ellipse|rect)\b|\b(?:cx|cy|rx|ry|r)\s*:|\[|:nth|-of-type")
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,2})?)\s*(px|mm|cm|in|pt|pc)?\s*")
_PX_PER_UNIT = {None: 1.0, "px": 1.0, "mm": 96.0 / 25.4, "cm": 96.0 / 2.54, "in": 96.0, "pt": 4.0 / 3.0, "pc": 16.0}
# Units that CSS has and the normaliser has not: it would drop the element without a word.
_UNKNOWN_UNIT = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+))\s*(q|rem)\s*", re.IGNORECASE)
_LENGTH_ATTRIBUTES = ("x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "x1", "y1", "x2", "y2", "stroke-width")
_ESCAPES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}
)


def rewrite(data: bytes, survey: Survey, source: str) -> tuple[bytes, Counter[str]]:
    """The document for the normaliser, and how many paths had data that cannot be used. Errors: DrawingError where
    arcs come to more than the limit."""
    rewriter = _Rewriter(survey, source)
    parse(data, rewriter.parser, source)
    return "".join(rewriter.out).encode(), rewriter.skipped


class _Rewriter:
    def __init__(self, survey: Survey, source: str) -> None:
        self.out: list[str] = []
        self._source = source
        self._path_bytes = 0
        self.skipped: Counter[str] = Counter()
        # Markers sit on paths and not on circles: with markers about, a circle must stay one.
        self._may_replace_shapes = not survey.has_markers and not _SHAPE_SELECTORS.search(survey.css)
        self._rem_px = _length(survey.root.get("font-size", "16")) or 16.0
        # A clip path may use shapes only; the normaliser trips over anything else.
        self._shape_ids = survey.shape_ids
        self._tags: list[str] = []
        self._written: list[str] = []
        self._omitted_depth = 0
        self._text_element: str | None = None
        self._text_is_blank = True
        self._in_style = 0
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        if self._omitted_depth:
            self._omitted_depth += 1
            return
        tag = local_name(name)
        parent = self._tags[-1] if self._tags else ""
        kept = _without_outside(attributes)
        self._rewrite_units(kept)
        if tag in _DROPPED or (
            tag == "use" and parent == "clipPath" and href_of(kept).removeprefix("#") not in self._shape_ids
        ):
            self._omitted_depth = 1
            return
        if tag == "text":
            inherited = {key: value for key, value in kept.items() if key in _TEXT_ATTRIBUTES}
            self._text_element = _element(_renamed(name, "image"), {**inherited, "href": _HREFS["text"]}) + "/>"
            self._text_is_blank = True
            self._omitted_depth = 1
            return
        if tag == "foreignObject":
            # A switch passes over a foreignObject, but would stop at an image.
            if parent != "switch":
                image = {**kept, "href": _HREFS["foreignObject"]}
                self.out.append(_element(_renamed(name, "image"), image) + "/>")
            self._omitted_depth = 1
            return
        if tag == "image":
            has_picture = bool(href_of(attributes))
            kept = {key: value for key, value in kept.items() if local_name(key) not in ("href", "preserveAspectRatio")}
            if has_picture:
                kept["href"] = _HREFS["image"]
        elif tag == "path":
            self._rewrite_path(kept)
        elif tag in _GEOMETRY and self._may_replace_shapes:
            name = self._rewrite_shape(name, tag, kept)
        elif tag == "style":
            self._in_style += 1
        if not self._tags and "xmlns" not in kept and ":" not in name:
            kept["xmlns"] = SVG_NAMESPACE
        self._tags.append(tag)
        self._written.append(name)
        self.out.append(_element(name, kept) + ">")

    def _end(self, _: str) -> None:
        if self._omitted_depth:
            self._omitted_depth -= 1
            if not self._omitted_depth and self._text_element is not None:
                if not self._text_is_blank:
                    self.out.append(self._text_element)
                self._text_element = None
            return
        if self._tags.pop() == "style":
            self._in_style -= 1
        self.out.append(f"</{self._written.pop()}>")

    def _text(self, text: str) -> None:
        if self._omitted_depth:
            self._text_is_blank = self._text_is_blank and not text.strip()
        elif self._in_style:
            self.out.append(text.translate(_ESCAPES))

    def _rewrite_units(self, attributes: dict[str, str]) -> None:
        for key in _LENGTH_ATTRIBUTES:
            match = _UNKNOWN_UNIT.fullmatch(attributes.get(key, ""))
            if match:
                px = self._rem_px if match[2].lower() == "rem" else 96.0 / 101.6
                attributes[key] = repr(float(match[1]) * px)

    def _rewrite_path(self, attributes: dict[str, str]) -> None:
        data = attributes.get("d", "")
        if has_unusable_numbers(data):
            self.skipped["path with unusable numbers"] += 1
            del attributes["d"]
            return
        if has_foreign_characters(data):
            self.skipped["path with unreadable data"] += 1
        if data:
            attributes["d"] = "".join(self._bounded(commands(data)))

    def _bounded(self, parts: Iterable[str]) -> Iterator[str]:
        for part in parts:
            self._path_bytes += len(part)
            if self._path_bytes > PATH_LIMIT_BYTES:
                raise DrawingError(
                    self._source,
                    f"its paths, with arcs as curves, are larger than the limit of"
                    f" {PATH_LIMIT_BYTES >> 20} MB (split it into several drawings)",
                )
            yield part

    def _rewrite_shape(self, name: str, tag: str, attributes: dict[str, str]) -> str:
        """Turn a round shape of known size into a path; the name of the element to write."""
        lengths = {key: _length(attributes[key]) for key in _GEOMETRY[tag] if key in attributes}
        if _SHAPE_SELECTORS.search(attributes.get("style", "")):
            return name
        data = _shape_data(tag, {key: value for key, value in lengths.items() if value is not None})
        if data is None or None in lengths.values():
            return name
        for key in lengths:
            del attributes[key]
        attributes["d"] = data
        return _renamed(name, "path")


def _without_outside(attributes: dict[str, str]) -> dict[str, str]:
    """The attributes that mean something to the normaliser; references only to the document itself."""
    return {
        key: value
        for key, value in attributes.items()
        if (":" not in key or key.partition(":")[0] in _KEPT_PREFIXES)
        and (local_name(key) != "href" or value.strip().startswith("#"))
    }


def _element(name: str, attributes: dict[str, str]) -> str:
    parts = [f'{key}="{value.translate(_ESCAPES)}"' for key, value in attributes.items()]
    return "<" + " ".join([name, *parts])


def _renamed(name: str, tag: str) -> str:
    prefix, colon, _ = name.rpartition(":")
    return prefix + colon + tag


def _length(text: str) -> float | None:
    """A length in user units; None where it needs a font or a viewport, or is no length."""
    match = _LENGTH.fullmatch(text)
    return float(match[1]) * _PX_PER_UNIT[match[2]] if match else None


def _shape_data(tag: str, lengths: dict[str, float]) -> str | None:
    """Path data of a circle, an ellipse or a rounded rectangle, in the order of SVG 1.1, sections 9.2 to 9.4.

    None where the shape is better left alone: not rendered at all, or without a curve.
    """
    if tag == "rect":
        return _rounded_rectangle(lengths)
    radius_x = lengths.get("r", lengths.get("rx", lengths.get("ry", 0.0)))
    radius_y = lengths.get("r", lengths.get("ry", radius_x))
    if radius_x <= 0.0 or radius_y <= 0.0:
        return None
    center_x, center_y = lengths.get("cx", 0.0), lengths.get("cy", 0.0)
    cubics = ellipse_cubics(center_x, center_y, radius_x, radius_y, 0.0, 2.0 * math.pi)
    start = (center_x + radius_x, center_y)
    cubics[-1] = (*cubics[-1][:4], *start)
    return command("M", start) + "".join(command("C", cubic) for cubic in cubics) + "Z"


def _rounded_rectangle(lengths: dict[str, float]) -> str | None:
    x, y = lengths.get("x", 0.0), lengths.get("y", 0.0)
    width, height = lengths.get("width", 0.0), lengths.get("height", 0.0)
    # A negative radius counts as not given.
    given = {key: lengths[key] for key in ("rx", "ry") if lengths.get(key, -1.0) >= 0.0}
    if not given or width <= 0.0 or height <= 0.0:
        return None
    rx = min(given.get("rx", given.get("ry", 0.0)), width / 2.0)
    ry = min(given.get("ry", given.get("rx", 0.0)), height / 2.0)
    if rx == 0.0 or ry == 0.0:
        return None
    right, bottom, quarter = x + width, y + height, math.pi / 2.0
    corners = (
        ((right - rx, y), (right - rx, y + ry), -quarter, (right, y + ry)),
        ((right, bottom - ry), (right - rx, bottom - ry), 0.0, (right - rx, bottom)),
        ((x + rx, bottom), (x + rx, bottom - ry), quarter, (x, bottom - ry)),
        ((x, y + ry), (x + rx, y + ry), 2.0 * quarter, (x + rx, y)),
    )
    parts = [command("M", (x + rx, y))]
    for before, center, start_rad, after in corners:
        cubics = ellipse_cubics(*center, rx, ry, start_rad, quarter)
        cubics[-1] = (*cubics[-1][:4], *after)
        parts.append(command("L", before))
        parts.extend(command("C", cubic) for cubic in cubics)
    return "".join(parts) + "Z"
