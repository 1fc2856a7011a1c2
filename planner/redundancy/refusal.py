"""Why an arm has no configuration to draw with: what each test says of the configurations that put its pen on the
paper."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import PenHold
from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import project
from planner.redundancy.configuration_tests import TESTS, within_margins
from planner.redundancy.samples import on_ray, starts_for_rays, turned_into_range

_MOST_TRIED = 20_000


def no_usable_configuration(kinematics: Kinematics) -> PlanError:
    """The error of an arm without any, with counts, the cause that most of them have alone, and what to do."""
    arm = kinematics.arm
    radii, rays, starts = starts_for_rays(kinematics)
    rest = f"arm {arm.name}: no configuration puts the pen on the paper: "
    if not len(starts):
        return PlanError(rest + "pen.tool_axis never points down within the joint limits; turn it around")
    chosen = np.unique(np.linspace(0, len(starts) - 1, min(_MOST_TRIED, len(starts))).astype(np.int64))
    found, exact = project(kinematics, starts[chosen], on_ray(radii[rays[chosen]]))
    found = turned_into_range(kinematics, found[exact])
    tried = f"of {len(chosen)} tried at {radii[0]:g} mm or more from the base axis "
    if not len(found):
        held = " with the pen pointed straight down" if arm.pen.hold is PenHold.TOOL_AXIS else ""
        return PlanError(
            rest + tried + f"none gets there{held}, joint limits aside; check d_mm and a_mm of the joints"
            " and workspace.inner_radius_mm"
        )
    passed = np.array([test.kept(kinematics, found) for test in TESTS])
    rejected = (~passed).sum(axis=1)
    alone = (~passed & ((~passed).sum(axis=0) == 1)).sum(axis=1)  # what giving up one test would leave
    worst = int((alone if alone.any() else rejected).argmax())
    counts = [
        f"{rejected[index]} {TESTS[index].rejects}{_joints(kinematics, found) if index == 0 else ''}"
        for index in np.argsort(-rejected, kind="stable").tolist()
        if rejected[index]
    ]
    return PlanError(rest + tried + f"{len(found)} get there, and of these {', '.join(counts)}; {TESTS[worst].remedy}")


def _joints(kinematics: Kinematics, found: FloatArray) -> str:
    """The joints that are beyond their limits most often."""
    beyond = (~within_margins(kinematics, found)).sum(axis=0)
    order = [index for index in np.argsort(-beyond, kind="stable").tolist() if beyond[index]][:3]
    return " (" + ", ".join(f"{kinematics.arm.joints[index].name} in {beyond[index]}" for index in order) + ")"
