"""`plan export`: a trajectory for other systems."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import IO, TYPE_CHECKING, cast

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import angle_deg, names
from planner.cli.terminal import print_note, print_summary
from planner.errors import UsageError

if TYPE_CHECKING:
    from planner.arms.arm import Arm
    from planner.export.gcode import GcodeOptions
    from planner.export.motion import Motion
    from planner.trajectory import Trajectory

FORMATS = {
    "ros2": "trajectory_msgs/JointTrajectory in YAML, or in JSON for a FILE.json",
    "gcode": "a line a sample, each joint an axis: GRBL, grblHAL, FluidNC, Marlin",
    "lerobot": "LeRobot's actions, a line of JSON each",
    "urscript": "a servoj program for six turning joints",
    "csv-1khz": "a trajectory file with 1000 samples a second",
    "mcap": "joint states and the pen for Foxglove (extra mcap)",
}
_CONTROLLERS = ("grbl", "grblhal", "fluidnc", "marlin")
_RATE_HZ = 1000.0
_NOTICED_S = 0.05

_DESCRIPTION = """\
Write a trajectory in the form of another system, so that it can be played there. It is examined first as plan run does:
what would break a limit of the arm, or run into the paper, is not written."""

_EPILOG = (
    "formats:\n"
    + "\n".join(f"  {name:10}{text}" for name, text in FORMATS.items())
    + """

examples:
  plan export traj.csv --format ros2 -o traj.yaml
  plan export traj.csv --format gcode --controller fluidnc -o traj.gcode
  plan export traj.csv --format lerobot -o - | head -2"""
)


def export(arguments: list[str]) -> int:
    """Write one trajectory. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    _check_gcode_options(options)
    check_target(options.output, options.trajectory)
    if options.format == "mcap":
        from planner.export.mcap_file import require_mcap

        require_mcap()

    from hardware.playback.preflight import set_points
    from planner.arms.arm_file import load_arm
    from planner.export.motion import Motion
    from planner.trajectory import read_trajectory

    trajectory = read_trajectory(options.trajectory)
    arm = load_arm(options.arm or trajectory.arm)
    set_points(trajectory, arm, options.trajectory)
    if options.format == "csv-1khz":
        return _resample(options, trajectory, arm)
    motion = Motion.of(trajectory, arm)
    if options.joints is not None:
        motion = motion.only(options.joints)
    _write(options, motion)
    _tell(options, f"{motion.n_samples} samples of {len(motion.joints)} joints, {trajectory.duration_s:.2f} s")
    return 0


def _parser() -> Parser:
    parser = Parser("plan export", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", type=input_file, metavar="traj.csv", help="- for standard input")
    parser.add_argument("--format", required=True, choices=list(FORMATS), help="see below")
    parser.add_argument("-o", "--output", type=output_file, required=True, metavar="FILE", help="- for standard output")
    parser.add_argument("--arm", metavar="NAME|FILE", help="the arm (default: the one in the trajectory)")
    parser.add_argument(
        "--joints", type=names, metavar="NAMES", help="write these alone, in this order: q1,q2 (default: all)"
    )
    parser.add_argument("--quiet", action="store_true", help="no summary, only warnings and errors")
    gcode = parser.add_argument_group("with --format gcode")
    gcode.add_argument("--controller", choices=_CONTROLLERS, help="who is to read it (default: grblhal)")
    gcode.add_argument("--axes", metavar="LETTERS", help="of the joints (default: the first of XYZABCUVW)")
    gcode.add_argument(
        "--pen", metavar="m3|AXIS", help="also set a servo by M3 S..., or an axis, where the pen is put down and up"
    )
    gcode.add_argument("--pen-down", type=angle_deg, metavar="N", help="what it is set to (default: 1000)")
    gcode.add_argument("--pen-up", type=angle_deg, metavar="N", help="and for up (default: 0)")
    return parser


def _check_gcode_options(options: argparse.Namespace) -> None:
    for key in ("controller", "axes", "pen", "pen_down", "pen_up"):
        if getattr(options, key) is not None and options.format != "gcode":
            raise UsageError(f"--{key.replace('_', '-')} goes with --format gcode")
    for key in ("axes", "pen"):
        letters = getattr(options, key)
        is_axis = letters is not None and letters.isascii() and letters.isalpha() and letters.isupper()
        if letters is None or (key == "pen" and (letters == "m3" or (is_axis and len(letters) == 1))):
            continue
        if not is_axis or key == "pen" or set(letters) & set("GMFSPNT"):
            wanted = "m3 or the letter of an axis" if key == "pen" else "letters of axes, such as XYZAB"
            raise UsageError(f"--{key} {letters}: wanted {wanted}")
    if options.format == "csv-1khz" and options.joints is not None:
        raise UsageError("--joints: a trajectory file holds all joints of its arm")


def _resample(options: argparse.Namespace, trajectory: Trajectory, arm: Arm) -> int:
    from planner.export.resampled import resampled
    from planner.trajectory import write_trajectory

    fine = resampled(trajectory, arm, _RATE_HZ)
    write_trajectory(fine, options.output)
    longer_s = fine.duration_s - trajectory.duration_s
    if longer_s > _NOTICED_S:
        print_note(
            f"takes {longer_s:.1f} s longer: what lies between samples at {trajectory.rate_hz:g} Hz would exceed a"
            " limit at full speed (planned with --rate 1000 it takes no longer)"
        )
    _tell(options, f"{fine.n_samples} samples, {fine.duration_s:.2f} s")
    return 0


def _write(options: argparse.Namespace, motion: Motion) -> None:
    from planner.export.gcode import gcode_lines
    from planner.export.lerobot import lerobot_lines
    from planner.export.mcap_file import write_mcap
    from planner.export.ros2 import json_lines, yaml_lines
    from planner.export.urscript import urscript_lines
    from planner.files import written_aside

    target: Path = options.output
    lines: Iterable[str]
    match options.format:
        case "mcap":
            with written_aside(target, binary=True) as file:
                write_mcap(motion, cast("IO[bytes]", file))
            return
        case "ros2":
            lines = (json_lines if target.suffix.lower() == ".json" else yaml_lines)(motion)
        case "gcode":
            lines = gcode_lines(motion, _gcode_options(options))
        case "lerobot":
            lines = lerobot_lines(motion)
        case _:
            lines = urscript_lines(motion)
    with written_aside(target) as file:
        cast("IO[str]", file).writelines(f"{line}\n" for line in lines)


def _gcode_options(options: argparse.Namespace) -> GcodeOptions:
    from planner.export.gcode import Controller, GcodeOptions

    given = {
        "controller": None if options.controller is None else Controller(options.controller),
        "axes": options.axes,
        "pen": options.pen,
        "down": options.pen_down,
        "up": options.pen_up,
    }
    return GcodeOptions(**{key: value for key, value in given.items() if value is not None})


def _tell(options: argparse.Namespace, figures: str) -> None:
    if not options.quiet:
        print_summary([f"{figures}: wrote {options.output}"], options.output)
