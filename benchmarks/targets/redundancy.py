"""How good the choice of postures is: against dense searches, along the radius and along single strokes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.targets.postures import reversals
from benchmarks.targets.row import Row
from benchmarks.targets.strokes import length_mm, lines, placed_strokes
from planner.arms.arm_file import load_arm
from planner.arms.posture_cost import PostureCost
from planner.arms.posture_course import cheapest_course, course_cost, polished_course
from planner.arms.posture_field import PostureField, choice_of_postures, posture_field, sharp_course
from planner.arms.posture_samples import on_ray
from planner.arms.posture_tests import usable_postures
from planner.arms.projection import Pins, project
from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.settings import PlanSettings

_STROKES, _LONGER_THAN_MM = 20, 12.0
_STATION_MM = 1.0
_SPACING_DEG = 1.0
_REFERENCES = 3


@dataclass(frozen=True, slots=True)
class Design:
    """Mean cost of a millimetre, and how the joints fare, of the strokes together."""

    cost: float
    sideways_mm_rad: float
    reversals: int


def against_brute_force(drawing: Path, settings: PlanSettings) -> list[Row]:
    """The field's course against a dense search over all postures of the ray; and, the price of the same posture at the
    same place, the field along short strokes against a dense search for each of them."""
    arm = load_arm(settings.arm)
    cost, radii, samples = choice_of_postures(arm, settings.weights)
    nodes, sharp = sharp_course(cost, radii, samples)
    field = posture_field(arm, settings.weights)
    pool = np.concatenate(samples)
    dense = best_of_dense(cost, nodes, on_ray(nodes), pool)
    ours, rounded, brute = (course_cost(cost, nodes, course) for course in (sharp, field.postures, dense))
    rows = [Row("redundancy optimum, the field's course against a dense search over all postures of the ray",
                "within 0.5 %", f"cost {ours:.3f} against {brute:.3f}: {ours / brute - 1:+.2%}"
                f" ({rounded / brute - 1:+.2%} once its corners are rounded)", ours <= 1.005 * brute)]
    strokes = sorted(lines(placed_strokes(drawing, arm, settings), _LONGER_THAN_MM), key=length_mm)[:_STROKES]
    designs = per_stroke_designs(cost, field, pool, strokes)
    base = designs["field"]
    told = "; ".join(f"{name}: cost {one.cost / base.cost - 1:+.1%}, sensitivity"
                     f" {one.sideways_mm_rad / base.sideways_mm_rad - 1:+.1%}, reversals {one.reversals}"
                     for name, one in designs.items() if name != "field")
    rows.append(Row(f"postures chosen for each of {len(strokes)} short strokes by itself, against the field",
                    "report: the price of the same posture at the same place",
                    f"field: cost {base.cost:.3f}, reversals {base.reversals}; {told}"))
    return rows


def per_stroke_designs(cost: PostureCost, field: PostureField, pool: FloatArray, strokes: list[FloatArray]
                       ) -> dict[str, Design]:
    """The same strokes by the field, by a dense search for each, and by the field polished for each."""
    courses: dict[str, list[tuple[FloatArray, FloatArray]]] = {"field": [], "per stroke": [], "both": []}
    for stroke in strokes:
        along, tips = stations(stroke)
        start, _ = project(cost.kinematics, field.reference(tips), tips)
        courses["field"].append((along, start))
        courses["per stroke"].append((along, best_of_dense(cost, along, tips, pool)))
        courses["both"].append((along, polished_course(cost, along, tips, start)))
    return {name: _design(cost, each) for name, each in courses.items()}


def stations(stroke: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n,) ways along a polyline and (n, 3) its points there, evenly spaced."""
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
    along = np.linspace(0.0, way[-1], int(np.ceil(way[-1] / _STATION_MM)) + 1)
    x, y = (np.interp(along, way, column) for column in stroke.T)
    return along, np.column_stack((x, y, np.zeros(len(along))))


def best_of_dense(cost: PostureCost, along_mm: FloatArray, tips_mm: FloatArray, pool: FloatArray) -> FloatArray:
    """(n, n_free) the cheapest course through all usable postures in which a joint is at a whole degree (or mm), found
    from several references at each tip; polished like ours, so that the grid costs nothing."""
    reached, course = cheapest_course(cost, along_mm, [_all_postures(cost, tip, pool) for tip in tips_mm])
    if len(reached) < len(along_mm):
        raise PlanError("the dense search found no course over the whole way")
    return polished_course(cost, along_mm, tips_mm, course)


def _all_postures(cost: PostureCost, tip_mm: FloatArray, pool: FloatArray) -> FloatArray:
    """(m, n_free) usable postures at one tip with one joint at each multiple of the spacing in turn."""
    kinematics, arm = cost.kinematics, cost.kinematics.arm
    matrix, constant = arm.coupling_matrix
    radius = float(np.hypot(*tip_mm[:2]))
    task, _ = kinematics.task_and_jacobian(pool)
    near = pool[np.argsort(np.abs(np.hypot(task[:, 0], task[:, 1]) - radius), kind="stable")[:60]].copy()
    near = near[np.linspace(0, len(near) - 1, _REFERENCES).astype(int)]
    near[:, 0] += np.arctan2(tip_mm[1], tip_mm[0])
    found = [np.empty((0, kinematics.n_free))]
    for joint in range(1, arm.n_joints):
        spacing = _SPACING_DEG * arm.per_file_unit[joint]
        values = np.arange(np.ceil(arm.minimum[joint] / spacing), arm.maximum[joint] / spacing) * spacing
        start = np.repeat(near, len(values), axis=0)
        postures, exact = project(
            kinematics, start, np.tile(tip_mm, (len(start), 1)), iterations=12,
            pins=Pins(np.tile(matrix[joint], (len(start), 1)), np.tile(values - constant[joint], len(near))))
        postures = postures[exact]
        found.append(postures[usable_postures(kinematics, postures)])
    _, first = np.unique(np.round(np.concatenate(found), 6), axis=0, return_index=True)
    return np.concatenate(found)[np.sort(first)]


def _design(cost: PostureCost, courses: list[tuple[FloatArray, FloatArray]]) -> Design:
    arm = cost.kinematics.arm
    weights = np.array([along[-1] for along, _ in courses])
    costs = np.array([course_cost(cost, along, course) for along, course in courses])
    joints = [arm.complete(course) for _, course in courses]
    square = [float((cost.kinematics.jacobian(each)[:, :2] ** 2).sum(axis=(1, 2)).mean()) / arm.n_joints
              for each in joints]
    return Design(float(weights @ costs / weights.sum()), float(np.sqrt(weights @ np.array(square) / weights.sum())),
                  sum(reversals(each / arm.per_file_unit) for each in joints))
