"""`plan run traj.csv`: play a trajectory."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.quantities import number
from planner.cli.terminal import Show, print_lines, print_note, print_summary, progress
from planner.errors import HardwareError, UsageError

if TYPE_CHECKING:
    from hardware.calibration import Calibration
    from hardware.clock import Clock
    from hardware.driver import Driver
    from hardware.journal import Journal
    from hardware.mujoco_arm import MujocoArm
    from hardware.playing import Progress
    from hardware.programme import Programme
    from hardware.simulated_arm import SimulatedArm
    from planner.arms.arm import Arm
    from planner.arrays import FloatArray

_DESCRIPTION = """\
Play a trajectory in real time: on the simulated arm, or on a real one with --driver and --port. It is examined
first: its joints have to be the arm's, every sample within their limits and every servo within its range. The arm
comes slowly from its park pose and goes back there. While it plays, space or p pauses (the pen goes up) and resumes,
q or Ctrl-C stops and parks, and x, Esc or a second Ctrl-C stops at once and holds."""

_EPILOG = """\
examples:
  plan run traj.csv                         on the simulated arm
  plan run traj.csv --fast --picture drawn.png --servos real
  plan run traj.csv --driver mujoco --fast --film arm.gif
  plan run traj.csv --driver maestro --port /dev/ttyACM0 --dry-run
  plan run traj.csv --driver native --port /dev/ttyUSB0 --speed-factor 0.5
  plan run traj.csv --driver native --port socket://arm.local:3333 --resume

exit codes: 0 played to its end; 2 not fit to be played; 4 the arm or the line to it failed; 130 stopped"""

_REPORTS_A_SECOND = 10
_FILMS = (".gif", ".mp4")
EXIT_STOPPED = 130


def run(arguments: list[str]) -> int:
    """Play one trajectory. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    _refuse_contradictions(options)

    from hardware.clock import InstantClock, WallClock
    from hardware.drivers import calibration_of, make_driver
    from hardware.player import play
    from hardware.playing import End
    from hardware.port import Line
    from hardware.preflight import servo_values, set_points
    from hardware.programme import make_programme
    from planner.arms.arm_file import load_arm
    from planner.cli.controls import KEYS, controls
    from planner.cli.resuming import open_journal, where_to_begin
    from planner.cli.run_pictures import check_pictures, save_pictures
    from planner.trajectory import read_trajectory

    check_pictures(options.picture, options.trajectory)
    if options.film:
        check_target(options.film, options.trajectory)
    trajectory = read_trajectory(options.trajectory)
    arm = load_arm(options.arm or trajectory.arm)
    positions = set_points(trajectory, arm, options.trajectory)
    calibration = calibration_of(options.driver, arm)
    if calibration is not None:
        servo_values(calibration, positions, trajectory, options.trajectory)
    last_stroke = int(trajectory.stroke.max())
    beginning = where_to_begin(options, arm)
    if options.resume and (beginning.complete or beginning.next_stroke > last_stroke):
        print_lines([f"{options.trajectory} is drawn to its end; without --resume it is drawn again"])
        return 0
    programme = make_programme(arm, positions, trajectory.stroke, trajectory.rate_hz * options.speed_factor,
                               from_stroke=beginning.next_stroke, park=arm.park)
    told = _told_to_servos(calibration, programme, arm)
    if options.dry_run:
        print_lines(_verdict(options, arm, programme, calibration, told))
        return 0

    clock = InstantClock() if options.fast else WallClock()
    simulated = _simulated(options, arm, clock)
    driver = simulated or make_driver(options.driver, arm, Line(options.port, options.baud), clock)
    journals: list[Journal] = []  # one, once the arm is there to draw: a wrong port must not cost an earlier run's

    def connected() -> None:
        journal = open_journal(options, beginning)
        journals.extend([journal] if journal else [])

    def finished(stroke: int) -> None:
        for journal in journals:
            journal.finished(stroke)

    ended, complete = "broken off", False
    try:
        with controls() as wishes, progress(quiet=options.quiet, single=True) as show:
            if not options.quiet:
                _announce(options, programme, arm, KEYS if wishes.has_keys else "")
            played = play(programme, arm, driver, clock, request=wishes.request,
                          report=_reporting(show, driver, programme.rate_hz, last_stroke),
                          connected=connected, finished=finished)
        ended, complete = played.end.value, played.end is End.PLAYED
    except HardwareError as error:
        ended = str(error)
        raise
    finally:
        for journal in journals:
            journal.close(ended, complete=complete)
            if not complete:
                print_note(f"--resume goes on from stroke {journal.next_stroke} of 0..{last_stroke}")
    lines = played.lines()
    if simulated and options.picture:
        lines += save_pictures(options.picture, trajectory, arm, positions, simulated.recording.positions,
                               beginning.next_stroke)
    if not options.quiet:
        print_summary(lines, *options.picture)
    return 0 if complete else EXIT_STOPPED


def _parser() -> Parser:
    parser = Parser("plan run", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", type=input_file, metavar="traj.csv", help="- for standard input")
    parser.add_argument("--driver", default="sim", metavar="NAME",
                        help="what moves the arm: sim, mujoco, native, maestro, maestro-crc, ssc32, feetech or "
                             "dynamixel (default: %(default)s)")
    parser.add_argument("--port", metavar="PORT|URL",
                        help="where the controller is: a serial port as plan ports lists them, or a URL such as "
                             "socket://HOST:PORT")
    parser.add_argument("--baud", type=_baud, metavar="RATE",
                        help="of the serial line (default: the controller's usual)")
    parser.add_argument("--arm", metavar="NAME|FILE",
                        help="play it on this arm, whose joints have to be the same (default: the one in the file)")
    parser.add_argument("--speed-factor", type=number(minimum=0.01, maximum=1.0), default=1.0, metavar="F",
                        help="play slower by this factor, 0.01 to 1 (default: 1)")
    parser.add_argument("--from-stroke", type=int, metavar="K", help="leave out the strokes before K, counted from 0")
    parser.add_argument("--resume", action="store_true",
                        help="go on after the last stroke that an earlier run finished, from its journal")
    parser.add_argument("--dry-run", action="store_true",
                        help="examine everything and say what would be sent, but send nothing")
    parser.add_argument("--fast", action="store_true", help="sim, mujoco: do not wait for the time of each sample")
    parser.add_argument("--servos", choices=("ideal", "real"), default="ideal",
                        help="sim: joints that follow exactly within their speeds, or with the resolution, dead band "
                             "and backlash of the arm file and a lag (default: %(default)s)")
    parser.add_argument("--picture", type=output_file, action="append", default=[], metavar="FILE",
                        help="sim, mujoco: what was drawn, as .svg at its true size, as .png or .pdf beside what was "
                             "wanted; may be given more than once")
    parser.add_argument("--film", type=output_file, metavar="FILE", help="mujoco: a .gif or .mp4 of the arm at work")
    parser.add_argument("--quiet", action="store_true", help="no progress and no summary")
    return parser


def _baud(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"'{text}' is no speed of a line, such as 115200")
    return int(text)


def _refuse_contradictions(options: argparse.Namespace) -> None:
    """Errors: UsageError."""
    from hardware.drivers import DRIVERS, MUJOCO, SIMULATED, SIMULATORS

    if options.driver not in DRIVERS:
        raise UsageError(f"there is no driver '{options.driver}'; there are {', '.join(DRIVERS)}")
    simulated = options.driver in SIMULATORS
    if simulated and (options.port or options.baud):
        raise UsageError("a simulated arm is at no port; name what is there with --driver")
    if not simulated and not options.port and not options.dry_run:
        raise UsageError(f"--driver {options.driver} needs --port; plan ports lists what is plugged in")
    for name, given, drivers in (
            ("fast", options.fast, SIMULATORS), ("picture", options.picture, SIMULATORS),
            ("servos", options.servos != "ideal", (SIMULATED,)), ("film", options.film, (MUJOCO,))):
        if given and options.driver not in drivers:
            raise UsageError(f"--{name} goes with --driver {' or '.join(drivers)}, not with {options.driver}")
    if options.film and options.film.suffix.lower() not in _FILMS:
        raise UsageError(f"{options.film}: a film ends in {' or '.join(_FILMS)}")
    if options.resume and options.from_stroke is not None:
        raise UsageError("--resume finds its stroke by itself; leave out --from-stroke")


def _simulated(options: argparse.Namespace, arm: Arm, clock: Clock) -> SimulatedArm | MujocoArm | None:
    from hardware.drivers import MUJOCO, SIMULATED

    if options.driver == SIMULATED:
        from hardware.simulated_arm import Servos, SimulatedArm

        return SimulatedArm(arm, clock, Servos(options.servos))
    if options.driver == MUJOCO:
        from hardware.mujoco_arm import MujocoArm

        return MujocoArm(arm, clock, options.film)
    return None


def _told_to_servos(calibration: Calibration | None, programme: Programme, arm: Arm) -> FloatArray | None:
    """(n, n_joints) pulses or counts of the whole programme. Errors: UsageError, before anything is sent."""
    if calibration is None:
        return None
    try:
        return calibration.to_servos(programme.positions)
    except HardwareError as error:
        raise UsageError(f"on the way from or to the park pose of arm '{arm.name}': {error}") from error


def _verdict(options: argparse.Namespace, arm: Arm, programme: Programme, calibration: Calibration | None,
             told: FloatArray | None) -> list[str]:
    """What a dry run says."""
    approach_s, retreat_s = programme.approach / programme.rate_hz, programme.retreat / programme.rate_hz
    lines = [f"{options.trajectory} can be played on arm '{arm.name}' by driver {options.driver}",
             f"it takes {programme.duration_s:.2f} s: {approach_s:.2f} s to the drawing, "
             f"{programme.duration_s - approach_s - retreat_s:.2f} s for it, and {retreat_s:.2f} s back",
             f"park pose: {_posture(arm, programme.park)}"]
    if calibration is None or told is None:
        return [*lines, "servos: the arm file says nothing of them"]
    for joint, address, low, high in zip(arm.joints, calibration.addresses, told.min(axis=0), told.max(axis=0),
                                         strict=True):
        lines.append(f"joint {joint.name}, servo {address}: {low:.1f} to {high:.1f} {calibration.unit}")
    return lines


def _announce(options: argparse.Namespace, programme: Programme, arm: Arm, keys: str) -> None:
    if options.port:
        approach_s = programme.approach / programme.rate_hz
        print_note(f"where the arm stands is not known: its servos are attached at the park pose "
                   f"({_posture(arm, programme.park)}), from which it takes {approach_s:.1f} s to the drawing")
    if keys:
        print_note(keys)


def _posture(arm: Arm, positions: FloatArray) -> str:
    values = zip(arm.joints, arm.to_file_units(positions), strict=True)
    return ", ".join(f"{joint.name} {value:.1f} {joint.file_unit}" for joint, value in values)


def _reporting(show: Show, driver: Driver, rate_hz: float, last_stroke: int) -> Callable[[Progress], None]:
    """Shows progress a few times a second."""
    between = max(round(rate_hz / _REPORTS_A_SECOND), 1)
    calls = 0

    def report(now: Progress) -> None:
        nonlocal calls
        calls += 1
        if calls % between and now.reached < now.total:
            return
        doing = f"stroke {now.stroke} of 0..{last_stroke}" if now.stroke >= 0 else "travelling"
        state = f"{'paused' if now.paused else doing}, {now.left_s:.0f} s left"
        show("\n".join((state, *driver.statistics())), now.reached, now.total)

    return report
