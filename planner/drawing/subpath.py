"""A subpath: what path data, basic shapes and glyphs all become."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arrays import BoolArray, FloatArray, frozen


@dataclass(frozen=True, eq=False, slots=True)
class Subpath:
    """Consecutive cubic Bezier curves, straight lines with their control points at the thirds.

    beziers: (n_curves, 4, 2); curve k ends exactly where curve k + 1 begins; a subpath of zero length is one curve with
    four equal points. is_closed: closed by `Z` or by its shape; then the last curve ends where the first begins.
    is_vertex: (n_curves,), whether the end of curve k is a vertex of the path as it was written: where an arc
    became several curves only the last of them ends in one. Markers sit on vertices.
    gap: (n, 4, 2), of a dash the curves to where the next dash of its line begins; None of the last one, and of what
    is no dash.
    """

    beziers: FloatArray
    is_closed: bool
    is_vertex: BoolArray
    gap: FloatArray | None = None

    @property
    def is_dot(self) -> bool:
        """Whether it has no length."""
        return len(self.beziers) == 1 and bool(np.all(self.beziers == self.beziers[0, 0]))

    def moved(self, affine: FloatArray) -> Subpath:
        """The same under an affine (2, 3)."""
        gap = None if self.gap is None else frozen(self.gap @ affine[:, :2].T + affine[:, 2])
        return replace(self, beziers=frozen(self.beziers @ affine[:, :2].T + affine[:, 2]), gap=gap)


def polyline(points: FloatArray, is_closed: bool = False) -> Subpath:
    """Points (n, 2) joined by straight lines; a closed one gets its last edge where it needs one. A single point is a
    dot."""
    if is_closed and np.any(points[0] != points[-1]):
        points = np.concatenate((points, points[:1]))
    if len(points) == 1:
        points = np.repeat(points, 2, axis=0)
    start, end = points[:-1], points[1:]
    beziers = np.stack((start, start + (end - start) / 3.0, end - (end - start) / 3.0, end), axis=1)
    return Subpath(frozen(beziers), is_closed, np.ones(len(beziers), dtype=np.bool_))


def joined(one: Subpath, other: Subpath) -> Subpath:
    """Two open subpaths of which the second begins where the first ends."""
    beziers = frozen(np.concatenate((one.beziers, other.beziers)))
    return Subpath(beziers, False, np.concatenate((one.is_vertex, other.is_vertex)), other.gap)
