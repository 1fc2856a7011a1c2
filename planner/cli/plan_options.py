"""The options that say how drawings are planned, and the settings that they amount to."""

from __future__ import annotations

import argparse
from pathlib import Path

from planner.cli.line_options import add_fill_options, add_path_options, add_pen_options, fill_of
from planner.cli.parser import Parser
from planner.cli.placement_options import add_placement_options
from planner.cli.preferences import preferences_for, with_preferences
from planner.cli.quantities import configuration_weights, length_mm, number, speed_mm_s
from planner.cli.reading import add_reading_options, reading_of
from planner.cli.workers import add_workers_option
from planner.paper_size import Orientation
from planner.pens import GroupBy
from planner.settings import (
    MAX_RATE_HZ,
    MIN_RATE_HZ,
    MIN_TOLERANCE_MM,
    Anchor,
    CanvasKind,
    Method,
    PlaceKind,
    PlanSettings,
    Timing,
)


def add_plan_options(parser: Parser) -> None:
    """The options that say how drawings are planned, whether one or many."""
    add_workers_option(parser)
    parser.add_argument("--preset", metavar="NAME", help="options by a name of yours (see plan config --help)")
    parser.add_argument("--quiet", action="store_true", help="no progress and no summary, only warnings and errors")
    parser.add_argument(
        "--method",
        choices=[method.value for method in Method],
        default=PlanSettings().method.value,
        help="how configurations are found (default: %(default)s)",
    )
    add_arm_and_placement_options(parser)


def add_arm_and_placement_options(parser: Parser) -> None:
    """The options that have a meaning whatever method finds the configurations."""
    default = PlanSettings()
    parser.add_argument(
        "--arm",
        default=default.arm,
        metavar="NAME|FILE",
        help="an arm by name, or its .toml file (default: %(default)s)",
    )
    parser.add_argument(
        "--no-cache",
        dest="cache",
        action="store_false",
        help="compute what is known of the arm anew, and keep nothing (PLAN_CACHE names the folder, or says off)",
    )
    motion = parser.add_argument_group("motion")
    motion.add_argument(
        "--weights",
        type=configuration_weights,
        default=default.weights,
        metavar="NAME=W,...",
        help="what method path spends spare joints on: time, sensitivity (of the drawing to joints that run late or"
        " stand wrong), reversals (of joints), limits (distance from them); those not named weigh 1, reversals 0",
    )
    motion.add_argument(
        "--timing",
        choices=[timing.value for timing in Timing],
        default=default.timing.value,
        help="optimal: the least time along a smooth path within the tolerance; ruckig: from one pen target to the next"
        " in joint space by Ruckig, all joints at once, at rest in each (default: %(default)s)",
    )
    motion.add_argument(
        "--rate",
        type=number(minimum=MIN_RATE_HZ, maximum=MAX_RATE_HZ),
        metavar="HZ",
        help="samples a second (default: one for each set point that the arm's servos take, or else"
        f" {default.rate_hz:g})",
    )
    motion.add_argument(
        "--tolerance",
        type=length_mm(minimum_mm=MIN_TOLERANCE_MM),
        metavar="LENGTH",
        help=f"how far the pen may be off the drawing (default: {default.tolerance_mm:g} mm, or half the expected error"
        " of a calibrated arm)",
    )
    motion.add_argument(
        "--speed",
        type=speed_mm_s,
        default=default.speed_mm_s,
        metavar="SPEED",
        help="fastest motion of the pen on the paper (default: the arm's own)",
    )
    motion.add_argument(
        "--lift",
        type=length_mm(),
        default=default.lift_mm,
        metavar="LENGTH",
        help="height of the pen while travelling (default: the arm's own)",
    )
    motion.add_argument(
        "--lowering-speed",
        type=speed_mm_s,
        default=default.lowering_speed_mm_s,
        metavar="SPEED",
        help="fastest lowering of the pen (default: %(default)g mm/s)",
    )
    motion.add_argument(
        "--dwell",
        type=number(zero=True),
        default=default.dwell_s,
        metavar="SECONDS",
        help="rest on the paper after lowering (default: %(default)g s)",
    )

    add_reading_options(parser)
    add_placement_options(parser.add_argument_group("placement"))
    add_pen_options(parser.add_argument_group("layers and pens"))
    add_path_options(parser.add_argument_group("lines"))
    add_fill_options(parser.add_argument_group("fills"))


def settings_of(options: argparse.Namespace) -> PlanSettings:
    """The settings that options from `add_plan_options` amount to. Errors: UnknownArm, ArmFileError."""
    rate_hz, tolerance_mm = options.rate, options.tolerance
    if rate_hz is None or tolerance_mm is None:
        from planner.arms.arm_file import load_arm
        from planner.arms.usual_settings import usual_rate_hz, usual_tolerance_mm

        arm = load_arm(options.arm, cache=options.cache)
        rate_hz = usual_rate_hz(arm) if rate_hz is None else rate_hz
        tolerance_mm = usual_tolerance_mm(arm) if tolerance_mm is None else tolerance_mm
    return PlanSettings(
        arm=options.arm,
        method=Method(options.method),
        rate_hz=rate_hz,
        tolerance_mm=tolerance_mm,
        timing=Timing(options.timing),
        speed_mm_s=options.speed,
        lowering_speed_mm_s=options.lowering_speed,
        dwell_s=options.dwell,
        lift_mm=options.lift,
        canvas=CanvasKind(options.canvas),
        place=PlaceKind(options.place),
        fit=options.fit,
        scale=options.scale,
        paper=options.paper,
        orientation=Orientation(options.orientation),
        align=Anchor(options.align),
        at_mm=tuple(options.at) if options.at else None,
        origin=Anchor(options.origin),
        copies=options.copies,
        mirror=options.mirror,
        margin_mm=options.margin,
        rotate_deg=options.rotate,
        join_mm=options.join,
        dedup_mm=options.dedup or 0.0,
        simplify_mm=options.simplify,
        min_length_mm=options.min_length,
        passes=options.passes,
        keep_order=options.keep_order,
        reverse=options.reverse,
        fill=fill_of(options),
        layers=options.layers,
        by=None if options.by is None else GroupBy(options.by),
        pens=options.pens,
        skip_unreachable=options.skip_unreachable,
        weights=options.weights,
        reading=reading_of(options),
        cache=options.cache,
    )


def preferred(parser: Parser, arguments: list[str]) -> argparse.Namespace:
    """The options, with what people prefer where `arguments` say nothing. Errors: UsageError."""
    said = parser.parse_args(arguments)
    place: Path = said.drawing if "drawing" in said else said.folder
    return with_preferences(parser, arguments, preferences_for(place), said.preset)[0]
