"""`planner.check` and `planner.compare`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Unpack

from planner.api.inputs import DrawingInput, Progress, arm_name, arm_of, drawing_source, shown
from planner.api.options import PlanOptions, settings_with
from planner.checked import number_in
from planner.errors import UsageError
from planner.settings import MIN_TOLERANCE_MM, PlanSettings

if TYPE_CHECKING:
    from planner.arms.arm import Arm
    from planner.arrays import FloatArray
    from planner.checking.check_result import CheckResult
    from planner.comparison.compare import Comparison
    from planner.comparison.targets import Targets
    from planner.redundancy.arm_model import ArmModel
    from planner.trajectory import Trajectory

_MOST_TARGETS = 1_000_000


def check(
    trajectory: Trajectory | str | os.PathLike[str],
    drawing: DrawingInput | None = None,
    *,
    arm: Arm | str | os.PathLike[str] | None = None,
    tolerance_mm: float | None = None,
) -> CheckResult:
    """Hold a trajectory against everything that one promises, with mathematics that the planner has no part in.

    Args:
        trajectory: A trajectory, or the path of its file.
        drawing: What was to be drawn, as of :func:`planner.plan`; without it the pen's path is not compared.
        arm: Judge it for this arm; the one that the trajectory names if it is not given.
        tolerance_mm: How far the pen may be off the drawing; what `plan` plans the arm with if it is not given.

    Returns:
        The findings, one a law; ``passed`` sums them up, and ``print(result)`` shows them.

    Raises:
        TrajectoryFileError, DrawingError, UnknownArm, ArmFileError: A file cannot be used.
        UsageError: An argument means nothing.
    """
    from planner.arms.usual_settings import usual_tolerance_mm
    from planner.checking.check import check_trajectory
    from planner.drawing.svg import read_drawing
    from planner.trajectory import Trajectory

    if tolerance_mm is not None:
        tolerance_mm = number_in("tolerance_mm", tolerance_mm, minimum=MIN_TOLERANCE_MM)
    if isinstance(trajectory, str | os.PathLike):
        trajectory = Trajectory.load(trajectory)
    elif not isinstance(trajectory, Trajectory):
        raise UsageError(f"check takes a trajectory or its file, not a value of type {type(trajectory).__name__}")
    wanted = None if drawing is None else read_drawing(drawing_source(drawing), options=trajectory.reading)
    judged = arm_of(trajectory.arm if arm is None else arm)
    tolerance = usual_tolerance_mm(judged) if tolerance_mm is None else tolerance_mm
    return check_trajectory(trajectory, judged, wanted, tolerance)


def compare(
    drawing: DrawingInput | None = None,
    arm: Arm | str | os.PathLike[str] | None = None,
    *,
    targets: Sequence[Sequence[float]] | FloatArray | None = None,
    random: int | None = None,
    seed: int = 0,
    settings: PlanSettings | None = None,
    progress: Progress = False,
    **options: Unpack[PlanOptions],
) -> Comparison:
    """Every method of inverse kinematics on the same targets, measured alike.

    Args:
        drawing: The targets are points along it, as it would be placed. Or, in its place:
        targets: Places for the pen, (n, 2) or (n, 3), mm from the base of the arm; or
        random: As many places on the paper as this, drawn at random.
        seed: Of the random places.
        arm: As of :func:`planner.plan`.
        settings, options: As of :func:`planner.plan`; placement and motion are of drawings.
        progress: As of :func:`planner.plan`.

    Returns:
        The figures of every method; ``print(comparison)`` shows them as a table.

    Raises:
        UsageError: An argument means nothing.
        PlanError: A target is out of reach.
        DrawingError, UnknownArm, ArmFileError: As of :func:`planner.plan`.
    """
    from planner.comparison.compare import compare as compare_methods
    from planner.comparison.compare import default_start
    from planner.redundancy.arm_model import ArmModel

    if [drawing, targets, random].count(None) != 2:
        raise UsageError("one of drawing, targets and random says what to compare on")
    wanted = settings_with(settings, None if arm is None else arm_name(arm), options)
    model = ArmModel(arm_of(wanted.arm if arm is None else arm))
    chosen = _targets(drawing, targets, random, seed, model, wanted)
    with shown(progress) as show:
        return compare_methods(model, chosen, default_start(model, chosen.kind), wanted, show)


def _targets(
    drawing: DrawingInput | None,
    targets: Sequence[Sequence[float]] | FloatArray | None,
    random: int | None,
    seed: int,
    model: ArmModel,
    settings: PlanSettings,
) -> Targets:
    from planner.comparison.targets import random_targets, single_targets, targets_along
    from planner.pipeline import placed_strokes

    if targets is not None:
        return single_targets(_tips_mm(targets))
    if random is not None:
        count = number_in("random", random, minimum=1, maximum=_MOST_TARGETS)
        return random_targets(model.kinematics, int(count), int(number_in("seed", seed, zero=True, maximum=2**32 - 1)))
    assert drawing is not None
    strokes, _ = placed_strokes(drawing_source(drawing), model, settings)
    return targets_along(strokes)


def _tips_mm(targets: Sequence[Sequence[float]] | FloatArray) -> FloatArray:
    """(n, 3), on the paper where there is no height. Errors: UsageError."""
    import numpy as np

    try:
        places = np.array(targets, dtype=np.float64)
    except (TypeError, ValueError):
        places = np.empty(0)
    if places.ndim != 2 or places.shape[1] not in (2, 3) or not len(places) or not np.isfinite(places).all():
        raise UsageError("targets are rows of two or three finite numbers, x y or x y z in mm")
    return np.column_stack((places, np.zeros((len(places), 3 - places.shape[1]))))
