"""`plan identify`: a test motion that finds what joints can do, and the arm file with what was found."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import IO, TYPE_CHECKING, cast

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import number
from planner.cli.terminal import print_lines, waiting
from planner.errors import UsageError

if TYPE_CHECKING:
    from planner.arms.arm import Arm
    from planner.identification.found import Found
    from planner.identification.motion import LadderMotion

_DESCRIPTION = """\
Find the limits of velocity, acceleration and jerk of an arm's joints. With --arm, plan a test motion: with the pen up,
one joint after the other goes back and forth, each step a little harder than the one before, from a tenth of the limits
of the arm file on and beyond them on purpose. Play it with plan run --beyond-limits, then give the arm with what was
recorded, or with what you saw: a new arm file gets the limits that were found, less a margin. Each line says between
what a limit is, or that it was not reached. Go on with the new file. The old one stays as it is."""

_EPILOG = """\
examples:
  plan identify --arm my_arm.toml -o test.csv
  plan run test.csv --beyond-limits --driver feetech --port /dev/ttyACM0 --record told.csv --record-positions at.csv
  plan identify my_arm.toml --record told.csv --positions at.csv -o my_arm_2.toml
  plan identify my_arm.toml --verdicts "q1=14,q2=20/17/12" -o my_arm_2.toml

Verdicts are the last steps of velocity, acceleration and jerk that looked right, 0 for none; one number is all three.
--factor and --rate have to be the same both times. Where the file's limits are a guess, begin with --factor 0.3."""


def identify(arguments: list[str]) -> int:
    """Plan a test motion, or read one. Errors: PlannerError."""
    from planner.identification.motion import LEAST_FACTOR, MOST_FACTOR, USUAL_FACTOR
    from planner.settings import MAX_RATE_HZ, MIN_RATE_HZ

    parser = Parser("plan identify", _DESCRIPTION, _EPILOG)
    parser.add_argument("tested", nargs="?", metavar="ARM", help="the arm that a test motion was played on")
    parser.add_argument("--arm", metavar="NAME|FILE", help="plan a test motion for this arm")
    parser.add_argument(
        "-o", "--output", type=output_file, required=True, metavar="FILE", help="the test motion, or the new arm file"
    )
    parser.add_argument(
        "--factor",
        type=number(minimum=LEAST_FACTOR, maximum=MOST_FACTOR),
        default=USUAL_FACTOR,
        metavar="F",
        help="the last step goes to F times the arm's limits (default: %(default)g)",
    )
    parser.add_argument(
        "--rate",
        type=number(minimum=MIN_RATE_HZ, maximum=MAX_RATE_HZ),
        default=100.0,
        metavar="HZ",
        help="samples a second of the test motion (default: %(default)g)",
    )
    parser.add_argument("--record", type=input_file, metavar="FILE", help="what servos were told: plan run --record")
    parser.add_argument(
        "--positions", type=input_file, metavar="FILE", help="where joints were: plan run --record-positions"
    )
    parser.add_argument("--verdicts", metavar="JOINT=STEP,...", help="the last step of each joint that looked right")
    parser.add_argument("--quiet", action="store_true", help="no summary, only warnings and errors")
    options = parser.parse_args(arguments)
    _check(options)

    from planner.arms.arm_file import load_arm

    arm = load_arm(options.arm or options.tested)
    with waiting("planning the test motion", quiet=options.quiet):
        motion = _motion(arm, options)
    lines = _planned(arm, motion, options) if options.arm else _read(arm, motion, options)
    if not options.quiet:
        print_lines([*lines, f"wrote {options.output}"])
    return 0


def _check(options: argparse.Namespace) -> None:
    """Errors: UsageError."""
    read = [name for name in ("record", "positions", "verdicts") if getattr(options, name) is not None]
    if (options.arm is None) == (options.tested is None):
        raise UsageError("either --arm ARM, to plan a test motion, or ARM and what came of it")
    if options.arm and read:
        raise UsageError(f"--{read[0]} tells of a test motion that was played: name the arm without --arm")
    if options.tested:
        if read not in (["record", "positions"], ["verdicts"]):
            raise UsageError("what came of the test motion? --record and --positions, or --verdicts alone, tell")
        if options.output.suffix != ".toml":
            raise UsageError(f"{options.output}: an arm file ends in .toml")
    arm = options.arm or options.tested
    check_target(
        options.output,
        *([Path(arm)] if arm.endswith(".toml") else []),
        *filter(None, (options.record, options.positions)),
    )


def _motion(arm: Arm, options: argparse.Namespace) -> LadderMotion:
    """Every position is one that its servo gets to, where the arm's file tells."""
    from contextlib import suppress

    from hardware.compensation.servo_values import own_calibration
    from planner.errors import ArmFileError
    from planner.identification.motion import make_motion

    reach = None
    with suppress(ArmFileError):
        reach = own_calibration(arm).reach
    return make_motion(arm, options.arm or options.tested, reach, options.rate, options.factor)


def _planned(arm: Arm, motion: LadderMotion, options: argparse.Namespace) -> list[str]:
    from planner.counted import clock
    from planner.identification.profile import Quantity
    from planner.trajectory import write_trajectory

    write_trajectory(motion.trajectory, options.output)
    lines = [
        f"a test motion of {clock(motion.trajectory.duration_s)}, up to {motion.trajectory.beyond_limits:g} times the"
        f" limits{'' if motion.trajectory.beyond_limits == 1.0 else '; plan run asks for --beyond-limits'}"
    ]
    for joint, one in enumerate(arm.joints):
        ladders = motion.ladders(joint)
        for quantity in Quantity:
            if quantity not in ladders:
                lines.append(f"{one.name}: no room to try its {quantity}")
                continue
            ladder = ladders[quantity]
            start_s, end_s = (at / options.rate for at in (ladder[0].first, ladder[-1].last))
            low, high = (step.level / one.per_file_unit for step in (ladder[0], ladder[-1]))
            lines.append(
                f"{one.name}: {len(ladder)} steps of {quantity}, {start_s:.1f} to {end_s:.1f} s, from {low:.4g} to"
                f" {high:.4g} {one.file_unit}{quantity.per_time}"
            )
    return lines


def _read(arm: Arm, motion: LadderMotion, options: argparse.Namespace) -> list[str]:
    from planner.arms.arm_edit import edited
    from planner.arms.arm_file import arm_file_text
    from planner.files import written_aside
    from planner.identification.found import found_by_verdicts, may_tell_more, with_limits
    from planner.identification.measured import read_verdicts

    if options.verdicts is not None:
        found, by = found_by_verdicts(arm, motion, read_verdicts(options.verdicts, arm)), "by eye"
    else:
        found, by = _measured(arm, motion, options), "from measured positions"
    text = edited(
        arm_file_text(options.tested), arm, with_limits(arm, found), f"Limits as found {by} by plan identify."
    )
    with written_aside(options.output) as file:
        cast("IO[str]", file).write(text)
    lines = [_told(arm, one) for one in found]
    if joints := may_tell_more(arm, found):
        names = ", ".join(arm.joints[joint].name for joint in joints)
        lines.append(f"another test motion, planned for the new file, may tell more of {names}")
    return lines


def _measured(arm: Arm, motion: LadderMotion, options: argparse.Namespace) -> list[Found]:
    from hardware.compensation.servo_values import own_calibration
    from planner.error_model.calibration.files import read_record
    from planner.identification.found import found_by_positions
    from planner.identification.measured import begins_at_s, read_positions

    record = read_record(options.record, arm)
    told = own_calibration(arm).to_servos(arm.from_file_units(motion.trajectory.positions))
    begin_s = begins_at_s(record, told, motion, str(options.record))
    measured = read_positions(options.positions, arm, record, begin_s)
    return found_by_positions(arm, motion, measured, str(options.positions))


def _told(arm: Arm, found: Found) -> str:
    from planner.identification.found import Outcome
    from planner.identification.motion import limits_of

    joint = arm.joints[found.joint]
    per, unit = joint.per_file_unit, f"{joint.file_unit}{found.quantity.per_time}"
    before, proposed, followed, beyond = (
        f"{value / per:.4g}"
        for value in (limits_of(joint).of(found.quantity), found.proposed, found.followed, found.beyond)
    )
    known = {
        Outcome.FOUND: f"it is between {followed} and {beyond}",
        Outcome.ROUGHLY: f"roughly: it is between {followed} and {beyond}",
        Outcome.HIDDEN: f"at least {followed}: {' and '.join(found.hidden_by)} may have given in before it",
        Outcome.NOT_REACHED: f"not reached: at least {followed}",
        Outcome.UNKNOWN: "not known: nothing was to be seen of it",
    }[found.outcome]
    return f"{joint.name}: {found.quantity} {before} -> {proposed} {unit}; {known}"
