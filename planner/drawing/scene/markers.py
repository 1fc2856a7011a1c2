"""Where markers sit on a path, and which way they point (SVG 2, section 13.7)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.drawing.subpath import Subpath

Vector = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Vertex:
    """x, y: where a marker sits. angle_deg: the direction of the path there. name: of the property that puts one."""

    x: float
    y: float
    angle_deg: float
    name: str


@dataclass(slots=True)
class _Corner:
    """A vertex with the directions in which the path comes in and goes out; None where it begins or ends."""

    at: Vector
    coming: Vector | None
    going: Vector | None

    @property
    def angle_deg(self) -> float:
        if self.coming is None or self.going is None:
            return _angle_deg(self.going or self.coming or (0.0, 0.0))
        first, second = _angle_deg(self.coming), _angle_deg(self.going)
        if abs(first - second) > 180.0:
            first += 360.0
        return (first + second) / 2.0


def vertices(subpaths: Sequence[Subpath]) -> list[Vertex]:
    """All vertices in order: the first has the start marker, the last the end marker, the others the middle ones, the
    moves between subpaths included."""
    corners = [corner for subpath in subpaths for corner in _corners(subpath)]
    last = len(corners) - 1
    return [
        Vertex(*corner.at, corner.angle_deg, "marker-end" if at == last else "marker-mid" if at else "marker-start")
        for at, corner in enumerate(corners)
    ]


def _corners(subpath: Subpath) -> list[_Corner]:
    (start, *_), ends = subpath.beziers[0].tolist(), np.flatnonzero(subpath.is_vertex)
    corners = [_Corner((start[0], start[1]), None, None)]
    first = 0
    for end in ends:
        corners[-1].going = _tangent(subpath.beziers[first].tolist())
        backwards = _tangent(subpath.beziers[end, ::-1].tolist())
        x, y = subpath.beziers[end, 3].tolist()
        corners.append(_Corner((x, y), (-backwards[0], -backwards[1]), None))
        first = end + 1
    if subpath.is_closed and len(corners) > 1:
        corners[0].coming, corners[-1].going = corners[-1].coming, corners[0].going
    return corners


def _tangent(points: Sequence[Sequence[float]]) -> Vector:
    """The direction in which a cubic starts: towards the first of its points that is elsewhere."""
    x, y = points[0]
    return next(((u - x, v - y) for u, v in points[1:] if (u, v) != (x, y)), (0.0, 0.0))


def _angle_deg(direction: Vector) -> float:
    return math.degrees(math.atan2(direction[1], direction[0]))
