"""Numbers as they are told in JSON."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike


def rounded(values: ArrayLike) -> Any:
    """A number, or nested lists of them, to nine decimals, with no "-0.0": a degree that went through radians comes
    back as it was."""
    return (np.round(np.asarray(values, dtype=np.float64), 9) + 0.0).tolist()
