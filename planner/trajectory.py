"""The trajectory: joint positions at a fixed rate with what the pen is doing, and its CSV form."""

from __future__ import annotations

import math
import os
import stat
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, cast

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.errors import OutputError, TrajectoryFileError
from planner.files import STANDARD_OUTPUT_DESCRIPTOR, is_standard_output

FORMAT_VERSION = 1
TRAVELLING = -1
"""Value of `stroke` while the pen is travelling, lifting or lowering."""

_DECIMALS = 9
_FIRST_LINE = 9  # after seven comment lines and the column names
_BLOCK_ROWS = 65_536
_BLOCK_CHARACTERS = 1 << 22
_LONGEST_LINE = 1 << 16
_LOWEST_RATE_HZ, _HIGHEST_RATE_HZ = 1e-3, 1e5  # times are written in microseconds
_LARGEST = 1e9


@dataclass(frozen=True, eq=False, slots=True)
class Trajectory:
    """Samples at a fixed rate, first and last at rest.

    columns: names of the joint columns, such as "q1_deg" or "d3_mm", in chain order.
    positions: (n_samples, n_joints) in the units that the column names say.
    pen: (n_samples,) True while the tip is on the paper.
    stroke: (n_samples,) index of the stroke being drawn, or TRAVELLING.
    svg_to_arm_mm: (a, b, c, d, e, f) from SVG user units to arm millimetres,
        x = a u + c v + e, y = b u + d v + f.
    first_line: the line that its first sample has in its file, for messages that name lines.
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
    first_line: int = _FIRST_LINE

    def line(self, sample: int) -> int:
        """Line of a sample in its file, counted from 1."""
        return self.first_line + sample

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
    behind otherwise. A symbolic link stays one, and the file that it points to is replaced; a device or
    a pipe is written to as it is, and so is standard output; a reader of that who has gone away (`| head`) is no
    error. Errors: OutputError."""
    aside = None
    try:
        if is_standard_output(target):
            if sys.stdout is not None:
                sys.stdout.flush()
            with suppress(BrokenPipeError), _opened(os.dup(STANDARD_OUTPUT_DESCRIPTOR), binary) as file:
                yield file
            return
        if target.is_dir():
            raise OutputError(str(target), "it is a folder")
        if target.exists() and not target.is_file():
            with _opened(os.open(target, os.O_WRONLY), binary) as file:
                yield file
            return
        final = Path(os.path.realpath(target))
        if not final.parent.is_dir():
            raise OutputError(str(target), f"there is no folder {final.parent}")
        if final.exists() and not os.access(final, os.W_OK):
            raise OutputError(str(target), "it is write-protected")
        descriptor, name = tempfile.mkstemp(dir=final.parent, prefix=".unfinished-")
        aside = Path(name)
        with _opened(descriptor, binary) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        aside.chmod(_usual_mode(final))  # mkstemp makes files private; a result is for everybody, as usual
        aside.replace(final)
        aside = None
    except OSError as error:
        name = "to standard output" if is_standard_output(target) else str(target)
        raise OutputError(name, error.strerror or str(error)) from error
    finally:
        if aside is not None:
            with suppress(OSError):
                aside.unlink()


def _opened(descriptor: int, binary: bool) -> IO[str] | IO[bytes]:
    if binary:
        return os.fdopen(descriptor, "wb")
    # A file name that is no Unicode may stand in a comment line: better a "?" than no trajectory.
    return os.fdopen(descriptor, "w", encoding="utf-8", errors="replace")


def _usual_mode(target: Path) -> int:
    """Permissions of the file that is replaced, or those that a new one would get."""
    if target.exists():
        return stat.S_IMODE(target.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def write_trajectory(trajectory: Trajectory, target: Path) -> None:
    """Write the CSV, whole or not at all. Errors: OutputError."""
    with written_aside(target) as file:
        _write(trajectory, cast("IO[str]", file))


def _write(trajectory: Trajectory, file: IO[str]) -> None:
    affine = " ".join(repr(float(value)) for value in trajectory.svg_to_arm_mm)
    for key, value in (
        ("trajectory", str(FORMAT_VERSION)),
        ("arm", trajectory.arm),
        ("drawing", trajectory.drawing),
        ("method", trajectory.method),
        ("rate_hz", repr(float(trajectory.rate_hz)).removesuffix(".0")),
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
        with source.open(encoding="utf-8-sig", errors="replace") as file:
            header, columns, first_line = _read_head(name, file)
            table = _read_rows(name, file, first_line, len(columns) + 3)
    except OSError as error:
        raise TrajectoryFileError(name, None, f"cannot be read: {error.strerror or error}") from error
    rate_hz = header.rate_hz
    _check_rows(name, table, rate_hz, first_line)
    if abs(header.duration_s - table[-1, 0]) > 0.5 / rate_hz:
        raise TrajectoryFileError(
            name, first_line + len(table) - 1,
            f"the last sample is at {table[-1, 0]:g} s, the header promises {header.duration_s:g} s")
    if not header.texts.get("arm"):
        raise TrajectoryFileError(name, None, "names no arm (no '# arm:' line)")
    return Trajectory(
        arm=header.texts["arm"], drawing=header.texts.get("drawing", ""),
        method=header.texts.get("method", ""), rate_hz=rate_hz, columns=columns,
        positions=np.ascontiguousarray(table[:, 1:-2]), pen=table[:, -2] != 0, stroke=table[:, -1].astype(np.int64),
        svg_to_arm_mm=header.svg_to_arm_mm, first_line=first_line)


@dataclass(frozen=True, slots=True)
class _Header:
    texts: Mapping[str, str]
    rate_hz: float
    duration_s: float
    svg_to_arm_mm: tuple[float, float, float, float, float, float]


def _read_head(name: str, file: IO[str]) -> tuple[_Header, tuple[str, ...], int]:
    """Header, joint columns, and the line of the first sample."""
    found: dict[str, tuple[str, int]] = {}
    number = 1
    while (line := file.readline(_LONGEST_LINE)).startswith("#"):
        key, separator, value = line[1:].partition(":")
        if separator:
            found[key.strip()] = value.strip(), number
        number += 1
    version, version_line = found.get("trajectory", (None, 1))
    if version is None:
        raise TrajectoryFileError(name, 1, "does not begin as a trajectory (no '# trajectory: 1' line)")
    if version != str(FORMAT_VERSION):
        raise TrajectoryFileError(
            name, version_line, f"is of format '{_shown(version)}'; this planner reads format {FORMAT_VERSION}")
    rate_hz = _numbers(name, found, "rate_hz", 1)[0]
    if not _LOWEST_RATE_HZ <= rate_hz <= _HIGHEST_RATE_HZ:
        raise TrajectoryFileError(
            name, found["rate_hz"][1],
            f"rate_hz is {rate_hz:g}; it has to be from {_LOWEST_RATE_HZ:g} to {_HIGHEST_RATE_HZ:g}")
    duration_s = _numbers(name, found, "duration_s", 1)[0]
    a, b, c, d, e, f = _numbers(name, found, "svg_to_arm_mm", 6)
    if not line:
        raise TrajectoryFileError(name, max(number - 1, 1), "ends before its column names")
    texts = {key: value for key, (value, _) in found.items()}
    return _Header(texts, rate_hz, duration_s, (a, b, c, d, e, f)), _joint_columns(name, line, number), number + 1


def _numbers(name: str, found: Mapping[str, tuple[str, int]], key: str, count: int) -> list[float]:
    if key not in found:
        raise TrajectoryFileError(name, None, f"has no '# {key}:' line")
    text, line = found[key]
    cells = text.split()
    if len(cells) != count or not all(map(_is_number, cells)):
        raise TrajectoryFileError(name, line, f"'# {key}:' is '{_shown(text)}'; wanted {count} number(s)")
    return [float(cell) for cell in cells]


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text)) and text.isascii() and "_" not in text
    except ValueError:
        return False


def _shown(text: str) -> str:
    """A part of a file as it may stand in a message: short, and without characters that upset a terminal."""
    return "".join(character if character.isprintable() else "?" for character in text[:60])


def _joint_columns(name: str, line: str, number: int) -> tuple[str, ...]:
    names = line.strip().split(",")
    if len(names) < 4 or names[0] != "t_s" or names[-2:] != ["pen", "stroke"]:
        raise TrajectoryFileError(name, number, "expected the columns t_s, the joints, pen, stroke")
    joints = tuple(names[1:-2])
    for column in joints:
        if not column.endswith(("_deg", "_mm")):
            raise TrajectoryFileError(name, number, f"column '{_shown(column)}' has no unit (_deg or _mm)")
    if len(set(joints)) != len(joints):
        raise TrajectoryFileError(name, number, "two columns have the same name")
    return joints


def _read_rows(name: str, file: IO[str], first_line: int, width: int) -> FloatArray:
    """(n_samples, width) all cells; read in blocks, so that memory is that of the numbers."""
    blocks = []
    number, rest = first_line, ""
    while chunk := file.read(_BLOCK_CHARACTERS):
        rows = (rest + chunk).split("\n")
        rest = rows.pop()
        if len(rest) > _LONGEST_LINE:
            raise TrajectoryFileError(name, number + len(rows), "is too long for a sample")
        if rows:
            blocks.append(_table(name, rows, number, width))
            number += len(rows)
    if rest:
        blocks.append(_table(name, [rest], number, width))
    if not blocks:
        raise TrajectoryFileError(name, first_line - 1, "has no samples")
    return np.concatenate(blocks)


def _table(name: str, rows: list[str], first_line: int, width: int) -> FloatArray:
    try:
        if all(rows):  # the parser below would pass over empty lines, with a warning
            table: FloatArray = np.loadtxt(rows, delimiter=",", ndmin=2, comments=None, dtype=np.float64)
            if table.shape == (len(rows), width) and bool((np.abs(table) < _LARGEST).all()):
                return table
    except ValueError:
        pass  # found again below, where its line is known
    for number, row in enumerate(rows, first_line):
        cells = row.split(",")
        if len(cells) != width:
            raise TrajectoryFileError(name, number, f"has {len(cells)} cell(s); wanted {width}")
        for cell in cells:
            if not _is_number(cell):
                raise TrajectoryFileError(name, number, f"'{_shown(cell.strip())}' is not a finite number")
            if abs(float(cell)) >= _LARGEST:
                raise TrajectoryFileError(name, number, f"{float(cell):g} is beyond any time, joint or stroke")
    raise TrajectoryFileError(name, first_line, "begins a part that cannot be read as numbers")


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
    refuse((table[:, -2] == 0) & (stroke != TRAVELLING), "the pen is up within a stroke")
    drawn = np.maximum.accumulate(stroke)
    refuse((stroke >= 0) & (stroke < drawn), "strokes go backwards")
