"""`plan jog`: day one of a new arm, one joint at a time."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, cast

from planner.cli.files import output_file
from planner.cli.jog_commands import COMMANDS, Keys, carry_out
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.terminal import print_lines, print_note
from planner.errors import UsageError

if TYPE_CHECKING:
    from hardware.drivers.driver import Driver
    from hardware.jog.jogging import Jogging
    from planner.arms.arm import Arm

_DESCRIPTION = """\
Move one joint of an arm at a time, slowly and inside the ranges of its file, by keys or by the commands of a script, to
find out which way it turns, where its zero and its limits are, and how high the paper lies. Writes an arm file."""

_EPILOG = f"""\
{COMMANDS}

examples:
  plan jog --arm my_arm.toml -o my_arm_1.toml --driver maestro --port /dev/ttyACM0
  plan jog --arm my_arm.toml -o my_arm_1.toml --script moves.txt
  plan jog --arm so101 -o my_so101.toml --import lerobot calibration.json"""


def jog(arguments: list[str]) -> int:
    """Jog one arm. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    _check(options)

    from planner.arms.arm_file import load_arm

    arm = load_arm(options.arm)
    if options.imported:
        from planner.arms.lerobot import with_lerobot_calibration

        arm = with_lerobot_calibration(arm, Path(options.imported[1]))
        if not options.port and not options.script:
            _write(options, arm)
            return 0
    _jogged(options, arm)
    return 0


def _parser() -> Parser:
    parser = Parser("plan jog", _DESCRIPTION, _EPILOG)
    parser.add_argument("--arm", required=True, metavar="NAME|FILE", help="the arm as it is known so far")
    parser.add_argument("-o", "--output", type=output_file, metavar="ARM.toml", help="what save writes")
    parser.add_argument(
        "--driver",
        default="sim",
        metavar="NAME",
        help="what moves it: sim, native, maestro, maestro-crc, ssc32, feetech or dynamixel (default: %(default)s)",
    )
    parser.add_argument("--port", metavar="PORT|URL", help="where the controller is, as for plan run")
    parser.add_argument("--baud", type=int, metavar="RATE", help="of the serial line (default: the controller's usual)")
    parser.add_argument(
        "--script", metavar="FILE", help="commands to carry out in the place of keys; - for standard input"
    )
    parser.add_argument(
        "--import",
        dest="imported",
        nargs=2,
        metavar=("lerobot", "FILE"),
        help="begin with the ids, zeros and ranges of LeRobot's calibration; alone, it moves nothing",
    )
    return parser


def _check(options: argparse.Namespace) -> None:
    from hardware.drivers.table import DRIVERS, MUJOCO, SIMULATED

    drivers = [name for name in DRIVERS if name != MUJOCO]
    if options.driver not in drivers:
        raise UsageError(f"there is no driver '{options.driver}' to jog with; there are {', '.join(drivers)}")
    if options.imported and options.imported[0] != "lerobot":
        raise UsageError(f"--import {options.imported[0]}: only the calibration of lerobot can be read")
    if options.imported and not options.output:
        raise UsageError("--import needs -o, the arm file to write")
    if options.driver == SIMULATED and options.port:
        raise UsageError("a simulated arm is at no port; name what is there with --driver")
    if options.driver != SIMULATED and not options.port:
        raise UsageError(f"--driver {options.driver} needs --port; plan ports lists what is plugged in")
    if options.baud is not None and options.baud <= 0:
        raise UsageError(f"--baud {options.baud} is no speed of a line, such as 115200")
    if options.output:
        if options.output.suffix != ".toml":
            raise UsageError(f"{options.output}: an arm file ends in .toml")
        check_target(options.output, *([Path(options.arm)] if options.arm.endswith(".toml") else []))


def _jogged(options: argparse.Namespace, arm: Arm) -> None:
    from hardware.clock import InstantClock, WallClock
    from hardware.compensation.servo_values import own_calibration
    from hardware.drivers.table import SIMULATED, calibration_of, make_driver
    from hardware.jog.jogging import Jogging
    from hardware.port import Line
    from hardware.simulation.simulated_arm import SimulatedArm
    from planner.cli.controls import breaking_off

    calibration = own_calibration(arm) if options.driver == SIMULATED else calibration_of(options.driver, arm)
    assert calibration is not None
    simulated = options.driver == SIMULATED
    clock = InstantClock() if simulated else WallClock()
    # Its servos' ranges stop it: limits may turn out to be elsewhere.
    free = replace(
        arm,
        joints=tuple(
            replace(joint, minimum=float(low), maximum=float(high))
            for joint, (low, high) in zip(arm.joints, calibration.reach, strict=True)
        ),
    )
    driver: Driver = (
        SimulatedArm(free, clock)
        if simulated
        else make_driver(options.driver, arm, Line(options.port, options.baud), clock)
    )
    with breaking_off(), closing(driver):
        jogging = Jogging(arm, driver, calibration, clock)
        with _commands(options) as commands:
            try:
                jogging.start()
                _follow(commands, jogging, lambda: _write(options, jogging.arm), by_script=bool(options.script))
            except KeyboardInterrupt:
                driver.emergency_stop()
                raise


def _follow(commands: Iterator[str], jogging: Jogging, save: Callable[[], None], *, by_script: bool) -> None:
    print_lines(jogging.lines())
    for number, command in enumerate(commands, start=1):
        try:
            if not carry_out(command, jogging, save):
                return
        except UsageError as error:
            if by_script:
                raise UsageError(f"line {number} of the script: {error}") from error
            print_note(str(error))
        print_lines(jogging.lines() if not by_script or command.split() == ["show"] else [])


@contextmanager
def _commands(options: argparse.Namespace) -> Iterator[Iterator[str]]:
    """Lines of a script, or what keys stand for. Errors: UsageError."""
    if options.script and options.script != "-":
        try:
            lines = Path(options.script).read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise UsageError(
                f"{options.script}: cannot be read: {getattr(error, 'strerror', None) or error}"
            ) from error
        yield iter(lines)
        return
    if options.script or not sys.stdin.isatty():
        options.script = "-"
        yield iter(sys.stdin)
        return
    from planner.cli.controls import Controls

    print_note(COMMANDS[COMMANDS.index("keys:") :])
    keys = Keys()
    with Controls().keyboard():
        yield (command for key in _pressed(sys.stdin.fileno()) if (command := keys.command(key)) is not None)


def _pressed(terminal: int) -> Iterator[str]:
    """Keys, until the terminal is gone; what arrows and function keys arrive as is passed over."""
    from planner.cli.controls import SEQUENCES

    while True:
        try:
            arrived = os.read(terminal, 64)
        except OSError:
            arrived = b""
        if not arrived:
            return
        yield from SEQUENCES.sub(b"", arrived).decode("utf-8", errors="replace")


def _write(options: argparse.Namespace, arm: Arm) -> None:
    from planner.arms.arm_file import read_arm_file
    from planner.arms.arm_text import arm_toml
    from planner.errors import ArmFileError
    from planner.files import written_aside

    if not options.output:
        raise UsageError("nowhere to save it: give -o ARM.toml")
    text = arm_toml(arm, [f"{arm.name} as found by plan jog."])
    with tempfile.TemporaryDirectory() as folder:
        tried = Path(folder) / options.output.name
        tried.write_text(text, encoding="utf-8")
        try:
            read_arm_file(tried)
        except ArmFileError as error:
            raise UsageError(f"what was found makes no arm file yet: {'; '.join(error.faults)}") from error
    with written_aside(options.output) as file:
        cast("IO[str]", file).write(text)
    print_lines([f"wrote {options.output}"])
