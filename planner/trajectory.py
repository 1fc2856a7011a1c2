"""The trajectory: joint positions at a fixed rate with what the pen is doing, and its CSV form."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.errors import OutputError, TrajectoryFileError

FORMAT_VERSION = 1
TRAVELLING = -1
"""Value of `stroke` while the pen is travelling, lifting or lowering."""

_DECIMALS = 9
_BLOCK_ROWS = 65_536


@dataclass(frozen=True, eq=False, slots=True)
class Trajectory:
    """Samples at a fixed rate, first and last at rest.

    columns: names of the joint columns, such as "q1_deg" or "d3_mm", in chain order.
    positions: (n_samples, n_joints) in the units that the column names say.
    pen: (n_samples,) True while the tip is on the paper.
    stroke: (n_samples,) index of the stroke being drawn, or TRAVELLING.
    svg_to_arm_mm: (a, b, c, d, e, f) from SVG user units to arm millimetres,
        x = a u + c v + e, y = b u + d v + f.
    """

    arm: str
    drawing: str
    method: str
    rate_hz: float
    columns: tuple[str, ...]
    positions: FloatArray
    pen: BoolArray
    stroke: IntArray
    svg_to_arm_mm: tuple[float, float, float, float, float, float]

    @property
    def n_samples(self) -> int:
        return int(self.positions.shape[0])

    @property
    def duration_s(self) -> float:
        return max(self.n_samples - 1, 0) / self.rate_hz

    @property
    def times_s(self) -> FloatArray:
        """(n_samples,) time of each sample."""
        times: FloatArray = np.arange(self.n_samples) / self.rate_hz
        return times


@contextmanager
def written_aside(target: Path, *, binary: bool = False) -> Iterator[IO[str] | IO[bytes]]:
    """A file that takes the place of `target` only once it is complete and on disk; nothing is left
    behind otherwise. Errors: OutputError."""
    folder = target.parent
    if target.is_dir():
        raise OutputError(str(target), "it is a folder")
    if not folder.is_dir():
        raise OutputError(str(target), f"there is no folder {folder}")
    aside = None
    try:
        descriptor, aside = tempfile.mkstemp(dir=folder, prefix=f".{target.name}.")
        with os.fdopen(descriptor, "wb" if binary else "w", **({} if binary else {"encoding": "utf-8"})) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(aside, 0o666 & ~mask)  # mkstemp makes files private; a result is for everybody, as usual
        os.replace(aside, target)
        aside = None
    except OSError as error:
        raise OutputError(str(target), error.strerror or str(error)) from error
    finally:
        if aside is not None:
            with suppress(OSError):
                os.unlink(aside)


def write_trajectory(trajectory: Trajectory, target: Path) -> None:
    """Write the CSV, whole or not at all. Errors: OutputError."""
    with written_aside(target) as file:
        _write(trajectory, file)  # type: ignore[arg-type]


def _write(trajectory: Trajectory, file: IO[str]) -> None:
    affine = " ".join(repr(float(value)) for value in trajectory.svg_to_arm_mm)
    for key, value in (
        ("trajectory", str(FORMAT_VERSION)),
        ("arm", trajectory.arm),
        ("drawing", trajectory.drawing),
        ("method", trajectory.method),
        ("rate_hz", f"{trajectory.rate_hz:.12g}"),
        ("duration_s", f"{trajectory.duration_s:.9g}"),
        ("svg_to_arm_mm", affine),
    ):
        file.write(f"# {key}: {' '.join(value.split())}\n")
    file.write(",".join(("t_s", *trajectory.columns, "pen", "stroke")) + "\n")
    row = ",".join(["%.6f", *[f"%.{_DECIMALS}f"] * len(trajectory.columns), "%d", "%d"]) + "\n"
    for start in range(0, trajectory.n_samples, _BLOCK_ROWS):
        block = slice(start, start + _BLOCK_ROWS)
        positions = trajectory.positions[block] + 0.0  # no "-0.000"
        table = np.column_stack((
            np.arange(start, start + len(positions)) / trajectory.rate_hz,
            positions, trajectory.pen[block], trajectory.stroke[block]))
        file.write((row * len(table)) % tuple(table.ravel().tolist()))


def read_trajectory(source: Path) -> Trajectory:
    """Read a trajectory file and check all that can be checked without its arm.

    Errors: TrajectoryFileError with the line.
    """
    name = str(source)
    try:
        lines = source.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise TrajectoryFileError(name, None, f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise TrajectoryFileError(name, None, "is not a text file") from error
    header, start = _read_header(name, lines)
    version = header.get("trajectory")
    if version is None:
        raise TrajectoryFileError(name, 1, "does not begin as a trajectory (no '# trajectory: 1' line)")
    if version != str(FORMAT_VERSION):
        raise TrajectoryFileError(name, 1, f"is of format '{version}'; this planner reads format {FORMAT_VERSION}")
    rate_hz = _header_numbers(name, header, "rate_hz", 1)[0]
    if not rate_hz > 0:
        raise TrajectoryFileError(name, None, f"rate_hz is {rate_hz:g}; it has to be positive")
    affine = _header_numbers(name, header, "svg_to_arm_mm", 6)
    duration_s = _header_numbers(name, header, "duration_s", 1)[0]
    columns = _read_columns(name, lines, start)
    table = _read_rows(name, lines, start + 1, len(columns) + 3)
    _check_rows(name, table, rate_hz, start + 2)
    if abs(duration_s - table[-1, 0]) > 0.5 / rate_hz:
        raise TrajectoryFileError(
            name, len(lines), f"the last sample is at {table[-1, 0]:g} s, the header promises {duration_s:g} s")
    a, b, c, d, e, f = affine
    return Trajectory(
        arm=header.get("arm", ""), drawing=header.get("drawing", ""), method=header.get("method", ""),
        rate_hz=rate_hz, columns=columns, positions=np.ascontiguousarray(table[:, 1:-2]),
        pen=table[:, -2] != 0, stroke=table[:, -1].astype(np.int64), svg_to_arm_mm=(a, b, c, d, e, f))


def _read_header(name: str, lines: list[str]) -> tuple[dict[str, str], int]:
    header: dict[str, str] = {}
    for number, line in enumerate(lines):
        if not line.startswith("#"):
            return header, number
        key, separator, value = line[1:].partition(":")
        if separator:
            header[key.strip()] = value.strip()
    raise TrajectoryFileError(name, len(lines) or None, "ends before its column names")


def _header_numbers(name: str, header: dict[str, str], key: str, count: int) -> list[float]:
    if key not in header:
        raise TrajectoryFileError(name, None, f"has no '# {key}:' line")
    try:
        values = [float(value) for value in header[key].split()]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        raise TrajectoryFileError(name, None, f"'# {key}:' is '{header[key]}'; wanted {count} number(s)")
    return values


def _read_columns(name: str, lines: list[str], start: int) -> tuple[str, ...]:
    names = lines[start].strip().split(",")
    if len(names) < 4 or names[0] != "t_s" or names[-2:] != ["pen", "stroke"]:
        raise TrajectoryFileError(name, start + 1, "expected the columns t_s, the joints, pen, stroke")
    joints = tuple(names[1:-2])
    for column in joints:
        if not column.endswith(("_deg", "_mm")):
            raise TrajectoryFileError(name, start + 1, f"column '{column}' has no unit (_deg or _mm)")
    if len(set(joints)) != len(joints):
        raise TrajectoryFileError(name, start + 1, "two columns have the same name")
    return joints


def _read_rows(name: str, lines: list[str], start: int, width: int) -> FloatArray:
    rows = lines[start:]
    if not rows:
        raise TrajectoryFileError(name, start, "has no samples")
    try:
        table: FloatArray = np.loadtxt(rows, delimiter=",", ndmin=2, comments=None, dtype=np.float64)
    except ValueError:
        table = np.empty((0, 0))
    if table.shape == (len(rows), width) and bool(np.isfinite(table).all()):
        return table
    for number, row in enumerate(rows, start + 1):  # the slow way, to name the line
        cells = row.split(",")
        if len(cells) != width:
            raise TrajectoryFileError(name, number, f"has {len(cells)} cells; wanted {width}")
        for cell in cells:
            try:
                good = math.isfinite(float(cell))
            except ValueError:
                good = False
            if not good:
                raise TrajectoryFileError(name, number, f"'{cell.strip()}' is not a finite number")
    raise TrajectoryFileError(name, None, "cannot be read as a table of numbers")


def _check_rows(name: str, table: FloatArray, rate_hz: float, first_line: int) -> None:
    def refuse(bad: BoolArray, reason: str) -> None:
        if bad.any():
            raise TrajectoryFileError(name, first_line + int(np.argmax(bad)), reason)

    refuse(np.abs(table[:, 0] - np.arange(len(table)) / rate_hz) > 2e-6 + 1e-6 / rate_hz,
           f"time is not on the grid of {rate_hz:g} samples a second (a line is missing, doubled or edited)")
    refuse((table[:, -2] != 0) & (table[:, -2] != 1), "pen is neither 0 nor 1")
    stroke = table[:, -1]
    refuse((stroke != np.round(stroke)) | (stroke < TRAVELLING), "stroke is not an index")
    refuse((table[:, -2] == 1) & (stroke == TRAVELLING), "the pen is down between strokes")
    drawn = np.maximum.accumulate(stroke)
    refuse((stroke >= 0) & (stroke < drawn), "strokes go backwards")
