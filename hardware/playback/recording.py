"""Runs as tables: what each servo was told, on which a calibration rests, and where the joints were measured to be."""

from __future__ import annotations

from math import isnan
from pathlib import Path
from typing import IO, cast

import numpy as np

from hardware.compensation.servo_values import Calibration
from hardware.measurements import Measurements
from hardware.motion.tip import tips_mm
from hardware.playback.program import Program
from planner.arms.arm import Arm
from planner.files import written_aside
from planner.trajectory import Trajectory


def write_record(arm: Arm, trajectory: Trajectory, program: Program, calibration: Calibration, target: Path) -> None:
    """One row a set point: its time, the stroke being drawn or -1, where the pen is meant to be on the paper, and the
    final value of each servo, in us or counts. Errors: OutputError."""
    commanded = calibration.to_servos(program.positions)
    heights_mm = trajectory.pen_heights_mm[np.floor(program.sample).astype(np.int64)]
    places_mm = tips_mm(arm, program.meant, heights_mm)[:, :2]
    table = np.column_stack((np.arange(len(commanded)) / program.rate_hz, program.stroke, places_mm, commanded))
    names = [f"{joint.name}_{calibration.unit}" for joint in arm.joints]
    row = ",".join(("%.6f", "%d", "%.4f", "%.4f", *["%.4f"] * len(names))) + "\n"
    with written_aside(target) as file:
        text = cast("IO[str]", file)
        text.write(",".join(("t_s", "stroke", "x_mm", "y_mm", *names)) + "\n")
        for cells in table:
            text.write(row % tuple(cells.tolist()))


def write_positions(arm: Arm, measured: Measurements, target: Path) -> None:
    """One row a measurement: its time since the first set point, and each joint's position in deg or mm, empty where
    it was not measured then. Errors: OutputError."""
    table = arm.to_file_units(measured.positions)
    with written_aside(target) as file:
        text = cast("IO[str]", file)
        text.write(",".join(("t_s", *arm.column_names)) + "\n")
        for time_s, row in zip(measured.times_s.tolist(), table.tolist(), strict=True):
            text.write(",".join((f"{time_s:.6f}", *("" if isnan(cell) else f"{cell:.4f}" for cell in row))) + "\n")
