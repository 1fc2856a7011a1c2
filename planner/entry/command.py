"""The console scripts: the command, once it is known that the packages found are those of this distribution."""

from __future__ import annotations

import gc
import sys

from .foreign import NAME, foreign

EXIT_DAMAGED = 70
"""As for any fault of the program itself: EX_SOFTWARE."""
_YOUNG_OBJECTS = 100_000
"""Python looks for circles of garbage after so many objects, in place of a few hundred: what a small plan imports and
makes is less, and no garbage, and was looked through more than a hundred times."""


def main() -> int:
    """Run the command `plan`; the exit code. A damaged installation ends as one line on standard error."""
    gc.set_threshold(_YOUNG_OBJECTS)
    try:
        return _run()
    finally:
        gc.freeze()  # the process ends: nothing is gained by looking for garbage once more, in all there is


def _run() -> int:
    complaint = foreign()
    if complaint is None:
        try:
            import planner
            from planner.cli import main as command

            if planner.DISTRIBUTION != NAME:
                raise ImportError("the package planner is another's")
        except Exception as error:  # whatever the code of strangers raises
            from .damage import damage

            complaint = damage(error)
            if complaint is None:
                raise
        else:
            return command()
    print(f"plan: error: {complaint}", file=sys.stderr)
    return EXIT_DAMAGED
