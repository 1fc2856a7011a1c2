"""Characters in a row, made longer or shorter: `textLength` of SVG 2, section 11.5."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False, slots=True)
class Row:
    """Arrays (n,) by character, changed in place. u: where each begins; advance: the room that it takes;
    is_typographic: False for what is drawn by the one before it; order: indices as they are seen."""

    u: FloatArray
    advance: FloatArray
    is_typographic: BoolArray
    order: IntArray

    def stretch(self, own: slice, length: float) -> float:
        """Makes characters with their room as long as `length`; what follows moves along. Returns the factor."""
        left, right = self._extent(own)
        factor = length / (right - left) if right > left else 1.0
        is_own = self._is_own(own)
        begin = int(np.argmax(is_own[self.order]))
        after = self.order[begin:]
        self.u[after[~is_own[after]]] += (right - left) * (factor - 1.0)
        self.u[own] = left + (self.u[own] - left) * factor
        self.advance[own] *= factor
        return factor

    def space_out(self, own: slice, inner: Sequence[slice], length: float) -> None:
        """Makes the gaps between characters wider or narrower; those within `inner` have been seen to. As in Chromium
        what follows moves by one gap more."""
        left, right = self._extent(own)
        is_followed = self._is_own(own) & self.is_typographic
        for one in inner:
            is_followed[one] = False
            is_followed[one.start] = True
        n_gaps = int(np.count_nonzero(is_followed)) - 1
        if n_gaps <= 0:
            return
        followed = is_followed[self.order]
        self.u[self.order] += (np.cumsum(followed) - followed) * ((length - (right - left)) / n_gaps)

    def _extent(self, own: slice) -> tuple[float, float]:
        starts, stops = self.u[own], self.u[own] + self.advance[own]
        return float(np.minimum(starts, stops).min()), float(np.maximum(starts, stops).max())

    def _is_own(self, own: slice) -> BoolArray:
        found = np.zeros(len(self.u), dtype=np.bool_)
        found[own] = True
        return found
