"""`plan run traj.csv`: play a trajectory."""

from __future__ import annotations

import argparse
from contextlib import closing, nullcontext
from typing import TYPE_CHECKING

from planner.cli.output import check_target
from planner.cli.run_options import parser, refuse_contradictions
from planner.cli.terminal import print_lines, print_summary
from planner.errors import HardwareError, UsageError

if TYPE_CHECKING:
    from hardware.compensation.servo_values import Calibration
    from hardware.playback.program import Program
    from planner.arms.arm import Arm
    from planner.arrays import FloatArray

EXIT_STOPPED = 130


def run(arguments: list[str]) -> int:
    """Play one trajectory. Errors: PlannerError."""
    options = parser().parse_args(arguments)
    refuse_contradictions(options)

    from hardware.compensation.servo_values import own_calibration
    from hardware.drivers.table import SIMULATORS, calibration_of
    from hardware.playback.compensated import compensated
    from hardware.playback.preflight import servo_values, set_points
    from hardware.playback.program import make_program, parking
    from hardware.playback.recording import write_record
    from planner.arms.arm_file import load_arm
    from planner.cli.controls import breaking_off
    from planner.cli.one_run import one_at_a_time, refuse_unkept
    from planner.cli.resuming import where_to_begin
    from planner.cli.run_pictures import check_pictures, save_pictures
    from planner.cli.run_playing import play_out, set_up, true_arm_of
    from planner.trajectory import PATTERN, read_trajectory

    check_pictures(options.picture, options.trajectory)
    if options.record:
        check_target(options.record, options.trajectory)
    if options.film:
        check_target(options.film, options.trajectory)
    if options.resume:
        refuse_unkept(options.trajectory)
    trajectory = read_trajectory(options.trajectory)
    arm = load_arm(options.arm or trajectory.arm)
    positions = set_points(trajectory, arm, options.trajectory)
    calibration = calibration_of(options.driver, arm)
    if calibration is not None:
        servo_values(calibration, positions, trajectory, options.trajectory)
    last_stroke, rate_hz = int(trajectory.stroke.max()), trajectory.rate_hz * options.speed_factor
    true_arm = true_arm_of(options, arm)
    rig = set_up(options, arm, true_arm)
    with breaking_off(), nullcontext() if options.dry_run else one_at_a_time(options), closing(rig.driver):
        beginning = where_to_begin(options, arm, trajectory.stroke, None if options.dry_run else rig.driver)
        all_drawn = options.resume and beginning.next_stroke > last_stroke
        if (options.resume and beginning.complete) or (all_drawn and options.driver in SIMULATORS):
            print_lines([f"{options.trajectory} is drawn to its end; without --resume it is drawn again"])
            return 0
        program = (
            parking(arm, positions, rate_hz, arm.park)
            if all_drawn
            else make_program(
                arm,
                positions,
                trajectory.stroke,
                rate_hz,
                from_stroke=beginning.next_stroke,
                from_sample=beginning.sample,
                park=arm.park,
            )
        )
        if options.record and calibration is None:
            calibration = own_calibration(arm)
        sent = program
        if calibration is not None and trajectory.method != PATTERN:  # where slack is to show
            sent = compensated(arm, program, calibration)
        told = _told_to_servos(calibration, sent, arm)
        if options.record and calibration is not None:
            write_record(arm, sent, calibration, options.record)
        if options.driver not in SIMULATORS or options.servos == "real":  # others have no slack
            program = sent
        if options.dry_run:
            print_lines(_check_result(options, arm, program, calibration, told))
            return 0
        played = play_out(options, arm, program, rig, beginning, last_stroke)
    lines = played.lines()
    if rig.recording is not None and options.picture:
        lines += save_pictures(
            options.picture, trajectory, arm, positions, true_arm, rig.recording().positions, beginning.next_stroke
        )
    if not options.quiet:
        print_summary(lines, *options.picture)
    return 0 if played.complete else EXIT_STOPPED


def _told_to_servos(calibration: Calibration | None, program: Program, arm: Arm) -> FloatArray | None:
    """(n, n_joints) pulses or counts of the whole program. Errors: UsageError, before anything is sent."""
    if calibration is None:
        return None
    try:
        return calibration.to_servos(program.positions)
    except HardwareError as error:
        raise UsageError(f"on the way from or to the park pose of arm '{arm.name}': {error}") from error


def _check_result(
    options: argparse.Namespace, arm: Arm, program: Program, calibration: Calibration | None, told: FloatArray | None
) -> list[str]:
    """What a dry run says."""
    from hardware.motion.slow_transfer import in_words

    approach_s, retreat_s = program.approach / program.rate_hz, program.retreat / program.rate_hz
    lines = [
        f"{options.trajectory} can be played on arm '{arm.name}' by driver {options.driver}",
        f"it takes {program.duration_s:.2f} s: {approach_s:.2f} s to the drawing, "
        f"{program.duration_s - approach_s - retreat_s:.2f} s for it, and {retreat_s:.2f} s back",
        f"park pose: {in_words(arm, program.park)}",
    ]
    if calibration is None or told is None:
        return [*lines, "servos: the arm file says nothing of them"]
    for joint, address, low, high in zip(
        arm.joints, calibration.addresses, told.min(axis=0), told.max(axis=0), strict=True
    ):
        lines.append(f"joint {joint.name}, servo {address}: {low:.1f} to {high:.1f} {calibration.unit}")
    return lines
