"""The profiles of a trajectory: each joint's position, velocity, acceleration and jerk with their limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba_array
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.plots.look import BLUE, GREY, INK, VERMILION, planner_style, set_title
from planner.plots.samples import finite_difference, min_max_envelope, pen_down_spans
from planner.trajectory import Trajectory

_QUANTITIES = ("position", "velocity", "acceleration", "jerk")
_PER_TIME = ("", "/s", "/s²", "/s³")
_N_BINS = 600  # about the pixels that a panel is wide
_N_PEN_SPANS = 400
_PEN_ALPHA = 0.24
_WIDTH_IN, _ROW_IN, _TOP_IN, _BOTTOM_IN, _LEFT_IN, _RIGHT_IN = 13.5, 1.45, 1.0, 0.45, 0.75, 0.2
_OVER = 1e-3  # of the limit: what the rounding of a file and the differences make of it is no fault


@dataclass(frozen=True, eq=False, slots=True)
class _Profile:
    """One panel: a quantity of one joint over time, in file units, and its two limits."""

    order: int
    joint: str
    unit: str
    times_s: FloatArray
    values: FloatArray
    low: float
    high: float

    @property
    def excess(self) -> float:
        """How far beyond a limit, as a share of half the span between the limits; negative within."""
        beyond = max(self.low - float(self.values.min()), float(self.values.max()) - self.high)
        return 2 * beyond / (self.high - self.low)

    @property
    def is_over(self) -> bool:
        return self.excess > _OVER

    @property
    def remark(self) -> str:
        """How close to its limits the joint comes."""
        if self.order > 0:
            used = 1 + self.excess
            return f"peak {100 * used:.0f} % of limit" if used < 10 else f"peak {used:.0f} times the limit"
        room = min(float(self.values.min()) - self.low, self.high - float(self.values.max()))
        return f"{room:.1f} {self.unit} to spare" if not self.is_over else f"{-room:.1f} {self.unit} too far"


def plot_profiles(trajectory: Trajectory, arm: Arm) -> Figure:
    """A row of panels for each joint: position, velocity, acceleration and jerk over time, in degrees or
    millimetres and seconds, with the arm's limits as lines and what is beyond them tinted; the time that
    the pen is on the paper is shaded. Above each panel stands how much of the limit is used.

    Derivatives are plain differences of the samples (`finite_difference`). A long trajectory is drawn by
    the least and greatest sample in each of some hundreds of spans of time, so every peak shows.
    Errors: UsageError where the trajectory's joints are not the arm's.
    """
    if trajectory.columns != arm.column_names:
        raise UsageError(
            f"the trajectory moves {', '.join(trajectory.columns)}, but arm '{arm.name}' has "
            f"{', '.join(arm.column_names)}; it was planned for arm '{trajectory.arm}'")
    size_in = (_WIDTH_IN, _TOP_IN + _ROW_IN * arm.n_joints + _BOTTOM_IN)
    columns = [_profiles(trajectory, arm, order) for order in range(len(_QUANTITIES))]
    spans = pen_down_spans(trajectory.pen, trajectory.rate_hz, _N_PEN_SPANS)
    with planner_style():
        figure = Figure(figsize=size_in)
        panels = figure.subplots(arm.n_joints, len(_QUANTITIES), sharex=True, squeeze=False, gridspec_kw={
            "left": _LEFT_IN / size_in[0], "right": 1 - _RIGHT_IN / size_in[0],
            "bottom": _BOTTOM_IN / size_in[1], "top": 1 - _TOP_IN / size_in[1], "wspace": 0.29, "hspace": 0.3})
        for order, column in enumerate(columns):
            for axes, profile in zip(panels[:, order], column, strict=True):
                _draw(axes, profile)
                _shade_pen_down(axes, spans)
            panels[0, order].set_title(_QUANTITIES[order].capitalize(), loc="left", size=9.5, weight="bold", pad=8)
            panels[-1, order].set_xlabel("time (s)")
        rest_s = max(0.004 * trajectory.duration_s, 2 / trajectory.rate_hz)
        panels[0, 0].set_xlim(-rest_s, trajectory.duration_s + rest_s)
        figure.align_ylabels(panels)
        remark = (f"{trajectory.duration_s:.4g} s at {trajectory.rate_hz:g} Hz on {arm.name}, "
                  f"method {trajectory.method}; derivatives are differences of the samples")
        set_title(figure, trajectory.drawing or "trajectory", remark, 0.2)
        _explain(figure, any(profile.is_over for column in columns for profile in column))
    return figure


def _profiles(trajectory: Trajectory, arm: Arm, order: int) -> list[_Profile]:
    """One quantity of every joint."""
    times_s, values = finite_difference(trajectory.positions, trajectory.rate_hz, order)
    if order == 0:
        low, high = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    else:
        high = arm.to_file_units((arm.max_velocity, arm.max_acceleration, arm.max_jerk)[order - 1])
        low = -high
    return [_Profile(order, joint.name, joint.file_unit, times_s, values[:, k], float(low[k]), float(high[k]))
            for k, joint in enumerate(arm.joints)]


def _draw(axes: Axes, profile: _Profile) -> None:
    thin = len(profile.values) > 2 * _N_BINS
    axes.plot(*min_max_envelope(profile.times_s, profile.values, _N_BINS),
              color=BLUE, linewidth=0.5 if thin else 1.0, zorder=3)
    for limit in (profile.low, profile.high):
        axes.axhline(limit, color=VERMILION, linewidth=0.9, linestyle=(0, (5, 2)), zorder=3.5)
    bottom = min(profile.low, float(profile.values.min()))
    top = max(profile.high, float(profile.values.max()))
    room = 0.1 * (top - bottom)
    axes.set_ylim(bottom - room, top + room)
    axes.axhspan(bottom - room, profile.low, color=VERMILION, alpha=0.10, linewidth=0)
    axes.axhspan(profile.high, top + room, color=VERMILION, alpha=0.10, linewidth=0)
    axes.yaxis.set_major_locator(MaxNLocator(5, min_n_ticks=3))
    unit = profile.unit + _PER_TIME[profile.order]
    if max(abs(bottom), abs(top)) >= 20_000:
        axes.yaxis.set_major_formatter(FuncFormatter(_in_thousands))
        unit = f"10³ {unit}"
    axes.set_ylabel(f"{profile.joint} ({unit})" if profile.order == 0 else unit)
    axes.yaxis.label.set_parse_math(False)
    axes.set_title(profile.remark, loc="right", size=7, pad=2.5, color=VERMILION if profile.is_over else INK,
                   weight="bold" if profile.is_over else "normal")
    if profile.is_over:
        worst = int(np.argmax(np.abs(profile.values - (profile.low + profile.high) / 2)))
        axes.plot(profile.times_s[worst], profile.values[worst], "o", markersize=4, markerfacecolor="none",
                  markeredgecolor=VERMILION, zorder=4)


def _in_thousands(value: float, _position: int | None) -> str:
    return f"{value / 1000:g}".replace("-", "\N{MINUS SIGN}")


def _shade_pen_down(axes: Axes, spans: FloatArray) -> None:
    """Grey from bottom to top while the pen is down, paler where it is down for part of a span only."""
    start, end, share = spans.T
    corners = np.stack([np.column_stack((x, np.full(len(spans), y)))
                        for x, y in ((start, 0.0), (end, 0.0), (end, 1.0), (start, 1.0))], axis=1)
    axes.add_collection(PolyCollection(
        list(corners), facecolors=to_rgba_array([GREY] * len(spans), alpha=list(_PEN_ALPHA * share)),
        linewidths=0, antialiaseds=False, transform=axes.get_xaxis_transform(), zorder=0.5,
        label="pen on the paper"), autolim=False)


def _explain(figure: Figure, any_over: bool) -> None:
    """The legend, at the top right."""
    entries: list[Line2D | Patch] = [
        Line2D([], [], color=BLUE, linewidth=1.2, label="joint"),
        Line2D([], [], color=VERMILION, linewidth=0.9, linestyle=(0, (5, 2)), label="limit of the arm"),
        Patch(facecolor=GREY, alpha=_PEN_ALPHA, linewidth=0, label="pen on the paper"),
    ]
    if any_over:
        entries.append(Line2D([], [], color=VERMILION, marker="o", markersize=4, markerfacecolor="none",
                              linestyle="none", label="worst sample over a limit"))
    figure.legend(handles=entries, loc="upper right", ncols=len(entries), borderaxespad=1.0)
