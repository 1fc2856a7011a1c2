"""The picture of a comparison, by what was compared: single targets, a drawing, or random targets."""

from __future__ import annotations

from matplotlib.figure import Figure

from planner.comparison.compare import Comparison
from planner.comparison.targets import TargetKind
from planner.plots.comparison_distributions import plot_distributions
from planner.plots.comparison_drawing import plot_along_drawing
from planner.plots.comparison_single import plot_single
from planner.plots.look import USUAL, Look


def plot_comparison(comparison: Comparison, look: Look = USUAL) -> Figure:
    """Errors: UsageError where not one method has found anything to show."""
    plot = {
        TargetKind.SINGLE: plot_single,
        TargetKind.DRAWING: plot_along_drawing,
        TargetKind.RANDOM: plot_distributions,
    }[comparison.targets.kind]
    return plot(comparison, look)
