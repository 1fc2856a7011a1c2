"""The sheet as it will look: every stroke of every pen is on it, in its colour, and as wide as its pen."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import to_hex

from planner.checking.chain import chain_poses
from planner.drawing.source import SvgInMemory
from planner.pens import GroupBy
from planner.pipeline import Plan, plan
from planner.plots.inked_sheet import plot_sheet
from planner.plots.look import Look
from planner.progress import unreported
from planner.settings import PlanSettings
from tests.arms.chains import load_once
from tests.drawn_shapes import lines_svg

BODY = '<path d="M10 10H50M20 30h0M40 30h0"/><path stroke="#ff0000" d="M60 10v30M70 20h0"/>'


@pytest.fixture(scope="module")
def made() -> Plan:
    drawing = SvgInMemory("drawn", lines_svg(BODY, 'viewBox="0 0 80 50" width="80mm" height="50mm"').encode())
    return plan(drawing, PlanSettings(by=GroupBy.COLOUR, fit=False), unreported)


def test_lines_and_taps_are_inked_in_the_colours_of_their_pens(made: Plan) -> None:
    arm, trajectory = load_once("drawing_arm"), made.trajectory
    tip_mm = chain_poses(arm, arm.from_file_units(trajectory.positions)).tip_mm.T
    look = Look.of(dpi=100.0)
    figure = plot_sheet(trajectory, tip_mm, look)
    axes = figure.axes[0]
    lines = [one for one in axes.collections if isinstance(one, LineCollection)]
    dots = [one for one in axes.collections if isinstance(one, EllipseCollection)]
    assert [to_hex(line.get_color()[0]) for line in lines] == ["#000000", "#ff0000"]
    assert [len(line.get_segments()) for line in lines] == [1, 1]
    assert [len(dot.get_offsets()) for dot in dots] == [2, 1]
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[::-1, :, :3].astype(int)
    for line, dot, colour in zip(lines, dots, ((0, 0, 0), (255, 0, 0)), strict=True):
        places = [segment[len(segment) // 2] for segment in line.get_segments()] + list(dot.get_offsets())
        for x, y in axes.transData.transform(places).round().astype(int):
            spot = pixels[y - 2 : y + 2, x - 2 : x + 2].reshape(-1, 3)
            assert np.abs(spot - colour).sum(axis=1).min() < 60
