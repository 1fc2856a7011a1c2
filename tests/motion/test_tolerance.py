"""The tolerance is spent once."""

from __future__ import annotations

import numpy as np
import pytest

from planner.motion import tolerance as share


def test_what_adds_up_from_the_drawing_to_the_samples_is_the_whole_tolerance() -> None:
    assert pytest.approx(1.0) == share.FLATTEN_SHARE + share.STROKE_SHARE
    assert share.FLATTEN_SHARE > 0
    assert np.hypot(share.NARROW_SHARE / 2, share.STROKE_SHARE) < 1.0  # across a gap that nobody looks at
    assert share.STROKE_SHARE > 0.95, "what the pen may stray is what the user asked for"
