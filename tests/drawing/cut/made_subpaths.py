"""Subpaths of lines and curves, open and closed, as hypothesis makes them."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from planner.drawing.subpath import Subpath


@st.composite
def subpaths_of(draw: st.DrawFn, point: st.SearchStrategy[tuple[float, float]]) -> Subpath:
    """Up to five curves through such points; a closed one ends where it begins."""
    start = first = draw(point)
    curves = []
    for _ in range(draw(st.integers(1, 4))):
        end = draw(point)
        curves.append([start, draw(point), draw(point), end] if draw(st.booleans()) else [start, start, end, end])
        start = end
    is_closed = draw(st.booleans())
    if is_closed and start != first:
        curves.append([start, start, first, first])
    return Subpath(np.array(curves), is_closed, np.ones(len(curves), dtype=np.bool_))
