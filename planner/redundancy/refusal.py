"""Why an arm has no configuration to draw with: what each test says of the configurations that put its pen on the
paper."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm, PenHold
from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.redundancy.configuration_tests import FREE, LINKS_ABOVE, QUICK, TESTS, ConfigurationTest, within_margins
from planner.redundancy.paper_samples import on_paper, outside_of_base, starts_for_paper

_ROUNDING_MM = 1e-6


def _clear_of_base(arm: Arm) -> ConfigurationTest:
    return ConfigurationTest(
        lambda kinematics, found: outside_of_base(kinematics, kinematics.tip_mm(found)),
        f"have the pen nearer to the base than {arm.workspace.inner_radius_mm:g} mm",
        "lower workspace.inner_radius_mm",
    )


def no_usable_configuration(kinematics: Kinematics) -> PlanError:
    """The error of an arm without any, with counts, the cause that most of them have alone, and what to do."""
    arm = kinematics.arm
    starts = starts_for_paper(kinematics)
    found = on_paper(kinematics, starts)
    rest = f"arm {arm.name}: no configuration puts the pen on the paper: "
    if not len(starts):
        return PlanError(
            rest + f"pen.tool_axis never points at it within the joint limits; {_behind(arm) or 'turn it around'}"
        )
    if not len(found):
        held = " with the pen pointed straight at it" if arm.pen.hold is PenHold.TOOL_AXIS else ""
        return PlanError(
            rest
            + f"of {len(starts)} tried none gets there{held}, joint limits aside; check d_mm and a_mm of the joints,"
            " and [paper]"
        )
    tests = (FREE, *TESTS, _clear_of_base(arm))
    passed = np.array([test.kept(kinematics, found) for test in tests])
    passed[tests.index(QUICK)] |= ~passed[0]
    rejected = (~passed).sum(axis=1)
    alone = (~passed & ((~passed).sum(axis=0) == 1)).sum(axis=1)  # what giving up one test would leave
    worst = int((alone if alone.any() else rejected).argmax())
    told = {0: _direction, 1: _joints}
    counts = [
        f"{rejected[index]} {tests[index].rejects}{told[index](kinematics, found) if index in told else ''}"
        for index in np.argsort(-rejected, kind="stable").tolist()
        if rejected[index]
    ]
    return PlanError(
        rest
        + f"of {len(starts)} tried {len(found)} get there, and of these {', '.join(counts)}; "
        + _remedy(arm, tests[worst])
    )


def _remedy(arm: Arm, test: ConfigurationTest) -> str:
    return (test is LINKS_ABOVE and _behind(arm)) or test.remedy


def _behind(arm: Arm) -> str:
    """What to do where the base stands on the wrong side of the paper, or in it."""
    off_mm = float(arm.paper.T_paper_base[2, 3])
    if off_mm >= -_ROUNDING_MM:
        return ""
    return (
        f"the base stands {-off_mm:.0f} mm behind the paper, whose z points to the side that is drawn on: move [paper],"
        " or turn it around"
    )


def _direction(kinematics: Kinematics, found: FloatArray) -> str:
    """Along which axis of the paper the tip does not move, where it is one for all."""
    _, jacobian = kinematics.task_and_jacobian(found)
    across = np.abs(np.linalg.svd(jacobian[:, :3])[0][:, :, -1]).min(axis=0)
    axis = int(across.argmax())
    return f" (along {'xyz'[axis]} of the paper)" if across[axis] > 1 - 1e-6 else ""


def _joints(kinematics: Kinematics, found: FloatArray) -> str:
    """The joints that are beyond their limits most often."""
    beyond = (~within_margins(kinematics, found)).sum(axis=0)
    order = [index for index in np.argsort(-beyond, kind="stable").tolist() if beyond[index]][:3]
    return " (" + ", ".join(f"{kinematics.arm.joints[index].name} in {beyond[index]}" for index in order) + ")"
