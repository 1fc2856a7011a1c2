"""The phase plane of a stroke: the pen's speed over its way, under what the joints allow along that path."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.plots.look import LIMIT_DASHES, USUAL, Look
from planner.plots.samples import min_max_envelope, require_joints
from planner.plots.sheet import Sheet
from planner.plots.speed_limits import PathSpeeds, path_speeds
from planner.trajectory import Trajectory

_LEFT, _BOTTOM, _RIGHT, _HEIGHT = 5.4, 4.2, 1.8, 30.0  # em
_N_BINS = 1500
_VIEW, _FARTHEST_VIEW = (1.5, 4.0), 12.0  # times the greatest speed


def plot_phase_plane(
    trajectory: Trajectory, arm: Arm, tip_mm: FloatArray, stroke: int | None = None, look: Look = USUAL
) -> Figure:
    """Speed along the path over the way of the pen on it, with the velocity limit curve, beyond which is tinted, and
    the acceleration limit curve. stroke: its index; None for the one that takes longest.

    Errors: UsageError where the trajectory's joints are not the arm's, or where there is no such stroke, or the pen
    only taps.
    """
    require_joints(trajectory, arm)
    index = _longest(trajectory) if stroke is None else stroke
    samples = np.flatnonzero(trajectory.stroke == index)
    if not len(samples):
        raise UsageError(f"there is no stroke {index}: {_strokes_of(trajectory)}")
    speeds = path_speeds(arm, arm.from_file_units(trajectory.positions[samples]), tip_mm[samples], trajectory.rate_hz)
    if len(speeds.way_mm) < 2:
        raise UsageError(f"stroke {index} is a tap: the pen does not move on the paper")
    colours = look.colours
    with look.style():
        sheet = Sheet(look)
        axes = sheet.panel(_LEFT, _BOTTOM, sheet.width - _LEFT - _RIGHT, _HEIGHT)
        top = _top(speeds)
        limit_mm, limit = min_max_envelope(speeds.way_mm, speeds.velocity_limit_mm_s, _N_BINS)
        axes.fill_between(limit_mm, np.minimum(limit, 10 * top), 10 * top, color=colours.limit, alpha=0.13, linewidth=0)
        axes.plot(
            limit_mm,
            limit,
            color=colours.limit,
            linewidth=0.9,
            linestyle=LIMIT_DASHES,
            zorder=3.5,
            label="velocity limit curve",
        )
        axes.plot(
            *min_max_envelope(speeds.acceleration_way_mm, speeds.acceleration_limit_mm_s, _N_BINS),
            color=colours.lifting,
            linewidth=0.8,
            zorder=2.5,
            label="acceleration limit curve",
        )
        axes.plot(
            *min_max_envelope(speeds.way_mm, speeds.speed_mm_s, _N_BINS),
            color=colours.drawn,
            linewidth=1.2,
            zorder=3,
            label="speed of the pen",
        )
        axes.set_xlim(0.0, float(speeds.way_mm[-1]))
        axes.set_ylim(0.0, top)
        axes.set_xlabel("way of the pen in the stroke (mm)")
        axes.set_ylabel("speed along the path (mm/s)")
        begin, end = samples[[0, -1]] / trajectory.rate_hz
        use = speeds.speed_mm_s / speeds.velocity_limit_mm_s
        nearest = int(np.argmax(use))
        remark = (
            f"stroke {index}, {begin:.2f} to {end:.2f} s on {arm.name}; nearest to its velocity limit is "
            f"{arm.joints[int(speeds.binding[nearest])].name}, {100 * use[nearest]:.0f} % of it at "
            f"{speeds.way_mm[nearest]:.1f} mm"
        )
        return sheet.finish(trajectory.title, remark, axes.get_legend_handles_labels()[0])


def _top(speeds: PathSpeeds) -> float:
    """The highest speed in view: all of the pen's, and of the velocity limit its least, and what does not make the
    pen's speed small beside it."""
    peak = float(speeds.speed_mm_s.max())
    usual = np.clip(1.15 * np.median(speeds.velocity_limit_mm_s), _VIEW[0] * peak, _VIEW[1] * peak)
    return float(max(usual, min(1.15 * speeds.velocity_limit_mm_s.min(), _FARTHEST_VIEW * peak)))


def _longest(trajectory: Trajectory) -> int:
    if not trajectory.pen.any():
        raise UsageError("there are no strokes: the pen is never down")
    return int(np.argmax(np.bincount(trajectory.stroke[trajectory.pen])))


def _strokes_of(trajectory: Trajectory) -> str:
    last = int(trajectory.stroke.max(initial=-1))
    return f"the trajectory has {last + 1}, 0 to {last}" if last >= 0 else "the trajectory has none"
