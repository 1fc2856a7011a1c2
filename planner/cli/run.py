"""`plan run traj.csv`: play a trajectory."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from planner.cli.parser import Parser
from planner.cli.quantities import number
from planner.cli.terminal import print_lines, progress

_DESCRIPTION = """\
Play a trajectory on the simulated arm, in real time. It is examined first: its joints have to be the arm's, and
every sample within their limits. Ctrl-C brakes along the drawing and lifts the pen; a second one stops at once."""

_EPILOG = """\
examples:
  plan run traj.csv
  plan run traj.csv --fast                  as fast as the computer can
  plan run traj.csv --speed-factor 0.5      at half the speed

exit codes: 0 played to its end; 2 not fit to be played; 4 the arm failed; 130 interrupted"""

_REPORTS_A_SECOND = 10
EXIT_STOPPED = 130


def run(arguments: list[str]) -> int:
    """Play one trajectory. Errors: PlannerError."""
    parser = Parser("plan run", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", type=Path, metavar="traj.csv")
    parser.add_argument("--arm", metavar="NAME|FILE", help="play it on this arm (default: the one in the trajectory)")
    parser.add_argument("--fast", action="store_true", help="do not wait for the time of each sample")
    parser.add_argument("--speed-factor", type=number(minimum=0.01, maximum=1.0), default=1.0, metavar="F",
                        help="play slower by this factor, 0.01 to 1 (default: 1)")
    parser.add_argument("--quiet", action="store_true", help="no progress and no summary")
    options = parser.parse_args(arguments)

    from hardware.clock import InstantClock, WallClock
    from hardware.player import play
    from hardware.preflight import set_points
    from hardware.simulated_arm import SimulatedArm
    from planner.arms.arm_file import load_arm
    from planner.trajectory import read_trajectory

    trajectory = read_trajectory(options.trajectory)
    arm = load_arm(options.arm or trajectory.arm)
    positions = set_points(trajectory, arm, options.trajectory)
    rate_hz = trajectory.rate_hz * options.speed_factor
    strokes = trajectory.stroke.tolist()
    last_stroke = max(strokes)
    between = max(round(rate_hz / _REPORTS_A_SECOND), 1)
    clock = InstantClock() if options.fast else WallClock()
    with progress(quiet=options.quiet, single=True) as show, _interrupts() as interrupted:

        def report(sent: int, total: int) -> None:
            if sent % between == 0 or sent == total:
                stroke = strokes[sent - 1]
                show(f"stroke {stroke} of 0..{last_stroke}" if stroke >= 0 else "travelling", sent, total)

        played = play(positions, rate_hz, arm, SimulatedArm(arm, clock), clock,
                      stop_requested=lambda: bool(interrupted), report=report)
    if not options.quiet:
        print_lines(played.lines())
    return EXIT_STOPPED if played.stopped else 0


@contextmanager
def _interrupts() -> Iterator[list[int]]:
    """Ctrl-C and a request to terminate fill the list instead of breaking in anywhere; the second one breaks in."""
    seen: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        if seen:
            raise KeyboardInterrupt
        seen.append(number)

    before = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield seen
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
