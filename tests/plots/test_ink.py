"""The sheet as it will look: every stroke of every pen is on it, in its colour, and as wide as its pen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import to_hex

from planner.arrays import IntArray
from planner.checking.chain import chain_poses
from planner.drawing.source import SvgInMemory
from planner.head import PenInk
from planner.pens import GroupBy
from planner.pipeline import Plan, plan
from planner.plots.ink import inks_of, thinned
from planner.plots.inked_sheet import plot_sheet
from planner.plots.look import Look
from planner.progress import unreported
from planner.settings import PlanSettings
from planner.trajectory import TRAVELLING, Trajectory
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


@given(st.floats(0.05, 5.0))
def test_lines_of_a_usual_pen_never_fill_the_gaps_between_them(apart_mm: float) -> None:
    """A hatch of 20 x 20 mm, a stroke a line: as wide as a usual pen draws, or half as wide as its lines lie apart."""
    y = np.arange(0.0, 20.0, apart_mm)
    along = np.linspace(0.0, 20.0, 41)
    places = np.concatenate([np.column_stack((along, np.full(41, level))) for level in y])
    hatch = _drawn(np.repeat(np.arange(len(y)), 41))
    (ink,) = inks_of(hatch, places)
    assert ink.width_mm == pytest.approx(min(0.4, apart_mm / 2), rel=0.5)
    assert ink.is_thinned is (ink.width_mm < 0.4) is bool(thinned([ink]))
    (known,) = inks_of(replace(hatch, pens=(PenInk("marker", (1, 2, 3), 3.0),)), places)
    assert (known.width_mm, known.colour, known.is_thinned) == (3.0, "#010203", False)


@given(st.lists(st.integers(1, 9), min_size=1, max_size=6), st.integers(1, 60))
def test_an_opening_ends_after_a_stroke_and_in_time(lengths: list[int], n_samples: int) -> None:
    labels = [TRAVELLING]
    for index, length in enumerate(lengths):
        labels += [index] * length + [TRAVELLING] * 2
    whole = _drawn(np.array(labels))
    part = whole.opening(n_samples)
    assert part.n_samples <= max(n_samples + 1, 1 + lengths[0] + 1)
    assert part is whole or (part.pen[-2] and not part.pen[-1])
    np.testing.assert_array_equal(part.stroke, whole.stroke[: part.n_samples])


def _drawn(stroke: IntArray) -> Trajectory:
    arm = load_once("drawing_arm")
    positions = np.zeros((len(stroke), arm.n_joints))
    return Trajectory(
        "drawing_arm", "d.svg", "path", 100.0, arm.column_names, positions, stroke >= 0, stroke, (1, 0, 0, 1, 0, 0)
    )
