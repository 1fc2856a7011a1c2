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
from planner.plots.look import LIMIT_DASHES, USUAL, Colours, Look
from planner.plots.samples import (
    finite_difference,
    min_max_envelope,
    pen_down_spans,
    require_joints,
    window_s,
)
from planner.plots.sheet import Sheet
from planner.trajectory import Trajectory

_QUANTITIES = ("position", "velocity", "acceleration", "jerk")
_PER_TIME = ("", "/s", "/s²", "/s³")
_N_BINS = 600  # about the pixels that a panel is wide
_N_PEN_SPANS = 400
_PEN_ALPHA = 0.24
_ROW, _LEFT, _BOTTOM, _RIGHT, _COLUMN_GAP, _ROW_GAP = 10.0, 6.2, 4.0, 1.4, 5.4, 2.7  # em
_HEADS = 3.2  # em, room for the names of the columns
_LABEL = 3.6  # em, from the axis to what it shows
_SAME_S = 1e-9
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


def plot_profiles(
    trajectory: Trajectory, arm: Arm, look: Look = USUAL, *, from_s: float | None = None, to_s: float | None = None
) -> Figure:
    """A row of panels for each joint: position, velocity, acceleration and jerk over time, in degrees or
    millimetres and seconds, with the arm's limits as lines and what is beyond them tinted; the time that
    the pen is on the paper is shaded. Above each panel stands how much of the limit is used.

    Derivatives are plain differences of the samples (`finite_difference`). A long trajectory is drawn by
    the least and greatest sample in each of some hundreds of spans of time, so every peak shows.
    from_s, to_s: the part of the time that is shown and judged.
    Errors: UsageError where the trajectory's joints are not the arm's, or there is nothing in that part.
    """
    require_joints(trajectory, arm)
    window = window_s(trajectory, from_s, to_s)
    columns = [_profiles(trajectory, arm, order, window) for order in range(len(_QUANTITIES))]
    spans = _pen_down_within(trajectory, window)
    with look.style():
        sheet = Sheet(look)
        width = (sheet.width - _LEFT - _RIGHT + _COLUMN_GAP) / len(_QUANTITIES) - _COLUMN_GAP
        first: Axes | None = None
        for row in range(arm.n_joints):
            for order, column in enumerate(columns):
                axes = sheet.panel(
                    _LEFT + order * (width + _COLUMN_GAP),
                    _BOTTOM + (arm.n_joints - 1 - row) * (_ROW + _ROW_GAP),
                    width,
                    _ROW,
                    share_x=first,
                )
                first = first or axes
                _draw(axes, column[row], look)
                axes.yaxis.set_label_coords(-_LABEL / width, 0.5)
                _shade_pen_down(axes, spans, look.colours)
                if row == 0:
                    axes.annotate(
                        _QUANTITIES[order].capitalize(),
                        (0, 1),
                        xycoords="axes fraction",
                        xytext=(0, 1.5 * look.letter_pt),
                        textcoords="offset points",
                        weight="bold",
                        size=1.15 * look.letter_pt,
                    )
                if row == arm.n_joints - 1:
                    axes.set_xlabel("time (s)")
                else:
                    axes.tick_params(labelbottom=False)
        rest_s = max(0.004 * (window[1] - window[0]), 2 / trajectory.rate_hz)
        sheet.figure.axes[0].set_xlim(window[0] - rest_s, window[1] + rest_s)
        remark = (
            f"{_shown(trajectory, window)} at {trajectory.rate_hz:g} Hz on {arm.name}, "
            f"method {trajectory.method}; derivatives are differences of the samples"
        )
        legend = _legend(look, any(profile.is_over for column in columns for profile in column))
        return sheet.finish(trajectory.title, remark, legend, _HEADS)


def _shown(trajectory: Trajectory, window: tuple[float, float]) -> str:
    whole = f"{trajectory.duration_s:.4g} s"
    return whole if window[1] - window[0] == trajectory.duration_s else f"{window[0]:g} to {window[1]:.6g} s of {whole}"


def _pen_down_within(trajectory: Trajectory, window: tuple[float, float]) -> FloatArray:
    """Pen-down spans of the samples around the window, so that a short part of a long trajectory is told finely."""
    begin = max(int(window[0] * trajectory.rate_hz) - 1, 0)
    end = int(np.ceil(window[1] * trajectory.rate_hz)) + 2
    spans = pen_down_spans(trajectory.pen[begin:end], trajectory.rate_hz, _N_PEN_SPANS)
    spans[:, :2] += begin / trajectory.rate_hz
    return spans


def _profiles(trajectory: Trajectory, arm: Arm, order: int, window: tuple[float, float]) -> list[_Profile]:
    """One quantity of every joint."""
    times_s, values = finite_difference(trajectory.positions, trajectory.rate_hz, order)
    if window[0] > 0 or window[1] < trajectory.duration_s:
        within = (times_s >= window[0] - _SAME_S) & (times_s <= window[1] + _SAME_S)
        times_s, values = times_s[within], values[within]
    if order == 0:
        low, high = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    else:
        high = arm.to_file_units((arm.max_velocity, arm.max_acceleration, arm.max_jerk)[order - 1])
        low = -high
    return [
        _Profile(order, joint.name, joint.file_unit, times_s, values[:, k], float(low[k]), float(high[k]))
        for k, joint in enumerate(arm.joints)
    ]


def _draw(axes: Axes, profile: _Profile, look: Look) -> None:
    colours = look.colours
    thin = len(profile.values) > 2 * _N_BINS
    axes.plot(
        *min_max_envelope(profile.times_s, profile.values, _N_BINS),
        color=colours.drawn,
        linewidth=0.5 if thin else 1.0,
        zorder=3,
    )
    for limit in (profile.low, profile.high):
        axes.axhline(limit, color=colours.limit, linewidth=0.9, linestyle=LIMIT_DASHES, zorder=3.5)
    bottom = min(profile.low, float(profile.values.min()))
    top = max(profile.high, float(profile.values.max()))
    room = 0.1 * (top - bottom)
    axes.set_ylim(bottom - room, top + room)
    axes.axhspan(bottom - room, profile.low, color=colours.limit, alpha=0.13, linewidth=0)
    axes.axhspan(profile.high, top + room, color=colours.limit, alpha=0.13, linewidth=0)
    axes.yaxis.set_major_locator(MaxNLocator(5, min_n_ticks=3))
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    unit = profile.unit + _PER_TIME[profile.order]
    if max(abs(bottom), abs(top)) >= 20_000:
        axes.yaxis.set_major_formatter(FuncFormatter(_in_thousands))
        unit = f"10³ {unit}"
    axes.set_ylabel(f"{profile.joint} ({unit})" if profile.order == 0 else unit)
    axes.yaxis.label.set_parse_math(False)
    axes.set_title(
        profile.remark,
        loc="right",
        size=0.85 * look.letter_pt,
        pad=0.3 * look.letter_pt,
        color=colours.limit if profile.is_over else colours.ink,
        weight="bold" if profile.is_over else "normal",
    )
    if profile.is_over:
        worst = int(np.argmax(np.abs(profile.values - (profile.low + profile.high) / 2)))
        axes.plot(
            profile.times_s[worst],
            profile.values[worst],
            "o",
            markersize=4,
            markerfacecolor="none",
            markeredgecolor=colours.limit,
            zorder=4,
        )


def _in_thousands(value: float, _position: int | None) -> str:
    return f"{value / 1000:g}".replace("-", "\N{MINUS SIGN}")


def _shade_pen_down(axes: Axes, spans: FloatArray, colours: Colours) -> None:
    """Grey from bottom to top while the pen is down, paler where it is down for part of a span only."""
    start, end, share = spans.T
    corners = np.stack(
        [np.column_stack((x, np.full(len(spans), y))) for x, y in ((start, 0.0), (end, 0.0), (end, 1.0), (start, 1.0))],
        axis=1,
    )
    axes.add_collection(
        PolyCollection(
            list(corners),
            facecolors=to_rgba_array([colours.travel] * len(spans), alpha=list(_PEN_ALPHA * share)),
            linewidths=0,
            antialiaseds=False,
            transform=axes.get_xaxis_transform(),
            zorder=0.5,
            label="pen on the paper",
        ),
        autolim=False,
    )


def _legend(look: Look, any_over: bool) -> list[Line2D | Patch]:
    colours = look.colours
    entries: list[Line2D | Patch] = [
        Line2D([], [], color=colours.drawn, linewidth=1.2, label="joint"),
        Line2D([], [], color=colours.limit, linewidth=0.9, linestyle=LIMIT_DASHES, label="limit of the arm"),
        Patch(facecolor=colours.travel, alpha=_PEN_ALPHA, linewidth=0, label="pen on the paper"),
    ]
    if any_over:
        entries.append(
            Line2D(
                [],
                [],
                color=colours.limit,
                marker="o",
                markersize=4,
                markerfacecolor="none",
                linestyle="none",
                label="worst sample over a limit",
            )
        )
    return entries
