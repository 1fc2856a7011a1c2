"""One pattern, drawn by true arms, for all tests of a calibration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from hardware.compensation.servo_values import pulse_calibration
from hardware.motion.tip import link_nodes_mm
from hardware.playback.program import make_program
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray, IntArray
from planner.error_model.calibration.files import Measured, Record, Touches
from planner.error_model.calibration.sheets import Sheet, rows_of_marks
from planner.error_model.pattern.pattern import Pattern, make_pattern
from tests.judge import playing
from tests.judge.true_arm import TrueArm, random_arm
from tests.judge.verdict import measured

NO_TOUCHES = Touches(np.empty(0), np.empty((0, 2)), np.empty((0, 2)), np.empty(0, dtype=np.int64))


@dataclass(frozen=True, eq=False)
class Drawn:
    """A pattern as an arm is told to draw it. approach: set points of the record before those of the pattern."""

    arm: Arm
    pattern: Pattern
    record: Record
    approach: int

    @property
    def marks(self) -> IntArray:
        return np.arange(len(self.pattern.marks_mm))

    def tips_mm(self, true: TrueArm, seed: int = 0, sd_mm: float = 0.15) -> FloatArray:
        """(m, 3) the marks of a true arm, as they are measured."""
        told = playing.Record(self.record.times_s, self.record.stroke, self.record.meant_mm, self.record.told)
        times_s = self.record.times_s[rows_of_marks(self.record, self.marks)]
        return measured(true, told, times_s, np.random.default_rng(seed), sd_mm)

    def sheet(self, tips_mm: FloatArray, sd_mm: float = 0.15, touches: Touches = NO_TOUCHES) -> Sheet:
        return Sheet(
            "marks.csv",
            self.record,
            Measured(self.marks[: len(tips_mm)], tips_mm, np.full(len(tips_mm), sd_mm), touches),
        )


def drawn(arm: Arm, count: int, seed: int) -> Drawn:
    pattern = make_pattern(arm, arm.name, count, seed)
    trajectory = pattern.trajectory
    program = make_program(
        arm, arm.from_file_units(trajectory.positions), trajectory.stroke, trajectory.rate_hz, park=arm.park
    )
    told = pulse_calibration(arm).to_servos(np.clip(program.positions, arm.minimum, arm.maximum))
    return Drawn(
        arm,
        pattern,
        Record(
            np.arange(len(told)) / trajectory.rate_hz,
            program.stroke,
            link_nodes_mm(arm, program.positions)[:, -1, :2],
            told,
        ),
        program.approach,
    )


@pytest.fixture(scope="session")
def sheet49() -> Drawn:
    return drawn(load_arm("drawing_arm_2022"), 49, 0)


@pytest.fixture(scope="session")
def fresh() -> Drawn:
    return drawn(load_arm("drawing_arm_2022"), 25, 5)


@pytest.fixture(scope="session")
def true_arms() -> list[TrueArm]:
    return [random_arm(load_arm("drawing_arm_2022"), np.random.default_rng(seed)) for seed in range(4)]
