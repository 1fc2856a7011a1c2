"""What of joined strokes is line of the drawing, and what leads across gaps: only the first may be touched."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray

_PARTS = slice(None, -1), slice(1, None)
_MIXING = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0xD6E8FEB86659FD93], dtype=np.uint64)


class Ink:
    """The straight pieces that strokes (n, 2) consist of before they are joined. Shorter ones than `least_mm` are of no
    concern, be they lines or gaps."""

    def __init__(self, strokes: Sequence[FloatArray], least_mm: float) -> None:
        self._least_mm = least_mm
        pieces = _pieces(strokes)
        self._keys = np.sort(_keys(pieces[self._is_long(pieces)]))

    def gaps_of(self, strokes: Sequence[FloatArray]) -> BoolArray:
        """(total pieces,) which of the pieces of strokes made of these are none of them, stroke after stroke."""
        pieces = _pieces(strokes)
        found = self._is_long(pieces)
        keys = _keys(pieces[found])
        first, behind = (np.searchsorted(self._keys, keys, side) for side in ("left", "right"))
        found[found] = first == behind
        return found

    def _is_long(self, pieces: FloatArray) -> BoolArray:
        long: BoolArray = np.hypot(*(pieces[:, 1] - pieces[:, 0]).T) > self._least_mm
        return long


def _pieces(strokes: Sequence[FloatArray]) -> FloatArray:
    """(total, 2, 2) the straight pieces of all strokes, one stroke after the other."""
    ends = [np.concatenate([np.empty((0, 2)), *(stroke[part] for stroke in strokes)]) for part in _PARTS]
    return np.stack(ends, axis=1)


def _keys(pieces: FloatArray) -> IntArray:
    """(n,) a number for each piece (n, 2, 2), made of all bits of its ends, whichever way it is led."""
    is_turned = (pieces[:, 0, 0] > pieces[:, 1, 0]) | (
        (pieces[:, 0, 0] == pieces[:, 1, 0]) & (pieces[:, 0, 1] > pieces[:, 1, 1])
    )
    led = np.where(is_turned[:, None, None], pieces[:, ::-1], pieces) + 0.0  # no -0.0, which is 0.0 in other bits
    bits = np.ascontiguousarray(led.reshape(-1, 4)).view(np.uint64)
    bits = (bits ^ (bits >> np.uint64(29))) * _MIXING
    mixed = np.bitwise_xor.reduce(bits ^ (bits >> np.uint64(32)), axis=1)
    keys: IntArray = mixed.view(np.int64)
    return keys
