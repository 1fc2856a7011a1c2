"""Other places for a drawing of the same size: turned, and moved within the room that there is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from planner.affine import compose
from planner.arrays import FloatArray, frozen
from planner.drawing.drawing import Outline
from planner.drawing.flatten import extent
from planner.placement.board import Board

_TURN_DEG = 15.0
_SHARES = (0.5, 0.0, 1.0)
"""Of what room is spare, from the near and from the right side; the middle first."""
_WORTH_MOVING_MM = 1.0
_ROUNDING_MM = 1e-6


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """A turn, clockwise as somebody sees it who stands behind the arm, and what it moves the middle of the ink by.
    matrix: (2, 3) from arm mm to arm mm."""

    turn_deg: float
    moved_mm: float
    matrix: FloatArray


def motions(outlines: Sequence[Outline], svg_to_arm: FloatArray, board: Board) -> list[Motion]:
    """Those that keep all ink within the board less its margin: by every turn, to the middle, the sides and the
    corners. svg_to_arm: (2, 3), where the drawing lies before."""
    sides, margin_mm = board.rectangle, board.margin_mm
    room_low = np.array([sides.near_mm, sides.right_mm]) + margin_mm
    room = np.array([sides.height_mm, sides.width_mm]) - 2.0 * margin_mm
    middle = _middle(*extent(outlines, svg_to_arm))
    found = []
    for turn_deg in np.arange(0.0, 360.0, _TURN_DEG).tolist():
        turn = np.column_stack((_turned(turn_deg), np.zeros(2)))
        low, high = extent(outlines, compose(turn, svg_to_arm))
        spare = room - (high - low)
        if (spare < -_ROUNDING_MM).any():
            continue
        shares = [_SHARES if free > _WORTH_MOVING_MM else _SHARES[:1] for free in spare.tolist()]
        for share in product(*shares):
            shift = room_low + np.array(share) * np.maximum(spare, 0.0) - low
            moved_mm = float(np.hypot(*(_middle(low, high) + shift - middle)))
            found.append(Motion(turn_deg, moved_mm, frozen(np.column_stack((turn[:, :2], shift)))))
    return found


def _middle(low: FloatArray, high: FloatArray) -> FloatArray:
    return (low + high) / 2.0


def _turned(clockwise_deg: float) -> FloatArray:
    """(2, 2) of arm x and y, which point away from the arm and to its left."""
    angle = np.radians(clockwise_deg)
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
