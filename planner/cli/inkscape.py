"""`plan inkscape`: documents are saved as trajectories from within Inkscape."""

from __future__ import annotations

from pathlib import Path

from planner.cli.parser import Parser
from planner.cli.terminal import print_lines

_DESCRIPTION = """\
Install the extension for Inkscape. Then File > Save a Copy offers "Trajectory of a drawing arm (*.csv)", asks for arm,
paper, pens and fills, and shows what the plan says. To remove it, delete its files."""

_EPILOG = """\
examples:
  plan inkscape
  plan inkscape --folder inkscape/extensions
  inkscape d.svg --export-extension=org.drawing_arm_planner.trajectory --export-filename=d.csv
                                                   without a window, with the options that it was used with last

It finds this planner by the Python that it is installed with: install it again where that has moved. An Inkscape from
Flatpak or Snap is shut off from other programs, and cannot run it."""


def inkscape(arguments: list[str]) -> int:
    """Install it. Errors: PlannerError."""
    parser = Parser("plan inkscape", _DESCRIPTION, _EPILOG)
    parser.add_argument(
        "--folder", type=Path, metavar="DIR", help="of Inkscape's extensions (default: the one that Inkscape names)"
    )
    options = parser.parse_args(arguments)

    from planner.inkscape.installing import extension_folder, install

    print_lines([f"wrote {path}" for path in install(options.folder or extension_folder())])
    return 0
