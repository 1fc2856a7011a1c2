"""The tolerance is spent once."""

from __future__ import annotations

import pytest

from planner.motion import tolerance as share


def test_what_adds_up_along_a_stroke_is_the_whole_tolerance() -> None:
    spent = share.FLATTEN_SHARE + share.JOIN_SHARE + share.SMOOTH_SHARE + share.SAMPLE_SHARE + share.CHORD_SHARE
    assert spent == pytest.approx(1.0) and min(share.FLATTEN_SHARE, share.JOIN_SHARE) > 0


def test_what_samples_are_measured_against_is_what_was_planned_for() -> None:
    assert pytest.approx(share.SAMPLE_SHARE + share.CHORD_SHARE) == share.ASIDE_SHARE
    assert share.SMOOTH_SHARE + share.ASIDE_SHARE < 1.0
