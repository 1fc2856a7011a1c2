"""Figures of strokes and of joints, against sums done otherwise and against the check."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.arm_file import load_arm
from planner.checking.check import check_trajectory
from planner.report.shares import QUANTITIES, largest_shares
from planner.stroke_figures import stroke_figures
from planner.trajectory import TRAVELLING, Trajectory

RATE_HZ = 50.0


def trajectory_of(stroke: list[int], arm: str = "three_joint", swing_deg: float = 0.0) -> Trajectory:
    described = load_arm(arm)
    middle = described.to_file_units((described.minimum + described.maximum) / 2)
    wave = np.sin(np.linspace(0, np.pi, len(stroke))) ** 4
    labels = np.array(stroke, dtype=np.int64)
    return Trajectory(
        arm,
        "made.svg",
        "path",
        RATE_HZ,
        described.column_names,
        middle + swing_deg * wave[:, np.newaxis] * np.arange(1, described.n_joints + 1),
        labels != TRAVELLING,
        labels,
        (1.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    )


strokes_of_lengths = st.lists(st.integers(1, 6), min_size=0, max_size=5)


@given(strokes_of_lengths, st.integers(0, 2**32 - 1), st.booleans())
def test_strokes_add_up_to_what_is_drawn(lengths: list[int], seed: int, lifts: bool) -> None:
    labels = [TRAVELLING]
    for index, length in enumerate(lengths):
        labels += [index] * length + [TRAVELLING] * lifts
    tip_mm = np.random.default_rng(seed).normal(size=(len(labels), 3))
    figures = stroke_figures(trajectory_of(labels), tip_mm)
    assert figures.index.tolist() == list(range(len(lengths)))
    np.testing.assert_allclose(figures.duration_s, (np.array(lengths) - 1) / RATE_HZ)
    for index, begins, length, mean, top in zip(
        figures.index, figures.begins_s, figures.length_mm, figures.mean_speed_mm_s, figures.top_speed_mm_s, strict=True
    ):
        at = np.flatnonzero(np.array(labels) == index)
        steps = [np.hypot(*(tip_mm[k + 1] - tip_mm[k])[:2]) for k in at[:-1]]
        assert begins * RATE_HZ == pytest.approx(at[0])
        assert length == pytest.approx(sum(steps))
        assert top == pytest.approx(max(steps, default=0.0) * RATE_HZ)
        assert 0 <= mean <= top + 1e-9


def test_a_stroke_at_the_cap_loses_nothing_and_rest_is_lost() -> None:
    labels = [TRAVELLING, *[0] * 11, TRAVELLING, *[1] * 11, TRAVELLING]
    tip_mm = np.zeros((len(labels), 3))
    tip_mm[1:12, 0] = np.arange(11) * 2.0
    tip_mm[13:24, 1] = np.arange(11).clip(max=5) * 2.0
    figures = stroke_figures(trajectory_of(labels), tip_mm)
    np.testing.assert_allclose(figures.lost_s(2.0 * RATE_HZ), [0.0, 5 / RATE_HZ], atol=1e-12)


@pytest.mark.parametrize("arm", ["drawing_arm", "scara", "three_joint"])
def test_shares_are_those_that_the_check_finds(arm: str) -> None:
    trajectory = trajectory_of([TRAVELLING] * 40 + [0] * 60 + [TRAVELLING] * 21, arm, swing_deg=1.5)
    described = load_arm(arm)
    found = {
        (finding.check, finding.place.joint): finding
        for finding in check_trajectory(trajectory, described).findings
        if finding.place is not None
    }
    low, high = described.to_file_units(described.minimum), described.to_file_units(described.maximum)
    for k, (joint, row) in enumerate(zip(described.joints, largest_shares(trajectory, described), strict=True)):
        for quantity, largest in zip(QUANTITIES, row, strict=True):
            finding = found[quantity, joint.name]
            assert finding.worst is not None
            assert finding.limit is not None
            share = (
                abs(finding.worst - (low[k] + high[k]) / 2) / ((high[k] - low[k]) / 2)
                if quantity == "position"
                else finding.worst / finding.limit
            )
            assert largest.share == pytest.approx(share, rel=1e-3)
            assert 0 <= largest.time_s <= trajectory.duration_s
            assert largest.stroke == trajectory.stroke[int(largest.time_s * RATE_HZ)]
