"""The frames of a film: the arm from above, with what it has drawn, and from the side."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

from planner.arrays import BoolArray, FloatArray
from planner.counted import clock
from planner.plots.ink import Ink, inks_of
from planner.plots.inked import legend_of
from planner.plots.look import USUAL, Colours, Look
from planner.plots.motion import Motion, seen_from_the_side
from planner.plots.paper import (
    PAPER_BOTTOM,
    PAPER_LEFT,
    PAPER_RIGHT,
    canvas_outline,
    half_ring,
    paper_patch,
    pieces,
    place_axes,
    round_step,
)
from planner.plots.paper_extent import base_of, paper_sides_mm, view_mm
from planner.plots.samples import joined_while_drawing
from planner.plots.sheet import Sheet

Frame = npt.NDArray[np.uint8]
"""(height, width, 3), both even, as video wants them."""

_TICK_EM = 4.5
_N_VIEW_PROBES = 2000
_MARGIN = 0.04  # of the size of the paper in view


class Film:
    """A motion on a sheet that is drawn once; each frame adds what the pen has drawn since the one before, and puts
    the arm over it. So a frame takes as long however much is drawn."""

    def __init__(
        self,
        motion: Motion,
        canvas_corners_mm: FloatArray | None = None,
        reach_mm: tuple[float, float] | None = None,
        look: Look = USUAL,
    ) -> None:
        self.motion, self.look = motion, look
        self._pen_of_stroke = motion.trajectory.pen_of_stroke
        with look.style():
            self._lay_out(canvas_corners_mm, reach_mm, look)

    def _lay_out(self, canvas_corners_mm: FloatArray | None, reach_mm: tuple[float, float] | None, look: Look) -> None:
        motion, colours = self.motion, look.colours
        probes = motion.nodes_mm(np.linspace(motion.begin_s, motion.end_s, _N_VIEW_PROBES))
        side = seen_from_the_side(motion.arm, probes)
        corners = np.empty((0, 2)) if canvas_corners_mm is None else canvas_corners_mm
        base_mm = base_of(motion.arm.paper)
        low, high = view_mm([probes[..., :2].reshape(-1, 2), motion.tip_mm[:, :2], corners], reach_mm, base_mm)
        side_low, side_high = side.min(axis=(0, 1)), side.max(axis=(0, 1))
        side_low[1] = min(side_low[1], 0.0)
        margin_mm = _MARGIN * float((high - low).max())
        side_low, side_high = side_low - margin_mm, side_high + margin_mm

        sheet = Sheet(look)
        across_mm = (high[1] - low[1]) + (side_high[0] - side_low[0])
        em_per_mm = (sheet.width - 2 * PAPER_LEFT - 2 * PAPER_RIGHT) / across_mm
        width = (high[1] - low[1]) * em_per_mm
        above = sheet.panel(PAPER_LEFT, PAPER_BOTTOM, width, (high[0] - low[0]) * em_per_mm)
        beside = sheet.panel(
            2 * PAPER_LEFT + PAPER_RIGHT + width,
            PAPER_BOTTOM,
            (side_high[0] - side_low[0]) * em_per_mm,
            (side_high[1] - side_low[1]) * em_per_mm,
        )
        place_axes(above, low, high, width, colours, base_mm)
        if reach_mm is not None:
            above.add_patch(half_ring(reach_mm, colours, base_mm))
        if len(corners):
            above.add_patch(canvas_outline(corners, colours))
        above.add_patch(paper_patch(paper_sides_mm(motion.trajectory, motion.tip_mm[:, :2]), colours))
        beside.set(
            xlim=(side_low[0], side_high[0]),
            ylim=(side_low[1], side_high[1]),
            xlabel="from the base (mm)",
            ylabel="over the paper (mm)",
        )
        tick_mm = round_step(_TICK_EM / em_per_mm)
        beside.xaxis.set_major_locator(MultipleLocator(tick_mm))
        beside.yaxis.set_major_locator(MultipleLocator(tick_mm))
        beside.axhline(0.0, color=colours.edge, linewidth=0.8, zorder=0)

        inks = inks_of(motion.trajectory, motion.tip_mm[:, :2])
        self._inks = [_ink_on(above, ink, em_per_mm * look.letter_pt) for ink in inks]
        self._above, self._views = above, tuple((axes, *_arm_on(axes, colours)) for axes in (above, beside))
        speed = "" if motion.speed_factor == 1 else f", {motion.speed_factor:.3g} times as fast"
        self.figure = sheet.finish(
            motion.trajectory.title,
            f"{motion.arm.name} draws, from above and square to the arm{speed}",
            [*self._views[0][1:], *legend_of(inks, look)],
        )
        self._clock = self.figure.text(
            1 - 1.6 / sheet.width,
            self.figure.texts[0].get_position()[1],
            "",
            ha="right",
            va="top",
            size=1.15 * look.letter_pt,
            animated=True,
        )
        self._canvas = FigureCanvasAgg(self.figure)

    @property
    def n_frames(self) -> int:
        return len(self.motion.times_s)

    @property
    def ink_colours(self) -> list[str]:
        """Of the pens, each once."""
        return list(dict.fromkeys(str(line.get_color()) for line, _ in self._inks))

    def frames(self) -> Iterator[Frame]:
        """Each frame in turn, all of one size."""
        motion, canvas = self.motion, self._canvas
        times_s = motion.times_s
        samples = motion.last_samples(times_s)
        joined = joined_while_drawing(motion.trajectory)
        canvas.draw()
        paper = canvas.copy_from_bbox(self.figure.bbox)
        shown = 0  # what was drawn before the part that is shown lies there already
        for frame, time_s in enumerate(times_s.tolist()):
            canvas.restore_region(paper)
            until = int(samples[frame])
            if until > shown or frame == 0:
                self._add_to_drawing(shown, until, joined)
                paper = canvas.copy_from_bbox(self.figure.bbox)
                shown = until
            self._place_arm(motion.nodes_mm(times_s[frame : frame + 1]), time_s, int(motion.trajectory.stroke[until]))
            picture: Frame = np.asarray(canvas.buffer_rgba(), dtype=np.uint8)
            height, width = (side - side % 2 for side in picture.shape[:2])
            yield picture[:height, :width, :3].copy()

    def _add_to_drawing(self, begin: int, end: int, joined: BoolArray) -> None:
        xy = self.motion.tip_mm[begin : end + 1, :2]
        down = self.motion.trajectory.pen[begin : end + 1]
        stroke = self.motion.trajectory.stroke[begin : end + 1]
        pen = np.where(down, self._pen_of_stroke[np.maximum(stroke, 0)], -1) if len(self._pen_of_stroke) else stroke
        for index in np.unique(pen[down]).tolist():
            line, dots = self._inks[index]
            own = pen == index
            drawn = pieces(xy, joined[begin:end] & own[1:])  # a tap has no line, but has a dot
            for artist, points in ((line, drawn), (dots, xy[own])):
                artist.set_data(points[:, 1], points[:, 0])
                self._above.draw_artist(artist)

    def _place_arm(self, nodes_mm: FloatArray, time_s: float, stroke: int) -> None:
        seen = (nodes_mm[0, :, 1::-1], seen_from_the_side(self.motion.arm, nodes_mm)[0])
        for (axes, links, tip), corners in zip(self._views, seen, strict=True):
            links.set_data(*corners.T)
            tip.set_data(*corners[-1:].T)
            axes.draw_artist(links)
            axes.draw_artist(tip)
        self._clock.set_text(
            f"{clock(time_s)} of {clock(self.motion.trajectory.duration_s)}, "
            + (f"stroke {stroke}" if stroke >= 0 else "pen up")
        )
        self.figure.draw_artist(self._clock)


def _ink_on(axes: Axes, ink: Ink, pt_per_mm: float) -> tuple[Line2D, Line2D]:
    """A line and dots in a pen's colour and width, yet to be placed."""
    width_pt = ink.width_mm * pt_per_mm
    (line,) = axes.plot([], [], color=ink.colour, linewidth=width_pt, zorder=3, animated=True)
    (dots,) = axes.plot(
        [], [], color=ink.colour, linestyle="none", marker="o", markeredgewidth=0, markersize=width_pt, animated=True
    )
    return line, dots


def _arm_on(axes: Axes, colours: Colours) -> tuple[Line2D, Line2D]:
    """The links, and the tip of the pen, yet to be placed."""
    (links,) = axes.plot(
        [],
        [],
        color=colours.link,
        linewidth=2.4,
        marker="o",
        markersize=4.5,
        markeredgewidth=0,
        zorder=5,
        animated=True,
        label="arm",
    )
    (tip,) = axes.plot(
        [],
        [],
        color=colours.limit,
        linestyle="none",
        marker="o",
        markersize=4.5,
        markeredgewidth=0,
        zorder=5,
        animated=True,
        label="tip of the pen",
    )
    return links, tip
