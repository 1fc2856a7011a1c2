"""The commanded values of each servo as a table: the record that a calibration rests on."""

from __future__ import annotations

from pathlib import Path
from typing import IO, cast

import numpy as np

from hardware.compensation.servo_values import Calibration
from hardware.motion.tip import link_nodes_mm
from hardware.playback.program import Program
from planner.arms.arm import Arm
from planner.files import written_aside


def write_record(arm: Arm, program: Program, calibration: Calibration, target: Path) -> None:
    """One row a set point: its time, the stroke being drawn or -1, where the pen is meant to be on the paper, and the
    final value of each servo, in us or counts. Errors: OutputError."""
    commanded = calibration.to_servos(program.positions)
    tips_mm = link_nodes_mm(arm, program.meant)[:, -1, :2]
    table = np.column_stack((np.arange(len(commanded)) / program.rate_hz, program.stroke, tips_mm, commanded))
    names = [f"{joint.name}_{calibration.unit}" for joint in arm.joints]
    row = ",".join(("%.6f", "%d", "%.4f", "%.4f", *["%.4f"] * len(names))) + "\n"
    with written_aside(target) as file:
        text = cast("IO[str]", file)
        text.write(",".join(("t_s", "stroke", "x_mm", "y_mm", *names)) + "\n")
        for cells in table:
            text.write(row % tuple(cells.tolist()))
