"""Viewports: `viewBox` and `preserveAspectRatio`."""

from __future__ import annotations

import re

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.transforms import Box

_NUMBER = r"((?>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?))"
_VIEW_BOX = re.compile(r"\s*" + r"(?:\s*,\s*|\s+|(?=[+-]))".join([_NUMBER] * 4) + r"\s*")
_ASPECT = re.compile(r"\s*(?:defer\s+)?(none|x(Min|Mid|Max)Y(Min|Mid|Max))(?:\s+(meet|slice))?\s*")
_FRACTIONS = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}


def parse_view_box(text: str | None) -> Box | None:
    """None where there is none, or none that can be used: an error in it, or a negative size."""
    match = _VIEW_BOX.fullmatch(text or "")
    if match is None:
        return None
    x, y, width, height = (float(number) for number in match.groups())
    return (x, y, width, height) if width >= 0.0 and height >= 0.0 else None


def fitted(view_box: Box, size: tuple[float, float], aspect: str | None) -> FloatArray:
    """(2, 3), from the units of a view box of some size to a viewport with its corner at the origin."""
    x, y, width, height = view_box
    scale = np.array(size) / (width, height)
    shift = np.zeros(2)
    match = _ASPECT.fullmatch(aspect or "") or _ASPECT.fullmatch("xMidYMid")
    if match is not None and match[1] != "none":
        scale[:] = scale.max() if match[4] == "slice" else scale.min()
        shift = (np.array(size) - scale * (width, height)) * (_FRACTIONS[match[2]], _FRACTIONS[match[3]])
    offset = shift - scale * (x, y)
    return np.array([[scale[0], 0.0, offset[0]], [0.0, scale[1], offset[1]]])
