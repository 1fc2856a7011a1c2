"""A calibration pattern: a trajectory of marks, each the end of a stroke that tells the height of the tip as well."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.error_model.believed import believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.drawn import drawn_joints
from planner.error_model.pattern.candidates import Candidates, candidates
from planner.error_model.pattern.choice import chosen_marks
from planner.error_model.pattern.legs import RESTING, slowing_from_rest, straight_leg
from planner.error_model.pattern.touch import LIFT_SLOPE, Heights, Touch, touch_line
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.redundancy.arm_model import ArmModel
from planner.trajectory import PATTERN, TRAVELLING, Trajectory

RATE_HZ = 100.0
_MARGIN_MM = 1.0
_POOL = 1200
_DWELL_S = 1.0
_APART_MM = 3.5
"""Between strokes."""


@dataclass(frozen=True, eq=False, slots=True)
class Pattern:
    """trajectory: stroke k is mark k. marks_mm: (m, 2) on the paper. touches: the stroke of each mark. mark_samples,
    zero_samples: (m,) the sample in the middle of each mark's dwell, and that at which its line begins if the tip is
    neither high nor low."""

    trajectory: Trajectory
    marks_mm: FloatArray
    touches: tuple[Touch, ...]
    mark_samples: IntArray
    zero_samples: IntArray


def make_pattern(arm: Arm, name: str, count: int, seed: int = 0, *, on_sheet: bool = False) -> Pattern:
    """A pattern of `count` marks for `arm`, which its trajectory calls `name`. on_sheet: it has to fit a printed sheet.
    Errors: PlanError, ArmFileError."""
    random = np.random.default_rng(seed)
    model = ArmModel(arm)
    heights = Heights.for_arm(arm)
    pool = candidates(model, heights, _MARGIN_MM, _POOL, random, on_sheet=on_sheet)
    drawing = _Drawing(model.kinematics, model.limits, heights, pool)
    parameters = Parameters.of(believed(arm), arm)
    drawn = drawn_joints(model)
    chosen = chosen_marks(arm, parameters, pool, drawn, count, random, drawing.accepts)
    if len(chosen) < count:
        raise PlanError(f"arm {arm.name}: its canvas has room for {len(chosen)} marks, not for {count}")
    legs = [drawing.begin(chosen[0])]
    strokes = [np.full(len(legs[0]), TRAVELLING)]
    touches, middles, zeros = [], [], []
    for k, index in enumerate(chosen):
        way, (touch, back) = drawing.way_to(chosen[k - 1] if k else None, index), drawing.touch_of(index)
        down, rest = np.split(touch.joints[1:], [-RESTING])
        dwell = np.concatenate((rest, np.repeat(rest[-1:], round(_DWELL_S * RATE_HZ), axis=0)))
        begins = sum(map(len, legs)) + len(way)
        middles.append(begins + len(down) + len(dwell) // 2)
        zeros.append(begins + touch.zero - 1)
        legs += [way, down, dwell, back]
        strokes += [
            np.full(len(way) + len(down), TRAVELLING),
            np.full(len(dwell), k),
            np.full(len(back), TRAVELLING),
        ]
        touches.append(touch)
    positions, stroke = np.concatenate(legs), np.concatenate(strokes)
    trajectory = Trajectory(
        arm=name,
        drawing="",
        method=PATTERN,
        rate_hz=RATE_HZ,
        columns=arm.column_names,
        positions=arm.to_file_units(positions),
        pen=stroke != TRAVELLING,
        stroke=stroke,
        svg_to_arm_mm=(0.0, -1.0, -1.0, 0.0, 0.0, 0.0),
        paper=arm.paper,
    )
    return Pattern(trajectory, pool.tips_mm[chosen], tuple(touches), np.array(middles), np.array(zeros))


class _Drawing:
    """How marks of a pool are drawn one after the other; moves are made once and kept."""

    def __init__(self, kinematics: Kinematics, limits: Limits, heights: Heights, pool: Candidates) -> None:
        self._kinematics, self._limits, self._heights, self._pool = kinematics, limits, heights, pool
        self._touches: dict[int, tuple[Touch, FloatArray] | None] = {}
        self._ways: dict[tuple[int | None, int], FloatArray | None] = {}

    def accepts(self, chosen: list[int], index: int) -> bool:
        """Whether a mark is clear of those chosen before, and can be drawn after the last of them."""
        if chosen and not self._is_clear(chosen, index):
            return False
        if index not in self._touches:
            self._touches[index] = self._touch(index)
        before = chosen[-1] if chosen else None
        if self._touches[index] is None:
            return False
        if (before, index) not in self._ways:
            self._ways[before, index] = self._way(before, index)
        return self._ways[before, index] is not None

    def begin(self, index: int) -> FloatArray:
        """(1, n_joints) where the pattern begins: above the beginning of its first stroke."""
        return self._kinematics.arm.complete(self._pool.raised[index])[None]

    def way_to(self, before: int | None, index: int) -> FloatArray:
        """From the end of the mark before, or from above, to the beginning of a mark's stroke."""
        way = self._ways[before, index]
        assert way is not None
        return way

    def touch_of(self, index: int) -> tuple[Touch, FloatArray]:
        """The stroke of a mark, and the way up from its end without its first sample, which repeats the last before."""
        touch = self._touches[index]
        assert touch is not None
        return touch

    def _is_clear(self, chosen: list[int], index: int) -> bool:
        pool = self._pool
        strokes = np.stack((pool.begins_mm[chosen], pool.tips_mm[chosen]), axis=1)
        return bool(_apart(np.stack((pool.begins_mm[index], pool.tips_mm[index])), strokes).min() >= _APART_MM)

    def _touch(self, index: int) -> tuple[Touch, FloatArray] | None:
        pool, heights = self._pool, self._heights
        begin, mark = pool.begins_mm[index], pool.tips_mm[index]
        free = np.stack((pool.begun[index], pool.free[index]))
        touch = touch_line(self._kinematics, np.stack((begin, mark)), free, heights.reach_mm, RATE_HZ)
        if touch is None or slowing_from_rest(self._limits, touch.joints, RATE_HZ) > 1.0:
            return None
        last = touch.joints[-1]
        back = self._leg((*mark, -heights.reach_mm), (*_lifted_from(touch, heights), heights.lift_mm), last, last)
        return None if back is None else (touch, back)

    def _way(self, before: int | None, index: int) -> FloatArray | None:
        pool, heights, complete = self._pool, self._heights, self._kinematics.arm.complete
        begin, raised = pool.begins_mm[index], complete(pool.raised[index])
        down = self._leg(
            (*begin, heights.lift_mm), (*begin, heights.reach_mm), raised, self.touch_of(index)[0].joints[0]
        )
        if down is None or before is None:
            return down
        touch, back = self.touch_of(before)
        over = self._leg((*_lifted_from(touch, heights), heights.lift_mm), (*begin, heights.lift_mm), back[-1], raised)
        return None if over is None else np.concatenate((over, down))

    def _leg(
        self, begin: tuple[float, ...], end: tuple[float, ...], first: FloatArray, last: FloatArray
    ) -> FloatArray | None:
        """A leg without its first sample, which is the last of the leg before."""
        free = self._kinematics.independent_of(np.stack((first, last)))
        leg = straight_leg(self._kinematics, self._limits, np.array([begin, end]), free, RATE_HZ)
        return None if leg is None else leg[1:]


def _lifted_from(touch: Touch, heights: Heights) -> FloatArray:
    """(2,) over which place the pen is lifted from a mark."""
    along = (touch.end_mm - touch.begin_mm) / np.linalg.norm(touch.end_mm - touch.begin_mm)
    place: FloatArray = touch.end_mm + (heights.lift_mm + heights.reach_mm) / LIFT_SLOPE * along
    return place


def _apart(segment: FloatArray, others: FloatArray) -> FloatArray:
    """(n,) distances of a segment (2, 2) to others (n, 2, 2), 0 where they cross."""
    away = np.minimum.reduce(
        [_to_segments(end, others) for end in segment]
        + [_to_segments(others[:, k], np.broadcast_to(segment, others.shape)) for k in range(2)]
    )
    sides = [
        _side(segment[0], segment[1], others[:, 0]) * _side(segment[0], segment[1], others[:, 1]),
        _side(others[:, 0], others[:, 1], segment[0]) * _side(others[:, 0], others[:, 1], segment[1]),
    ]
    crossed: FloatArray = np.where((sides[0] < 0) & (sides[1] < 0), 0.0, away)
    return crossed


def _side(start: FloatArray, end: FloatArray, point: FloatArray) -> FloatArray:
    """On which side of a line, by its sign."""
    along, off = end - start, point - start
    side: FloatArray = along[..., 0] * off[..., 1] - along[..., 1] * off[..., 0]
    return side


def _to_segments(points: FloatArray, segments: FloatArray) -> FloatArray:
    """(n,) distances of a point (2,), or of points (n, 2), to segments (n, 2, 2)."""
    along = segments[:, 1] - segments[:, 0]
    share = np.clip(((points - segments[:, 0]) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    away: FloatArray = np.hypot(*(segments[:, 0] + share[:, None] * along - points).T)
    return away
