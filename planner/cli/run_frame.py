"""`plan run --frame`: round the corners of what is drawn on, with the pen in the air."""

from __future__ import annotations

import argparse

import numpy as np

from hardware.motion.tip import tips_mm
from hardware.playback.player import play
from hardware.playback.program import Program, visiting
from planner.arrays import FloatArray
from planner.cli.controls import KEYS, controls
from planner.cli.run_job import Job
from planner.cli.run_playing import Rig
from planner.cli.terminal import print_lines, print_note
from planner.settings import PlanSettings


def go_round(options: argparse.Namespace, job: Job, rig: Rig) -> bool:
    """Whether it came to its end. No journal is kept: nothing is drawn. Errors: PlanError, HardwareError."""
    program = framing(job)
    if options.dry_run:
        print_lines([f"going round takes {program.duration_s:.1f} s"])
        return True
    with controls() as wishes:
        rig.driver.open()
        if not options.quiet and wishes.has_keys:
            print_note(KEYS)
        result = play(program, job.clear_arm, rig.driver, rig.clock, request=wishes.request)
    if not options.quiet:
        print_lines(result.lines())
    return result.complete


def framing(job: Job) -> Program:
    """From the park pose to each corner, to the first again, and back. Errors: PlanError."""
    from planner.redundancy.arm_model import ArmModel
    from planner.travel.raised import raised_configurations
    from planner.travel.travel_moves import TravelRules

    settings, arm = PlanSettings(), job.clear_arm
    rules = TravelRules(
        arm.pen.clearance_mm, arm.pen.lift_mm, settings.lowering_speed_mm_s, job.rate_hz, settings.tolerance_mm
    )
    corners = raised_configurations(ArmModel(arm), rules, _corners_mm(job))
    return visiting(arm, np.concatenate((corners, corners[:1])), job.rate_hz, arm.park)


def _corners_mm(job: Job) -> FloatArray:
    """(4, 2) of the rectangle that the header tells of, or else of the ink."""
    told = job.trajectory.placement.canvas_mm
    if told is not None:
        near, far, right, left = told
    else:
        drawn = job.trajectory.pen
        tips = tips_mm(job.arm, job.positions[drawn], job.trajectory.pen_heights_mm[drawn])[:, :2]
        (near, right), (far, left) = tips.min(axis=0), tips.max(axis=0)
    return np.array([[far, left], [far, right], [near, right], [near, left]])
