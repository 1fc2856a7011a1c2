"""`plan run`: the program is played, watched by people and noted in a journal."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hardware.clock import Clock, InstantClock, WallClock
from hardware.drivers.driver import Driver
from hardware.drivers.table import MUJOCO, SIMULATED, TELL_WHERE_THEY_STAND, calibration_of, make_driver
from hardware.motion.slow_transfer import in_words
from hardware.playback.journal_entry import Entry
from hardware.playback.player import play
from hardware.playback.program import Program
from hardware.playback.progress import Played, Progress
from hardware.port import Line
from hardware.simulation.simulated_arm import Recording, Servos, SimulatedArm
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.cli.controls import KEYS, controls
from planner.cli.keeping import Keeping
from planner.cli.terminal import print_note, print_warnings, progress
from planner.error_model.random_arm import random_arm
from planner.errors import HardwareError, UsageError
from planner.progress import Show

if TYPE_CHECKING:
    from hardware.simulation.mujoco_arm import MujocoArm

_REPORTS_A_SECOND = 10


@dataclass(frozen=True, slots=True)
class Rig:
    """What a run plays on, and the clock that it goes by. recording: of a simulated arm, None of a real one."""

    driver: Driver
    clock: Clock
    recording: Callable[[], Recording] | None


def true_arm_of(options: argparse.Namespace, arm: Arm) -> Arm:
    """What real servos of the simulated arm move. Errors: PlannerError."""
    if options.servos == "ideal" or calibration_of(SIMULATED, arm) is None:
        return arm
    if not options.true_arm:
        return random_arm(arm, options.seed or 0)
    true_arm = load_arm(options.true_arm)
    if true_arm.column_names != arm.column_names:
        raise UsageError(
            f"--true-arm {options.true_arm} has the joints {', '.join(true_arm.column_names)}; arm '{arm.name}' has "
            f"{', '.join(arm.column_names)}"
        )
    return true_arm


def set_up(options: argparse.Namespace, arm: Arm, true_arm: Arm) -> Rig:
    """Nothing is opened yet. Errors: ArmFileError where the arm file does not say how joints are moved."""
    clock = InstantClock() if options.fast else WallClock()
    simulated = _simulated(options, arm, true_arm, clock)
    if simulated is None:
        return Rig(make_driver(options.driver, arm, Line(options.port or "", options.baud), clock), clock, None)
    return Rig(simulated, clock, lambda: simulated.recording)


def play_out(
    options: argparse.Namespace, arm: Arm, program: Program, rig: Rig, beginning: Entry, last_stroke: int
) -> Played:
    """What became of the program. Errors: HardwareError, OutputError."""
    keeping = Keeping(options, beginning, last_stroke, rig.driver, program.rate_hz, rig.clock)
    ended, complete = "broken off", False
    with progress(quiet=options.quiet, single=True) as show:
        try:
            with controls() as wishes:

                def connected() -> None:
                    if wishes.has_keys and not options.quiet:
                        print_note(KEYS)
                    keeping.connected()

                rig.driver.open()
                if not options.quiet and options.port:
                    print_note(_announced(options, program, arm))
                keeping.opened()
                played = play(
                    program,
                    arm,
                    rig.driver,
                    rig.clock,
                    request=wishes.request,
                    report=_reporting(show, rig.driver, program.rate_hz, last_stroke),
                    connected=connected,
                    sent=keeping.sent,
                    finished=keeping.finished,
                    onward=keeping.onward,
                    reached=keeping.reached,
                )
            ended, complete = played.end.value, played.complete
        except HardwareError as error:
            ended = str(error)
            raise
        finally:  # before the last words, which a terminal that is stuck may never take
            keeping.close(ended, complete=complete)
    return played


def _simulated(options: argparse.Namespace, arm: Arm, true_arm: Arm, clock: Clock) -> SimulatedArm | MujocoArm | None:
    if options.driver == SIMULATED:
        servos = Servos(options.servos)
        if servos is Servos.REAL and calibration_of(SIMULATED, arm) is None:
            print_warnings(
                [
                    f"the file of arm '{arm.name}' says neither servo nor bus of all its joints: their servos "
                    "lag behind, without dead band, backlash and resolution"
                ]
            )
            servos = Servos.LAGGING
        return SimulatedArm(arm, clock, servos, true_arm)
    if options.driver == MUJOCO:
        from hardware.simulation.mujoco_arm import MujocoArm

        return MujocoArm(arm, clock, options.film)
    return None


def _announced(options: argparse.Namespace, program: Program, arm: Arm) -> str:
    """What is going to happen once the controller answers."""
    park, approach_s = in_words(arm, program.park), program.approach / program.rate_hz
    if options.driver in TELL_WHERE_THEY_STAND:
        return (
            f"the arm goes slowly from where its servos stand to the park pose ({park}), from which it takes "
            f"{approach_s:.1f} s to the drawing"
        )
    return (
        f"where the arm stands is not known: its servos are attached at the park pose ({park}), from which it "
        f"takes {approach_s:.1f} s to the drawing"
    )


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
