"""The trajectory: joint positions at a fixed rate with what the pen is doing, and its CSV form."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, cast

import numpy as np

from planner.affine import scale_of
from planner.arms.paper_pose import BASE_PLANE, PaperPose
from planner.arrays import BoolArray, ByteArray, FloatArray, IntArray
from planner.drawing.drawing import Drawing
from planner.drawing.fill_options import NO_FILL, FillOptions
from planner.drawing.options import AS_A_BROWSER, ReadingOptions
from planner.drawing.pen_groups import chosen_layers, only
from planner.errors import TrajectoryFileError, UsageError
from planner.files import written_aside
from planner.head import (
    ALL,
    LONGEST_LINE,
    NO_WORK,
    NOTHING_LEFT_OUT,
    NOTHING_TOLD,
    Chosen,
    Head,
    LeftOut,
    PathWork,
    PenInk,
    Placement,
    is_number,
    read_head,
    shown,
)
from planner.settings import Timing

if TYPE_CHECKING:
    import pandas

TRAVELLING = -1
"""Value of `stroke` while the pen is travelling, lifting or lowering."""
PATTERN = "pattern"
"""Value of `method` where a trajectory feels for the paper: between strokes it goes below it on purpose."""
TEST_MOTION = "identify"
"""Value of `method` where a trajectory tries what joints can do: it goes beyond their limits on purpose, up to the
factor that its header tells."""

_DECIMALS = 9
_FEWEST_DECIMALS, _MOST_DECIMALS = 6, 17
_BLOCK_ROWS = 65_536
_BLOCK_CHARACTERS = 1 << 22
_LARGEST = 1e9


@dataclass(frozen=True, eq=False, slots=True)
class Trajectory:
    """Samples at a fixed rate, first and last at rest.

    Attributes:
        columns: Names of the joint columns, such as "q1_deg" or "d3_mm", in chain order.
        positions: (n_samples, n_joints) in the units that the column names say.
        pen: (n_samples,) True while the tip is on the paper.
        stroke: (n_samples,) index of the stroke being drawn, or TRAVELLING, -1.
        svg_to_arm_mm: (a, b, c, d, e, f) from SVG user units to arm millimetres,
            x = a u + c v + e, y = b u + d v + f.
        decimals: As `positions`, how many decimals each has in the file that it was read from; None where it was not.
        first_line: The line that its first sample has in that file, for messages that name lines; None where there is
            no such file: it is then the line that it would be written to.
        placement: What the header tells of where the drawing went.
        left_out: What was not drawn on purpose.
        pens: Those that draw, in their order, where somebody speaks of pens.
        pen_changes: The samples, at rest away from the paper, at which each pen but the first is put in.
        chosen: What of the drawing was drawn.
        path_work: What was done to its lines beforehand.
        fill: How its areas were filled.
        beyond_limits: Of a test motion alone, how many times the joints' limits it goes to; else 1.
        timing: How its motions were timed.
        paper: Where the paper lies that arm millimetres are counted on, in the frame of the base.
        reading: How the drawing was read.
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
    first_line: int | None = None
    decimals: ByteArray | None = None
    placement: Placement = NOTHING_TOLD
    left_out: LeftOut = NOTHING_LEFT_OUT
    paper: PaperPose = BASE_PLANE
    reading: ReadingOptions = AS_A_BROWSER
    pens: tuple[PenInk, ...] = ()
    pen_changes: tuple[int, ...] = ()
    chosen: Chosen = ALL
    path_work: PathWork = NO_WORK
    fill: FillOptions = NO_FILL
    beyond_limits: float = 1.0
    timing: Timing = Timing.OPTIMAL

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Trajectory:
        """Read a trajectory file. Errors: TrajectoryFileError with the line."""
        return read_trajectory(Path(path))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the file, whole or not at all. Errors: OutputError."""
        write_trajectory(self, Path(path))

    def to_frame(self) -> pandas.DataFrame:
        """The samples as a pandas data frame with the columns of the file. Errors: UsageError where pandas is not
        installed."""
        try:
            import pandas
        except ImportError:
            raise UsageError("a data frame needs pandas: pip install 'drawing-arm-planner[frame]'") from None
        joints = dict(zip(self.columns, self.positions.T, strict=True))
        return pandas.DataFrame({"t_s": self.times_s, **joints, "pen": self.pen.astype(int), "stroke": self.stroke})

    @property
    def title(self) -> str:
        """What it is a trajectory of, as headings say it."""
        name, tile = self.drawing or "trajectory", self.placement.tile
        return name if tile is None else f"{name}, sheet {tile}"

    @property
    def svg_to_arm(self) -> FloatArray:
        """(2, 3) `svg_to_arm_mm` as a matrix."""
        a, b, c, d, e, f = self.svg_to_arm_mm
        return np.array([[a, c, e], [b, d, f]])

    def all_of(self, drawing: Drawing) -> Drawing:
        """What of the drawing the header tells that was drawn, as often as it was. Errors: UsageError for a layer that
        is not there."""
        drawing = chosen_layers(drawing, self.chosen.layers)
        if self.chosen.by is not None:
            drawing = only(drawing, self.chosen.by, self.chosen.kinds, scale_of(self.svg_to_arm))
        return drawing if self.placement.copies is None else self.placement.copies.of(drawing, self.svg_to_arm)

    def part(self, first: int, last: int, pen: PenInk, chosen: Chosen) -> Trajectory:
        """Samples `first` to `last`, the arm at rest at both: what one pen draws of it, as a trajectory of its own."""
        stroke = self.stroke[first : last + 1]
        begins = int(stroke[stroke != TRAVELLING].min())
        return replace(
            self,
            positions=self.positions[first : last + 1],
            pen=self.pen[first : last + 1],
            stroke=np.where(stroke == TRAVELLING, TRAVELLING, stroke - begins),
            pens=(pen,),
            pen_changes=(),
            chosen=chosen,
        )

    def opening(self, n_samples: int) -> Trajectory:
        """The strokes that end within so many samples, and their moves; all of it where that is short, and one stroke
        at the least."""
        if self.n_samples <= n_samples or not self.pen.any():
            return self
        ends = np.flatnonzero(self.pen[:-1] & ~self.pen[1:])
        in_time = ends[ends < n_samples]
        last = int(in_time[-1] if len(in_time) else ends[0] if len(ends) else self.n_samples - 2) + 1
        shown = slice(0, last + 1)
        return replace(self, positions=self.positions[shown], pen=self.pen[shown], stroke=self.stroke[shown])

    @property
    def pen_of_stroke(self) -> IntArray:
        """(n_strokes,) which of the pens draws each stroke."""
        n_strokes = int(self.stroke.max(initial=-1)) + 1
        begins = np.full(n_strokes, self.n_samples)
        drawn = np.flatnonzero(self.stroke != TRAVELLING)
        begins[self.stroke[drawn][::-1]] = drawn[::-1]
        which: IntArray = np.searchsorted(np.array(self.pen_changes, dtype=np.int64), begins, side="right")
        return which

    @property
    def pen_heights_mm(self) -> FloatArray:
        """(n_samples,) how much further the tip of the pen that is in the holder sticks out than that of the pen in the
        arm's file."""
        if not self.pens:
            return np.zeros(self.n_samples)
        changes = np.array(self.pen_changes, dtype=np.int64)
        which = np.searchsorted(changes, np.arange(self.n_samples), side="right")
        heights: FloatArray = np.array([pen.height_mm for pen in self.pens])[which]
        return heights

    def line(self, sample: int) -> int:
        """Line of a sample in its file, counted from 1."""
        first_line = self.head.n_lines + 2 if self.first_line is None else self.first_line
        return first_line + sample

    @property
    def head(self) -> Head:
        """The comment lines of its file."""
        return Head(
            self.arm,
            self.drawing,
            self.method,
            self.rate_hz,
            self.duration_s,
            self.svg_to_arm_mm,
            self.placement,
            self.left_out,
            self.paper,
            self.reading,
            self.pens,
            self.pen_changes,
            self.chosen,
            self.path_work,
            self.fill,
            self.beyond_limits,
            self.timing,
        )

    @property
    def n_samples(self) -> int:
        """How many samples there are."""
        return int(self.positions.shape[0])

    @property
    def duration_s(self) -> float:
        """From the first sample to the last."""
        return max(self.n_samples - 1, 0) / self.rate_hz

    @property
    def times_s(self) -> FloatArray:
        """(n_samples,) time of each sample."""
        times: FloatArray = np.arange(self.n_samples) / self.rate_hz
        return times

    @property
    def rounding(self) -> FloatArray:
        """(n_samples, n_joints) how far each position can be from the one that was meant, in its unit: half of its
        last decimal in the file, and what arithmetic in double precision loses. Fewer than six decimals are none that a
        trajectory has: there, zeros at the end were left out."""
        held = 4 * np.finfo(np.float64).eps * np.abs(self.positions)
        if self.decimals is None:
            return held
        rounding: FloatArray = held + 0.5 * 10.0 ** -np.clip(self.decimals, _FEWEST_DECIMALS, _MOST_DECIMALS)
        return rounding


def write_trajectory(trajectory: Trajectory, target: Path) -> None:
    """Write the CSV, whole or not at all. Errors: OutputError."""
    with written_aside(target) as file:
        _write(trajectory, cast("IO[str]", file))


def _write(trajectory: Trajectory, file: IO[str]) -> None:
    file.write(trajectory.head.text())
    file.write(",".join(("t_s", *trajectory.columns, "pen", "stroke")) + "\n")
    row = ",".join(["%.6f", *[f"%.{_DECIMALS}f"] * len(trajectory.columns), "%d", "%d"]) + "\n"
    for start in range(0, trajectory.n_samples, _BLOCK_ROWS):
        block = slice(start, start + _BLOCK_ROWS)
        positions = trajectory.positions[block] + 0.0  # no "-0.000"
        table = np.column_stack(
            (
                np.arange(start, start + len(positions)) / trajectory.rate_hz,
                positions,
                trajectory.pen[block],
                trajectory.stroke[block],
            )
        )
        file.write((row * len(table)) % tuple(table.ravel().tolist()))


def read_trajectory(source: Path) -> Trajectory:
    """Read a trajectory file and check all that can be checked without its arm.

    Errors: TrajectoryFileError with the line.
    """
    name = str(source)
    try:
        with source.open(encoding="utf-8-sig", errors="replace") as file:
            head, line, number = read_head(name, file)
            columns, first_line = _joint_columns(name, line, number), number + 1
            table, decimals = _read_rows(name, file, first_line, len(columns) + 3)
    except OSError as error:
        raise TrajectoryFileError(name, None, f"cannot be read: {error.strerror or error}") from error
    _check_rows(name, table, head.rate_hz, first_line)
    if abs(head.duration_s - table[-1, 0]) > 0.5 / head.rate_hz:
        raise TrajectoryFileError(
            name,
            first_line + len(table) - 1,
            f"the last sample is at {table[-1, 0]:g} s, the header promises {head.duration_s:g} s",
        )
    if head.beyond_limits != 1.0 and (head.method != TEST_MOTION or (table[:, -2] != 0).any()):
        raise TrajectoryFileError(
            name, None, "goes beyond the limits ('# beyond_limits:'), which a test motion of plan identify alone may"
        )
    if not head.arm:
        raise TrajectoryFileError(name, None, "names no arm (no '# arm:' line)")
    return Trajectory(
        arm=head.arm,
        drawing=head.drawing,
        method=head.method,
        rate_hz=head.rate_hz,
        columns=columns,
        positions=np.ascontiguousarray(table[:, 1:-2]),
        pen=table[:, -2] != 0,
        stroke=table[:, -1].astype(np.int64),
        svg_to_arm_mm=head.svg_to_arm_mm,
        first_line=first_line,
        decimals=decimals,
        placement=head.placement,
        left_out=head.left_out,
        paper=head.paper,
        reading=head.reading,
        pens=head.pens,
        pen_changes=head.pen_changes,
        chosen=head.chosen,
        path_work=head.path_work,
        fill=head.fill,
        beyond_limits=head.beyond_limits,
        timing=head.timing,
    )


def _joint_columns(name: str, line: str, number: int) -> tuple[str, ...]:
    names = line.strip().split(",")
    if len(names) < 4 or names[0] != "t_s" or names[-2:] != ["pen", "stroke"]:
        raise TrajectoryFileError(name, number, "expected the columns t_s, the joints, pen, stroke")
    joints = tuple(names[1:-2])
    for column in joints:
        if not column.endswith(("_deg", "_mm")):
            raise TrajectoryFileError(name, number, f"column '{shown(column)}' has no unit (_deg or _mm)")
    if len(set(joints)) != len(joints):
        raise TrajectoryFileError(name, number, "two columns have the same name")
    return joints


def _read_rows(name: str, file: IO[str], first_line: int, width: int) -> tuple[FloatArray, ByteArray]:
    """(n_samples, width) all cells, and the decimals of the joints' ones; read in blocks, so that memory is that of
    the numbers."""
    blocks, decimals = [], []
    number, rest = first_line, ""
    while True:
        chunk = file.read(_BLOCK_CHARACTERS)
        rows = (rest + chunk).split("\n")
        rest = rows.pop()
        if len(rest) > LONGEST_LINE:
            raise TrajectoryFileError(name, number + len(rows), "is too long for a sample")
        if not chunk and rest:
            rows.append(rest)
        if rows:
            blocks.append(_table(name, rows, number, width))
            decimals.append(_decimals(rows, width)[:, 1:-2])
            number += len(rows)
        if not chunk:
            break
    if not blocks:
        raise TrajectoryFileError(name, first_line - 1, "has no samples")
    return np.concatenate(blocks), np.concatenate(decimals)


def _decimals(rows: Sequence[str], width: int) -> ByteArray:
    """(n_rows, width) digits after the point of each cell, less the power of ten that it is multiplied by."""
    text = np.frombuffer((",".join(rows) + ",").encode(errors="replace"), dtype=np.uint8)
    ends = np.flatnonzero(text == ord(","))
    exponents = np.flatnonzero((text == ord("e")) | (text == ord("E")))
    digits = np.cumsum((text >= ord("0")) & (text <= ord("9")), dtype=np.int32)
    points = np.flatnonzero(text == ord("."))
    last = ends.copy()  # where the digits of each cell end
    cell_of_exponent = np.searchsorted(ends, exponents)
    last[cell_of_exponent] = exponents
    found = np.zeros(len(ends), dtype=np.int64)
    cell_of_point = np.searchsorted(ends, points)
    found[cell_of_point] = digits[last[cell_of_point]] - digits[points]
    for cell, exponent in zip(cell_of_exponent.tolist(), exponents.tolist(), strict=True):
        found[cell] -= int(text[exponent + 1 : ends[cell]].tobytes())
    decimals: ByteArray = np.clip(found, 0, _MOST_DECIMALS).astype(np.int8).reshape(len(rows), width)
    return decimals


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
            if not is_number(cell):
                raise TrajectoryFileError(name, number, f"'{shown(cell.strip())}' is not a finite number")
            if abs(float(cell)) >= _LARGEST:
                raise TrajectoryFileError(name, number, f"{float(cell):g} is beyond any time, joint or stroke")
    raise TrajectoryFileError(name, first_line, "begins a part that cannot be read as numbers")


def _check_rows(name: str, table: FloatArray, rate_hz: float, first_line: int) -> None:
    def refuse(bad: BoolArray, reason: str) -> None:
        if bad.any():
            raise TrajectoryFileError(name, first_line + int(np.argmax(bad)), reason)

    refuse(
        np.abs(table[:, 0] - np.arange(len(table)) / rate_hz) > 2e-6 + 1e-6 / rate_hz,
        f"time is not on the grid of {rate_hz:g} samples a second (a line is missing, doubled or edited)",
    )
    refuse((table[:, -2] != 0) & (table[:, -2] != 1), "pen is neither 0 nor 1")
    stroke = table[:, -1]
    refuse((stroke != np.round(stroke)) | (stroke < TRAVELLING), "stroke is not an index")
    refuse((table[:, -2] == 1) & (stroke == TRAVELLING), "the pen is down between strokes")
    refuse((table[:, -2] == 0) & (stroke != TRAVELLING), "the pen is up within a stroke")
    drawn = np.maximum.accumulate(stroke)
    refuse((stroke >= 0) & (stroke < drawn), "strokes go backwards")
