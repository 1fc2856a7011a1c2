"""Which file is meant: `-` and its like are standard output, which is written to as it is."""

from __future__ import annotations

import os
from pathlib import Path

STANDARD = "-"
STANDARD_OUTPUT_DESCRIPTOR = 1


def is_standard_output(target: Path) -> bool:
    """Whether a result for `target` goes to standard output: named `-`, or by a name such as /dev/stdout."""
    if str(target) == STANDARD:
        return True
    try:
        return os.path.samestat(target.stat(), os.fstat(STANDARD_OUTPUT_DESCRIPTOR))
    except (OSError, ValueError):
        return False
