"""`python -m planner.cli`, for where the command `plan` is not installed."""

from __future__ import annotations

import sys

from planner.cli import main

sys.exit(main())
