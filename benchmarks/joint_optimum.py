"""Strokes of a drawing against an independent optimum of path and timing together, and what art takes to draw.

    python benchmarks/joint_optimum.py optimum DRAWING.svg --strokes 8
    python benchmarks/joint_optimum.py art FOLDER --rate 100

For each stroke one nonlinear program (Ipopt): the pen's position, velocity and acceleration at the ends of cells, the
jerk of each cell, constant, and the length of the cells of each segment of the stroke are unknown; the pen stays within
the tolerance of its segment, and passes each vertex within it; the joints' limits hold at the ends and in the middle of
cells, by a polynomial of the configurations around the stroke. None of the planner's splines, tubes or timings takes
part: the planner's motion is where the search starts. Bounds are a little wider than the tolerance at vertices, so
optima may be a little too short.
"""

from __future__ import annotations

import argparse
import resource
import sys
from dataclasses import replace
from pathlib import Path

import casadi
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.targets.strokes import length_mm, lines, placed_strokes
from planner import check
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.inverse_kinematics.stroke_configurations import exact_configurations
from planner.motion.line import timed_lines
from planner.motion.timed_stroke import TimedStroke
from planner.motion.tolerance import STROKE_SHARE
from planner.settings import PlanSettings

_CELL_S = 0.008
_FEWEST_CELLS, _MOST_CELLS = 3, 220
_MOST_S = 40.0
"""Processor time that a stroke's program may take."""
_DEGREE = 5
_BEYOND = 0.7
"""How far the pen may go past the end of a segment while it draws that segment, in tolerances."""


def joint_optimum(context: PlanContext, stroke: FloatArray, planned: TimedStroke) -> float | None:
    """Seconds of the optimum, or None where Ipopt does not find one."""
    settings, limits, kinematics = context.settings, context.model.limits, context.model.kinematics
    room_mm = STROKE_SHARE * settings.tolerance_mm
    tips = kinematics.tip_mm(kinematics.independent_of(planned.joints))[:, :2]
    time = np.arange(len(tips)) / settings.rate_hz
    steps = np.diff(stroke, axis=0)
    lengths = np.hypot(*steps.T)
    along, across = steps / lengths[:, None], np.column_stack((-steps[:, 1], steps[:, 0])) / lengths[:, None]

    passed = [0.0]  # when the planned motion is nearest to each vertex
    for vertex in stroke[1:-1]:
        begin = int(np.searchsorted(time, passed[-1]))
        window = tips[begin : begin + 400]
        gap = np.hypot(*(window - vertex).T)
        near = np.flatnonzero(gap < 2 * settings.tolerance_mm)
        stop = near[0] + np.flatnonzero(np.append(gap[near[0] :], np.inf) >= 2 * settings.tolerance_mm)[0]
        passed.append(float(time[begin + near[0] + int(np.argmin(gap[near[0] : stop]))]))
    passed.append(float(time[-1]))
    spans = np.maximum(np.diff(passed), 1e-3)
    counts = np.maximum(np.ceil(spans / _CELL_S).astype(int), _FEWEST_CELLS)
    if counts.sum() > _MOST_CELLS:
        return None
    segment = np.repeat(np.arange(len(counts)), counts)
    guess_h = spans / counts
    nodes_s = np.concatenate(([0.0], np.cumsum(guess_h[segment])))

    middle, half = 0.5 * (stroke.min(0) + stroke.max(0)), 0.5 * np.ptp(stroke, axis=0).max() + 1.0
    joints_of = _configurations(context, middle, half)
    state = casadi.SX.sym("state", 8)  # position, velocity, acceleration, jerk
    t = casadi.SX.sym("t")
    x, dx, d2x, d3x = (state[2 * k : 2 * k + 2] for k in range(4))
    moved = joints_of((x + dx * t + d2x * t**2 / 2 + d3x * t**3 / 6 - middle) / half)
    rates, form = [], moved
    for limit in (limits.velocity, limits.acceleration, limits.jerk):
        form = casadi.jacobian(form, t)
        rates.append(casadi.substitute(form, t, 0) / limit)
    shares = casadi.Function("shares", [state], [casadi.vertcat(*rates)])

    n = len(segment)
    X, U, H = casadi.MX.sym("X", 6, n + 1), casadi.MX.sym("U", 2, n), casadi.MX.sym("H", len(counts))
    h = casadi.vertcat(*[H[int(k)] for k in segment]).T
    h = casadi.repmat(h, 2, 1)
    p, v, a = (X[2 * k : 2 * k + 2, :] for k in range(3))

    def after(part: float) -> tuple[casadi.MX, casadi.MX, casadi.MX]:
        s = part * h
        return (
            p[:, :-1] + v[:, :-1] * s + a[:, :-1] * s**2 / 2 + U * s**3 / 6,
            v[:, :-1] + a[:, :-1] * s + U * s**2 / 2,
            a[:, :-1] + U * s,
        )

    g, low, high = [], [], []

    def bounded(form: casadi.MX, least: float | FloatArray, most: float | FloatArray) -> None:
        flat = casadi.vec(form)
        g.append(flat)
        low.append(np.broadcast_to(least, flat.shape[0]))
        high.append(np.broadcast_to(most, flat.shape[0]))

    end = casadi.vertcat(*after(1.0))
    bounded(X[:, 1:] - end, 0.0, 0.0)
    pen_mm_s = settings.speed_mm_s or context.model.arm.pen.speed_mm_s
    for where in (casadi.vertcat(X[:, :-1], U), casadi.vertcat(*after(0.5), U), casadi.vertcat(end, U)):
        bounded(shares.map(n)(where), -1.0, 1.0)
        bounded(where[2, :] ** 2 + where[3, :] ** 2, 0.0, pen_mm_s**2)
    for point in (p[:, :-1], after(0.5)[0], p[:, 1:]):
        from_begin = point - stroke[segment].T
        bounded(casadi.sum1(from_begin * across[segment].T), -room_mm, room_mm)
        reach = casadi.sum1(from_begin * along[segment].T)
        bounded(reach, -_BEYOND * room_mm, lengths[segment] + _BEYOND * room_mm)
    bounded(X[:, 0], np.r_[stroke[0], np.zeros(4)], np.r_[stroke[0], np.zeros(4)])
    bounded(X[:, n], np.r_[stroke[-1], np.zeros(4)], np.r_[stroke[-1], np.zeros(4)])
    for vertex, node in zip(stroke[1:-1], np.cumsum(counts)[:-1].tolist(), strict=True):
        off = X[:2, node] - vertex
        bounded(casadi.sumsqr(off), 0.0, room_mm**2)

    rate = settings.rate_hz
    derivatives = [tips, *(np.gradient(tips, 1 / rate, axis=0),)]
    derivatives.append(np.gradient(derivatives[1], 1 / rate, axis=0))
    x0 = np.column_stack([np.interp(nodes_s, time, column) for part in derivatives for column in part.T])
    u0 = np.diff(x0[:, 4:], axis=0) / guess_h[segment][:, None]
    unknowns = casadi.vertcat(casadi.vec(X), casadi.vec(U), H)
    total = casadi.sum1(H * counts)
    solver = casadi.nlpsol(
        "joint",
        "ipopt",
        {"x": unknowns, "f": total, "g": casadi.vertcat(*g)},
        {
            "ipopt": {
                "print_level": 0,
                "sb": "yes",
                "max_iter": 1500,
                "max_cpu_time": _MOST_S,
                "tol": 1e-6,
                "linear_solver": "mumps",
            },
            "print_time": 0,
        },
    )
    size = 6 * (n + 1) + 2 * n
    found = solver(
        x0=np.r_[x0.ravel(), u0.ravel(), guess_h],
        lbx=np.r_[np.full(size, -np.inf), np.full(len(counts), 1e-4)],
        ubx=np.r_[np.full(size, np.inf), np.full(len(counts), 1.0)],
        lbg=np.concatenate(low),
        ubg=np.concatenate(high),
    )
    return float(found["f"]) if solver.stats()["success"] else None


def _configurations(context: PlanContext, middle_mm: FloatArray, half_mm: float):  # type: ignore[no-untyped-def]
    """Joint positions as a polynomial of a point, scaled to -1..1 around the middle."""
    powers = [(i, j) for i in range(_DEGREE + 1) for j in range(_DEGREE + 1 - i)]
    grid = np.stack(np.meshgrid(*2 * [np.cos(np.pi * (np.arange(14) + 0.5) / 14)]), axis=-1).reshape(-1, 2)
    tips = np.column_stack((middle_mm + half_mm * grid, np.zeros(len(grid))))
    kinematics = context.model.kinematics
    independent, failed = exact_configurations(kinematics, context.references.at(tips), tips)
    good = np.setdiff1d(np.arange(len(grid)), [one.path for one in failed])
    table = np.column_stack([grid[good, 0] ** i * grid[good, 1] ** j for i, j in powers])
    joints = context.model.arm.complete(independent[good])
    factors, *_ = np.linalg.lstsq(table, joints, rcond=None)
    error = np.abs(table @ factors - joints).max()
    if error > 1e-4:
        print(f"  configurations known to {error:.1e} only", file=sys.stderr)
    return lambda x: casadi.DM(factors.T) @ casadi.vertcat(*[x[0] ** i * x[1] ** j for i, j in powers])


def compare_strokes(drawing: Path, settings: PlanSettings, count: int, most_vertices: int) -> None:
    arm = load_arm(settings.arm)
    context = PlanContext.of(arm, settings)
    strokes = [s for s in lines(placed_strokes(drawing, arm, settings), 2.0) if len(s) <= most_vertices]
    strokes = strokes[:: max(len(strokes) // count, 1)][:count]
    ours = optimal = 0.0
    for stroke, planned in zip(strokes, timed_lines(context.model, context.references, settings, strokes), strict=True):
        assert isinstance(planned, TimedStroke)
        time_s = (len(planned.joints) - 1) / settings.rate_hz
        best_s = joint_optimum(context, stroke, planned)
        told = "no optimum found" if best_s is None else f"{best_s:.4f} s, {time_s / best_s:.3f} of it"
        print(f"{len(stroke)} points, {length_mm(stroke):.1f} mm: {time_s:.4f} s; optimum {told}", flush=True)
        if best_s is not None:
            ours, optimal = ours + time_s, optimal + best_s
    print(f"together {ours:.3f} s, optimum {optimal:.3f} s: {ours / optimal:.3f}")


def art(folder: Path, settings: PlanSettings) -> None:
    """A line for each drawing: pen-down and total time, processor time, and how much of the tolerance is used."""
    from planner import plan

    for file in sorted(folder.glob("*.svg")):
        before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
        planned = plan(file, settings=settings)
        processor_s = resource.getrusage(resource.RUSAGE_SELF).ru_utime - before
        trajectory = planned.trajectory
        down_s = float(trajectory.pen.sum()) / trajectory.rate_hz
        result = check(trajectory, drawing=file, tolerance_mm=settings.tolerance_mm)
        used = max(
            (f.worst for f in result.findings if f.check in ("nothing extra", "nothing missing") and f.worst),
            default=0.0,
        )
        print(
            f"{file.stem:24} pen down {down_s:8.1f} s, total {trajectory.n_samples / trajectory.rate_hz:8.1f} s,"
            f" processor {processor_s:6.1f} s, {used / settings.tolerance_mm:.2f} of the tolerance,"
            f" {'passed' if result.passed else 'FAILED'}",
            flush=True,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("optimum", "art"))
    parser.add_argument("path", type=Path)
    parser.add_argument("--rate", type=float, default=1000.0)
    parser.add_argument("--tolerance", type=float, default=0.05)
    parser.add_argument("--arm", default="drawing_arm")
    parser.add_argument("--strokes", type=int, default=8)
    parser.add_argument("--most-vertices", type=int, default=25)
    options = parser.parse_args()
    settings = replace(PlanSettings(), arm=options.arm, rate_hz=options.rate, tolerance_mm=options.tolerance)
    if options.what == "optimum":
        compare_strokes(options.path, settings, options.strokes, options.most_vertices)
    else:
        art(options.path, settings)


if __name__ == "__main__":
    main()
