"""The options that say where a drawing goes."""

from __future__ import annotations

import argparse

from planner.cli.quantities import angle_deg, coordinate_mm, grid, length_mm, paper, scale
from planner.paper_size import Orientation
from planner.settings import Anchor, CanvasKind, PlaceKind, PlanSettings


def add_placement_options(placement: argparse._ArgumentGroup) -> None:
    """The options that say where a drawing goes."""
    default = PlanSettings()
    anchors = [anchor.value for anchor in Anchor]
    placement.add_argument(
        "--canvas",
        choices=[kind.value for kind in CanvasKind],
        default=default.canvas.value,
        help="the rectangle of the paper to draw on (default: %(default)s)",
    )
    placement.add_argument(
        "--place",
        choices=[kind.value for kind in PlaceKind],
        default=default.place.value,
        help="what is placed: the drawing's page, ink wherever it is on it, so that drawings of one page land in"
        " register; or the extent of its ink, as for drawings without a page; best also turns and moves it, at the same"
        " size, to where it is drawn soonest and most accurately (default: %(default)s)",
    )
    placement.add_argument(
        "--fit",
        action=argparse.BooleanOptionalAction,
        default=default.fit,
        help="scale it to the room that there is, or keep its true size (default: --fit)",
    )
    placement.add_argument("--scale", type=scale, metavar="F", help="scale its true size by so much: 0.5, 50%%")
    placement.add_argument(
        "--paper",
        type=paper,
        metavar="SIZE",
        help="the sheet, amid the canvas: a0 to a10, letter, legal, 100x150, 4x6in",
    )
    placement.add_argument(
        "--orientation",
        choices=[kind.value for kind in Orientation],
        default=default.orientation.value,
        help="which way the paper lies (default: as the drawing)",
    )
    placement.add_argument(
        "--align",
        choices=anchors,
        default=default.align.value,
        metavar="WHERE",
        help=f"where it goes in what room there is: {', '.join(anchors)} (default: %(default)s)",
    )
    placement.add_argument(
        "--at",
        type=coordinate_mm,
        nargs=2,
        metavar=("X", "Y"),
        help="where it goes at its true size instead: to the right and down from the paper's top left corner",
    )
    placement.add_argument(
        "--origin",
        choices=anchors,
        default=default.origin.value,
        metavar="WHERE",
        help="which point of it goes to --at (default: %(default)s)",
    )
    placement.add_argument(
        "--copies",
        type=grid,
        default=default.copies,
        metavar="NxM",
        help="columns and rows of copies, a margin between",
    )
    placement.add_argument(
        "--margin",
        type=length_mm(zero=True),
        default=default.margin_mm,
        metavar="LENGTH",
        help="kept free along the edges of canvas and paper (default: %(default)g mm)",
    )
    placement.add_argument(
        "--rotate",
        type=angle_deg,
        default=default.rotate_deg,
        metavar="DEGREES",
        help="turn the drawing before placing it (default: %(default)g)",
    )
    placement.add_argument("--mirror", action="store_true", help="exchange left and right before turning it")
    placement.add_argument(
        "--skip-unreachable",
        action="store_true",
        help="leave out what the arm cannot reach, and say so, instead of failing",
    )
