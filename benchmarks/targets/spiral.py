"""An elliptic spiral through 6000 rounded points beside an independent optimum: the smoothest path within the
tolerance, and the third-order optimum along it.

The smoothest path: a quintic spline of few knots whose third derivative over the turn is least in the mean square, each
point no further than the tolerance aside of it (a quadratic program, Ipopt). Its configurations are those of the arm's
map. The least time along it within velocity, acceleration and jerk limits: the program of `fine_nlp`. Nothing of the
planner's paths, tubes or timings takes part.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import casadi
import numpy as np
from scipy.interpolate import BSpline

from benchmarks.targets.fine_nlp import least_time_s
from benchmarks.targets.row import Row
from benchmarks.targets.strokes import SinglePath, length_mm, placed_strokes
from planner import pipeline
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.inverse_kinematics.joint_path import interpolate
from planner.inverse_kinematics.stroke_configurations import exact_configurations
from planner.settings import PlanSettings
from planner.timing.timing_problem import FRACTIONS

_POINTS, _TURNS = 6000, 20
_RADII_MM = (4.0, 25.0)
_FLATNESS = 0.7
_SPEED_MM_S, _RATE_HZ = 5000.0, 1000.0
_DEGREE = 5
_KNOTS_A_TURN = 40
_ALONG = 20.0
"""How far a point may be along the path from its own place, in tolerances: it is beside the path that counts."""
_CELLS = 2500
_RAMP = 10
"""Cells at either end over which the way grows as the cube of what the cells are counted by."""


def against_optimum(settings: PlanSettings) -> list[Row]:
    asked = replace(settings, tolerance_mm=0.05, speed_mm_s=_SPEED_MM_S, rate_hz=_RATE_HZ)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "spiral.svg"
        file.write_text(_svg())
        ours_s = pipeline.plan(file, asked, lambda *_: None).summary.phases.drawing_s
        (stroke,) = placed_strokes(file, load_arm(asked.arm), asked)
    least_s = least_time_s(_joint_path(smoothest(stroke, asked.tolerance_mm), asked), finer=1)
    return [
        Row(
            f"elliptic spiral of {_POINTS} points, `--speed {_SPEED_MM_S:g} --rate {_RATE_HZ:g}`, against the"
            " third-order optimum on the smoothest path within the tolerance",
            "≤ 1.03",
            f"{ours_s:.3f} s, optimum {least_s:.3f} s: {ours_s / least_s:.3f}",
            bool(ours_s <= 1.03 * least_s) if np.isfinite(least_s) else None,
        )
    ]


def smoothest(stroke: FloatArray, tolerance_mm: float) -> BSpline[np.float64]:
    """A spline over [0, 1] from end to end of points (n, 2) that are evenly spaced in it."""
    at = np.linspace(0.0, 1.0, len(stroke))
    inner = np.linspace(0.0, 1.0, _KNOTS_A_TURN * _TURNS + 1)
    knots = np.concatenate((_DEGREE * [0.0], inner, _DEGREE * [1.0]))
    n_controls = len(knots) - _DEGREE - 1
    value = casadi.DM(BSpline.design_matrix(at, knots, _DEGREE).tocsc())
    fine = np.linspace(0.0, 1.0, 4 * len(inner))
    third = casadi.DM(BSpline(knots, np.eye(n_controls), _DEGREE)(fine, nu=3) / (2 * np.pi * _TURNS) ** 3)
    along = np.gradient(stroke, axis=0)
    along /= np.hypot(*along.T)[:, None]
    controls = casadi.SX.sym("controls", n_controls, 2)
    off = casadi.mtimes(value, controls) - stroke
    beside = -along[:, 1] * off[:, 0] + along[:, 0] * off[:, 1]
    behind = along[:, 0] * off[:, 0] + along[:, 1] * off[:, 1]
    room = np.full(len(stroke), tolerance_mm)
    room[[0, -1]] = 0.0
    most = np.concatenate((room, _ALONG * room))
    solver = casadi.nlpsol(
        "smoothest",
        "ipopt",
        {
            "x": casadi.vec(controls),
            "f": casadi.sumsqr(casadi.mtimes(third, controls)) / len(fine),
            "g": casadi.vertcat(beside, behind),
        },
        {"ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-8, "linear_solver": "mumps"}, "print_time": 0},
    )
    near = np.column_stack([np.interp(np.linspace(0.0, 1.0, n_controls), at, column) for column in stroke.T])
    found = solver(x0=near.ravel(order="F"), lbg=-most, ubg=most)
    if not solver.stats()["success"]:
        raise RuntimeError("no smoothest path was found")
    return BSpline(knots, np.asarray(found["x"]).reshape(n_controls, 2, order="F"), _DEGREE)


def _joint_path(path: BSpline[np.float64], settings: PlanSettings) -> SinglePath:
    """Its joints in cells of even way, but for a ramp at both ends."""
    context = PlanContext.of(load_arm(settings.arm), settings)
    dense = np.linspace(0.0, 1.0, 100 * _CELLS)
    pen = path(dense)
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(pen, axis=0).T))))
    sigma = np.arange(_CELLS + 1.0)
    ramped = _ramped(sigma) + _ramped(np.array([float(_CELLS)])) - _ramped(_CELLS - sigma) - sigma
    parameter = np.interp(ramped / ramped[-1], way / way[-1], dense)
    tips = np.column_stack((path(parameter), np.zeros(len(sigma))))
    kinematics = context.model.kinematics
    independent, _ = exact_configurations(kinematics, context.references.at(tips), tips)
    joints = interpolate(np.array([_CELLS]), context.model.arm.complete(independent))
    cap = np.full((_CELLS, len(FRACTIONS)), np.inf)
    return SinglePath(joints, cap, context.model.limits, length_mm(path(parameter)) / 100.0)


def _ramped(distance: FloatArray) -> FloatArray:
    """The integral of x² (6 - 8 x + 3 x²), then of 1."""
    x = np.minimum(distance / _RAMP, 1.0)
    return _RAMP * (2 * x**3 - 2 * x**4 + 0.6 * x**5) + np.maximum(distance - _RAMP, 0.0)


def _svg() -> str:
    turn = np.linspace(0.0, 2 * np.pi * _TURNS, _POINTS)
    size = np.linspace(*_RADII_MM, _POINTS)
    points = 30.0 + size[:, None] * np.column_stack((_FLATNESS * np.cos(turn), np.sin(turn)))
    listed = " ".join(f"{x:.4f},{y:.4f}" for x, y in points.tolist())
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="0 0 60 60" fill="none"'
        f' stroke="black"><polyline points="{listed}"/></svg>'
    )
