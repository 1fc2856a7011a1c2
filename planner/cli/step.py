"""`plan step`: a small step of the tool as one of the joints, and back."""

from __future__ import annotations

import json

import numpy as np

from planner.cli.joints import all_joints
from planner.cli.parser import Parser
from planner.cli.quantities import angle_deg
from planner.cli.terminal import print_lines
from planner.errors import UsageError
from planner.settings import PlanSettings

_DESCRIPTION = """\
Say which small step of the joints makes a small step of the tool at a configuration, or what a step of the joints makes
of the tool; what of it is impossible there, which motion is internal, and whether a singularity can be left with the
tool at rest."""

_EPILOG = """\
examples:
  plan step --arm scara --at 0 90 -120 -90 --tool 1 -1 0 0 0 0 --frame 2
  plan step --arm six_joint --at 0 30 20 0 40 0 --tool 0 0 1        the turn of the tool is left to the arm
  plan step --arm scara --at 0 0 -120 0 --joints 1 -2 0 1           a step of the joints"""


def step(arguments: list[str]) -> int:
    """Describe one step. Errors: PlannerError."""
    parser = Parser("plan step", _DESCRIPTION, _EPILOG)
    parser.add_argument("--arm", default=PlanSettings().arm, metavar="NAME|FILE", help="the arm (default: %(default)s)")
    parser.add_argument(
        "--at",
        nargs="+",
        type=angle_deg,
        required=True,
        metavar="Q",
        help="the configuration: a position for each joint (deg or mm), or for each that no coupling drives",
    )
    parser.add_argument(
        "--tool",
        nargs="+",
        type=angle_deg,
        metavar="D",
        help="the step of the tool: x y z (mm), or x y z and turns about these axes (deg)",
    )
    parser.add_argument("--joints", nargs="+", type=angle_deg, metavar="D", help="or a step of each joint (deg or mm)")
    parser.add_argument(
        "--frame",
        default="base",
        metavar="K",
        help="whose axes count: base, tool or the number of a frame (default: base)",
    )
    parser.add_argument("--json", action="store_true", help="print it as JSON")
    options = parser.parse_args(arguments)
    if (options.tool is None) == (options.joints is None):
        raise UsageError("give either --tool, a step of the tool, or --joints, one of the joints")
    if options.tool is not None and len(options.tool) not in (3, 6):
        raise UsageError(f"--tool: 3 numbers, or 6 with the turns, not {len(options.tool)}")

    from planner.arms.arm_file import load_arm
    from planner.kinematics.small_step import step_of_joints, step_of_tool
    from planner.kinematics.step_description import step_description, step_lines

    arm = load_arm(options.arm)
    numbers = {"base": 0, "tool": arm.n_joints} | {str(index): index for index in range(arm.n_joints + 1)}
    if options.frame not in numbers:
        raise UsageError(f"--frame {options.frame}: arm '{arm.name}' has base, tool and 0 to {arm.n_joints}")
    frame = numbers[options.frame]
    at = all_joints(arm, options.at, "--at")
    asked = None
    if options.tool is not None:
        asked = np.array(options.tool) * np.array([1.0] * 3 + [np.pi / 180] * 3)[: len(options.tool)]
        found = step_of_tool(arm, at, asked, frame)
    else:
        independent = list(arm.independent_joints)
        if len(options.joints) not in (arm.n_joints, len(independent)):
            all_joints(arm, options.joints, "--joints")  # says how many there are
        given = np.array(options.joints)
        if len(given) < arm.n_joints:
            given_si = arm.coupling_matrix[0] @ (given * arm.per_file_unit[independent])
        else:
            given_si = arm.from_file_units(given)
        found = step_of_joints(arm, at, given_si, frame)
    described = step_description(arm, at, found, asked, frame)
    print_lines(
        [json.dumps(described, indent=2)]
        if options.json
        else [f"{arm.name}: {arm.source}", "", *step_lines(arm, described)]
    )
    return 0
