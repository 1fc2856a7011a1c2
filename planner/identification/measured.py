"""What `plan identify` reads: the record of what servos were told, where joints were measured to be, and verdicts."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.error_model.calibration.files import Record, cells_of, number_of
from planner.errors import CalibrationError, UsageError
from planner.identification.motion import LadderMotion
from planner.identification.profile import Quantity

_SAME = 1e-3
"""us or counts: records have four decimals."""
_ENDS_S = 1.0
"""How much earlier or later than the record what was measured may end."""


@dataclass(frozen=True, eq=False, slots=True)
class Measured:
    """times_s: (k,) from the first sample of the test motion on; positions: (k, n_joints) rad or mm, NaN where a joint
    was not measured then."""

    times_s: FloatArray
    positions: FloatArray

    def of(self, joint: int) -> tuple[FloatArray, FloatArray]:
        """Times and positions of one joint."""
        known = ~np.isnan(self.positions[:, joint])
        return self.times_s[known], self.positions[known, joint]


def begins_at_s(record: Record, told: FloatArray, motion: LadderMotion, source: str) -> float:
    """When in a record the test motion begins, for which servos are told (n, n_joints). Errors: CalibrationError where
    it is the record of something else."""
    period_s, n_extra = 1 / motion.trajectory.rate_hz, len(record.told) - len(told)
    if abs(record.period_s - period_s) > 1e-3 * period_s:
        raise CalibrationError(
            source,
            f"has a row every {1e3 * record.period_s:.3g} ms, the test motion one every {1e3 * period_s:.3g} ms: it has"
            " to be played at its own speed, and given the --rate that it was planned with",
        )
    moving = np.flatnonzero(np.any(np.diff(told, axis=0) != 0, axis=1))
    some = moving[:: max(len(moving) // 200, 1)] + 1
    for begin in range(n_extra + 1):
        if np.all(np.abs(record.told[begin + some] - told[some]) <= _SAME) and np.all(
            np.abs(record.told[begin : begin + len(told)] - told) <= _SAME
        ):
            return float(record.times_s[begin])
    raise CalibrationError(
        source,
        "is not the record of the test motion for this arm: give the arm file, --factor and --rate that it was planned"
        " with, and the record of a run from its beginning to its end",
    )


def read_positions(source: Path, arm: Arm, record: Record, begin_s: float) -> Measured:
    """What `plan run --record-positions` wrote: t_s and a column a joint, such as q1_deg, empty where it was not
    measured. begin_s: when in the record the test motion begins. Errors: CalibrationError."""
    names, rows, lines = cells_of(source)
    wanted = ["t_s", *arm.column_names]
    if missing := [name for name in wanted if name not in names]:
        raise CalibrationError(str(source), f"has no column {missing[0]}; wanted {','.join(wanted)}")
    place = [names.index(name) for name in wanted]
    table = np.array(
        [
            [number_of(source, line, row[k]) if k == place[0] or row[k].strip() else np.nan for k in place]
            for row, line in zip(rows, lines, strict=True)
        ]
    ).reshape(-1, len(wanted))
    if len(table) < 2 or np.any(np.diff(table[:, 0]) < 0):
        raise CalibrationError(str(source), "its times do not go up: is it what plan run --record-positions wrote?")
    late_s = float(table[-1, 0] - record.times_s[-1])
    if abs(late_s) > _ENDS_S:
        raise CalibrationError(
            str(source),
            f"ends {abs(late_s):.1f} s {'after' if late_s > 0 else 'before'} the record does: they are not of one run,"
            " or it was paused or broken off",
        )
    return Measured(table[:, 0] - begin_s, arm.from_file_units(table[:, 1:]))


def read_verdicts(text: str, arm: Arm) -> dict[str, dict[Quantity, int]]:
    """`q1=14/12/9,q2=7`: of each joint the last step that looked right, of velocity, acceleration and jerk, 0 for none;
    one number is all three. Errors: UsageError."""
    names = [joint.name for joint in arm.joints]
    verdicts: dict[str, dict[Quantity, int]] = {}
    for part in text.split(","):
        name, equals, numbers = (cell.strip() for cell in part.partition("="))
        cells = [cell.strip() for cell in numbers.split("/")]
        if not equals or len(cells) not in (1, len(Quantity)) or not all(cell.isdecimal() for cell in cells):
            raise UsageError(f"--verdicts: '{part.strip():.40}' is no verdict; wanted such as q1=14 or q1=14/12/9")
        if name not in names:
            raise UsageError(f"--verdicts: there is no joint '{name:.40}' (joints: {', '.join(names)})")
        if name in verdicts:
            raise UsageError(f"--verdicts: joint {name} is there twice")
        if max(map(len, cells)) > 6:
            raise UsageError(f"--verdicts: joint {name} has no step of such a number")
        steps = [int(cell) for cell in cells] * (1 if len(cells) > 1 else len(Quantity))
        verdicts[name] = dict(zip(Quantity, steps, strict=True))
    return verdicts
