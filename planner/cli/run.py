"""`plan run traj.csv`: play a trajectory."""

from __future__ import annotations

from contextlib import closing, nullcontext

from planner.cli.output import check_target
from planner.cli.run_options import parser, refuse_contradictions
from planner.cli.terminal import print_lines, print_summary, waiting

EXIT_STOPPED = 130


def run(arguments: list[str]) -> int:
    """Play one trajectory. Errors: PlannerError."""
    options = parser().parse_args(arguments)
    refuse_contradictions(options)

    from hardware.drivers.table import SIMULATORS
    from hardware.playback.recording import write_positions, write_record
    from planner.cli.controls import breaking_off
    from planner.cli.run_claims import one_at_a_time
    from planner.cli.run_events import tell_ended
    from planner.cli.run_files import refuse_unkept
    from planner.cli.run_job import dry_run_lines, examine
    from planner.cli.run_pens import PenChanges
    from planner.cli.run_pictures import check_pictures, save_pictures
    from planner.cli.run_playing import measuring_driver, play_out, set_up, true_arm_of
    from planner.cli.run_resume import where_to_begin

    check_pictures(options.picture, options.trajectory)
    if options.record:
        check_target(options.record, options.trajectory)
    if options.record_positions:
        check_target(options.record_positions, options.trajectory)
    if options.film:
        check_target(options.film, options.trajectory)
    if options.resume:
        refuse_unkept(options.trajectory)
    with waiting("examining", quiet=options.quiet or options.events):
        job = examine(options)
    true_arm = true_arm_of(options, job)
    rig = set_up(options, job.arm, true_arm)
    if options.frame:
        from planner.cli.run_frame import go_round

        with breaking_off(), one_at_a_time(options), closing(rig.driver):
            return 0 if go_round(options, job, rig) else EXIT_STOPPED
    with breaking_off(), nullcontext() if options.dry_run else one_at_a_time(options), closing(rig.driver):
        asked = None if options.dry_run else rig.driver
        beginning = where_to_begin(options, job.arm, job.trajectory.stroke, asked)
        all_drawn = options.resume and beginning.next_stroke > job.last_stroke
        if (options.resume and beginning.complete) or (all_drawn and options.driver in SIMULATORS):
            print_lines([f"{options.trajectory} is drawn to its end; without --resume it is drawn again"])
            return 0
        with waiting("getting ready", quiet=options.quiet or options.events):
            program = job.parking() if all_drawn else job.program(beginning)
            compensated = job.compensated(program)
            commanded = job.commanded(compensated)
        if options.record and job.calibration is not None:
            write_record(job.arm, job.trajectory, compensated, job.calibration, options.record)
        if options.driver not in SIMULATORS or options.servos == "real":  # others have no slack
            program = compensated
        if options.dry_run:
            print_lines(dry_run_lines(options, job, program, commanded))
            return 0
        changes = PenChanges(job.trajectory, beginning.next_stroke, rig.clock, rig.insert)
        if options.record_positions:
            measuring_driver(rig).measure()
        result = play_out(options, job.clear_arm, program, rig, beginning, job.trajectory, changes)
    if options.record_positions:
        write_positions(job.arm, measuring_driver(rig).measured(), options.record_positions)
    lines = result.lines()
    if rig.recording is not None and options.picture:
        moved = rig.recording()
        heights_mm = changes.heights_mm(moved.times_s)
        with waiting("drawing", quiet=options.quiet or options.events):
            lines += save_pictures(options.picture, job, true_arm, moved.positions, heights_mm, beginning.next_stroke)
    if options.events:
        tell_ended(result.end.value, lines, complete=result.complete, parked=result.parked)
    elif not options.quiet:
        print_summary(lines, *options.picture)
    return 0 if result.complete else EXIT_STOPPED
