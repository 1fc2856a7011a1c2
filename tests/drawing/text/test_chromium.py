"""Characters stand where Chromium has them; benchmarks/text_positions.py measures there."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.drawing.text.texts import Sample

GOLDEN = json.loads((Path(__file__).parent / "chromium.json").read_text(encoding="utf-8"))
ROUNDED = 0.8
"""Chromium takes whole pixels for ascent and descent, of 92.8 and 23.6 here."""


@pytest.mark.parametrize("name", GOLDEN)
def test_characters_stand_where_chromium_has_them(name: str) -> None:
    sample = Sample(GOLDEN[name]["svg"], "outline")
    wanted = GOLDEN[name]["cells"]
    found = sample.cells()
    assert [cell is None for cell in found] == [cell is None for cell in wanted]
    for mine, theirs in zip(found, wanted, strict=True):
        if mine is not None:
            assert np.abs(mine - theirs).max() < ROUNDED
