"""Text along a path."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.style.style import Style
from planner.drawing.subpath import Subpath
from planner.drawing.text.context import TextContext
from planner.drawing.xml_tree import Element

_STEPS, _MOST_CHORDS = 32, 1_000_000
"""Chords that a curve is measured by, fewer where a path has very many curves."""


@dataclass(frozen=True, eq=False, slots=True)
class TextPath:
    """points: (n, 2) along the subpaths; lengths: (n,), the length of path up to each; where one subpath ends and the
    next begins a length stands twice. offset: where text begins. A path that is not there has no points: text along it
    is not shown."""

    points: FloatArray
    lengths: FloatArray
    offset: float

    @property
    def is_missing(self) -> bool:
        return len(self.points) < 2

    @property
    def end(self) -> tuple[float, float]:
        return (0.0, 0.0) if self.is_missing else (float(self.points[-1, 0]), float(self.points[-1, 1]))

    def at(self, length: float) -> tuple[float, float, float] | None:
        """The point there and the direction of the path in radians; None beyond its ends."""
        if self.is_missing or not 0.0 <= length <= self.lengths[-1]:
            return None
        index = int(np.clip(np.searchsorted(self.lengths, length, side="right"), 1, len(self.lengths) - 1))
        start, stop = self.points[index - 1], self.points[index]
        step = self.lengths[index] - self.lengths[index - 1]
        x, y = start + (stop - start) * ((length - self.lengths[index - 1]) / step if step > 0.0 else 0.0)
        return float(x), float(y), math.atan2(stop[1] - start[1], stop[0] - start[0])


def text_path(element: Element, style: Style, context: TextContext) -> TextPath:
    """That of a `textPath`: path data of its own, or a `path` that it names."""
    attributes = element.attributes
    target: Element | None
    if "path" in attributes:
        target = Element("path", {"d": attributes["path"]}, element.line, element.parent)
    else:
        href = attributes.get("href", attributes.get("xlink:href", "")).strip()
        target = context.document.by_id.get(href[1:]) if href.startswith("#") else None
    if target is None or target.tag != "path":
        return TextPath(np.zeros((0, 2)), np.zeros(0), 0.0)
    points, lengths = measured(context.path_of(target))
    total = float(lengths[-1]) if len(lengths) else 0.0
    return TextPath(points, lengths, _start(element, style, target, total))


def _start(element: Element, style: Style, target: Element, total: float) -> float:
    said = element.attributes.get("startOffset", "").strip()
    own = _number(target.attributes.get("pathLength", ""))
    if said.endswith("%"):
        return _number(said[:-1]) / 100.0 * total
    offset = style.in_units(said, "diagonal") or 0.0
    return offset * total / own if own > 0.0 else offset


def _number(text: str) -> float:
    """0 where it is none."""
    try:
        value = float(text)
    except ValueError:
        return 0.0
    return value if math.isfinite(value) else 0.0


def measured(subpaths: list[Subpath]) -> tuple[FloatArray, FloatArray]:
    """Points along subpaths (n, 2), and the length up to each (n,)."""
    n_curves = max(sum(len(subpath.beziers) for subpath in subpaths), 1)
    t = np.linspace(0.0, 1.0, min(max(_MOST_CHORDS // n_curves, 1), _STEPS) + 1)[:, None]
    basis = np.concatenate(((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3), axis=1)
    points, lengths, total = [], [], 0.0
    for subpath in subpaths:
        curved = np.einsum("tk,nkd->ntd", basis, subpath.beziers)
        own = np.concatenate((curved[:1, 0], curved[:, 1:].reshape(-1, 2)))
        steps = np.hypot(*np.diff(own, axis=0).T)
        is_new = np.concatenate(([True], steps > 0.0))
        along = total + np.concatenate(([0.0], np.cumsum(steps)))
        points.append(own[is_new])
        lengths.append(along[is_new])
        total = float(along[-1])
    if not points:
        return np.zeros((0, 2)), np.zeros(0)
    return np.concatenate(points), np.concatenate(lengths)
