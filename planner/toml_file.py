"""TOML files that people write for the planner, arm files aside, which have faults of their own."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from planner.errors import UsageError

_SIZE_LIMIT_BYTES = 1 << 20


def read_toml(path: Path) -> dict[str, Any]:
    """What stands in the file. Errors: UsageError for one that cannot be read, is too large, or is no TOML."""
    try:
        with path.open("rb") as file:
            content = file.read(_SIZE_LIMIT_BYTES + 1)
        if len(content) > _SIZE_LIMIT_BYTES:
            raise UsageError(f"{path}: larger than {_SIZE_LIMIT_BYTES >> 20} MB")
        return tomllib.loads(content.decode())
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise UsageError(f"{path}: not readable TOML: {error}") from error
