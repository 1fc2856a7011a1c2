"""The planner's timing beside COPP's TOPP3-SOCP on one smooth path in as many cells.

The path is Lissajous' figure of 1 : 2, an eight, on the arm's canvas. Both get the same joint curves: COPP over the
pen's arc length, from rest to rest, linearised about its TOPP2-RA solution and then once more about its own, as it
advises where that comes near zero; the planner over a sigma that the arc length follows with its cube near both ends.
No cap on the pen's speed.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from benchmarks.targets.row import Row, missing
from benchmarks.targets.strokes import UNROUNDED_HZ, problem_of
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.joint_path import interpolate
from planner.inverse_kinematics.references import references_of
from planner.inverse_kinematics.stroke_configurations import exact_configurations
from planner.kinematics.limits import Limits
from planner.motion.stroke_motion import motions
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings
from planner.timing.path_timing import minimum_time
from planner.timing.timing_problem import FRACTIONS
from planner.workspace.canvas import canvas_of

Value = TypeVar("Value")

_CELLS = 400
_RAMP = 6
_RUNS = 3
_COPP_UNITS = 10.0
"""Length of COPP's path parameter: over [0, 1] its solver sometimes makes too little progress."""


def against_copp(settings: PlanSettings) -> list[Row]:
    what = f"Lissajous figure in {_CELLS} cells against COPP's TOPP3-SOCP, same limits"
    targets = ("time of the trajectory ≤ 1.000 of COPP's", "time to compute ≤ 1/3 of COPP's")
    if absent := missing("copp_py", what, "; ".join(targets)):
        return [absent]
    arm = load_arm(settings.arm)
    limits = Limits.of(arm)
    curve = _lissajous(arm, settings)
    ours_s, ours_run_s = _planner(curve, limits)
    (once_s, once_run_s), (twice_s, twice_run_s) = _copp(curve, limits, 1), _copp(curve, limits, 2)
    return [
        Row(
            what + ": trajectory",
            targets[0],
            f"{ours_s:.4f} s; COPP {once_s:.4f} s in one pass, {twice_s:.4f} s in two:"
            f" {ours_s / min(once_s, twice_s):.4f} of the better",
            ours_s <= min(once_s, twice_s),
        ),
        Row(
            what + ": computing",
            targets[1],
            f"{1e3 * ours_run_s:.0f} ms; COPP {1e3 * once_run_s:.0f} ms in one pass, {1e3 * twice_run_s:.0f} ms in two:"
            f" 1/{once_run_s / ours_run_s:.1f} of one",
            ours_run_s <= once_run_s / 3,
        ),
    ]


def _lissajous(arm: Arm, settings: PlanSettings) -> BSpline[np.float64]:
    """Joints over the share s in [0, 1] of the pen's way."""
    model = ArmModel(arm, cache=False)
    canvas = canvas_of(model, settings.canvas, arm.pen.lift_mm)
    corners = canvas.to_arm_mm(np.array([[0.0, 0.0], [canvas.width_mm, canvas.height_mm]]))
    middle, half = corners.mean(axis=0), 0.4 * np.abs(corners[1] - corners[0])
    phase = np.linspace(0.1, 0.1 + 2 * np.pi, 20001)
    pen = middle + half * np.column_stack((np.sin(2 * phase), np.sin(phase)))
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(pen, axis=0).T))))
    share = np.linspace(0.0, 1.0, _CELLS + 1)
    at = make_interp_spline(way / way[-1], phase, k=5)(share)
    tips = np.column_stack((middle + half * np.column_stack((np.sin(2 * at), np.sin(at))), np.zeros(len(at))))
    references = references_of(model, settings.method, settings.weights).at(tips)
    independent, _ = exact_configurations(model.kinematics, references, tips)
    return make_interp_spline(share, arm.complete(independent), k=7)


def _planner(curve: BSpline[np.float64], limits: Limits) -> tuple[float, float]:
    """Duration, every limit kept between the cell ends as well, and time to compute it."""
    sigma = np.arange(_CELLS + 1.0)

    def ramp(distance: FloatArray) -> FloatArray:  # integral of x^2 (6 - 8 x + 3 x^2), then of 1
        x = np.minimum(distance / _RAMP, 1.0)
        return _RAMP * (2 * x**3 - 2 * x**4 + 0.6 * x**5) + np.maximum(distance - _RAMP, 0.0)

    way = ramp(sigma) + ramp(np.array([float(_CELLS)])) - ramp(_CELLS - sigma) - sigma
    cells, cap = np.array([_CELLS]), np.full((_CELLS, len(FRACTIONS)), np.inf)

    def plan() -> float:
        paths = interpolate(cells, curve(np.clip(way / way[-1], 0.0, 1.0)))
        motion = motions(paths, minimum_time(problem_of(paths, limits, cap)).rates, limits, UNROUNDED_HZ)
        return float(motion.n_periods[0]) / UNROUNDED_HZ

    return _best(plan)


def _copp(curve: BSpline[np.float64], limits: Limits, passes: int) -> tuple[float, float]:
    import copp_py as copp

    n_joints = len(limits.velocity)
    share = np.linspace(0.0, 1.0, _CELLS + 1)
    stations, count = _COPP_UNITS * share, len(share)

    def plan() -> float:
        robot = copp.Robot(n_joints, capacity=count)
        robot.append_s(stations)
        first, second, third = (curve(share, order) / _COPP_UNITS**order for order in (1, 2, 3))
        robot.set_q(curve(share), first, second, 0, dddq=third)
        for add, most in (
            (robot.add_velocity_limits, limits.velocity),
            (robot.add_acceleration_limits, limits.acceleration),
            (robot.add_jerk_limits, limits.jerk),
        ):
            add(most, -most, start_idx_s=0, length=count)
        without_jerk = copp.solver.topp2_ra.Problem(robot.constraints, (0, count - 1), (0.0, 0.0))
        problem = copp.solver.topp3_socp.Problem(robot.constraints, copp.solver.topp2_ra.solve(without_jerk))
        profile = copp.solver.topp3_socp.solve(problem)
        for _ in range(passes - 1):
            problem = copp.solver.topp3_socp.Problem(robot.constraints, profile.a, b_linearization=profile.b)
            profile = copp.solver.topp3_socp.solve(problem)
        return float(copp.interpolation.s_to_t_topp3(stations, profile)[0])

    return _best(plan)


def _best(run: Callable[[], Value]) -> tuple[Value, float]:
    """The result, and the shortest of a few runs in s."""
    times = []
    for _ in range(_RUNS):
        began = time.perf_counter()
        result = run()
        times.append(time.perf_counter() - began)
    return result, min(times)
