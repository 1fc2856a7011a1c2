"""`plan jog`: day one of a new arm, one joint at a time."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.events import add_events_option, tell
from planner.cli.files import output_file
from planner.cli.jog_commands import COMMANDS, carry_out
from planner.cli.jog_events import Piped, follow_told
from planner.cli.jog_keyboard import Keyboard
from planner.cli.keys import terminal_keys
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.terminal import print_lines, print_note
from planner.errors import UsageError
from planner.files import STANDARD

if TYPE_CHECKING:
    from hardware.compensation.servo_values import Calibration
    from hardware.drivers.driver import Driver
    from hardware.jog.jogging import Jogging
    from planner.arms.arm import Arm
    from planner.cli.jog_file import FoundArm

_DESCRIPTION = """\
Move one joint of an arm at a time, slowly and inside the ranges of its file, by keys or by the commands of a script, to
find out which way it turns, where its zero and its limits are, and how high the paper lies. What was found is saved in
the arm file, in which all else stays as it is."""

_EPILOG = f"""\
{COMMANDS}

examples:
  plan jog --arm my_arm.toml --driver maestro --port /dev/ttyACM0
  plan jog --arm drawing_arm -o my_arm.toml --script moves.txt
  plan jog --arm so101 -o my_so101.toml --import lerobot calibration.json"""


def jog(arguments: list[str]) -> int:
    """Jog one arm. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    _check(options)

    from planner.cli.jog_file import FoundArm

    found = FoundArm(options.arm, options.output)
    arm = found.before
    if options.imported:
        from planner.arms.lerobot import with_lerobot_calibration

        arm = with_lerobot_calibration(arm, Path(options.imported[1]))
        if not options.port and not options.script and not options.events:
            print_lines([f"wrote {found.write(arm)}"])
            return 0
    _jogged(options, arm, found)
    return 0


def _parser() -> Parser:
    parser = Parser("plan jog", _DESCRIPTION, _EPILOG)
    parser.add_argument("--arm", required=True, metavar="NAME|FILE", help="the arm as it is known so far")
    parser.add_argument(
        "-o", "--output", type=output_file, metavar="ARM.toml", help="what save writes (default: the file of --arm)"
    )
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
        "--from-middle",
        action="store_true",
        help="let hobby servos leap to the middle of their ranges, where the arm file has no [park] pose; without it "
        "jog asks, and a script is refused",
    )
    parser.add_argument(
        "--import",
        dest="imported",
        nargs=2,
        metavar=("lerobot", "FILE"),
        help="begin with the ids, zeros and ranges of LeRobot's calibration; alone, it moves nothing",
    )
    add_events_option(parser, ", and commands on standard input, of which stop holds the arm at once")
    return parser


def _check(options: argparse.Namespace) -> None:
    from hardware.drivers.table import DRIVERS, MUJOCO, SIMULATED

    drivers = [name for name in DRIVERS if name != MUJOCO]
    if options.driver not in drivers:
        raise UsageError(f"there is no driver '{options.driver}' to jog with; there are {', '.join(drivers)}")
    if options.imported and options.imported[0] != "lerobot":
        raise UsageError(f"--import {options.imported[0]}: only the calibration of lerobot can be read")
    if options.driver == SIMULATED and options.port:
        raise UsageError("a simulated arm is at no port; name what is there with --driver")
    if options.driver != SIMULATED and not options.port:
        raise UsageError(f"--driver {options.driver} needs --port; plan ports lists what is plugged in")
    if options.baud is not None and options.baud <= 0:
        raise UsageError(f"--baud {options.baud} is no speed of a line, such as 115200")
    if options.events and options.script not in (None, STANDARD):
        raise UsageError("--events takes its commands from standard input, not from a --script")
    if options.output is None and options.arm.endswith(".toml"):
        options.output = Path(options.arm)
    if options.imported and not options.output:
        raise UsageError("--import needs -o, the arm file to write")
    if options.output:
        if options.output.suffix != ".toml":
            raise UsageError(f"{options.output}: an arm file ends in .toml")
        check_target(options.output)


def _jogged(options: argparse.Namespace, arm: Arm, found: FoundArm) -> None:
    from hardware.clock import InstantClock, WallClock
    from hardware.compensation.servo_values import own_calibration
    from hardware.drivers.table import SIMULATED, calibration_of, make_driver
    from hardware.jog.jogging import Jogging
    from hardware.port import Line
    from hardware.simulation.simulated_arm import SimulatedArm
    from planner.cli.controls import breaking_off
    from planner.cli.run_claims import alone_on

    simulated = options.driver == SIMULATED
    calibration = own_calibration(arm) if simulated else calibration_of(options.driver, arm)
    assert calibration is not None
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
    with (
        breaking_off(),
        alone_on(options.port, f"jogging {arm.name}"),
        closing(driver),
        _keyboard(options) as keyboard,
    ):
        said = Piped() if options.events else keyboard
        commands = said.commands() if said else _lines(options.script)
        jogging = Jogging(arm, driver, calibration, clock, said.watch if said else lambda: None)
        driver.open()
        if not simulated:
            _announce(options, arm, calibration, keyboard)
        try:
            jogging.start()
            if options.events:
                follow_told(commands, jogging, lambda: found.write(jogging.arm), lambda: found.holds(jogging.arm))
            else:
                _follow(commands, jogging, lambda: found.write(jogging.arm), by_script=keyboard is None)
        except KeyboardInterrupt:
            driver.emergency_stop()
            if options.events:
                tell("stopped")
            else:
                print_note("stopped: the arm holds where it is")
            raise
        finally:
            if not found.holds(jogging.arm):
                print_note("what was found since it was saved last is in no file")


def _announce(options: argparse.Namespace, arm: Arm, calibration: Calibration, keyboard: Keyboard | None) -> None:
    """Say how the servos begin to move, and make sure that somebody wants that where they may leap. Errors: UsageError
    where nobody does."""
    from hardware.drivers.table import MEASURE_POSITIONS
    from hardware.jog.jogging import start_of
    from hardware.motion.slow_transfer import in_words

    where = "the park pose" if arm.park else "the middle of their ranges"
    pose = f"{where} ({in_words(arm, start_of(arm, calibration))})"
    if options.driver in MEASURE_POSITIONS:
        print_note(f"the servos go slowly from where they are to {pose}")
        return
    if arm.park is not None:
        print_note(f"the position of the arm is not known: its servos are attached at {pose}")
        return
    leap = f"the position of the arm is not known and its file has no [park] pose: its servos leap to {pose}"
    if options.from_middle:
        print_note(leap)
        return
    if keyboard is None:
        raise UsageError(f"{leap}; bring the arm near that by hand, keep clear, and say --from-middle")
    print_note(f"{leap}; bring the arm near that by hand, keep clear, and press y")
    if not keyboard.agrees():
        raise UsageError("nobody pressed y: nothing was moved")


def _follow(commands: Iterator[str], jogging: Jogging, save: Callable[[], str], *, by_script: bool) -> None:
    print_lines(jogging.lines())
    for number, command in enumerate(commands, start=1):
        try:
            if not carry_out(command, jogging, lambda: print_lines([f"wrote {save()}"])):
                return
        except UsageError as error:
            if by_script:
                raise UsageError(f"line {number} of the script: {error}") from error
            print_note(str(error))
        print_lines(jogging.lines() if not by_script or command.split() == ["show"] else [])


@contextmanager
def _keyboard(options: argparse.Namespace) -> Iterator[Keyboard | None]:
    """None for a script, or where standard input is no terminal whose keys can be read one by one."""
    with nullcontext() if options.script or options.events else terminal_keys() as keys:
        if keys is not None:
            print_note(COMMANDS[COMMANDS.index("keys:") :])
        yield None if keys is None else Keyboard(keys)


def _lines(script: str | None) -> Iterator[str]:
    """Of a script, by name or on standard input. Errors: UsageError."""
    if script is None or script == STANDARD:
        return iter(sys.stdin)
    try:
        return iter(Path(script).read_text(encoding="utf-8").splitlines())
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{script}: cannot be read: {getattr(error, 'strerror', None) or error}") from error
