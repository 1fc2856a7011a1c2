"""The command as whole processes, imports and all: a small drawing anew, a folder of icons, one drawing end to end."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from benchmarks.targets.family import planned, spent
from benchmarks.targets.row import Row
from planner.settings import PlanSettings

_RUNS = 5
_ICONS = 200
_SMALL_BYTES = 500


def small_again(settings: PlanSettings) -> list[Row]:
    """A drawing of as many bytes, planned once, and then a few times more."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "small.svg"
        file.write_text(_icon(0).ljust(_SMALL_BYTES))
        first = planned(file, settings)
        again = sorted(planned(file, settings).wall_s for _ in range(_RUNS))
    return [
        Row(
            f"a drawing of {_SMALL_BYTES} bytes again, whole process",
            "≤ 0.45 s",
            f"median {again[_RUNS // 2]:.2f} s of {_RUNS}, best {again[0]:.2f}; the first plan {first.wall_s:.2f} s",
            again[_RUNS // 2] <= 0.45,
        )
    ]


def icons(settings: PlanSettings) -> list[Row]:
    with tempfile.TemporaryDirectory() as folder:
        for number in range(_ICONS):
            (Path(folder) / f"icon{number:03}.svg").write_text(_icon(number))
        cost = spent("batch", folder, "--quiet", "--arm", settings.arm)
    return [
        Row(
            f"{_ICONS} icons by `plan batch FOLDER`",
            "≤ 15 s",
            f"{cost.wall_s:.1f} s ({cost.processors_s:.1f} s of processors), {cost.peak_mb:.0f} MB",
            cost.wall_s <= 15,
        )
    ]


def end_to_end(drawing: Path, settings: PlanSettings) -> list[Row]:
    cost = planned(drawing, settings)
    return [
        Row(
            f"{drawing.name} end to end",
            "≤ 4 s, ≤ 300 MB",
            f"{cost.wall_s:.1f} s ({cost.processors_s:.1f} s of processors), {cost.peak_mb:.0f} MB",
            cost.wall_s <= 4 and cost.peak_mb <= 300,
        )
    ]


def _icon(number: int) -> str:
    """An icon of 24 pixels: a few arcs, lines, a rounded rectangle and a dot, each icon another."""
    random = np.random.default_rng(number)
    (x, y), (u, v), r = random.uniform(5, 19, 2).round(1), random.uniform(3, 21, 2).round(1), random.uniform(2, 5)
    w, h = random.uniform(6, 16, 2).round(1)
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" width="24" height="24" viewBox="0 0 24 24" fill="none"'
        ' stroke="black" stroke-width="2" stroke-linecap="round" stroke-linejoin="round">'
        f'<circle cx="{x}" cy="{y}" r="{r:.1f}"/><path d="M{u} {v}a{r:.1f} {r:.1f} 0 0 1 {x - u:.1f} {y - v:.1f}"/>'
        f'<rect x="{24 - w:.1f}" y="2" width="{w - 2:.1f}" height="{h:.1f}" rx="2"/><path d="m{v} {u} 2 2 4-4"/>'
        '<path d="M12 17h.01"/></svg>'
    )
