"""Which pen draws what: outlines by layer, colour or width, and the pens in the order in which they come."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from planner.counted import counted
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.layer_name import LayerName
from planner.errors import UsageError
from planner.pens import Colour, GroupBy, Pen, colour_of, hex_of

PLAIN = Pen("pen")
"""The pen of a plan in which nobody speaks of pens."""


@dataclass(frozen=True, eq=False, slots=True)
class PenGroup:
    """outlines: what a pen draws, document order. kinds: the layers, colours or widths of that. halts: whether somebody
    is asked for the pen before. speed_share: of the speed that it would have. delay_s: rest before it."""

    pen: Pen
    outlines: tuple[Outline, ...]
    kinds: tuple[str, ...] = ()
    halts: bool = True
    speed_share: float = 1.0
    delay_s: float = 0.0

    @property
    def is_named(self) -> bool:
        """Whether somebody speaks of pens."""
        return self.pen is not PLAIN


def chosen_layers(drawing: Drawing, layers: Sequence[str] | None) -> Drawing:
    """The drawing with the layers that are wanted: by name, or by the number that their names begin with. Layers whose
    names begin with `%` are left out unless they are named. Errors: UsageError for one that is not there."""
    names = layer_names(drawing)
    wanted = wanted_layers(drawing, layers)
    if len(wanted) == len(names):
        return drawing
    skipped = dict(drawing.skipped)
    if layers is None:
        left = [name for name in names if name not in wanted]
        skipped["layer that is not to be plotted (%)"] = len(left)
    outlines = tuple(outline for outline in drawing.outlines if outline.layer in wanted)
    if not outlines:
        raise UsageError(f"{drawing.source} has nothing in {counted(len(wanted), 'chosen layer')}")
    return replace(drawing, outlines=outlines, skipped=skipped, scene=None)


def wanted_layers(drawing: Drawing, layers: Sequence[str] | None) -> set[str]:
    """The names of those. Errors: UsageError for one that is not there."""
    names = layer_names(drawing)
    if layers is None:
        return {name for name in names if LayerName.of(name).is_drawn}
    wanted: set[str] = set()
    for layer in layers:
        found = (
            {name for name in names if layer == name}
            or {name for name in names if layer == on_one_line(name)}
            or {name for name in names if layer.isdecimal() and LayerName.of(name).number == int(layer[:9])}
        )
        if not found:
            there = ", ".join(on_one_line(name) or "(no layer)" for name in names)
            raise UsageError(f"{drawing.source} has no layer '{layer:.40}'; it has {there}")
        wanted |= found
    return wanted


def on_one_line(name: str) -> str:
    """A name as people see it, and may say it: with single spaces, whatever stands between its words."""
    return " ".join(name.split())


def layer_names(drawing: Drawing) -> list[str]:
    """In document order."""
    return list(dict.fromkeys(outline.layer for outline in drawing.outlines))


def only(drawing: Drawing, by: GroupBy, kinds: Sequence[str], mm_per_unit: float) -> Drawing:
    """The drawing with what is of one of these layers, colours or widths. Errors: UsageError where nothing is."""
    outlines = tuple(outline for outline in drawing.outlines if kind_of(outline, by, mm_per_unit) in kinds)
    if not outlines:
        raise UsageError(f"{drawing.source} has nothing of {by} {', '.join(kinds)}")
    return replace(drawing, outlines=outlines, scene=None)


def kind_of(outline: Outline, by: GroupBy, mm_per_unit: float) -> str:
    """Its layer; its colour as #rrggbb; its width on paper in mm, to a hundredth."""
    if by is GroupBy.LAYER:
        return outline.layer
    return hex_of(outline.colour) if by is GroupBy.COLOUR else f"{outline.width * mm_per_unit:.2f}"


def pen_groups(drawing: Drawing, by: GroupBy | None, pens: Sequence[Pen], mm_per_unit: float) -> list[PenGroup]:
    """What each pen draws; one pen all of it where `by` is None. mm_per_unit: what a unit of width becomes on paper.

    With pens, a layer goes to the pen that names it, a colour or a width to the nearest; without, each has a pen of its
    own. Errors: UsageError where a layer has no pen.
    """
    if by is None:
        return [PenGroup(PLAIN, drawing.outlines)]
    kinds: dict[str, list[Outline]] = {}
    for outline in drawing.outlines:
        kinds.setdefault(kind_of(outline, by, mm_per_unit), []).append(outline)
    if by is GroupBy.LAYER:
        return _of_layers(kinds, pens)
    if not pens:
        return [PenGroup(_pen_of(kind, by), tuple(outlines), (kind,)) for kind, outlines in kinds.items()]
    nearest = {kind: _nearest(pens, outlines[0], mm_per_unit, by) for kind, outlines in kinds.items()}
    groups = []
    for pen in pens:
        own = tuple(kind for kind in kinds if nearest[kind] is pen)
        if own:
            groups.append(PenGroup(pen, tuple(chain.from_iterable(kinds[kind] for kind in own)), own))
    return groups


def _of_layers(layers: Mapping[str, Sequence[Outline]], pens: Sequence[Pen]) -> list[PenGroup]:
    """Layer after layer; neighbours that one pen draws alike are one group."""
    groups: list[PenGroup] = []
    for name, outlines in layers.items():
        told = LayerName.of(name)
        pen = next((pen for pen in pens if name == pen.name or name in pen.layers), None)
        if pen is None and pens:
            known = ", ".join(pen.name for pen in pens)
            raise UsageError(
                f"no pen draws layer '{name:.40}'; name it in the layers of one of {known}, or leave it out by --layers"
            )
        pen = pen or Pen(on_one_line(name) or "no layer", outlines[0].colour)
        last = groups[-1] if groups else None
        halts = last is None or last.pen != pen or told.halts
        if last is not None and not halts and (last.speed_share, 0.0) == (told.speed_share, told.delay_s):
            groups[-1] = replace(last, outlines=(*last.outlines, *outlines), kinds=(*last.kinds, name))
        else:
            groups.append(PenGroup(pen, tuple(outlines), (name,), halts, told.speed_share, told.delay_s))
    return groups


def _pen_of(kind: str, by: GroupBy) -> Pen:
    return Pen(kind, colour_of(kind)) if by is GroupBy.COLOUR else Pen(f"{kind} mm wide", width_mm=float(kind))


def _nearest(pens: Sequence[Pen], outline: Outline, mm_per_unit: float, by: GroupBy) -> Pen:
    if by is GroupBy.WIDTH:
        return min(pens, key=lambda pen: abs(pen.width_mm - outline.width * mm_per_unit))
    return min(pens, key=lambda pen: _unlikeness(pen.colour, outline.colour))


def _unlikeness(one: Colour, other: Colour) -> float:
    """How unlike two colours are, as the eye weighs the channels (Riemersma's low-cost distance)."""
    red, green, blue = np.subtract(one, other).tolist()
    mean = (one[0] + other[0]) / 2.0
    return float((2.0 + mean / 256.0) * red**2 + 4.0 * green**2 + (2.0 + (255.0 - mean) / 256.0) * blue**2)


def described(drawing: Drawing, length_mm: Callable[[Sequence[Outline]], float]) -> list[str]:
    """A line for each layer: name, number of lines and taps, their length on the page, colours."""
    lines = []
    for name in layer_names(drawing):
        outlines = [outline for outline in drawing.outlines if outline.layer == name]
        colours = dict.fromkeys(hex_of(outline.colour) for outline in outlines)
        shown = ", ".join(list(colours)[:6]) + (" ..." if len(colours) > 6 else "")
        told = on_one_line(name) or "(no layer)"
        lines.append(f"{told}: {counted(len(outlines), 'line')}, {length_mm(outlines):.0f} mm, {shown}")
    return lines
