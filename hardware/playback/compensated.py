"""From where joints are meant to be to where their servos are sent: slack is taken up, and lag is led.

The whole program is known before it is played, so all this is done in advance, in the same way for every driver.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hardware.compensation.servo_values import Calibration
from hardware.compensation.take_up import taken_up
from hardware.playback.program import Program
from planner.arms.arm import Arm
from planner.arms.slack import half_slack, leads_s
from planner.arrays import FloatArray
from planner.trajectory import TRAVELLING

_SETTLING_S = 0.5
"""Rest before the program, in which every joint is brought to a known side of its slack, and after it."""


def compensated(arm: Arm, program: Program, calibration: Calibration) -> Program:
    """The program with set points that make the arm's joints go where `program` wants them.

    It begins and ends with a rest; `meant` keeps what the joints are to do. For an arm that was not calibrated
    nothing changes: the slack in its file is a guess, and an arm with less of it would draw worse for it. Set points
    stay within the ranges of servos, and the joints' limits of speed and acceleration hold.
    """
    slack, lead_s = half_slack(arm), leads_s(arm, 1 / program.rate_hz)
    if arm.accuracy is None:
        return program
    rest = int(np.ceil((_SETTLING_S + lead_s.max()) * program.rate_hz))
    meant = np.pad(program.positions, ((rest, rest), (0, 0)), mode="edge")
    commanded = taken_up(meant, slack, arm.max_velocity, arm.max_acceleration, 1 / program.rate_hz, rest)
    sent = np.clip(led(commanded, lead_s * program.rate_hz), *calibration.reach.T)
    return replace(
        program,
        positions=sent,
        uncompensated=meant,
        approach=program.approach + rest,
        retreat=program.retreat + rest,
        sample=np.pad(program.sample, rest, mode="edge"),
        stroke=np.pad(program.stroke, rest, constant_values=TRAVELLING),
    )


def led(set_points: FloatArray, by: FloatArray) -> FloatArray:
    """Set points (n, n_joints), each joint's by so many rows earlier; in between they are joined straight, which keeps
    limits. The last ones are held."""
    rows = np.arange(len(set_points))
    columns = [np.interp(rows + shift, rows, column) for shift, column in zip(by.tolist(), set_points.T, strict=True)]
    return np.column_stack(columns)
