"""From the polylines of strokes to joint samples: smooth pen paths, exact joint paths, and their timing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import JointPaths
from planner.inverse_kinematics.references import References
from planner.inverse_kinematics.stroke_configurations import (
    InfeasiblePath,
    colliding_paths,
    joint_paths,
    strays_mm,
)
from planner.kinematics.chain import Kinematics
from planner.motion.chord_error_limit import chord_error_limit
from planner.motion.held_motion import timed_within
from planner.motion.speed_limit import pen_speed_mm_s, rate_limit
from planner.motion.timed_stroke import Contact, TimedStroke
from planner.motion.tolerance import CHORD_SHARE, SPLINE_SHARE, STROKE_SHARE
from planner.motion.tube_radius import tube_radius
from planner.placement.pen_path import StrokePaths, smoothed
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings
from planner.timing.timing_problem import FRACTIONS

TIMING_SUBDIVISIONS = 1
"""How often the cells of a path are cut in two before it is timed: jerk switches at cell ends only, and cells as
long as the corners that they go round are too coarse for that."""
_CHANCE, _CHANCE_CELLS = 0.06, 300
"""How much further chords may cut than is allowed, where caps foresee it, on paths of up to so many cells; the longer a
path, the less. Few chords have their middle where they would cut most: a short path hardly has one, and is timed anew
if it has. A long one has some for sure."""
_FEW = 4
"""Configurations by which the arm's quickness is judged."""


def timed_lines(
    model: ArmModel, references: References, settings: PlanSettings, strokes: Sequence[FloatArray]
) -> list[TimedStroke | InfeasiblePath]:
    """Joint samples of each stroke (n > 1, 2), arm mm, or why it cannot be drawn."""
    kinematics, tolerance_mm = model.kinematics, settings.tolerance_mm
    paths, splines, infeasible_paths = followed(model, references, settings, strokes)
    if infeasible_paths:
        blocked = {infeasible_path.path: infeasible_path for infeasible_path in infeasible_paths}
        feasible = [stroke for index, stroke in enumerate(strokes) if index not in blocked]
        rest = iter(timed_lines(model, references, settings, feasible) if feasible else ())
        return [blocked[index] if index in blocked else next(rest) for index in range(len(strokes))]
    for _ in range(TIMING_SUBDIVISIONS):
        paths, splines = paths.subdivided(), splines.subdivided()
    speed_limit = pen_speed_limit(kinematics, paths, splines, settings)
    motions = timed_within(kinematics, model.limits, paths, splines, speed_limit, tolerance_mm, settings.rate_hz)
    collisions = colliding_paths(kinematics, [motion.joints for motion in motions])
    dwell = round(settings.dwell_s * settings.rate_hz)
    timed: list[TimedStroke | InfeasiblePath] = []
    for index, (stroke, motion, is_smooth) in enumerate(
        zip(strokes, motions, (paths.deviation_mm <= STROKE_SHARE * tolerance_mm).tolist(), strict=True)
    ):
        independent = kinematics.independent_of(motion.joints)
        timed.append(
            collisions.get(index)
            or TimedStroke(
                motion.joints,
                Contact(stroke[0], independent[0]),
                Contact(stroke[-1], independent[-1]),
                dwell,
                motion.converged,
                motion.held and is_smooth,
            )
        )
    return timed


def followed(
    model: ArmModel, references: References, settings: PlanSettings, strokes: Sequence[FloatArray]
) -> tuple[StrokePaths, JointPaths, list[InfeasiblePath]]:
    """Pen and joint paths of strokes before they are timed, and those that cannot be followed."""
    kinematics = model.kinematics
    room_mm = STROKE_SHARE * settings.tolerance_mm
    radius_mm = tube_radius(kinematics, _some_configurations(references, strokes), room_mm, settings.rate_hz)
    paths = smoothed(strokes, room_mm, radius_mm)
    splines, infeasible_paths = joint_paths(kinematics, references, paths.pen)
    if not infeasible_paths and strays_mm(kinematics, paths.pen, splines).max() > SPLINE_SHARE * settings.tolerance_mm:
        paths = paths.subdivided()
        splines, infeasible_paths = joint_paths(kinematics, references, paths.pen)
    return paths, splines, infeasible_paths


def _some_configurations(references: References, strokes: Sequence[FloatArray]) -> FloatArray:
    """(n, n_independent) where a few of the strokes begin."""
    begins = np.array([stroke[0] for stroke in strokes[:: max(len(strokes) // _FEW, 1)]])
    return references.at(np.column_stack((begins, np.zeros(len(begins)))))


def pen_speed_limit(
    kinematics: Kinematics, paths: StrokePaths, splines: JointPaths, settings: PlanSettings
) -> FloatArray:
    """(total cells, n_fractions) cap on dsigma/dt at FRACTIONS of every cell: the pen's own speed, and what keeps it
    near its stroke between samples."""
    speed_mm_s = pen_speed_mm_s(kinematics.arm, settings)
    chance = 1.0 + _CHANCE * np.minimum(1.0, _CHANCE_CELLS / paths.pen.n_cells)
    error_mm = chance * STROKE_SHARE * settings.tolerance_mm
    chords = rate_limit(paths, FRACTIONS, speed_mm_s, error_mm, settings.rate_hz)
    bulges = chord_error_limit(kinematics, splines, CHORD_SHARE * settings.tolerance_mm, settings.rate_hz)
    return np.minimum(chords, bulges[:, None])
