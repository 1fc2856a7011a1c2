"""Both themes can be read, in either size; what stands above a picture stays clear of it and within it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from planner.account import account_of
from planner.arms.arm import Arm
from planner.plots.coloured_path import plot_error, plot_speed
from planner.plots.drawing import plot_drawing
from planner.plots.inked_sheet import plot_sheet
from planner.plots.look import Colours, Look, Size, Theme
from planner.plots.phase_plane import plot_phase_plane
from planner.plots.profiles import plot_profiles
from planner.plots.timeline import plot_timeline
from planner.trajectory import Trajectory

LOOKS = [Look.of(Theme.LIGHT, Size.PAPER), Look.of(Theme.DARK, Size.SCREEN)]


def luminance(colour: str | tuple[float, ...]) -> float:
    """Relative luminance by the Web Content Accessibility Guidelines 2.1."""
    channels = np.array(to_rgb(colour))
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(colour: str, ground: str) -> float:
    light, dark = sorted((luminance(colour), luminance(ground)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("colours", [Look.of(theme).colours for theme in Theme], ids=list(Theme))
def test_letters_and_lines_stand_out_from_their_ground(colours: Colours) -> None:
    for ground in (colours.surface, colours.ring):
        assert contrast(colours.ink, ground) > 12
        assert contrast(colours.quiet, ground) > 4.5
        assert contrast(colours.drawn, ground) > 3
        assert contrast(colours.limit, ground) > 3
    levels = [luminance(colour) for colour in colours.colour_map(48)(range(48))[:, :3]]
    assert np.all(np.diff(levels) > 0)


@pytest.mark.parametrize("look", LOOKS, ids=["paper", "screen"])
def test_headings_legends_and_panels_do_not_overlap(
    look: Look, arm: Arm, make_trajectory: Callable[..., Trajectory]
) -> None:
    trajectory = make_trajectory(n_samples=101, drawing="W" * 300 + ".svg")
    s = np.linspace(0, 1, 101)
    tip_mm = np.column_stack((80 + 30 * s * np.cos(9 * s), 30 * s * np.sin(9 * s), 5.0 * ~trajectory.pen))
    account = account_of(trajectory, tip_mm, 1.0)
    for figure in (
        plot_sheet(trajectory, tip_mm, look),
        plot_profiles(trajectory, arm, look),
        plot_drawing(
            trajectory,
            tip_mm,
            account,
            None,
            np.array([[40, -60], [40, 60], [120, 60], [120, -60]]),
            (33.0, 149.0),
            look,
        ),
        plot_speed(trajectory, tip_mm, account, None, (33.0, 149.0), look),
        plot_error(trajectory, tip_mm, s, 0.05, None, None, look),
        plot_phase_plane(trajectory, arm, tip_mm, None, look),
        plot_timeline(trajectory, tip_mm, 1.0, look),
    ):
        assert figure.get_size_inches()[0] == look.width_in
        assert to_rgb(figure.get_facecolor()) == to_rgb(look.colours.surface)
        _keeps_apart(figure)


def _keeps_apart(figure: Figure) -> None:
    canvas = FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    renderer = canvas.get_renderer()
    whole = figure.bbox.padded(1.0)
    above = [item.get_window_extent(renderer) for item in (*figure.texts, *figure.legends)]
    panels = [axes.get_tightbbox(renderer) for axes in figure.axes]
    for box in (*above, *panels):
        assert whole.x0 <= box.x0 < box.x1 <= whole.x1
        assert whole.y0 <= box.y0 < box.y1 <= whole.y1
    for upper, lower in pairwise(above):
        assert upper.y0 >= lower.y1
    for panel in panels:
        assert panel.y1 <= above[-1].y0
    for first, panel in enumerate(panels):
        for other in panels[first + 1 :]:
            # tick labels of neighbours may come close, but not by more than the margin of a letter
            overlap = Bbox.intersection(panel, other)
            assert overlap is None or min(overlap.width, overlap.height) < 4
