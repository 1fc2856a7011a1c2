"""What the simulated arm leaves on the paper, read from its picture and measured without a line of the planner's."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from planner.arrays import FloatArray
from planner.cli import main

_SPACING_MM = 0.02


def ink_of(trajectory: Path) -> list[FloatArray]:
    """Lines (n, 2) in arm mm that the simulated arm draws as it plays a trajectory."""
    picture = trajectory.with_suffix(".ink.svg")
    assert main(["run", str(trajectory), "--fast", "--quiet", "--picture", str(picture)]) == 0
    told = re.findall(r'<polyline points="([^"]*)"', picture.read_text(encoding="utf-8"))
    seen = [np.array([point.split(",") for point in points.split()], dtype=float) for points in told]
    return [-line[:, ::-1] for line in seen]  # arm x goes up the picture and arm y to the left


def map_of(trajectory: Path) -> FloatArray:
    """(2, 3) from user units to arm mm, as the head of the file says."""
    (told,) = re.findall(r"# svg_to_arm_mm: (.*)", trajectory.read_text(encoding="utf-8"))
    a, b, c, d, e, f = map(float, told.split())
    return np.array([[a, c, e], [b, d, f]])


def moved(points: FloatArray, affine: FloatArray) -> FloatArray:
    """(n, 2) points through a map (2, 3)."""
    there: FloatArray = points @ affine[:, :2].T + affine[:, 2]
    return there


def apart_mm(lines: list[FloatArray], wanted: list[FloatArray]) -> float:
    """The largest distance from a point of either to the other."""
    one, other = (np.concatenate([_dense(line) for line in some]) for some in (lines, wanted))
    return float(max(cKDTree(one).query(other)[0].max(), cKDTree(other).query(one)[0].max()))


def _dense(line: FloatArray) -> FloatArray:
    steps = np.hypot(*np.diff(line, axis=0).T)
    along = np.concatenate(([0.0], np.cumsum(steps)))
    at = np.linspace(0.0, along[-1], int(along[-1] / _SPACING_MM) + 2)
    return np.column_stack([np.interp(at, along, column) for column in line.T])
