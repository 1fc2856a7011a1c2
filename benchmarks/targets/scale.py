"""Drawings of a million points: one drawing laid over itself, and one stroke. Time per point and peak memory of the
command, with all its processes."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.targets.family import Cost, planned
from benchmarks.targets.row import Row
from benchmarks.targets.strokes import placed_strokes
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.settings import PlanSettings

_POINTS = (250_000, 500_000, 1_000_000)
_SHIFT = 0.002
"""Copies of a drawing are shifted by this share of its size: the density of points on the paper then stays, and with
it the work per point."""
_LINEAR = 1.2
"""Processor time per point at the most points against that at the least, at most."""
_MOST_MB = 1024
_TURNS = 200
_SPIRAL_MM = (5.0, 100.0)


def many_strokes(drawing: Path, settings: PlanSettings) -> list[Row]:
    """The drawing as often over itself as makes so many points."""
    strokes = placed_strokes(drawing, load_arm(settings.arm), settings)
    own = sum(map(len, strokes))
    runs = []
    with tempfile.TemporaryDirectory() as folder:
        for wanted in _POINTS:
            count = -(-wanted // own)
            file = Path(folder) / "many.svg"
            file.write_text(_overlaid(strokes, count))
            runs.append((count * own, count * len(strokes), planned(file, settings)))
    return _rows(f"{drawing.stem} over itself", runs)


def one_stroke(settings: PlanSettings) -> list[Row]:
    """A spiral of even steps as one polyline."""
    runs = []
    with tempfile.TemporaryDirectory() as folder:
        for count in _POINTS:
            file = Path(folder) / "spiral.svg"
            file.write_text(_svg(_polyline(_spiral(count)), np.full(2, 2 * _SPIRAL_MM[1])))
            runs.append((count, 1, planned(file, settings)))
    return _rows("one spiral", runs)


def _rows(what: str, runs: Sequence[tuple[int, int, Cost]]) -> list[Row]:
    each_us = [1e6 * cost.processors_s / points for points, _, cost in runs]
    grows = each_us[-1] / each_us[0]
    most_mb = max(cost.peak_mb for *_, cost in runs)
    measured = "; ".join(
        f"{points} points, {n_strokes} strokes: {cost.wall_s:.1f} s, {us:.0f} µs of processors a point,"
        f" {cost.peak_mb:.0f} MB"
        for (points, n_strokes, cost), us in zip(runs, each_us, strict=True)
    )
    return [
        Row(
            f"{what}, up to a million points",
            f"linear: a point ≤ {_LINEAR} x that of a quarter; ≤ {_MOST_MB} MB",
            f"{measured}: {grows:.2f} x",
            grows <= _LINEAR and most_mb <= _MOST_MB,
        )
    ]


def _overlaid(strokes: Sequence[FloatArray], count: int) -> str:
    low = np.min([stroke.min(axis=0) for stroke in strokes], axis=0)
    size = np.max([stroke.max(axis=0) for stroke in strokes], axis=0) - low
    copy = "".join(_polyline(np.repeat(stroke - low, 1 + (len(stroke) == 1), axis=0)) for stroke in strokes)
    side = int(np.ceil(np.sqrt(count)))
    places = [(_SHIFT * size * divmod(index, side)).tolist() for index in range(count)]
    uses = "".join(f'<use href="#copy" x="{x:.4f}" y="{y:.4f}"/>' for x, y in places)
    return _svg(f'<defs><g id="copy">{copy}</g></defs>{uses}', size * (1 + _SHIFT * side))


def _spiral(count: int) -> FloatArray:
    share = np.sqrt(np.linspace(0.0, 1.0, count))
    inner, outer = _SPIRAL_MM
    radius, angle = inner + (outer - inner) * share, 2 * np.pi * _TURNS * share
    return outer + radius[:, None] * np.column_stack((np.cos(angle), np.sin(angle)))


def _polyline(points: FloatArray) -> str:
    return '<polyline points="' + " ".join(f"{x:.4f},{y:.4f}" for x, y in points.tolist()) + '"/>'


def _svg(body: str, size: FloatArray) -> str:
    width, height = size.tolist()
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm"'
        f' viewBox="0 0 {width} {height}" fill="none" stroke="black" stroke-linecap="round">{body}</svg>'
    )
