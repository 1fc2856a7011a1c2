"""`plan run`: a program is played, shown to people and noted in a journal."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hardware.clock import Clock, InstantClock, WallClock
from hardware.compensation.servo_values import own_calibration
from hardware.drivers.driver import Driver, Measuring
from hardware.drivers.table import MEASURE_POSITIONS, MUJOCO, SIMULATED, make_driver
from hardware.motion.slow_transfer import in_words
from hardware.playback.journal_entry import Entry
from hardware.playback.observer import Observer, Progress
from hardware.playback.player import play
from hardware.playback.program import Program
from hardware.playback.result import PlaybackResult
from hardware.port import Line
from hardware.simulation.simulated_arm import Recording, Servos, SimulatedArm
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arms.usual_servos import describes_servos, with_usual_servos
from planner.cli.controls import KEYS, Controls, controls
from planner.cli.run_events import ToldRun
from planner.cli.run_job import Job
from planner.cli.run_journal import RunJournal
from planner.cli.run_pens import PenChanges
from planner.cli.terminal import print_note, print_warnings, progress
from planner.counted import counted
from planner.error_model.random_arm import random_arm
from planner.errors import HardwareError, UsageError
from planner.progress import Report, left
from planner.trajectory import Trajectory

if TYPE_CHECKING:
    from hardware.simulation.mujoco_arm import MujocoArm

_REPORTS_A_SECOND = 10


@dataclass(frozen=True, slots=True)
class Rig:
    """The driver that a run plays on, and its clock. recording: of a simulated arm, None for a real one. insert: tells
    one that shows the ink how much further the tip of the next pen sticks out than that of the arm's file, in mm."""

    driver: Driver
    clock: Clock
    recording: Callable[[], Recording] | None
    insert: Callable[[float], None] = lambda height_mm: None


def true_arm_of(options: argparse.Namespace, job: Job) -> Arm:
    """What real servos of the simulated arm move. Errors: PlannerError."""
    arm = job.arm
    if options.servos == "ideal":
        return arm
    if not options.true_arm:
        return random_arm(with_usual_servos(arm), options.seed or 0, job.positions, job.trajectory.pen)
    true_arm = load_arm(options.true_arm)
    if true_arm.column_names != arm.column_names:
        raise UsageError(
            f"--true-arm {options.true_arm} has the joints {', '.join(true_arm.column_names)}; arm '{arm.name}' has "
            f"{', '.join(arm.column_names)}"
        )
    if describes_servos(true_arm):
        own_calibration(arm)  # which says what the file lacks: pulses for other servos would mean nothing to these
        return true_arm
    return true_arm if describes_servos(arm) else with_usual_servos(true_arm)


def set_up(options: argparse.Namespace, arm: Arm, true_arm: Arm) -> Rig:
    """Nothing is opened yet. Errors: ArmFileError where the arm file does not say how joints are moved."""
    clock = InstantClock() if options.fast else WallClock()
    simulated = _simulated(options, arm, true_arm, clock)
    if simulated is None:
        return Rig(make_driver(options.driver, arm, Line(options.port or "", options.baud), clock), clock, None)
    if isinstance(simulated, SimulatedArm):
        return Rig(simulated, clock, lambda: simulated.recording)
    return Rig(simulated, clock, lambda: simulated.recording, simulated.insert)


def measuring_driver(rig: Rig) -> Measuring:
    """The driver as one that tells where joints are. Errors: UsageError where it does not."""
    if not isinstance(rig.driver, Measuring):
        raise UsageError("--record-positions goes with drivers that tell where joints are")
    return rig.driver


def play_out(
    options: argparse.Namespace,
    arm: Arm,
    program: Program,
    rig: Rig,
    beginning: Entry,
    trajectory: Trajectory,
    changes: PenChanges,
) -> PlaybackResult:
    """How playing the program of the trajectory went. arm: with the pen that sticks out furthest. Errors:
    HardwareError, OutputError, and UsageError where pens have to be changed and there is nobody to do it."""
    last_stroke = int(trajectory.stroke.max())
    journal = RunJournal(options, beginning, last_stroke, rig.driver, program.rate_hz, rig.clock)
    ended, complete = "broken off", False
    with progress(quiet=options.quiet or options.events, paced=False) as show:
        try:
            with controls(by_program=options.events) as wishes:
                if trajectory.pen_changes and not options.fast and not wishes.has_keys:
                    raise UsageError(
                        f"it needs {counted(len(trajectory.pens), 'pen')}, and somebody at a terminal to change them:"
                        " run it in one, or plan it with --split"
                    )
                rig.driver.open()
                if not options.quiet and options.port:
                    print_note(_announced(options, program, arm))
                journal.opened()
                every = max(round(program.rate_hz / _REPORTS_A_SECOND), 1)
                display = (
                    ToldRun(program, rig.driver, last_stroke, every)
                    if options.events
                    else _Display(show, rig.driver, every, last_stroke, None if options.quiet else wishes)
                )
                result = play(
                    program,
                    arm,
                    rig.driver,
                    rig.clock,
                    request=wishes.request,
                    observers=(display, journal),
                    halts=trajectory.pen_changes,
                    waiting=changes.waiting_for(None if options.fast else wishes, tells=options.events),
                )
            ended, complete = result.end.value, result.complete
        except HardwareError as error:
            ended = str(error)
            raise
        finally:  # before the last words, which a terminal that is stuck may never take
            journal.close(ended, complete=complete)
    return result


def _simulated(options: argparse.Namespace, arm: Arm, true_arm: Arm, clock: Clock) -> SimulatedArm | MujocoArm | None:
    if options.driver == SIMULATED:
        servos = Servos(options.servos)
        if servos is Servos.IDEAL:
            return SimulatedArm(arm, clock)
        if not describes_servos(arm):
            print_warnings(
                [
                    f"the file of arm '{arm.name}' does not describe the servos of all its joints: servos of a usual "
                    "kind stand in for them"
                ]
            )
        return SimulatedArm(with_usual_servos(arm), clock, servos, true_arm)
    if options.driver == MUJOCO:
        from hardware.simulation.mujoco_arm import MujocoArm

        return MujocoArm(arm, clock, options.film)
    return None


def _announced(options: argparse.Namespace, program: Program, arm: Arm) -> str:
    """What will happen once the controller answers."""
    park, approach_s = in_words(arm, program.park), program.approach / program.rate_hz
    if options.driver in MEASURE_POSITIONS:
        return (
            f"the arm goes slowly from where its servos are to the park pose ({park}), from which it takes "
            f"{approach_s:.1f} s to the drawing"
        )
    return (
        f"the position of the arm is not known: its servos are attached at the park pose ({park}), from which it "
        f"takes {approach_s:.1f} s to the drawing"
    )


class _Display(Observer):
    """Shows the keys once, where there are any, and progress at every so many set points. wishes: None for no keys."""

    def __init__(self, show: Report, driver: Driver, every: int, last_stroke: int, wishes: Controls | None) -> None:
        self._show, self._driver, self._last_stroke, self._wishes = show, driver, last_stroke, wishes
        self._every = every
        self._calls = 0

    def connected(self) -> None:
        if self._wishes and self._wishes.has_keys:
            print_note(KEYS)

    def progressed(self, progress: Progress) -> None:
        self._calls += 1
        if self._calls % self._every and progress.reached < progress.total:
            return
        doing = f"stroke {progress.stroke} of 0..{self._last_stroke}" if progress.stroke >= 0 else "travelling"
        state = f"{'paused' if progress.paused else doing}, {left(progress.left_s)}"
        self._show("\n".join((state, *self._driver.statistics())), progress.reached, progress.total)
