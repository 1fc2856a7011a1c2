"""`plan run`: the programme is played, watched by people and noted in a journal."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING

from hardware.clock import Clock, InstantClock, WallClock
from hardware.driver import Driver
from hardware.drivers import MUJOCO, SIMULATED, TELL_WHERE_THEY_STAND, calibration_of, make_driver
from hardware.gentle_move import in_words
from hardware.player import play
from hardware.playing import Played, Progress
from hardware.port import Line
from hardware.programme import Programme
from hardware.simulated_arm import Recording, Servos, SimulatedArm
from planner.arms.arm import Arm
from planner.cli.controls import KEYS, controls
from planner.cli.resuming import RunJournal
from planner.cli.terminal import Show, print_note, print_warnings, progress
from planner.errors import HardwareError

if TYPE_CHECKING:
    from hardware.mujoco_arm import MujocoArm

_REPORTS_A_SECOND = 10


def play_out(options: argparse.Namespace, arm: Arm, programme: Programme, journal: RunJournal,
          last_stroke: int) -> tuple[Played, Recording | None]:
    """What became of the programme, and what a simulated arm did. Errors: HardwareError, OutputError."""
    clock = InstantClock() if options.fast else WallClock()
    simulated = _simulated(options, arm, clock)
    ended, complete = "broken off", False
    with progress(quiet=options.quiet, single=True) as show:
        try:
            with controls() as wishes:
                def opened() -> None:
                    if not options.quiet:
                        print_note(_announced(options, programme, arm))

                def connected() -> None:
                    if wishes.has_keys and not options.quiet:
                        print_note(KEYS)
                    journal.open()

                driver = simulated or make_driver(options.driver, arm, Line(options.port, options.baud, opened), clock)
                played = play(programme, arm, driver, clock, request=wishes.request,
                              report=_reporting(show, driver, programme.rate_hz, last_stroke),
                              connected=connected, sent=journal.sent, finished=journal.finished)
            ended, complete = played.end.value, played.complete
        except HardwareError as error:
            ended = str(error)
            raise
        finally:  # before the last words, which a terminal that is stuck may never take
            journal.close(ended, complete=complete)
    return played, simulated.recording if simulated else None


def _simulated(options: argparse.Namespace, arm: Arm, clock: Clock) -> SimulatedArm | MujocoArm | None:
    if options.driver == SIMULATED:
        servos = Servos(options.servos)
        if servos is Servos.REAL and calibration_of(SIMULATED, arm) is None:
            print_warnings([f"the file of arm '{arm.name}' says neither servo nor bus of all its joints: their servos "
                            "lag behind, without dead band, backlash and resolution"])
            servos = Servos.LAGGING
        return SimulatedArm(arm, clock, servos)
    if options.driver == MUJOCO:
        from hardware.mujoco_arm import MujocoArm

        return MujocoArm(arm, clock, options.film)
    return None


def _announced(options: argparse.Namespace, programme: Programme, arm: Arm) -> str:
    """What is going to happen once the controller answers."""
    park, approach_s = in_words(arm, programme.park), programme.approach / programme.rate_hz
    if options.driver in TELL_WHERE_THEY_STAND:
        return (f"the arm goes slowly from where its servos stand to the park pose ({park}), from which it takes "
                f"{approach_s:.1f} s to the drawing")
    return (f"where the arm stands is not known: its servos are attached at the park pose ({park}), from which it "
            f"takes {approach_s:.1f} s to the drawing")


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
