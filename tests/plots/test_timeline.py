"""Phases of a trajectory, and the timeline that shows them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.collections import PolyCollection

from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.phases import Phase, phases_of, seconds_in
from planner.plots.timeline import plot_timeline
from planner.trajectory import TRAVELLING, Trajectory

RATE_HZ = 50.0


def travelling() -> tuple[Trajectory, FloatArray]:
    """Comes down, dwells, draws, lifts and travels, in steps of a millimetre where it moves."""
    way = (
        [(0, 2 - k, Phase.LOWERING if k else Phase.TRAVELLING) for k in range(2)]
        + [(0, 0, Phase.RESTING)] * 3
        + [(k, 0, Phase.DRAWING) for k in range(5)]
        + [(5, 0, Phase.LIFTING)]
        + [(5 + k, 1 + k, Phase.TRAVELLING) for k in range(4)]
    )
    tip_mm = np.array([(x, 0.0, z) for x, z, _ in way] + [(9, 0.0, 5)], dtype=np.float64)
    pen = tip_mm[:, 2] == 0
    trajectory = Trajectory(
        "any",
        "travelling.svg",
        "path",
        RATE_HZ,
        ("x_mm",),
        tip_mm[:, :1],
        pen,
        np.where(pen, 0, TRAVELLING),
        (1, 0, 0, 1, 0, 0),
    )
    return trajectory, tip_mm


def test_each_step_has_the_phase_that_it_is_made_of() -> None:
    trajectory, tip_mm = travelling()
    assert [Phase(phase).name for phase in phases_of(trajectory, tip_mm, 1.0)] == (
        ["TRAVELLING", "LOWERING"] + ["RESTING"] * 3 + ["DRAWING"] * 5 + ["LIFTING"] + ["TRAVELLING"] * 4
    )


@given(st.integers(0, 2**32 - 1), st.integers(1, 80), st.floats(0.1, 4))
def test_the_phases_add_up_to_the_duration(seed: int, n_samples: int, clearance_mm: float) -> None:
    random = np.random.default_rng(seed)
    tip_mm = np.round(random.uniform(0, 5, (n_samples, 3)) * random.integers(0, 2, (n_samples, 1)))
    pen = random.random(n_samples) < 0.5
    trajectory = Trajectory(
        "any", "", "path", RATE_HZ, ("x_mm",), tip_mm[:, :1], pen, np.where(pen, 0, TRAVELLING), (1, 0, 0, 1, 0, 0)
    )
    phases = phases_of(trajectory, tip_mm, clearance_mm)
    assert len(phases) == n_samples - 1
    assert seconds_in(phases, RATE_HZ).sum() == pytest.approx(trajectory.duration_s)


def test_bars_lie_where_the_phases_do_and_totals_beside_them() -> None:
    trajectory, tip_mm = travelling()
    height, rows, totals = plot_timeline(trajectory, tip_mm, 1.0).axes
    phases = phases_of(trajectory, tip_mm, 1.0)
    middles_s = (np.arange(len(phases)) + 0.5) / RATE_HZ
    bars = [item for item in rows.collections if isinstance(item, PolyCollection)]
    assert [bar.get_label() for bar in bars] == [phase.name.lower() for phase in Phase]
    for phase, bar in zip(Phase, bars, strict=True):
        spans = [path.get_extents() for path in bar.get_paths()]
        covered = np.any([(span.x0 < middles_s) & (middles_s < span.x1) for span in spans], axis=0)
        np.testing.assert_array_equal(covered, phases == phase)
        assert all(span.y0 < phase < span.y1 for span in spans)
    assert [bar.get_width() for bar in totals.patches] == pytest.approx(seconds_in(phases, RATE_HZ))
    assert [text.get_text() for text in totals.texts][Phase.DRAWING] == "0.1 s, 33 %"
    assert (height.get_xlabel(), height.get_ylabel(), totals.get_xlabel()) == (
        "time (s)",
        "tip height (mm)",
        "total (s)",
    )


def test_a_part_of_the_time_is_counted_alone() -> None:
    trajectory, tip_mm = travelling()
    figure = plot_timeline(trajectory, tip_mm, 1.0, from_s=0.04, to_s=0.12)
    height, rows, totals = figure.axes
    assert sum(bar.get_width() for bar in totals.patches) == pytest.approx(0.08)
    assert height.get_xlim() == pytest.approx((0.04, 0.12))
    (resting,) = [bar for bar in rows.collections if bar.get_label() == "resting"]
    assert resting.get_paths()[0].get_extents().x0 == pytest.approx(0.04)
    with pytest.raises(UsageError, match=r"the trajectory lasts 0\.3 s"):
        plot_timeline(trajectory, tip_mm, 1.0, from_s=0.5)
