"""Which lines of a drawing the header of a trajectory tells to have been chosen."""

from __future__ import annotations

from collections.abc import Callable

from planner.affine import scale_of
from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.pen_groups import kind_of, wanted_layers
from planner.head import Chosen


def told_by(chosen: Chosen, drawing: Drawing, affine: FloatArray) -> Callable[[Outline], bool]:
    """Whether a line is one of them. affine: (2, 3), where the drawing is put. Errors: UsageError for a layer that is
    not there."""
    layers = wanted_layers(drawing, chosen.layers)
    by, kinds = chosen.by, chosen.kinds
    mm_per_unit = scale_of(affine)

    def is_chosen(line: Outline) -> bool:
        return line.layer in layers and (by is None or kind_of(line, by, mm_per_unit) in kinds)

    return is_chosen
