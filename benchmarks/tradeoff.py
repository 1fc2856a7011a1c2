"""What the weights of method `path` buy: time, sensitivity and reversals against damped least squares, as a figure.

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

SWEEP = (0.0, 0.3, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0, 4.0)
"""Weights of sensitivity, the others at 1."""
ALONE = {
    "time alone": ConfigurationWeights(1, 0, 0, 0),
    "sensitivity alone": ConfigurationWeights(0, 1, 0, 0),
    "reversals alone": ConfigurationWeights(0, 0, 1, 0),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drawing", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--arm", default=PlanSettings().arm)
    options = parser.parse_args()
    settings = PlanSettings(arm=options.arm)
    arm = load_arm(settings.arm)
    strokes = lines(placed_strokes(options.drawing, arm, settings), LONGER_THAN_MM)

    def measured(one: PlanSettings) -> tuple[float, int, float]:
        found = figures(arm, strokes, one)
        return found.sensitivity_mm_rad, found.reversals, float(timed(arm, strokes, one).time_s.sum())

    dls = measured(replace(settings, method=Method.DLS))

    def against_dls(weights: ConfigurationWeights) -> tuple[float, ...]:
        """Sensitivity, reversals and time in per cent above damped least squares."""
        return tuple(
            100 * (ours / theirs - 1)
            for ours, theirs in zip(measured(replace(settings, weights=weights)), dls, strict=True)
        )

    sweep = [against_dls(ConfigurationWeights(sensitivity=weight)) for weight in SWEEP]
    alone = {name: against_dls(weights) for name, weights in ALONE.items()}
    for name, point in [*zip(map("sensitivity {:g}".format, SWEEP), sweep, strict=True), *alone.items()]:
        print(f"{name}: sensitivity {point[0]:+.1f} %, reversals {point[1]:+.1f} %, time {point[2]:+.1f} %")
    draw(sweep, alone, options.output)


def draw(sweep: list[tuple[float, ...]], alone: dict[str, tuple[float, ...]], output: Path) -> None:
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 4.8), sharex=True, layout="constrained")
    for axes, row, name, target in ((left, 1, "joint reversals", -20.0), (right, 2, "drawing time", 0.0)):
        axes.plot(
            *[[point[column] for point in sweep] for column in (0, row)],
            "o-",
            color="#0072B2",
            markersize=4,
            label="field, weight of sensitivity 0 to 4",
        )
        default = sweep[SWEEP.index(1.0)]
        axes.plot(
            default[0],
            default[row],
            "o",
            color="#0072B2",
            markersize=11,
            fillstyle="none",
            label="field, default weights",
        )
        for (label, point), marker in zip(alone.items(), "sD^", strict=True):
            axes.plot(point[0], point[row], marker, color="#D55E00", markersize=7, label=f"field, {label}")
        axes.plot(0, 0, "X", color="black", markersize=9, label="damped least squares (DLS)")
        axes.axvline(-7.0, color="0.6", linestyle=":")
        axes.axhline(target, color="0.6", linestyle=":", label="targets: left of and below the dotted lines")
        axes.set_xlabel("tip sensitivity across the paper against DLS, %")
        axes.set_ylabel(f"{name} against DLS, %")
        axes.grid(color="0.92")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    figure.savefig(output, dpi=120)


if __name__ == "__main__":
    main()
