"""`plan compare`: the same targets by every method of inverse kinematics."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, cast

from planner.cli.files import input_file, output_file
from planner.cli.interrupts import interrupts_remembered
from planner.cli.joints import all_joints
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.plan_options import add_arm_and_placement_options, settings_of
from planner.cli.quantities import angle_deg, coordinate_mm
from planner.cli.terminal import print_summary, print_warnings, progress
from planner.errors import UsageError
from planner.files import is_standard_output
from planner.settings import PlanSettings

if TYPE_CHECKING:
    from planner.arms.arm import Arm
    from planner.arrays import FloatArray
    from planner.comparison.compare import Comparison
    from planner.comparison.targets import Targets
    from planner.redundancy.arm_model import ArmModel

_DESCRIPTION = """\
Compare the methods of inverse kinematics on the same targets: the documented damped least squares (dls), the same
with tolerances fit for drawing (dls-drawing), a nonlinear program for each target (nlp), the closed form
(closed-form), and the configurations that drawings are planned with (path). The targets are single points, points drawn
at random, or a drawing placed as plan places it. Of single targets the documented iterations are shown one by one."""

_EPILOG = """\
examples:
  plan compare --target 53 47.8 0                  the worked example of the drawing arm's documents
  plan compare --target 53 47.8 --target 80 0 --arm scara
  plan compare --target 53 47.8 --start 0 60 -40 -50 --json -
  plan compare --random 1000 --seed 7 --arm six_joint --plot six_joint.png
  plan compare flower.svg --margin 1cm --json flower.json --plot flower.pdf

In the table n/a says that a figure means nothing there: the closed form does not iterate, single targets have no
neighbours.

exit codes: 0 compared, whatever methods failed; 2 unusable input or usage; 3 out of reach"""

_MOST_TARGETS = 1_000_000
_COUPLED = 1e-4
"""Degrees by which a configuration may miss its coupling."""


def compare(arguments: list[str]) -> int:
    """Compare all methods. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    settings = settings_of(options)
    _check(options, settings)

    from planner.arms.arm_file import load_arm
    from planner.comparison.compare import compare as compare_methods
    from planner.comparison.compare import default_start
    from planner.redundancy.arm_model import ArmModel

    model = ArmModel(load_arm(settings.arm))
    targets, warnings = _targets(options, model, settings)
    start = _start(model.arm, options.start) if options.start else default_start(model, targets.kind)
    with progress(quiet=options.quiet) as show, interrupts_remembered() as raise_if_interrupted:

        def report(stage: str, done: int, total: int) -> None:
            raise_if_interrupted()
            show(stage, done, total)

        comparison = compare_methods(model, targets, start, settings, report)
    print_warnings(warnings)
    _print(comparison, options.json, options.plot)
    if options.plot is not None:
        from planner.plots.comparison import plot_comparison
        from planner.plots.figure_file import save_figure

        save_figure(plot_comparison(comparison), options.plot)
    return 0


def _targets(options: argparse.Namespace, model: ArmModel, settings: PlanSettings) -> tuple[Targets, list[str]]:
    import numpy as np

    from planner.comparison.targets import random_targets, single_targets, targets_along
    from planner.pipeline import placed_strokes

    if options.target:
        return single_targets(np.array([(*place, 0.0)[:3] for place in options.target])), []
    if options.random is not None:
        return random_targets(model.kinematics, options.random, options.seed or 0), []
    strokes, warnings = placed_strokes(options.drawing, model, settings)
    return targets_along(strokes), warnings


def _start(arm: Arm, positions: Sequence[float]) -> FloatArray:
    """Errors: UsageError for a configuration that breaks a coupling: no method would begin there."""
    start = all_joints(arm, positions, "--start")
    coupled = arm.complete(arm.independent_of(start))
    for joint, value, wanted in zip(arm.joints, start.tolist(), coupled.tolist(), strict=True):
        if abs(value - wanted) > _COUPLED * joint.per_file_unit:
            raise UsageError(
                f"--start: the coupling of arm '{arm.name}' makes {joint.name}"
                f" {wanted / joint.per_file_unit:.6g} {joint.file_unit}; it may be left out"
            )
    return start


def _print(comparison: Comparison, target: Path | None, picture: Path | None) -> None:
    from planner.files import written_aside

    if target is not None:
        text = json.dumps(comparison.as_dict(), indent=2, allow_nan=False)
        with written_aside(target) as file:
            cast("IO[str]", file).write(text + "\n")
        if is_standard_output(target):
            return
    print_summary([comparison.text()], *filter(None, [picture]))


def _check(options: argparse.Namespace, settings: PlanSettings) -> None:
    """Errors: UsageError for options that do not go together, OutputError where a result cannot be written."""
    given = [
        name
        for name, value in (
            ("DRAWING.svg", options.drawing),
            ("--target", options.target),
            ("--random", options.random),
        )
        if value is not None
    ]
    if len(given) != 1:
        raise UsageError(
            "one of DRAWING.svg, --target and --random says what to compare on"
            + (f", not {' and '.join(given)}" if given else "")
            + " (see plan compare --help)"
        )
    if options.seed is not None and options.random is None:
        raise UsageError("--seed goes with --random")
    usual = replace(PlanSettings(), arm=settings.arm, weights=settings.weights)
    if options.rate is None:
        usual = replace(usual, rate_hz=settings.rate_hz)
    if options.tolerance is None:
        usual = replace(usual, tolerance_mm=settings.tolerance_mm)
    if options.drawing is None and settings != usual:
        raise UsageError(f"placement and motion are of drawings; {given[0]} goes with --arm and --weights alone")
    for place in options.target or ():
        if len(place) not in (2, 3):
            raise UsageError(f"--target takes X Y or X Y Z, not {len(place)} numbers")
    sources = [options.drawing] if options.drawing else []
    if options.json is not None:
        check_target(options.json, *sources)
    if options.plot is not None:
        check_target(options.plot, *sources)

        from planner.plots.figure_file import picture_format

        picture_format(options.plot)


def _parser() -> Parser:
    parser = Parser("plan compare", _DESCRIPTION, _EPILOG)
    parser.usage = "plan compare DRAWING.svg | --target X Y [Z] ... | --random N [--seed S]  [options]"
    parser.add_argument("drawing", nargs="?", type=input_file, metavar="DRAWING.svg")
    parser.add_argument(
        "--target",
        nargs="+",
        action="append",
        type=coordinate_mm,
        metavar=("X", "Y [Z]"),
        help="a place for the pen, mm from the base (Z: default 0, the paper);"
        " negative numbers carry no suffix; may be given again",
    )
    parser.add_argument(
        "--random",
        type=_count(1, _MOST_TARGETS),
        metavar="N",
        help="places on the paper, each within reach of a configuration that was drawn at random",
    )
    parser.add_argument("--seed", type=_count(0, 2**32 - 1), metavar="S", help="of --random (default: 0)")
    parser.add_argument(
        "--start",
        nargs="+",
        type=angle_deg,
        metavar="Q",
        help="where methods that go from configuration to configuration begin: a position for each joint (deg, or "
        "mm where it slides), or for each that no coupling drives; with a drawing, at each "
        "stroke (default: the documents' start for their arm; with a drawing, and for other "
        "arms, the arm's home)",
    )
    parser.add_argument(
        "--json",
        type=output_file,
        metavar="FILE",
        help="all figures as JSON; - for standard output, in place of the table",
    )
    parser.add_argument(
        "--plot",
        type=output_file,
        metavar="FILE",
        help="a picture (.png, .svg or .pdf): the convergence and the configurations, the way along the "
        "drawing, or the distributions",
    )
    parser.add_argument("--quiet", action="store_true", help="no progress")
    add_arm_and_placement_options(parser)
    parser.set_defaults(method=PlanSettings().method.value)
    return parser


def _count(least: int, most: int) -> argparse._ActionType:
    """A reader of whole numbers in that range."""

    def read(text: str) -> int:
        if not (text.isascii() and text.isdigit() and least <= int(text) <= most):
            raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {least} to {most}")
        return int(text)

    return read
