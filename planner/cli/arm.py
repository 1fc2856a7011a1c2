"""`plan arm [NAME]`: the arms there are, one of them, or one of its configurations."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from planner.cli.arm_import import add_import_options, import_arm, refuse_import_options
from planner.cli.files import output_file
from planner.cli.joints import all_joints
from planner.cli.output import check_folder_target
from planner.cli.parser import Parser
from planner.cli.quantities import angle_deg
from planner.cli.terminal import print_lines
from planner.counted import counted
from planner.errors import PlanError, UsageError

if TYPE_CHECKING:
    from planner.arms.arm import Arm

_DESCRIPTION = """\
List the arms that come with the planner, or describe one: its Denavit-Hartenberg table, limits, couplings and pen.
With --at, describe a configuration of it: the pen's pose, the Jacobian, which motion is internal, which velocity
impossible, and how far the tip strays where a joint is off.
With --urdf, make an arm file of a robot description."""

_EPILOG = """\
examples:
  plan arm
  plan arm drawing_arm
  plan arm my_arm.toml --json
  plan arm my_arm.toml --report my_arm
  plan arm scara --at 0 90 -120 -90 --frame 2
  plan arm --urdf robot.urdf --base base_link --tip tool0 --pen-length 120 -o robot.toml"""

_PAGE = "index.html"


def arm(arguments: list[str]) -> int:
    """List or describe arms. Errors: PlannerError."""
    parser = Parser("plan arm", _DESCRIPTION, _EPILOG)
    parser.add_argument("arm", nargs="?", metavar="NAME|FILE")
    parser.add_argument("--json", action="store_true", help="print the description as JSON")
    parser.add_argument(
        "--at",
        nargs="+",
        type=angle_deg,
        metavar="Q",
        help="describe this configuration: a position for each joint (deg, or mm where it slides), or for "
        "each that no coupling drives",
    )
    parser.add_argument(
        "--frame",
        metavar="K",
        help="with --at: the frame that the Jacobian is expressed in, "
        "base, tool or the number of one between (default: base)",
    )
    parser.add_argument("--report", type=output_file, metavar="DIR", help="write DIR/index.html, a page about the arm")
    add_import_options(parser)
    options = parser.parse_args(arguments)
    if options.urdf is not None:
        describing = {"--json": options.json, "--at": options.at, "--frame": options.frame, "--report": options.report}
        for option, given in describing.items():
            if given:
                raise UsageError(f"{option} describes an arm, and does not go with --urdf")
        return import_arm(options)
    refuse_import_options(options)

    from planner.arms.arm_file import known_arms, load_arm
    from planner.arms.description import arm_description

    if options.arm is None:
        for given, option in (
            (options.json, "--json"),
            (options.at, "--at"),
            (options.frame, "--frame"),
            (options.report, "--report"),
        ):
            if given:
                raise UsageError(f"{option} describes one arm: name it (see plan arm)")
        known = [load_arm(name) for name in known_arms()]
        print_lines(_columns([(one.name, counted(one.n_joints, "joint"), one.source) for one in known]))
        return 0
    described = load_arm(options.arm)
    if options.at is not None:
        return _configuration(described, options.at, options.frame or "base", as_json=options.json)
    if options.frame is not None:
        raise UsageError("--frame goes with --at")
    if options.report:
        return _report(described, options.report)
    paper, refusal = _paper(described)
    description = arm_description(described) | paper
    if options.json:
        print_lines([json.dumps(description, indent=2)])
    else:
        print_lines([f"{described.name}: {described.source}", "", *_table(description, refusal)])
    return 0


def _configuration(arm: Arm, positions: Sequence[float], frame: str, *, as_json: bool) -> int:
    from planner.kinematics.configuration_description import configuration_description, configuration_lines

    numbers = {"base": 0, "tool": arm.n_joints} | {str(index): index for index in range(arm.n_joints + 1)}
    if frame not in numbers:
        raise UsageError(f"--frame {frame}: arm '{arm.name}' has base, tool and 0 to {arm.n_joints}")
    configuration = configuration_description(arm, all_joints(arm, positions, "--at"), numbers[frame])
    print_lines(
        [json.dumps(configuration, indent=2)]
        if as_json
        else [f"{arm.name}: {arm.source}", "", *configuration_lines(arm, configuration)]
    )
    return 0


def _report(arm: Arm, folder: Path) -> int:
    """Errors: OutputError."""
    check_folder_target(folder, _PAGE)
    from planner.report.arm_page import arm_page
    from planner.report.page import write_page

    write_page(arm_page(arm), folder / _PAGE)
    print_lines([f"wrote {folder / _PAGE}"])
    return 0


def _paper(arm: Arm) -> tuple[dict[str, Any], str]:
    """The keys `reach_mm` and `canvas`; for an arm that has none, None and what is in the way."""
    from planner.redundancy.arm_model import ArmModel
    from planner.workspace.reach import paper_in_reach

    try:
        paper = paper_in_reach(ArmModel(arm))
    except PlanError as error:
        return {"reach_mm": None, "canvas": None}, str(error)
    low, high = paper.reach_mm
    return {
        "reach_mm": {"min": round(low, 3), "max": round(high, 3)},
        "canvas": {
            "width_mm": round(paper.width_mm, 3),
            "height_mm": round(paper.height_mm, 3),
            "corners_arm_mm": paper.corners_arm_mm.round(3).tolist(),
        },
    }, ""


def _table(arm: dict[str, Any], refusal: str) -> list[str]:
    rows = [("joint", "kind", "theta", "d", "a", "alpha", "min", "max", "velocity", "acceleration", "jerk", "unit")]
    for joint, dh in zip(arm["joints"], arm["dh"], strict=True):
        numbers = (
            dh["theta_deg"],
            dh["d_mm"],
            dh["a_mm"],
            dh["alpha_deg"],
            joint["min"],
            joint["max"],
            joint["max_velocity"],
            joint["max_acceleration"],
            joint["max_jerk"],
        )
        rows.append((joint["name"], joint["kind"], *map(_number, numbers), joint["unit"]))
    lines = _columns(rows)
    lines.append("(theta and alpha in deg, d and a in mm; limits in the joint's unit, per s, s2 and s3)")
    lines += [
        f"{what}: {_placed(values)}"
        for what, values in (
            *(
                (f"origin of {joint['name']}", dh.get("origin"))
                for joint, dh in zip(arm["joints"], arm["dh"], strict=True)
            ),
            ("tool", arm.get("tool")),
        )
        if values
    ]
    thick = [
        f"{joint['name']} {_number(joint['thickness_mm'])} mm" for joint in arm["joints"] if "thickness_mm" in joint
    ]
    if thick:
        lines.append(f"links that stay apart, by thickness: {', '.join(thick)}")
    for coupling in arm["coupling"]:
        terms = "".join(
            f" {'+' if value >= 0 else '-'} {'' if abs(value) == 1 else f'{abs(value):g} '}{name}"
            for name, value in coupling["coefficients"].items()
        )
        unit = "mm" if "constant_mm" in coupling else "deg"
        lines.append(f"coupling: {coupling['joint']} = {_number(coupling[f'constant_{unit}'])} {unit}{terms}")
    pen = arm["pen"]
    lines.append(
        f"pen: travels {_number(pen['lift_mm'])} mm above the paper, moves only straight up or down "
        f"below {_number(pen['clearance_mm'])} mm"
    )
    reach, canvas = arm["reach_mm"], arm["canvas"]
    if refusal:
        lines.append(f"canvas: none ({refusal})")
        return lines
    corners = ", ".join(f"({_number(x)}, {_number(y)})" for x, y in canvas["corners_arm_mm"])
    lines.append(f"reach: {_number(reach['min'])} to {_number(reach['max'])} mm from the base")
    lines.append(f"canvas: {_number(canvas['width_mm'])} x {_number(canvas['height_mm'])} mm, corners {corners} mm")
    return lines


def _placed(values: dict[str, float]) -> str:
    """An origin or the tool, such as `x 30 mm, yaw 90 deg`."""
    told = ((*key.split("_"), _number(value)) for key, value in values.items())
    return ", ".join(f"{axis} {number} {unit}" for axis, unit, number in told if number != "0")


def _number(value: float) -> str:
    return f"{round(value, 2) + 0.0:.10g}"


def _columns(rows: Iterable[Sequence[str]]) -> list[str]:
    """Rows of text as lines with aligned columns, numbers to the right."""
    table = list(rows)
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    numeric = [all(_is_number(row[k]) for row in table[1:]) and len(table) > 1 for k in range(len(widths))]
    return [
        "  ".join(
            cell.rjust(width) if right else cell.ljust(width)
            for cell, width, right in zip(row, widths, numeric, strict=True)
        ).rstrip()
        for row in table
    ]


def _is_number(text: str) -> bool:
    return text.lstrip("-").replace(".", "", 1).replace("e+", "", 1).isdigit()
