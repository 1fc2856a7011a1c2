"""The transform of one Denavit-Hartenberg row, for symbols and for arrays alike."""

from __future__ import annotations

from typing import Any

import numpy as np


def dh_entries(c: Any, s: Any, d: Any, a_mm: float, alpha_rad: float) -> tuple[tuple[Any, ...], ...]:
    """The entries of Rz(theta) Tz(d) Tx(a) Rx(alpha), row by row: c and s are cosine and sine of theta. Exact zeros and
    ones where alpha is a right angle."""
    ca, sa = _exact(float(np.cos(alpha_rad))), _exact(float(np.sin(alpha_rad)))
    return (
        (c, -s * ca, s * sa, a_mm * c),
        (s, c * ca, -c * sa, a_mm * s),
        (0.0, sa, ca, d),
        (0.0, 0.0, 0.0, 1.0),
    )


def _exact(value: float) -> float:
    rounded = round(value)
    return float(rounded) if abs(value - rounded) < 1e-15 else value
