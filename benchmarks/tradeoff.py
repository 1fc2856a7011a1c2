"""What the weights of method `path` buy: drawing time and expected drawn error against damped least squares, drawn.

python benchmarks/tradeoff.py DRAWING.svg -o docs/images/configurations_tradeoff.png
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.targets.configurations import LONGER_THAN_MM, figures
from benchmarks.targets.strokes import lines, placed_strokes, timed
from planner.arms.arm_file import load_arm
from planner.settings import ConfigurationWeights, Method, PlanSettings

SWEEP = (0.0, 0.3, 1.0, 3.0, 10.0)
"""Weights of sensitivity, time at 1."""
OTHERS = {"reversals alone": ConfigurationWeights(0, 0, 1, 0)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drawing", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--arms", nargs="+", default=["drawing_arm", "so101"])
    options = parser.parse_args()
    measured = {name: of_arm(name, options.drawing) for name in options.arms}
    draw(measured, options.output)


def of_arm(name: str, drawing: Path) -> dict[str, tuple[float, float]]:
    """Drawn error and time in per cent above damped least squares, by weights."""
    settings = PlanSettings(arm=name)
    arm = load_arm(name)
    strokes = lines(placed_strokes(drawing, arm, settings), LONGER_THAN_MM)

    def measured(one: PlanSettings) -> tuple[float, float]:
        return figures(arm, strokes, one).drawn_error, float(timed(arm, strokes, one).time_s.sum())

    dls = measured(replace(settings, method=Method.DLS))
    found = {}
    for label, weights in {f"{w:g}": ConfigurationWeights(sensitivity=w) for w in SWEEP}.items() | OTHERS.items():
        error, time = measured(replace(settings, weights=weights))
        found[label] = (100 * (error / dls[0] - 1), 100 * (time / dls[1] - 1))
        print(
            f"{name}, sensitivity {label}: drawn error {found[label][0]:+.1f} %, time {found[label][1]:+.1f} %",
            flush=True,
        )
    return found


def draw(measured: dict[str, dict[str, tuple[float, float]]], output: Path) -> None:
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    figure, columns = pyplot.subplots(
        1, len(measured), figsize=(5 * len(measured), 4.6), squeeze=False, layout="constrained"
    )
    for axes, (name, points) in zip(columns[0], measured.items(), strict=True):
        sweep = [points[f"{weight:g}"] for weight in SWEEP]
        axes.plot(*zip(*sweep, strict=True), "o-", color="#0072B2", markersize=4, label="sensitivity 0 to 10, time 1")
        for weight, point in zip(SWEEP, sweep, strict=True):
            axes.annotate(f"{weight:g}", point, xytext=(4, 4), textcoords="offset points", fontsize=8)
        axes.plot(*points["1"], "o", color="#0072B2", markersize=11, fillstyle="none", label="the default")
        for (label, _), marker in zip(OTHERS.items(), "^", strict=True):
            axes.plot(*points[label], marker, color="#D55E00", markersize=7, label=label)
        axes.plot(0, 0, "X", color="black", markersize=9, label="damped least squares (DLS)")
        axes.axhline(0, color="0.6", linestyle=":")
        axes.axvline(0, color="0.6", linestyle=":", label="as good as DLS: left of and below these")
        axes.set_title(name)
        axes.set_xlabel("expected drawn error against DLS, %")
        axes.set_ylabel("drawing time against DLS, %")
        axes.grid(color="0.92")
    handles, labels = columns[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    figure.savefig(output, dpi=120)


if __name__ == "__main__":
    main()
