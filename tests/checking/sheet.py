"""A trajectory file taken apart, so that any cell, row or line of it can be changed before it is checked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.checking.chain import chain_poses
from planner.checking.check import check_trajectory
from planner.drawing.drawing import Drawing
from planner.errors import TrajectoryFileError
from planner.trajectory import Trajectory, read_trajectory

REFUSED = "refused by the reader"


@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """A trajectory file, the arm and the drawing that it is held to. cells: (n, width) texts."""

    head: dict[str, str]
    names: list[str]
    cells: np.ndarray
    arm: Arm
    drawing: Drawing

    @staticmethod
    def of(trajectory: Trajectory, arm: Arm, drawing: Drawing, decimals: int = 9) -> Sheet:
        head = dict(line[2:].split(": ", 1) for line in trajectory.head.text().splitlines())
        columns = [
            [f"{time:.6f}" for time in trajectory.times_s],
            *[[f"{value:.{decimals}f}" for value in column] for column in trajectory.positions.T],
            [str(int(down)) for down in trajectory.pen],
            [str(stroke) for stroke in trajectory.stroke],
        ]
        return Sheet(
            head, ["t_s", *trajectory.columns, "pen", "stroke"], np.array(columns, dtype=object).T, arm, drawing
        )

    @property
    def positions(self) -> FloatArray:
        return self.cells[:, 1:-2].astype(np.float64)

    @property
    def pen(self) -> BoolArray:
        return self.cells[:, -2] == "1"

    @property
    def stroke(self) -> IntArray:
        return self.cells[:, -1].astype(np.int64)

    @property
    def rate_hz(self) -> float:
        return float(self.head["rate_hz"])

    def tip_mm(self) -> FloatArray:
        tips: FloatArray = chain_poses(self.arm, self.arm.from_file_units(self.positions)).tip_mm.T
        return tips

    def told(self, **entries: str) -> Sheet:
        return replace(self, head={**self.head, **entries})

    def with_positions(self, positions: FloatArray) -> Sheet:
        cells = self.cells.copy()
        cells[:, 1:-2] = np.vectorize("{:.9f}".format, otypes=[object])(positions)
        return replace(self, cells=cells)

    def with_strokes(self, stroke: IntArray) -> Sheet:
        """Other labels; the pen is down where there is a stroke."""
        cells = self.cells.copy()
        cells[:, -2], cells[:, -1] = np.where(stroke >= 0, "1", "0"), [str(label) for label in stroke]
        return replace(self, cells=cells)

    def with_cell(self, row: int, column: int, text: str) -> Sheet:
        cells = self.cells.copy()
        cells[row, column] = text
        return replace(self, cells=cells)

    def rows(self, kept: IntArray) -> Sheet:
        """Other rows, with the times and the duration that belong to so many."""
        cells = self.cells[kept].copy()
        cells[:, 0] = [f"{index / self.rate_hz:.6f}" for index in range(len(cells))]
        return replace(self, cells=cells).told(duration_s=f"{(len(cells) - 1) / self.rate_hz:.9g}")

    def text(self) -> str:
        head = "".join(f"# {key}: {value}\n" for key, value in self.head.items())
        return head + "\n".join([",".join(self.names), *map(",".join, self.cells.tolist())]) + "\n"

    def found(self, file: Path, tolerance_mm: float = 0.05) -> set[str]:
        """The laws that the check finds broken."""
        file.write_text(self.text())
        try:
            trajectory = read_trajectory(file)
        except TrajectoryFileError:
            return {REFUSED}
        return {one.check for one in check_trajectory(trajectory, self.arm, self.drawing, tolerance_mm).faults}

    def lead_mm(self, samples: IntArray, offset_mm: FloatArray) -> Sheet:
        """The tip moved by offsets (n, 3) at some samples, couplings kept, by Newton's method on differences."""
        free = list(self.arm.independent_joints)
        configurations = self.arm.from_file_units(self.positions)
        q = configurations[samples][:, free]
        wanted = self.tip_mm()[samples] + offset_mm

        def tips(values: FloatArray) -> FloatArray:
            found: FloatArray = chain_poses(self.arm, self.arm.complete(values)).tip_mm.T
            return found

        for _ in range(4):
            here = tips(q)
            slopes = np.stack([(tips(q + step) - here) / 1e-6 for step in 1e-6 * np.eye(len(free))], axis=2)
            q = q + np.einsum("nij,nj->ni", np.linalg.pinv(slopes), wanted - here)
        configurations[samples] = self.arm.complete(q)
        return self.with_positions(self.arm.to_file_units(configurations))
