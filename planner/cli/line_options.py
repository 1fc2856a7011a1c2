"""The options that say which lines are drawn, with which pens, and what fills areas."""

from __future__ import annotations

import argparse

from planner.cli.quantities import angle_deg, length_mm, names, pens_file, scale, whole_number
from planner.drawing.fill_options import (
    LEAST_SPACING_MM,
    USUAL_SPACING_MM,
    FillBy,
    FillKind,
    FillOptions,
    WideStrokes,
)
from planner.drawing.image_options import ImageOptions, ImageStyle
from planner.pens import GroupBy
from planner.settings import PlanSettings

USUAL_DEDUP_MM = 0.05


def add_pen_options(pens: argparse._ArgumentGroup) -> None:
    """The options that say which layers are drawn, and with which pens."""
    pens.add_argument(
        "--layers",
        type=names,
        metavar="NAME,...",
        help="draw these layers alone, by name or by the number that their names begin with (default: all but those"
        " whose names begin with %%)",
    )
    pens.add_argument(
        "--by",
        choices=[by.value for by in GroupBy],
        help="a pen for each layer, colour or width; between two the arm parks, and you are asked for the next",
    )
    pens.add_argument(
        "--pens",
        type=pens_file,
        default=(),
        metavar="FILE",
        help="the pens that there are: tables [[pen]] with name, colour, width_mm, speed_mm_s, lift_mm,"
        " lowering_speed_mm_s, height_mm (how much further its tip sticks out), layers; each draws the layers it"
        " names, or the colours or widths nearest to it",
    )


def add_path_options(lines: argparse._ArgumentGroup) -> None:
    """The options that say what is done to lines before they are drawn."""
    default = PlanSettings()
    lines.add_argument(
        "--join",
        type=length_mm(zero=True),
        metavar="LENGTH",
        help="join ends that are nearer (default: twice the tolerance)",
    )
    lines.add_argument(
        "--dedup",
        type=length_mm(zero=True),
        nargs="?",
        const=USUAL_DEDUP_MM,
        metavar="LENGTH",
        help=f"draw one of lines that run within so much of each other (without a length: {USUAL_DEDUP_MM:g} mm)",
    )
    lines.add_argument(
        "--simplify",
        type=length_mm(zero=True),
        default=default.simplify_mm,
        metavar="LENGTH",
        help="drop points that change a line by less, beside the tolerance",
    )
    lines.add_argument(
        "--min-length",
        type=length_mm(zero=True),
        default=default.min_length_mm,
        metavar="LENGTH",
        help="leave out strokes that are shorter, taps aside",
    )
    lines.add_argument(
        "--passes", type=whole_number, default=default.passes, metavar="N", help="draw each line so often, pen down"
    )
    lines.add_argument("--keep-order", action="store_true", help="draw in the order of the drawing, nothing joined")
    lines.add_argument("--reverse", action="store_true", help="draw in the opposite order, each line backwards")


def add_fill_options(fills: argparse._ArgumentGroup) -> None:
    """The options that say how areas are filled."""
    default = PlanSettings().fill
    fills.add_argument(
        "--fill",
        choices=[kind.value for kind in FillKind],
        default=default.kind.value,
        help="lines across areas that the drawing fills (default: their edges alone)",
    )
    fills.add_argument(
        "--fill-angle", type=angle_deg, default=default.angle_deg, metavar="DEGREES", help="(default: %(default)g)"
    )
    fills.add_argument(
        "--fill-spacing",
        type=length_mm(minimum_mm=LEAST_SPACING_MM),
        metavar="LENGTH",
        help=f"between lines (default: the width of the finest of --pens, or {USUAL_SPACING_MM:g} mm)",
    )
    fills.add_argument(
        "--fill-inset", type=length_mm(zero=True), metavar="LENGTH", help="from the edge (default: half the spacing)"
    )
    fills.add_argument(
        "--fill-by",
        choices=[by.value for by in FillBy],
        default=default.by.value,
        help="lightness: darker is denser; colour: each has an angle of its own (default: all are alike)",
    )
    fills.add_argument(
        "--stroke-width",
        choices=[how.value for how in WideStrokes],
        default=default.wide_strokes.value,
        help="strokes wider than the pen's line (the spacing) are drawn once, or in passes side by side"
        " (default: %(default)s)",
    )


def add_image_options(images: argparse._ArgumentGroup) -> None:
    """The options that say how pictures of pixels become lines."""
    default = ImageOptions()
    images.add_argument(
        "--image",
        choices=[style.value for style in ImageStyle],
        default=default.style.value,
        help="pictures as the outlines of what is dark, as the middle of drawn lines, or as tones: by parallel lines,"
        " by one line that never lifts, by dots (default: those in an SVG are left out, and one that is the drawing"
        " itself is hatched)",
    )
    images.add_argument(
        "--image-line",
        type=length_mm(minimum_mm=LEAST_SPACING_MM),
        metavar="LENGTH",
        help=f"width of the pen's line (default: that of the finest of --pens, or {USUAL_SPACING_MM:g} mm)",
    )
    images.add_argument(
        "--image-detail",
        type=length_mm(minimum_mm=LEAST_SPACING_MM),
        metavar="LENGTH",
        help="the finest that is drawn (default: the width of the line)",
    )
    images.add_argument(
        "--image-ink",
        type=scale,
        default=default.ink,
        metavar="SHARE",
        help="how much of the paper hatch, scribble and stipple cover where the picture is black (default: 100%%)",
    )
    images.add_argument(
        "--image-levels",
        type=whole_number,
        default=default.levels,
        metavar="N",
        help="tones of which trace draws the outlines (default: %(default)s)",
    )
    images.add_argument(
        "--image-angle", type=angle_deg, default=default.angle_deg, metavar="DEGREES", help="(default: %(default)g)"
    )


def image_of(options: argparse.Namespace) -> ImageOptions:
    """How pictures are drawn, by options from `add_image_options`. Errors: UsageError."""
    return ImageOptions(
        ImageStyle(options.image),
        _usual_line_mm(options) if options.image_line is None else options.image_line,
        options.image_detail,
        options.image_levels,
        options.image_angle,
        options.image_ink,
    )


def fill_of(options: argparse.Namespace) -> FillOptions:
    """The fill that options from `add_fill_options` amount to."""
    return FillOptions(
        FillKind(options.fill),
        options.fill_angle,
        _usual_line_mm(options) if options.fill_spacing is None else options.fill_spacing,
        options.fill_inset,
        FillBy(options.fill_by),
        WideStrokes(options.stroke_width),
    )


def _usual_line_mm(options: argparse.Namespace) -> float:
    """The width of the finest of the pens, where there are any."""
    widths_mm = [pen.width_mm for pen in getattr(options, "pens", ()) if pen.width_mm]
    return max(min(widths_mm, default=USUAL_SPACING_MM), LEAST_SPACING_MM)
