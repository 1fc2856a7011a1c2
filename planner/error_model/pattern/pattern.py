"""A calibration pattern: a trajectory of dots, each with a line beside it that tells the height of the tip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.error_model.believed import believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.pattern.candidates import Candidates, candidates
from planner.error_model.pattern.choice import chosen_marks
from planner.error_model.pattern.legs import RESTING, slowing_from_rest, straight_leg
from planner.error_model.pattern.touch import REACH_MM, Touch, ends_of, touch_line
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.redundancy.arm_model import ArmModel
from planner.trajectory import PATTERN, TRAVELLING, Trajectory

RATE_HZ = 100.0
_MARGIN_MM = 1.0
_POOL = 1200
_DWELL_S = 0.5
_APART_MM = 4.0
"""Between dots, and between a dot and another mark's line."""
_WAYS = np.array([[0.0, 1.0], [0.0, -1.0], [1.0, 0.0], [-1.0, 0.0]])


@dataclass(frozen=True, eq=False, slots=True)
class Pattern:
    """trajectory: stroke k is mark k. marks_mm: (m, 2) on the paper. touches: the line of each mark. mark_samples,
    zero_samples: (m,) the sample in the middle of each mark's dwell, and that at which its line begins if the tip is
    neither high nor low."""

    trajectory: Trajectory
    marks_mm: FloatArray
    touches: tuple[Touch, ...]
    mark_samples: IntArray
    zero_samples: IntArray


def make_pattern(arm: Arm, name: str, count: int, seed: int = 0) -> Pattern:
    """A pattern of `count` marks for `arm`, which its trajectory calls `name`. Errors: PlanError, ArmFileError."""
    random = np.random.default_rng(seed)
    model = ArmModel(arm)
    pool = candidates(model, _MARGIN_MM, _POOL, random)
    drawing = _Drawing(model.kinematics, model.limits, pool)
    parameters = Parameters.of(believed(arm), arm)
    chosen = chosen_marks(arm, parameters, pool, count, random, drawing.accepts)
    if len(chosen) < count:
        raise PlanError(f"arm {arm.name}: its canvas has room for {len(chosen)} marks, not for {count}")
    legs = [drawing.begin(chosen[0])]
    strokes = [np.full(len(legs[0]), TRAVELLING)]
    touches, middles, zeros = [], [], []
    for k, index in enumerate(chosen):
        before = chosen[k - 1] if k else None
        way, rest = np.split(drawing.way_to(before, index), [-RESTING])
        dwell = np.concatenate((rest, np.repeat(rest[-1:], round(_DWELL_S * RATE_HZ), axis=0)))
        touch, there, back = drawing.touch_of(index)
        begins = sum(map(len, legs)) + len(way) + len(dwell) + len(there)
        middles.append(sum(map(len, legs)) + len(way) + len(dwell) // 2)
        legs += [way, dwell, there, touch.joints, back]
        strokes += [
            np.full(len(way), TRAVELLING),
            np.full(len(dwell), k),
            np.full(len(there) + len(touch.joints) + len(back), TRAVELLING),
        ]
        touches.append(touch)
        zeros.append(begins + touch.zero)
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

    def __init__(self, kinematics: Kinematics, limits: Limits, pool: Candidates) -> None:
        self._kinematics, self._limits, self._pool = kinematics, limits, pool
        self._lift_mm = kinematics.arm.pen.lift_mm
        self._touches: dict[int, tuple[Touch, FloatArray, FloatArray] | None] = {}
        self._ways: dict[tuple[int | None, int], FloatArray | None] = {}

    def accepts(self, chosen: list[int], index: int) -> bool:
        """Whether a mark is clear of those chosen before, and can be drawn after the last of them."""
        if chosen and not self._is_clear(chosen, index):
            return False
        if index not in self._touches:
            self._touches[index] = self._touch(chosen, index)
        before = chosen[-1] if chosen else None
        if self._touches[index] is None:
            return False
        if (before, index) not in self._ways:
            self._ways[before, index] = self._way(before, index)
        return self._ways[before, index] is not None

    def begin(self, index: int) -> FloatArray:
        """(1, n_joints) where the pattern begins: above its first mark."""
        return self._kinematics.arm.complete(self._pool.raised[index])[None]

    def way_to(self, before: int | None, index: int) -> FloatArray:
        way = self._ways[before, index]
        assert way is not None
        return way

    def touch_of(self, index: int) -> tuple[Touch, FloatArray, FloatArray]:
        """The line of a mark, the way there from the mark, and the way up from its end; their first samples left out
        where they repeat the last one before."""
        touch = self._touches[index]
        assert touch is not None
        return touch

    def _is_clear(self, chosen: list[int], index: int) -> bool:
        here = self._pool.tips_mm[index]
        dots = self._pool.tips_mm[chosen]
        lines = np.array([(touch.begin_mm, touch.end_mm) for touch in (self.touch_of(k)[0] for k in chosen)])
        return bool(min(np.hypot(*(dots - here).T).min(), _to_segments(here, lines).min()) >= _APART_MM)

    def _touch(self, chosen: list[int], index: int) -> tuple[Touch, FloatArray, FloatArray] | None:
        kinematics, mark, free = self._kinematics, self._pool.tips_mm[index], self._pool.free[index]
        dots = self._pool.tips_mm[chosen]
        for way in _WAYS:
            ends = np.array(ends_of(mark, way))
            if len(dots) and min(_to_segments(dot, ends[None])[0] for dot in dots) < _APART_MM:
                continue
            touch = touch_line(kinematics, mark, free, way, RATE_HZ)
            if touch is None or slowing_from_rest(self._limits, touch.joints, RATE_HZ) > 1.0:
                continue
            there = self._there(index, touch)
            back = self._leg(
                (*touch.end_mm, -REACH_MM), (*touch.end_mm, self._lift_mm), touch.joints[-1], touch.joints[-1]
            )
            if there is not None and back is not None:
                return touch, there, back
        return None

    def _there(self, index: int, touch: Touch) -> FloatArray | None:
        mark = self._pool.tips_mm[index]
        complete = self._kinematics.arm.complete
        up = self._leg(
            (*mark, 0.0), (*mark, self._lift_mm), complete(self._pool.free[index]), complete(self._pool.raised[index])
        )
        if up is None:
            return None
        over = self._leg((*mark, self._lift_mm), (*touch.begin_mm, self._lift_mm), up[-1], up[-1])
        if over is None:
            return None
        down = self._leg((*touch.begin_mm, self._lift_mm), (*touch.begin_mm, REACH_MM), over[-1], touch.joints[0])
        return None if down is None else np.concatenate((up, over, down[:-1]))

    def _way(self, before: int | None, index: int) -> FloatArray | None:
        """From the end of the line of the mark before, or from above the mark, down onto the mark."""
        complete = self._kinematics.arm.complete
        mark, raised = self._pool.tips_mm[index], complete(self._pool.raised[index])
        down = self._leg((*mark, self._lift_mm), (*mark, 0.0), raised, complete(self._pool.free[index]))
        if down is None:
            return None
        if before is None:
            return down
        touch, _, back = self.touch_of(before)
        over = self._leg((*touch.end_mm, self._lift_mm), (*mark, self._lift_mm), back[-1], raised)
        return None if over is None else np.concatenate((over, down))

    def _leg(
        self, begin: tuple[float, ...], end: tuple[float, ...], first: FloatArray, last: FloatArray
    ) -> FloatArray | None:
        """A leg without its first sample, which is the last of the leg before."""
        free = self._kinematics.independent_of(np.stack((first, last)))
        leg = straight_leg(self._kinematics, self._limits, np.array([begin, end]), free, RATE_HZ)
        return None if leg is None else leg[1:]


def _to_segments(point: FloatArray, segments: FloatArray) -> FloatArray:
    """(n,) distances of a point (2,) to segments (n, 2, 2)."""
    along = segments[:, 1] - segments[:, 0]
    share = np.clip(((point - segments[:, 0]) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    away: FloatArray = np.hypot(*(segments[:, 0] + share[:, None] * along - point).T)
    return away
