"""The options of `plan run`, and which of them contradict each other."""

from __future__ import annotations

import argparse

from planner.cli.events import add_events_option, refuse_events_among_results
from planner.cli.files import input_file, output_file
from planner.cli.parser import Parser
from planner.cli.quantities import number
from planner.errors import UsageError

_DESCRIPTION = """\
Play a trajectory in real time: on the simulated arm, or on a real one with --driver and --port. It is examined
first: its joints must be the arm's, every sample within their limits and every servo within its range. The arm comes
slowly from its park pose and goes back there. While it plays, space or p pauses (the pen goes up) and resumes, q or
Ctrl-C stops and parks, and x, Esc or a second Ctrl-C stops at once and holds."""

_EPILOG = """\
examples:
  plan run traj.csv                         on the simulated arm
  plan run traj.csv --fast --picture drawn.png --servos real
  plan run traj.csv --driver mujoco --fast --film arm.gif
  plan run traj.csv --driver maestro --port /dev/ttyACM0 --dry-run
  plan run traj.csv --driver maestro --port /dev/ttyACM0 --frame
  plan run traj.csv --driver native --port /dev/ttyUSB0 --speed-factor 0.5
  plan run traj.csv --driver native --port socket://arm.local:3333 --resume

exit codes: 0 played to its end; 2 not fit to be played; 4 the arm or the line to it failed; 130 stopped"""

_FILMS = (".gif", ".mp4")


def parser() -> Parser:
    options = Parser("plan run", _DESCRIPTION, _EPILOG)
    options.add_argument("trajectory", type=input_file, metavar="traj.csv", help="- for standard input")
    options.add_argument(
        "--driver",
        default="sim",
        metavar="NAME",
        help="what moves the arm: sim, mujoco, native, maestro, maestro-crc, ssc32, feetech or "
        "dynamixel (default: %(default)s)",
    )
    options.add_argument(
        "--port",
        metavar="PORT|URL",
        help="where the controller is: a serial port as plan ports lists them, or a URL such as socket://HOST:PORT",
    )
    options.add_argument(
        "--baud",
        type=_baud,
        metavar="RATE",
        help="baud rate of the serial line (default: the usual one of the controller)",
    )
    options.add_argument(
        "--arm",
        metavar="NAME|FILE",
        help="play it on this arm, which must have the same joints (default: the one in the file)",
    )
    options.add_argument(
        "--speed-factor",
        type=number(minimum=0.01, maximum=1.0),
        default=1.0,
        metavar="F",
        help="play slower by this factor, 0.01 to 1 (default: 1)",
    )
    options.add_argument("--from-stroke", type=int, metavar="K", help="leave out the strokes before K, counted from 0")
    options.add_argument(
        "--resume",
        action="store_true",
        help="go on where an earlier run ended, by its journal: at the stroke that it did not finish, on native in the "
        "middle of it",
    )
    options.add_argument(
        "--dry-run", action="store_true", help="examine everything and say what would be sent, but send nothing"
    )
    options.add_argument(
        "--frame", action="store_true", help="go round the corners of what is drawn on, pen up, and draw nothing"
    )
    options.add_argument("--fast", action="store_true", help="sim, mujoco: do not wait for the time of each sample")
    options.add_argument(
        "--servos",
        choices=("ideal", "real"),
        default="ideal",
        help="sim: joints that follow exactly within their speeds, or those of an arm with errors that its file does "
        "not know of: resolution, dead band, backlash, lag, curves, lengths (default: %(default)s)",
    )
    options.add_argument(
        "--true-arm",
        metavar="NAME|FILE",
        help="--servos real: what the arm really is (default: drawn at random about the arm's file, as far off as that "
        "leaves open)",
    )
    options.add_argument("--seed", type=_seed, metavar="N", help="--servos real: of the random arm (default: 0)")
    options.add_argument(
        "--picture",
        type=output_file,
        action="append",
        default=[],
        metavar="FILE",
        help="sim, mujoco: what was drawn, as .svg at its true size, as .png or .pdf beside what was "
        "wanted; may be given more than once",
    )
    options.add_argument("--film", type=output_file, metavar="FILE", help="mujoco: a .gif or .mp4 of the arm at work")
    options.add_argument(
        "--record",
        type=output_file,
        metavar="FILE",
        help="also write what each servo is told, a .csv of one row a set point, which plan calibrate needs",
    )
    options.add_argument(
        "--record-positions",
        type=output_file,
        metavar="FILE",
        help="sim, feetech, dynamixel: also write where the joints are measured to be, which plan identify reads",
    )
    options.add_argument(
        "--beyond-limits",
        action="store_true",
        help="play a test motion of plan identify, which goes beyond the joints' limits on purpose",
    )
    options.add_argument("--quiet", action="store_true", help="no progress and no summary")
    add_events_option(options, "; keys are read from standard input, whose end stops the arm")
    return options


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 0 on")
    return int(text)


def _baud(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a baud rate, such as 115200")
    return int(text)


def refuse_contradictions(options: argparse.Namespace) -> None:
    """Errors: UsageError."""
    from hardware.drivers.table import DRIVERS, MEASURE_POSITIONS, MUJOCO, SIMULATED, SIMULATORS

    if options.driver not in DRIVERS:
        raise UsageError(f"there is no driver '{options.driver}'; there are {', '.join(DRIVERS)}")
    simulated = options.driver in SIMULATORS
    if simulated and (options.port or options.baud):
        raise UsageError("a simulated arm has no port; name the controller there with --driver")
    if not simulated and not options.port and not options.dry_run:
        raise UsageError(f"--driver {options.driver} needs --port; plan ports lists what is plugged in")
    for name, given, drivers in (
        ("fast", options.fast, SIMULATORS),
        ("picture", options.picture, SIMULATORS),
        ("servos", options.servos != "ideal", (SIMULATED,)),
        ("film", options.film, (MUJOCO,)),
        ("record-positions", options.record_positions, (SIMULATED, *MEASURE_POSITIONS)),
    ):
        if given and options.driver not in drivers:
            raise UsageError(f"--{name} goes with --driver {' or '.join(drivers)}, not with {options.driver}")
    if options.film and options.film.suffix.lower() not in _FILMS:
        raise UsageError(f"{options.film}: the name of a film ends in {' or '.join(_FILMS)}")
    for name, given in (("true-arm", options.true_arm is not None), ("seed", options.seed is not None)):
        if given and options.servos != "real":
            raise UsageError(f"--{name} goes with --servos real")
    if options.true_arm and options.seed is not None:
        raise UsageError("--true-arm says what the arm really is; leave out --seed")
    if options.frame and (options.resume or options.from_stroke is not None or options.record or options.picture):
        raise UsageError("--frame draws nothing; leave out --resume, --from-stroke, --record and --picture")
    if options.record_positions and (options.frame or options.dry_run):
        raise UsageError("--record-positions needs a run; leave out --frame and --dry-run")
    refuse_events_among_results(options, options.record, options.record_positions, options.film, *options.picture)
    if options.resume and options.from_stroke is not None:
        raise UsageError("--resume finds the stroke itself; leave out --from-stroke")
