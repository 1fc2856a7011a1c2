"""`planner.plan`: from a drawing to a trajectory."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING, Unpack

from planner.api.inputs import DrawingInput, Progress, arm_name, arm_of, drawing_source, shown
from planner.api.options import PlanOptions, settings_with
from planner.api.result import Plan
from planner.checked import number_in
from planner.settings import PlanSettings

if TYPE_CHECKING:
    from planner.arms.arm import Arm

_MOST_WORKERS = 1024


def plan(
    drawing: DrawingInput,
    arm: Arm | str | os.PathLike[str] | None = None,
    *,
    settings: PlanSettings | None = None,
    progress: Progress = False,
    workers: int = 1,
    **options: Unpack[PlanOptions],
) -> Plan:
    """Plan the motion of an arm that draws a drawing.

    The result is the same as that of the command `plan`.

    Args:
        drawing: A path, the text of an SVG (it begins with ``<``), its bytes, or a file object, text or binary.
        arm: A name (see ``plan arm``), the path of an arm file, or what :func:`planner.load_arm` returns.
            The settings' own, ``"drawing_arm"``, if it is not given.
        settings: What the options change; the defaults if they are not given.
        progress: True for a bar on standard error, or a function that is called as ``progress(stage, done, total)``.
            What it raises ends the plan.
        workers: Processes that share the work. A script that asks for more than one needs the usual
            ``if __name__ == "__main__":``.
        options: The fields of :class:`planner.PlanSettings`, such as ``speed_mm_s=40`` or ``method="nlp"``. Where
            neither they nor `settings` say it, ``rate_hz`` and ``tolerance_mm`` are the usual ones of the arm.

    Raises:
        DrawingError: The drawing cannot be read, or holds nothing that a pen can draw.
        ArmFileError, UnknownArm: There is no such arm.
        UsageError: An option means nothing. UnknownOption, which is a TypeError too: there is no such option.
        PlanError: This arm cannot draw it so: TargetOutOfReach, DoesNotFit, LinksCollide.
    """
    from planner.arms.usual_settings import usual_rate_hz, usual_tolerance_mm
    from planner.execution.workers import Workers
    from planner.pipeline import plan as plan_drawing

    wanted = settings_with(settings, None if arm is None else arm_name(arm), options)
    helpers = Workers(int(number_in("workers", workers, minimum=1, maximum=_MOST_WORKERS)))
    source = drawing_source(drawing)
    loaded = arm_of(wanted.arm if arm is None else arm, cache=wanted.cache)
    if settings is None:
        rate_hz, tolerance_mm = usual_rate_hz(loaded), usual_tolerance_mm(loaded)
        wanted = replace(
            wanted,
            rate_hz=wanted.rate_hz if "rate_hz" in options else rate_hz,
            tolerance_mm=wanted.tolerance_mm if "tolerance_mm" in options else tolerance_mm,
        )
    with shown(progress, stages_of_a_plan=True) as show:
        planned = plan_drawing(source, wanted, show, helpers, loaded)
    return Plan(planned.trajectory, planned.summary, planned.drawing, loaded, wanted)


def load_arm(arm: str | os.PathLike[str]) -> Arm:
    """The arm of that name, or of that ``.toml`` file.

    Raises:
        UnknownArm: There is no arm of that name.
        ArmFileError: The file cannot be used; every fault in it is listed.
    """
    return arm_of(arm)
