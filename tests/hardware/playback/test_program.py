from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.motion.stopping import interpolate, lift, slow_down
from hardware.motion.tip import link_nodes_mm
from hardware.playback.program import make_program, parking
from hardware.playback.sample_map import next_to_draw
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.errors import UsageError
from planner.pipeline import plan
from planner.settings import PlanSettings
from planner.trajectory import TRAVELLING, Trajectory
from tests.drawn_shapes import lines_svg

DRAWING = lines_svg(
    '<path d="M5 5 15 25 25 5"/><path d="M30 15h0"/><circle cx="45" cy="15" r="8"/>', 'viewBox="0 0 60 30"'
)


@cache
def _planned(arm: str, folder: Path) -> Trajectory:
    """A line, a tap and a circle."""
    drawing = folder / "drawing.svg"
    drawing.write_text(DRAWING)
    return plan(drawing, PlanSettings(arm=arm), lambda stage, done, total: None).trajectory


@pytest.mark.parametrize("name", ["drawing_arm", "scara"])
def test_every_program_is_from_rest_to_rest_within_limits_and_draws_what_was_asked_for(
    name: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    arm = load_arm(name)
    trajectory = _planned(name, tmp_path_factory.getbasetemp())
    path = arm.from_file_units(trajectory.positions)
    for from_stroke in (0, 1, 2):
        for pace in (1.0, 0.1):
            made = make_program(arm, path, trajectory.stroke, trajectory.rate_hz * pace, from_stroke=from_stroke)
            padded = np.concatenate((np.tile(made.positions[0], (3, 1)), made.positions))
            assert slow_down(arm, padded, 1 / made.rate_hz) <= 1.05
            assert made.rate_hz >= 50
            np.testing.assert_array_equal(made.positions[-1], made.park)
            np.testing.assert_allclose(
                made.positions, arm.complete(made.positions[:, list(arm.independent_joints)]), atol=np.radians(1e-4)
            )
            heights_mm = link_nodes_mm(arm, made.positions)[:, -1, 2]
            outside = np.concatenate((heights_mm[: made.approach], heights_mm[len(heights_mm) - made.retreat :]))
            assert outside.min() >= arm.pen.clearance_mm - 0.02
            assert np.abs(heights_mm[made.stroke != TRAVELLING]).max() < 0.01
            # The samples of every stroke asked for are there, each at its place.
            refine = round(made.rate_hz / (trajectory.rate_hz * pace))
            for stroke in range(3):
                wanted = path[trajectory.stroke == stroke]
                drawn = made.positions[made.stroke == stroke][::refine]
                np.testing.assert_allclose(drawn, wanted if stroke >= from_stroke else drawn[:0], atol=1e-12)


def test_the_whole_file_is_played_from_where_it_begins(arm: Arm, sketch: Trajectory) -> None:
    path = arm.from_file_units(sketch.positions)
    made = make_program(arm, path, sketch.stroke, 100.0)
    assert made.approach == 0
    np.testing.assert_array_equal(made.positions[: len(path)], path)
    np.testing.assert_array_equal(made.stroke[: len(path)], sketch.stroke)
    assert (made.stroke[len(path) :] == TRAVELLING).all()


def test_a_park_pose_is_where_it_comes_from_and_goes_to(arm: Arm, sketch: Trajectory) -> None:
    path = arm.from_file_units(sketch.positions)
    park = arm.complete(np.radians([0.0, 120.0, -120.0, -20.0]))
    made = make_program(arm, path, sketch.stroke, 100.0, park=park)
    np.testing.assert_array_equal(made.positions[0], park)
    np.testing.assert_array_equal(made.positions[-1], park)
    np.testing.assert_array_equal(made.positions[made.approach : -made.retreat], path)
    assert made.duration_s == pytest.approx((len(made.positions) - 1) / 100)
    fastest = np.abs(np.diff(made.positions[: made.approach + 1], axis=0)).max(axis=0) * 100
    assert (fastest <= arm.max_velocity / 5 + 1e-9).all()


def test_a_file_that_begins_on_the_paper_is_come_to_from_above(arm: Arm, sketch: Trajectory) -> None:
    first = int(np.argmax(sketch.pen))
    cut = replace(sketch, positions=sketch.positions[first:], pen=sketch.pen[first:], stroke=sketch.stroke[first:])
    path = arm.from_file_units(cut.positions)
    made = make_program(arm, path, cut.stroke, 100.0)
    np.testing.assert_allclose(made.park, lift(arm, path[0], 100.0)[-1], atol=1e-12)
    tips = link_nodes_mm(arm, made.positions[: made.approach + 1])[:, -1]
    assert (np.diff(tips[:, 2]) <= 1e-9).all()
    np.testing.assert_allclose(tips[:, :2], np.tile(tips[0, :2], (len(tips), 1)), atol=1e-3)


@pytest.mark.parametrize("pace", [1.0, 0.1])
def test_a_drawing_is_joined_in_the_midst_of_a_stroke_from_above(arm: Arm, sketch: Trajectory, pace: float) -> None:
    """Where the pen comes down, set off from rest: within limits, and nothing before that sample is drawn."""
    path = arm.from_file_units(sketch.positions)
    of_stroke = np.flatnonzero(sketch.stroke == 1)
    for sample in (int(of_stroke[1]), int(of_stroke[len(of_stroke) // 2]), int(of_stroke[-2])):
        made = make_program(arm, path, sketch.stroke, 100.0 * pace, from_stroke=1, from_sample=sample)
        padded = np.concatenate((np.tile(made.positions[0], (3, 1)), made.positions))
        assert slow_down(arm, padded, 1 / made.rate_hz) <= 1.05
        tips = link_nodes_mm(arm, made.positions)[:, -1]
        come_down = made.approach
        np.testing.assert_allclose(made.positions[come_down], path[sample], atol=1e-12)
        low = tips[:come_down, 2] < arm.pen.clearance_mm
        assert np.linalg.norm(tips[:come_down][low, :2] - tips[come_down, :2], axis=1).max() < 0.05
        assert made.sample[0] == made.sample[come_down] == sample
        assert (np.diff(made.sample) >= 0).all()
        assert made.sample[-1] == len(path) - 1
        refine = round(made.rate_hz / (100.0 * pace))
        drawn = made.stroke != TRAVELLING
        at = interpolate(path, made.sample[drawn])
        np.testing.assert_allclose(made.positions[drawn], at, atol=1e-6 if refine == 1 else 1e-4)


def test_when_nothing_is_left_to_draw_it_only_parks(arm: Arm, sketch: Trajectory) -> None:
    path = arm.from_file_units(sketch.positions)
    made = parking(arm, path, 100.0)
    np.testing.assert_array_equal(made.positions, make_program(arm, path, sketch.stroke, 100.0).park[None])
    assert next_to_draw(sketch.stroke, float(made.sample[0])) == (3, None)


@given(sample=st.floats(0, 1))
def test_what_is_next_is_neither_lost_nor_drawn_twice(sketch: Trajectory, sample: float) -> None:
    """Up to one sample."""
    come_to = sample * (len(sketch.stroke) - 1)
    stroke, midst = next_to_draw(sketch.stroke, come_to)
    index = np.arange(len(sketch.stroke))
    drawn = sketch.stroke != TRAVELLING
    again = drawn & (index >= midst if midst is not None else sketch.stroke >= stroke)
    assert again[drawn & (index > come_to)].all()
    assert (again & (index < come_to - 1 - 1e-9)).sum() == 0


def test_a_stroke_that_is_not_there_is_an_error(arm: Arm, sketch: Trajectory) -> None:
    path = arm.from_file_units(sketch.positions)
    for index in (-1, 3):
        with pytest.raises(UsageError, match=f"no stroke {index}; the drawing has 0 to 2"):
            make_program(arm, path, sketch.stroke, 100.0, from_stroke=index)
