"""`plan run`: what is to be played, examined before anything moves."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from hardware.compensation.servo_values import Calibration, own_calibration
from hardware.drivers.table import calibration_of
from hardware.motion.slow_transfer import in_words
from hardware.playback.compensated import compensated
from hardware.playback.journal_entry import Entry
from hardware.playback.preflight import servo_values, set_points
from hardware.playback.program import Program, make_program, parking
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.counted import clock
from planner.errors import HardwareError, UsageError
from planner.trajectory import PATTERN, TEST_MOTION, Trajectory, read_trajectory


@dataclass(frozen=True, eq=False, slots=True)
class Job:
    """A trajectory that is fit to be played on an arm.

    positions: (n_samples, n_joints) set points, rad or mm. calibration: None for an arm that is only simulated and
    whose file says nothing of servos. rate_hz: of the samples as they are played.
    """

    trajectory: Trajectory
    arm: Arm
    positions: FloatArray
    calibration: Calibration | None
    rate_hz: float

    @property
    def clear_arm(self) -> Arm:
        """The arm with the pen that sticks out furthest: a motion that keeps that off the paper keeps off every pen.
        Errors: UsageError for pens of several heights in an arm that lets them tilt."""
        return self.arm.holding(max((pen.height_mm for pen in self.trajectory.pens), default=0.0))

    @property
    def last_stroke(self) -> int:
        return int(self.trajectory.stroke.max())

    def program(self, beginning: Entry) -> Program:
        """The drawing from where the run begins. Errors: UsageError, PlanError."""
        return make_program(
            self.clear_arm,
            self.positions,
            self.trajectory.stroke,
            self.rate_hz,
            from_stroke=beginning.next_stroke,
            from_sample=beginning.sample,
            park=self.arm.park,
        )

    def parking(self) -> Program:
        """For an arm that has drawn everything: it goes to its park pose, and that is all."""
        return parking(self.clear_arm, self.positions, self.rate_hz, self.arm.park)

    def compensated(self, program: Program) -> Program:
        """The program with the slack of the servos taken up; as it is for a pattern or a test motion, in which
        slack has to show."""
        if self.calibration is None or self.trajectory.method in (PATTERN, TEST_MOTION):
            return program
        return compensated(self.arm, program, self.calibration)

    def commanded(self, program: Program) -> FloatArray | None:
        """(n, n_joints) pulses or counts of the whole program, None where the arm file says nothing of servos.

        Errors: UsageError where one is outside its servo's range, before anything is sent.
        """
        if self.calibration is None:
            return None
        try:
            return self.calibration.to_servos(program.positions)
        except HardwareError as error:
            raise UsageError(f"on the way from or to the park pose of arm '{self.arm.name}': {error}") from error


def examine(options: argparse.Namespace) -> Job:
    """Read the trajectory and its arm, and make sure that every sample may be sent to every servo.

    Errors: PlannerError.
    """
    trajectory = read_trajectory(options.trajectory)
    if trajectory.beyond_limits != 1.0 and not options.beyond_limits:
        raise UsageError(
            f"{options.trajectory} is a test motion that goes to {trajectory.beyond_limits:g} times the arm's limits on"
            " purpose: play it with --beyond-limits, and with a hand at the switch"
        )
    arm = load_arm(options.arm or trajectory.arm)
    positions = set_points(trajectory, arm, options.trajectory)
    calibration = calibration_of(options.driver, arm)
    if calibration is None and options.record:
        calibration = own_calibration(arm)  # which says what the arm file lacks
    if calibration is not None:
        servo_values(calibration, positions, trajectory, options.trajectory)
    return Job(trajectory, arm, positions, calibration, trajectory.rate_hz * options.speed_factor)


def dry_run_lines(options: argparse.Namespace, job: Job, program: Program, commanded: FloatArray | None) -> list[str]:
    """What a dry run says. commanded: as of `Job.commanded`."""
    approach_s, retreat_s = program.approach / program.rate_hz, program.retreat / program.rate_hz
    lines = [
        f"{options.trajectory} can be played on arm '{job.arm.name}' by driver {options.driver}",
        f"it takes {clock(program.duration_s)}: {clock(approach_s)} to the drawing, "
        f"{clock(program.duration_s - approach_s - retreat_s)} for it, and {clock(retreat_s)} back",
        f"park pose: {in_words(job.arm, program.park)}",
    ]
    if job.trajectory.pens:
        lines.append(f"pens: {', '.join(pen.name for pen in job.trajectory.pens)}")
    if job.calibration is None or commanded is None:
        return [*lines, "servos: the arm file says nothing of them"]
    least, most = commanded.min(axis=0), commanded.max(axis=0)
    for joint, address, low, high in zip(job.arm.joints, job.calibration.addresses, least, most, strict=True):
        lines.append(f"joint {joint.name}, servo {address}: {low:.1f} to {high:.1f} {job.calibration.unit}")
    return lines
