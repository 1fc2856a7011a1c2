"""`vpype read x.svg linesort arm --arm so101 traj.csv`: a plan from within a vpype pipeline.

vpype looks its plug-ins up by their entry points and loads all of them at its start, so nothing heavy is imported here.
"""

from __future__ import annotations

import io
from pathlib import Path

import click
import vpype as vp
import vpype_cli

_PLAN_ALONE = ("list_layers", "report", "split", "tile")
_HELP_OPTION = "an option of plan and its value, such as margin=1cm, or its name alone, such as mirror; may be repeated"


@click.command()
@click.argument("output", type=vpype_cli.PathType())
@click.option("-a", "--arm", default=None, help="an arm by name, or its .toml file (default: as of plan)")
@click.option("-x", "--option", "options", multiple=True, metavar="NAME[=VALUE]", help=_HELP_OPTION)
@vpype_cli.global_processor  # type: ignore[untyped-decorator]
def arm(document: vp.Document, output: str, arm: str | None, options: tuple[str, ...]) -> vp.Document:
    """Plan the motion of an arm that draws the document, and write it to OUTPUT as a trajectory.

    Layers keep their names and pens their colours: -x by=layer halts between them. Lines keep the order that they have
    where that is the quickest; see plan --help for all options.

    Example:

        vpype read drawing.svg linemerge linesort arm --arm so101 -x margin=1cm traj.csv
    """
    from planner.cli.plan import plan_parser
    from planner.cli.plan_options import settings_of
    from planner.drawing.source import SvgInMemory
    from planner.errors import PlannerError, UsageError
    from planner.pipeline import plan
    from planner.progress import unreported
    from planner.trajectory import write_trajectory

    text = io.StringIO()
    vp.write_svg(text, document, document.page_size, set_date=False)
    arguments = ["-", *(["--arm", arm] if arm else []), *(f"--{option}" for option in options)]
    try:
        wanted = plan_parser().parse_args(arguments)
        for name in _PLAN_ALONE:
            if getattr(wanted, name):
                raise UsageError(f"{name.replace('_', '-')} goes with plan, not with arm, which writes one trajectory")
        settings = settings_of(wanted)
        planned = plan(SvgInMemory(Path(output).stem, text.getvalue().encode()), settings, unreported)
        write_trajectory(planned.trajectory, Path(output))
    except PlannerError as error:
        raise click.ClickException(str(error)) from error
    for line in [*(f"warning: {warning}" for warning in planned.summary.warnings), *planned.summary.lines()]:
        click.echo(line, err=True)
    return document


arm.help_group = "Output"  # type: ignore[attr-defined]  # vpype sorts its help by it
