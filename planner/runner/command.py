"""The command of the runner: what of `plan` an arm needs that trajectories are brought to."""

from __future__ import annotations

import sys
from collections.abc import Sequence

NAME = "drawing-arm-runner"
PLANNER = "drawing-arm-planner"
COMMANDS = {
    "run": "play a trajectory; --dry-run examines it, and sends nothing",
    "jog": "one joint at a time, on the first day of an arm",
    "ports": "list the serial devices that are plugged in",
}
NOT_HERE = ("--frame", "--picture", "--film")
EXIT_USAGE = 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one of the commands as `plan` would; the exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    name = words[0] if words else "--help"
    if name in ("-h", "--help"):
        print(_help())
        return 0
    if name not in COMMANDS:
        return _refuse(f"'{name:.60}' is none of its commands, {', '.join(COMMANDS)}; the others are in {PLANNER}")
    for option in NOT_HERE:
        if any(word.partition("=")[0] == option for word in words):
            return _refuse(f"{option} needs the solvers and pictures of {PLANNER}")
    from planner.cli import main as command

    return command(words)


def _refuse(message: str) -> int:
    print(f"{NAME}: error: {message}", file=sys.stderr)
    return EXIT_USAGE


def _help() -> str:
    width = max(map(len, COMMANDS))
    listed = "\n".join(f"  {NAME} {name:<{width}}   {what}" for name, what in COMMANDS.items())
    return f"Plays trajectories of {PLANNER} on an arm.\n\n{listed}\n\nEach has its own --help."
