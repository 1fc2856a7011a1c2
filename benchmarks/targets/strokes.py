"""The strokes of a drawing as the planner draws them, and their timing, stroke by stroke.

The only door to the planner's own steps, so that all rows measure the same paths with the same limits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from planner import pipeline
from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.execution import work_chunks
from planner.execution.context import PlanContext
from planner.inverse_kinematics.joint_path import JointPaths
from planner.inverse_kinematics.references import references_of
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.motion import line
from planner.motion.speed_limit import pen_speed_mm_s
from planner.motion.stroke_motion import StrokeMotions, motions
from planner.placement.pen_path import StrokePaths
from planner.ragged import starts_of
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings
from planner.spline_paths import DEGREE
from planner.timing.path_timing import minimum_time
from planner.timing.timing_problem import FRACTIONS, TimingProblem

UNROUNDED_HZ = 1e4
"""A sample rate at which rounding up to whole periods is next to nothing, and minutes are no more samples than a plan
may have."""

_NO_CAP = 1e9


@dataclass(frozen=True, eq=False, slots=True)
class TimedPaths:
    """Pen and joint paths of many strokes in the cells that they are timed with.

    cap: (total cells, 5) on dsigma/dt at FRACTIONS of each cell; time_s: (n_paths,), all limits kept between the cell
    ends as well, not rounded to sample periods.
    """

    paths: StrokePaths
    joints: JointPaths
    cap: FloatArray
    limits: Limits
    motion: StrokeMotions
    time_s: FloatArray

    def single(self, path: int) -> SinglePath:
        return _single(self.joints, self.cap, self.limits, path, float(self.time_s[path]))


@dataclass(frozen=True, eq=False, slots=True)
class SinglePath:
    """One joint path over sigma in [0, n_cells], with the cap (n_cells, 5) on dsigma/dt and the planner's time."""

    joints: JointPaths
    cap: FloatArray
    limits: Limits
    time_s: float

    @property
    def n_cells(self) -> int:
        return int(self.joints.n_cells[0])

    def derivative(self, sigma: FloatArray, order: int) -> FloatArray:
        """(n, n_joints)"""
        cell: IntArray = np.clip(sigma.astype(np.int64), 0, self.n_cells - 1)
        return self.joints.at(cell, sigma - cell, order)

    def cap_at(self, sigma: FloatArray) -> FloatArray:
        """(n,) the cap between the FRACTIONS, joined by straight lines."""
        shared = np.minimum(self.cap[1:, 0], self.cap[:-1, -1])  # where cells meet
        cap = np.concatenate(
            (self.cap[:1, 0], np.column_stack((self.cap[:-1, 1:-1], shared)).ravel(), self.cap[-1, 1:])
        )
        return np.interp(sigma, np.linspace(0.0, self.n_cells, len(cap)), np.minimum(cap, _NO_CAP))


def drawings(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.svg"))


def placed_strokes(drawing_file: Path, arm: Arm, settings: PlanSettings) -> list[FloatArray]:
    """Polylines (n, 2) in arm mm in drawing order; taps have one point."""
    return pipeline.placed_strokes(drawing_file, ArmModel(arm, cache=False), settings)[0]


def lines(strokes: Sequence[FloatArray], longer_than_mm: float = 0.0) -> list[FloatArray]:
    return [stroke for stroke in strokes if len(stroke) > 1 and length_mm(stroke) > longer_than_mm]


def length_mm(stroke: FloatArray) -> float:
    return float(np.hypot(*np.diff(stroke, axis=0).T).sum())


def followed(
    arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings
) -> tuple[StrokePaths, JointPaths, list[InfeasiblePath]]:
    """Pen and joint paths of polylines, and those that cannot be followed, before timing."""
    model = ArmModel(arm, cache=False)
    return line.followed(model, references_of(model, settings.method, settings.weights), settings, strokes)


def timed(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> TimedPaths:
    """The planner's timing of polylines, those that cannot be followed as well."""
    paths, joints, _ = followed(arm, strokes, settings)
    for _ in range(line.TIMING_SUBDIVISIONS):
        paths, joints = paths.subdivided(), joints.subdivided()
    limits = Limits.of(arm)
    return _timed(paths, joints, line.pen_speed_limit(Kinematics(arm), paths, joints, settings), limits)


def _timed(paths: StrokePaths, joints: JointPaths, cap: FloatArray, limits: Limits) -> TimedPaths:
    motion = motions(joints, minimum_time(problem_of(joints, limits, cap)).rates, limits, UNROUNDED_HZ)
    return TimedPaths(paths, joints, cap, limits, motion, motion.n_periods / UNROUNDED_HZ)


def untimed(context: PlanContext, strokes: Sequence[FloatArray]) -> list[SinglePath]:
    """Their paths at the rate of the settings, for others to time; time_s: what they take at the pen's cap."""
    settings, kinematics = context.settings, context.model.kinematics
    paths, joints, _ = line.followed(context.model, context.references, settings, strokes)
    for _ in range(line.TIMING_SUBDIVISIONS):
        paths, joints = paths.subdivided(), joints.subdivided()
    cap = line.pen_speed_limit(kinematics, paths, joints, settings)
    usual_s = np.array([length_mm(stroke) for stroke in strokes]) / pen_speed_mm_s(kinematics.arm, settings)
    return [_single(joints, cap, context.model.limits, path, float(usual_s[path])) for path in range(len(strokes))]


def _single(joints: JointPaths, cap: FloatArray, limits: Limits, path: int, time_s: float) -> SinglePath:
    cells, controls = starts_of(joints.n_cells), starts_of(joints.n_cells + DEGREE)
    own = JointPaths(joints.n_cells[path : path + 1], joints.controls[controls[path] : controls[path + 1]])
    return SinglePath(own, cap[cells[path] : cells[path + 1]], limits, time_s)


def timed_in_chunks(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> list[TimedPaths]:
    """The same in the work chunks and pieces that the planner makes of them."""
    context = PlanContext.of(arm, settings)
    cut = work_chunks.stroke_chunks(context, list(chain.from_iterable(work_chunks.pieces_of(context, strokes))))
    return [timed(arm, chunk.strokes, settings) for chunk in cut]


def problem_of(joints: JointPaths, limits: Limits, cap: FloatArray) -> TimingProblem:
    derivatives = (joints.positions(FRACTIONS, 1), joints.positions(FRACTIONS, 2), joints.positions(FRACTIONS, 3))
    return TimingProblem.of(joints.n_cells, derivatives, limits, cap)
