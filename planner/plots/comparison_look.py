"""How the methods of a comparison are told apart, the same in all of its pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from matplotlib.lines import Line2D

from planner.comparison.compare import Comparison, MethodResult
from planner.comparison.measured import Measured
from planner.errors import UsageError

# More of the palette of Okabe and Ito; vermilion is left to the limits.
_BLUE, _SKY, _GREEN, _PURPLE, _ORANGE = "#0072B2", "#56B4E9", "#009E73", "#CC79A7", "#E69F00"


@dataclass(frozen=True, slots=True)
class Line:
    """The wider, the further below the others: where methods agree, all of them show."""

    colour: str
    width: float
    dashes: Literal["-"] | tuple[float, tuple[float, ...]] = "-"

    @property
    def zorder(self) -> float:
        return 4.0 - 0.5 * self.width


_LINES = {
    "dls": Line(_ORANGE, 0.9),
    "dls-drawing": Line(_PURPLE, 1.2, (0, (6, 2))),
    "nlp": Line(_GREEN, 1.5, (0, (3, 1.5))),
    "closed-form": Line(_SKY, 1.9, (0, (6, 2, 1, 2))),
    "path": Line(_BLUE, 2.6),
}


def line_of(result: MethodResult) -> Line:
    return _LINES[result.method.name]


def shown(comparison: Comparison) -> list[tuple[MethodResult, Measured]]:
    """The methods that solve at least one target. Errors: UsageError where none does."""
    able = [
        (result, result.measured)
        for result in comparison.results
        if result.measured is not None and result.measured.solved.any()
    ]
    if not able:
        raise UsageError("no method has solved a target, so there is nothing to draw")
    return able


def method_handles(results: list[MethodResult]) -> list[Line2D]:
    """What the legend says of the methods."""
    return [
        Line2D(
            [],
            [],
            color=line_of(result).colour,
            linestyle=line_of(result).dashes,
            linewidth=line_of(result).width,
            label=result.method.title,
        )
        for result in results
    ]
