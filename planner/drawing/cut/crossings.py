"""Where cubics cross straight edges: all roots, each found on the cubic itself."""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.cubics import at
from planner.drawing.cut.cubic_roots import sign_changes


def crossings(
    control: FloatArray, start: FloatArray, end: FloatArray, edges: FloatArray, reach: float
) -> tuple[IntArray, FloatArray]:
    """The crossings of cubics (n, 4, 2), between parameters start and end (n,), with edges (n, 2, 2): which of the n
    pairs each belongs to, and its parameter on the cubic. An edge counts as longer by `reach` at both ends.

    The distance of a cubic from an edge's line is a cubic polynomial, and they cross where it changes its sign.
    """
    along = edges[:, 1] - edges[:, 0]
    length = np.hypot(*along.T)
    offsets = control - edges[:, np.newaxis, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        direction = np.nan_to_num(along / length[:, np.newaxis])
    f = offsets[..., 1] * direction[:, :1] - offsets[..., 0] * direction[:, 1:]
    power = np.stack(  # f(t) = p0 + p1 t + p2 t^2 + p3 t^3
        (
            f[:, 0],
            3.0 * (f[:, 1] - f[:, 0]),
            3.0 * (f[:, 2] - 2.0 * f[:, 1] + f[:, 0]),
            f[:, 3] - f[:, 0] + 3.0 * (f[:, 1] - f[:, 2]),
        )
    )
    pair, t = sign_changes(power, start, end)
    place = np.sum(at(offsets[pair], t[:, np.newaxis]) * direction[pair], axis=1)
    is_on_edge: BoolArray = (place >= -reach) & (place <= length[pair] + reach)
    return pair[is_on_edge], t[is_on_edge]
