"""The options that say how a drawing is read."""

from __future__ import annotations

import argparse

from planner.cli.files import output_file
from planner.cli.line_options import add_image_options, image_of
from planner.cli.parser import Parser
from planner.cli.quantities import number
from planner.drawing.options import AS_A_BROWSER, CROP_MODES, MAX_DPI, MIN_DPI, TEXT_MODES, ReadingOptions


def add_reading_options(parser: Parser) -> None:
    """For every command that reads an SVG."""
    reading = parser.add_argument_group("reading")
    reading.add_argument(
        "--text",
        choices=TEXT_MODES,
        default=AS_A_BROWSER.text,
        help="text as single lines, as the outlines of a font, or left out (default: %(default)s)",
    )
    reading.add_argument(
        "--font", type=output_file, metavar="FILE", help="with --text outline: the font, not one that is installed"
    )
    reading.add_argument(
        "--crop",
        choices=CROP_MODES,
        default=AS_A_BROWSER.crop,
        help="cut off ink beyond the page, as a browser does, or draw it (default: %(default)s)",
    )
    reading.add_argument(
        "--occlude", action="store_true", help="leave out lines under opaque fills that are painted over them"
    )
    reading.add_argument(
        "--dpi",
        type=number(minimum=MIN_DPI, maximum=MAX_DPI),
        default=AS_A_BROWSER.dpi,
        metavar="N",
        help="pixels of the drawing that make an inch; old programs meant 72 or 90 (default: %(default)g)",
    )
    add_image_options(parser.add_argument_group("pictures"))


def reading_of(options: argparse.Namespace) -> ReadingOptions:
    """What options from `add_reading_options` amount to. Errors: UsageError."""
    return ReadingOptions(options.text, options.font, options.crop, options.occlude, options.dpi, image_of(options))
