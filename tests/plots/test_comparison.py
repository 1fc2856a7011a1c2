"""The pictures of a comparison: what they show is what was found."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from matplotlib.axes import Axes

from planner.comparison.compare import Comparison, compare, default_start
from planner.comparison.targets import Targets, random_targets, single_targets, targets_along
from planner.comparison.worked_example import ITERATIONS
from planner.errors import UsageError
from planner.plots.comparison import plot_comparison
from planner.plots.comparison_look import shown
from planner.settings import PlanSettings
from tests.arms.chains import kinematics_of, load_once, model_of, tips_by_product

STROKES = [np.array([[120.0, 20.0], [120.0, 24.0]]), np.array([[110.0, -10.0], [113.0, -10.0]])]


@lru_cache
def compared(name: str, kind: str) -> Comparison:
    arm, model = load_once(name), model_of(load_once(name))
    targets: Targets = {
        "single": lambda: single_targets(np.array([[53.0, 47.8, 0.0]])),
        "random": lambda: random_targets(kinematics_of(arm), 12, 1),
        "drawing": lambda: targets_along(STROKES),
    }[kind]()
    return compare(model, targets, default_start(model, targets.kind), PlanSettings(arm=name), lambda *_: None)


def lines(axes: Axes, label: str) -> np.ndarray:
    (line,) = [line for line in axes.lines if line.get_label() == label]
    return np.asarray(line.get_xydata())


def test_the_convergence_is_shown_beside_the_printed_figures() -> None:
    comparison = compared("drawing_arm", "single")
    figure = plot_comparison(comparison)
    convergence, side, above = figure.axes
    errors = np.array([state.error_mm for state in comparison.convergences[0].steps])
    np.testing.assert_allclose(lines(convergence, "along the paper")[:, 1], np.hypot(*errors[:, :2].T))
    np.testing.assert_allclose(lines(convergence, "across it")[:, 1], np.abs(errors[:, 2]))
    rings = [np.asarray(line.get_xydata()) for line in convergence.lines if "printed" in str(line.get_label())]
    for index, (ring, row) in enumerate(zip(rings, ITERATIONS, strict=True)):
        np.testing.assert_allclose(ring, [[index, 10 * row.error_plane_cm], [index, 10 * row.error_height_cm]])
    links = [np.asarray(line.get_xydata()) for line in above.lines if line.get_label() in ("_links", "start")]
    assert len(links) == 1 + len(shown(comparison))
    for drawn, (_, measured) in zip(links[1:], shown(comparison), strict=True):
        np.testing.assert_allclose(drawn[-1, ::-1], tips_by_product(comparison.arm, measured.joints)[0, :2], atol=1e-9)
    assert (convergence.get_xlabel(), convergence.get_ylabel()) == ("iteration", "error of the tip (mm)")
    assert above.get_xlim()[0] > above.get_xlim()[1]  # arm y grows to the left, as seen from behind the base
    assert side.get_ylabel().endswith("(mm)")
    figure.draw_without_rendering()


def test_an_arm_without_prints_has_none_shown() -> None:
    figure = plot_comparison(compared("scara", "single"))
    assert not [line for line in figure.axes[0].lines if "printed" in str(line.get_label())]
    figure.draw_without_rendering()


def test_along_a_drawing_every_joint_is_shown_with_its_limits_and_strokes_apart() -> None:
    comparison = compared("scara", "drawing")
    figure = plot_comparison(comparison)
    able = shown(comparison)
    maps, panels = figure.axes[: len(able)], figure.axes[len(able) :]
    assert [axes.get_ylabel() for axes in panels] == ["tip's error (mm)", "q1 (deg)", "q2 (deg)", "q3 (mm)", "q4 (deg)"]
    for result, measured in able:
        for index, axes in enumerate(panels[1:]):
            positions = lines(axes, result.method.title)
            assert np.flatnonzero(np.isnan(positions[:, 1])).tolist() == [
                5
            ]  # after the five targets of the first stroke
            kept = positions[~np.isnan(positions[:, 1])]
            np.testing.assert_allclose(kept[:, 1], comparison.arm.to_file_units(measured.joints)[:, index])
            np.testing.assert_allclose(kept[:, 0], [0, 1, 2, 3, 4, 4, 5, 6, 7])
    for axes, (result, _) in zip(maps, able, strict=True):
        assert len(lines(axes, "within")) == 9 and not len(lines(axes, "outside")) and not len(lines(axes, "unsolved"))
        assert axes.get_title(loc="left") == f"{result.method.title}: 0.0 % outside"
    figure.draw_without_rendering()


def test_limits_are_drawn_where_they_are_and_targets_outside_are_marked() -> None:
    comparison = compared("scara", "drawing")
    q1 = comparison.results[-1].measured.joints[:, 0]  # type: ignore[union-attr]
    narrow = _with_upper_limit(comparison, float(np.median(q1)))
    figure = plot_comparison(narrow)
    able = shown(narrow)
    limit = np.degrees(narrow.arm.maximum[0])
    panel = figure.axes[len(able) + 1]
    assert [line for line in panel.lines if np.allclose(line.get_ydata(), limit)]
    (outside,) = [line for line in figure.axes[len(able) - 1].lines if line.get_label() == "outside"]
    np.testing.assert_allclose(
        np.sort(np.asarray(outside.get_xdata())), np.sort(narrow.targets.tips_mm[q1 > narrow.arm.maximum[0], 1])
    )
    assert len(outside.get_xdata()) == 4


def _with_upper_limit(comparison: Comparison, limit: float) -> Comparison:
    first, *rest = comparison.arm.joints
    return replace(comparison, arm=replace(comparison.arm, joints=(replace(first, maximum=limit), *rest)))


def test_distributions_rise_to_the_share_that_is_solved() -> None:
    comparison = compared("scara", "random")
    figure = plot_comparison(comparison)
    assert len(figure.axes) == 6
    for result, measured in shown(comparison):
        share = 100 * measured.solved.mean()
        errors = lines(figure.axes[0], result.method.title)
        assert errors[-1, 1] == pytest.approx(share) and (np.diff(errors, axis=0) >= 0).all()
        assert errors[-1, 0] == pytest.approx(max(measured.error_mm[measured.solved].max(), 1e-9))
        drawn = [line.get_label() for line in figure.axes[1].lines]
        assert (result.method.title in drawn) == result.method.iterates
        limits = lines(figure.axes[2], result.method.title)
        outside = result.figures.outside_share or 0.0
        assert (limits[:, 0] > 1e-9).sum() / max(len(limits), 1) == pytest.approx(outside)
    figure.draw_without_rendering()


def test_nothing_found_is_nothing_to_draw() -> None:
    comparison = compared("scara", "random")
    with pytest.raises(UsageError, match="nothing to draw"):
        plot_comparison(replace(comparison, results=tuple(replace(each, measured=None) for each in comparison.results)))
