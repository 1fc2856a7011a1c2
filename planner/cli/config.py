"""`plan config`: which options are in force, and where each is said."""

from __future__ import annotations

import json

from planner.cli.files import input_file
from planner.cli.parser import Parser
from planner.cli.plan import plan_parser
from planner.cli.preferences import BESIDE, USER_FILE_VARIABLE, preferences_for, user_file, with_preferences
from planner.cli.terminal import print_lines
from planner.errors import UsageError
from planner.pens import Pen

_DESCRIPTION = f"""\
Say which options a plan would have where the command line says nothing, and where each is said: a file of your own, a
file {BESIDE} beside the drawing, or a preset in one of them. {USER_FILE_VARIABLE} names another file of your own."""

_EPILOG = """\
examples:
  plan config
  plan config flower.svg --preset fast
  plan flower.svg --preset fast

such a file:
  [options]
  arm = "my_arm"
  margin = "1cm"
  [presets.fast]
  speed = "8cm/s"
  [arms]
  my_arm = "arms/my_arm.toml"     # relative to the file"""


def config(arguments: list[str]) -> int:
    """Print what is in force. Errors: UsageError for a file that cannot be used."""
    parser = Parser("plan config", _DESCRIPTION, _EPILOG)
    parser.add_argument("drawing", nargs="?", type=input_file, metavar="DRAWING.svg", help="the files for this drawing")
    parser.add_argument("--preset", metavar="NAME", help="with this preset")
    parser.add_argument("--json", action="store_true", help="print it as JSON")
    asked = parser.parse_args(arguments)
    if asked.drawing and not asked.drawing.exists():
        raise UsageError(f"{asked.drawing}: no such drawing or folder")
    preferences = preferences_for(asked.drawing)
    in_force, sources = with_preferences(plan_parser(), [str(asked.drawing or "-")], preferences, asked.preset)
    said = {
        name.replace("_", "-"): (value, sources.get(name, "default"))
        for name, value in sorted(vars(in_force).items())
        if name not in ("drawing", "output", "report", "preset", "quiet", "workers")
    }
    if asked.json:
        shown = {name: {"value": _plain(value), "from": where} for name, (value, where) in said.items()}
        print_lines([json.dumps({"options": shown, "presets": preferences.presets()}, indent=2)])
        return 0
    width = max(map(len, said))
    files = [str(file.path) for file in preferences.files] or [f"none (there is no {user_file()})"]
    print_lines(
        [
            f"files: {', '.join(files)}",
            f"presets: {', '.join(preferences.presets()) or 'none'}",
            *(f"{name:<{width}}  {_shown(value)}  ({where})" for name, (value, where) in said.items()),
        ]
    )
    return 0


def _shown(value: object) -> object:
    plain = _plain(value)
    if plain is None or plain == []:
        return "not set"
    return ", ".join(map(str, plain)) if isinstance(plain, list) else plain


def _plain(value: object) -> object:
    """As JSON has it; pens by their names."""
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, Pen):
        return value.name
    return value if value is None or isinstance(value, bool | int | float | str) else str(value)
