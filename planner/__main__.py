"""`python -m planner`, for where the command `plan` is not on the path."""

from __future__ import annotations

import sys

from planner.entry.command import main

if __name__ == "__main__":
    sys.exit(main())
