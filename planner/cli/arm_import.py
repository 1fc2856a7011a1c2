"""`plan arm --urdf FILE`: an arm file from a robot description."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import IO, TYPE_CHECKING, cast

from planner.cli.files import STANDARD_INPUT, input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import angle_deg, coordinate_mm, length_mm, number
from planner.cli.terminal import print_note, print_summary
from planner.counted import counted
from planner.errors import UsageError
from planner.files import STANDARD, is_standard_output

if TYPE_CHECKING:
    from planner.arms.urdf.import_options import ImportOptions

_AXES = {
    f"{sign}{name}": tuple(float(f"{sign}1") if k == place else 0.0 for k in range(3))
    for place, name in enumerate("xyz")
    for sign in ("", "-")
}
_HOLDS = ("tool_axis", "construction", "free")
_SHORTEST_S = 1e-3


def add_import_options(parser: Parser) -> None:
    group = parser.add_argument_group("an arm file from a robot description (URDF)")
    group.add_argument("--urdf", type=input_file, metavar="FILE", help="the description; - for standard input")
    group.add_argument("-o", "--output", type=output_file, metavar="ARM.toml", help="the arm file (default: printed)")
    group.add_argument("--base", metavar="LINK", help="the link that the arm stands with (default: the root)")
    group.add_argument(
        "--tip", metavar="LINK", help="the link that holds the pen (default: the end of the longest branch)"
    )
    group.add_argument("--name", metavar="NAME", help="of the arm (default: that of the robot)")
    group.add_argument(
        "--pen-length", type=coordinate_mm, metavar="LENGTH", help="from the tip link to the pen's tip (default: 0)"
    )
    group.add_argument(
        "--tool",
        nargs=6,
        type=angle_deg,
        metavar=("X", "Y", "Z", "ROLL", "PITCH", "YAW"),
        help="the pen's holder, in the frame of the tip link (mm and deg; default: that frame itself)",
    )
    group.add_argument(
        "--tool-axis",
        choices=sorted(_AXES),
        help="which way the nib points in the holder's frame (default: away from the last joint); an axis with a minus "
        "as --tool-axis=-z",
    )
    group.add_argument(
        "--hold",
        choices=_HOLDS,
        help="what keeps the pen to the paper, see docs/arms.md (default: what the chain allows)",
    )
    group.add_argument(
        "--velocity", type=number(), metavar="V", help="of joints without a velocity limit, deg/s or mm/s (default: 90)"
    )
    group.add_argument(
        "--speeding-up",
        type=number(minimum=_SHORTEST_S),
        metavar="SECONDS",
        help="how long a joint takes to its full speed: accelerations are no part of URDF (default: 0.2)",
    )
    group.add_argument(
        "--jerking",
        type=number(minimum=_SHORTEST_S),
        metavar="SECONDS",
        help="and to its full acceleration (default: 0.05)",
    )
    group.add_argument(
        "--turn",
        type=number(maximum=3600),
        metavar="DEG",
        help="of joints without limits, to either side (default: 180)",
    )
    group.add_argument(
        "--inner-radius",
        type=length_mm(zero=True),
        metavar="LENGTH",
        help="what the pen stays away from the base axis (default: 0.15 of the arm's length)",
    )
    group.add_argument("--lift", type=length_mm(), metavar="LENGTH", help="of pen-up travel (default: 5 mm)")


_OPTIONS = (
    ("output", "-o"),
    ("base", "--base"),
    ("tip", "--tip"),
    ("name", "--name"),
    ("pen_length", "--pen-length"),
    ("tool", "--tool"),
    ("tool_axis", "--tool-axis"),
    ("hold", "--hold"),
    ("velocity", "--velocity"),
    ("speeding_up", "--speeding-up"),
    ("jerking", "--jerking"),
    ("turn", "--turn"),
    ("inner_radius", "--inner-radius"),
    ("lift", "--lift"),
)


def refuse_import_options(options: argparse.Namespace) -> None:
    """Errors: UsageError where one is given without --urdf."""
    for key, option in _OPTIONS:
        if getattr(options, key) is not None:
            raise UsageError(f"{option} goes with --urdf")


def import_arm(options: argparse.Namespace) -> int:
    """Write the arm file. Errors: PlannerError."""
    target: Path = options.output or Path(STANDARD)
    if target.suffix != ".toml" and not is_standard_output(target):
        raise UsageError(f"{target}: an arm file ends in .toml")
    if options.arm is not None:
        raise UsageError(f"--urdf makes an arm file, so that no arm is named ({options.arm}); --name names the new one")
    check_target(target, options.urdf)

    from planner.arms.arm_file import arm_of_text
    from planner.arms.arm_text import arm_toml
    from planner.arms.urdf.imported import imported
    from planner.arms.urdf.robot import read_urdf
    from planner.files import written_aside
    from planner.kinematics.usual_hold import with_hold, with_usual_hold

    found = imported(read_urdf(options.urdf), _said(options))
    arm, remarks = with_usual_hold(found.arm) if options.hold is None else with_hold(found.arm, options.hold)
    remarks = [*found.remarks, *remarks]
    source = "standard input" if options.urdf == STANDARD_INPUT else options.urdf.name
    head = [f"Made of {source} by plan arm --urdf: link {found.base} to link {found.tip}.", "", *remarks]
    text = arm_toml(arm, head)
    arm_of_text(text, str(options.urdf))  # what is no arm for other reasons is told now
    with written_aside(target) as file:
        cast("IO[str]", file).write(text)
    for remark in remarks:
        print_note(remark)
    moving = counted(arm.n_joints, "joint")
    if not is_standard_output(target):
        print_summary([f"{target}: arm {arm.name}, {moving} from link {found.base} to link {found.tip}"], target)
    return 0


def _said(options: argparse.Namespace) -> ImportOptions:
    from planner.arms.rigid_transform import RigidTransform
    from planner.arms.urdf.import_options import ImportOptions

    given = {
        "base": options.base,
        "tip": options.tip,
        "name": options.name,
        "tool_axis": None if options.tool_axis is None else _AXES[options.tool_axis],
        "pen_length_mm": options.pen_length,
        "velocity": options.velocity,
        "speeding_up_s": options.speeding_up,
        "jerking_s": options.jerking,
        "turn_deg": options.turn,
        "inner_radius_mm": options.inner_radius,
        "lift_mm": options.lift,
    }
    if options.tool is not None:
        x, y, z, *angles = options.tool
        given["tool"] = RigidTransform(x, y, z, *map(math.radians, angles))
    return ImportOptions(**{key: value for key, value in given.items() if value is not None})
