"""What holds for every method on every arm: configurations meet their targets, and figures are recounted by brute
force."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, fields, replace
from itertools import count, pairwise

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arms.arm_file import known_arms
from planner.comparison.compare import Comparison, compare, default_start
from planner.comparison.description import comparison_description
from planner.comparison.figures import Figures, figures_of
from planner.comparison.measured import Measured, measure
from planner.comparison.methods import METHODS
from planner.comparison.table import WIDTH, table_lines
from planner.comparison.targets import TargetKind, Targets, random_targets, single_targets
from planner.errors import TargetBeyondReach
from planner.kinematics.frame_jacobian import chain_frames
from planner.settings import ConfigurationWeights, PlanSettings
from tests.arms.chains import kinematics_of, load_once, model_of, tips_by_product

NAMES = ["dls", "dls-drawing", "nlp", "closed-form", "path"]


def compared(arm: Arm, targets: Targets) -> Comparison:
    model, settings = model_of(arm), PlanSettings(arm=arm.name)
    return compare(model, targets, default_start(model, targets.kind), settings, lambda *_: None)


def single(*place_mm: float) -> Targets:
    return single_targets(np.array([place_mm]))


@pytest.mark.parametrize("name", known_arms())
def test_all_methods_on_random_targets(name: str) -> None:
    arm = load_once(name)
    comparison = compared(arm, random_targets(kinematics_of(arm), 10, 3))
    assert [result.method.name for result in comparison.results] == NAMES
    for result in comparison.results:
        if result.method.name == "closed-form" and arm.closed_form is None:
            assert result.refusal is not None and result.refusal.startswith(f"arm {name} names no closed form")
            assert result.measured is None and result.figures == Figures()
        else:
            assert result.refusal is None and result.measured is not None
            assert_targets_are_met(arm, comparison.targets, result.measured, result.method.tolerance_mm)
            assert_limits_are_recounted(arm, result.measured, result.figures)
            assert result.figures.solved_share is not None and result.figures.solved_share > 0.5
            missed = int((~result.measured.solved).sum())
            assert sum(failure.count for failure in result.failures) == missed
    path = comparison.results[-1].figures
    assert path.solved_share == 1.0 and path.repeat_deg is not None and path.repeat_deg < 1e-6
    assert comparison.results[2].figures.outside_share == 0.0  # the program keeps limits
    assert_readable(comparison)


def assert_targets_are_met(arm: Arm, targets: Targets, found: Measured, tolerance_mm: float) -> None:
    solved = found.solved
    tips = tips_by_product(arm, found.joints[solved])
    miss = np.linalg.norm(tips - targets.tips_mm[solved], axis=1)
    assert (miss <= tolerance_mm + 1e-9).all()
    np.testing.assert_allclose(found.error_mm[solved], miss, atol=1e-5)
    independent = list(arm.independent_joints)
    np.testing.assert_allclose(arm.complete(found.joints[solved][:, independent]), found.joints[solved], atol=1e-12)
    if arm.pen.hold.value == "tool_axis":
        axes = chain_frames(arm, found.joints[solved])[:, -1, :3, :3] @ np.array(arm.pen.tool_axis)
        assert (np.abs(axes[:, :2]) < 0.011).all() and (axes[:, 2] < 0).all()  # to the sine that damping tolerates


def assert_limits_are_recounted(arm: Arm, found: Measured, figures: Figures) -> None:
    outside, worst = 0, {"deg": 0.0, "mm": 0.0}
    for joints, solved in zip(found.joints.tolist(), found.solved.tolist(), strict=True):
        over = [
            max(joint.minimum - value, value - joint.maximum) for joint, value in zip(arm.joints, joints, strict=True)
        ]
        if solved and max(over) > 1e-9:
            outside += 1
        if solved:
            for joint, amount in zip(arm.joints, over, strict=True):
                worst[joint.file_unit] = max(worst[joint.file_unit], amount / joint.per_file_unit)
    solved_count = int(found.solved.sum())
    assert figures.outside_share == pytest.approx(outside / solved_count)
    assert figures.usable_share == pytest.approx((solved_count - outside) / len(found.solved))
    assert figures.excess_deg == pytest.approx(worst["deg"])
    slides = any(joint.file_unit == "mm" for joint in arm.joints)
    assert (figures.excess_mm == pytest.approx(worst["mm"])) if slides else (figures.excess_mm is None)
    assert (figures.excess_joint is not None) == (outside > 0)


def assert_readable(comparison: Comparison) -> None:
    """The same keys for every arm and method, no infinities, and lines that fit."""
    described = json.loads(json.dumps(comparison_description(comparison), allow_nan=False))
    assert list(described) == ["arm", "targets", "start", "methods", "convergence"]
    for method in described["methods"]:
        assert list(method) == [
            "method",
            "title",
            "tolerance_mm",
            "refusal",
            *[field.name for field in fields(Figures)],
            "failures",
            "postures",
        ]
    lines = table_lines(comparison)
    assert max(map(len, lines)) <= WIDTH
    assert lines[2].split() == ["DLS", "DLS", "NLP", "per", "closed", "path"]
    slides = any(joint.file_unit == "mm" for joint in comparison.arm.joints)
    assert any("mm/mm2" in line for line in lines) == slides
    for result in comparison.results:
        assert result.refusal is None or any(result.method.title in line for line in lines)


def test_broken_limits_are_counted_and_the_recount_sees_them() -> None:
    whole = load_once("scara")
    targets = random_targets(kinematics_of(whole), 20, 3)
    found = measure(METHODS[1], whole, ConfigurationWeights(), targets, default_start(model_of(whole), targets.kind))
    first, second, *rest = whole.joints
    half = replace(second, maximum=float(np.median(found.joints[:, 1])))
    arm = replace(whole, joints=(first, half, *rest))
    figures = figures_of(arm, targets, found, iterates=True)
    assert figures.outside_share is not None and figures.outside_share > 0.3 and figures.excess_joint == second.name
    assert_limits_are_recounted(arm, found, figures)


def test_iterations_of_single_targets_are_told_and_random_ones_are_not() -> None:
    arm = load_once("three_joint")
    targets = single_targets(np.array([[150.0, 20.0, 0.0], [120.0, -50.0, 30.0]]))
    comparison = compared(arm, targets)
    assert [each.target_mm.tolist() for each in comparison.convergences] == targets.tips_mm.tolist()
    for index, each in enumerate(comparison.convergences):
        found = comparison.results[0].measured
        assert found is not None and found.iterations[index] == len(each.steps) - 1
        np.testing.assert_array_equal(found.joints[index], each.steps[-1].joints)
    described = comparison_description(comparison)
    assert described["targets"] == {"kind": "single", "count": 2, "tips_mm": targets.tips_mm.tolist()}
    for method, result in zip(described["methods"], comparison.results, strict=True):
        assert result.measured is not None
        tips = tips_by_product(
            arm, np.array([arm.from_file_units(list(configuration.values())) for configuration in method["postures"]])
        )
        assert np.linalg.norm(tips - targets.tips_mm, axis=1).max() <= method["tolerance_mm"] + 1e-9
        assert method["step_deg"] is method["repeat_deg"] is method["drawing_s"] is None
    assert_readable(comparison)


def test_a_target_out_of_reach_is_named_with_its_gap() -> None:
    """The arm stretched out: three links of 50 mm along the paper."""
    with pytest.raises(TargetBeyondReach, match="out of reach") as caught:
        compared(load_once("drawing_arm"), single(300.0, 0.0, 0.0))
    assert caught.value.exit_code == 3 and caught.value.target_mm == (300.0, 0.0, 0.0)
    assert caught.value.gap_mm == pytest.approx(300.0 - 150.0, abs=2)


def test_default_starts() -> None:
    arm = load_once("drawing_arm")
    np.testing.assert_allclose(np.degrees(default_start(model_of(arm), TargetKind.RANDOM)), [0, 60, -40, -50, -60])
    home = default_start(model_of(arm), TargetKind.DRAWING)
    assert (home >= arm.minimum).all() and (home <= arm.maximum).all()
    assert tips_by_product(arm, home[None])[0, 2] == pytest.approx(0.0, abs=1e-6)
    lifted = replace(load_once("scara"), workspace=replace(arm.workspace, inner_radius_mm=5000.0))  # no home
    np.testing.assert_allclose(
        default_start(model_of(lifted), TargetKind.SINGLE), (lifted.minimum + lifted.maximum) / 2
    )


def test_a_method_that_the_arm_has_not_does_not_end_the_comparison() -> None:
    arm = replace(load_once("scara"), workspace=replace(load_once("scara").workspace, inner_radius_mm=5000.0))
    comparison = compared(arm, single(150.0, 30.0, 0.0))
    refused = {result.method.name: result.refusal for result in comparison.results if result.refusal}
    assert set(refused) == {"closed-form", "path"}
    lines = table_lines(comparison)
    assert any(line.startswith("path optimiser: arm scara") for line in lines)
    assert all(cell == "n/a" for line in lines if line.startswith("solved (%)") for cell in line.split()[-2:])


def test_cold_is_building_and_the_first_target_and_warm_is_the_quickest_run() -> None:
    ticks = count()
    arm = load_once("three_joint")
    targets = single_targets(np.array([[150.0, 20.0, 0.0], [120.0, -50.0, 0.0]]))
    found = measure(
        METHODS[3],
        arm,
        ConfigurationWeights(),
        targets,
        default_start(model_of(arm), targets.kind),
        clock=lambda: float(next(ticks)),
    )
    assert found.cold_s == 1.0 and found.warm_s == 0.5


def along_a_line(arm: Arm, seed: int, n: int = 12) -> tuple[Targets, Measured]:
    """Made-up configurations along three strokes, a few of them unsolved."""
    random = np.random.default_rng(seed)
    firsts = np.array([0, 5, 6])
    along = np.concatenate((0.5 * np.arange(5), [0.0], 0.8 * np.arange(n - 6)))
    targets = Targets(TargetKind.DRAWING, random.normal(size=(n, 3)), firsts, along)
    joints, again = (random.uniform(-2, 2, (n, arm.n_joints)) for _ in range(2))
    solved = np.ones(n, dtype=bool)
    solved[random.integers(n)] = False
    return targets, Measured(
        joints,
        solved,
        np.arange(n, dtype=float),
        random.uniform(size=n),
        again,
        random.uniform(size=n) > 0.2,
        0.1,
        0.001,
    )


@pytest.mark.parametrize("name", ["scara", "three_joint"])
@pytest.mark.parametrize("seed", range(5))
def test_figures_along_a_drawing_are_recounted(name: str, seed: int) -> None:
    arm = load_once(name)
    targets, found = along_a_line(arm, seed)
    figures = asdict(figures_of(arm, targets, found, iterates=False))
    sequences = [range(a, b) for a, b in pairwise([*targets.firsts.tolist(), len(found.solved)])]
    for unit in ("deg", "mm"):
        chosen = [index for index, joint in enumerate(arm.joints) if joint.file_unit == unit]
        q = arm.to_file_units(found.joints)[:, chosen]
        again = arm.to_file_units(found.again)[:, chosen]
        steps = [
            abs(q[i + 1] - q[i]).max()
            for c in sequences
            for i in c[:-1]
            if found.solved[i] and found.solved[i + 1] and chosen
        ]
        bends = [
            value
            for c in sequences
            for i in c[1:-1]
            if found.solved[i - 1 : i + 2].all()
            for value in (q[i + 1] - 2 * q[i] + q[i - 1]) / (targets.along_mm[i] - targets.along_mm[i - 1]) ** 2
        ]
        changes = [
            abs(q[i] - again[i]).max() for i in range(len(q)) if found.solved[i] and found.solved_again[i] and chosen
        ]
        if chosen:
            assert figures[f"step_{unit}"] == pytest.approx(max(steps))
            assert figures[f"roughness_{unit}_mm2"] == pytest.approx(
                math.sqrt(sum(value**2 for value in bends) / len(bends))
            )
            assert figures[f"repeat_{unit}"] == pytest.approx(max(changes))
        else:
            assert figures[f"step_{unit}"] is figures[f"roughness_{unit}_mm2"] is figures[f"repeat_{unit}"] is None
    assert figures["iterations"] is None
    assert figures["error_max_mm"] == pytest.approx(found.error_mm[found.solved].max())


def test_nothing_solved_is_nothing_to_tell() -> None:
    arm = load_once("scara")
    targets, found = along_a_line(arm, 0)
    figures = figures_of(arm, targets, replace(found, solved=np.zeros(len(found.solved), dtype=bool)), iterates=True)
    assert (figures.solved_share, figures.usable_share, figures.iterations_max) == (0.0, 0.0, 11)
    assert figures.error_max_mm is figures.outside_share is figures.step_deg is figures.manipulability_min is None
