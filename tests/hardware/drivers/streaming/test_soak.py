"""The soak of benchmarks/soak/streaming.py, in short."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from planner.cli import main
from tests.drawn_shapes import lines_svg
from tests.hardware.drivers.streaming.soak import Soak


@pytest.mark.parametrize("driver", ["maestro", "ssc32"])
def test_whatever_dies_or_is_reset_the_drawing_gets_done(
    driver: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drawing, csv = tmp_path / "drawing.svg", tmp_path / "traj.csv"
    strokes = "".join(f"M{x} 5v8" for x in range(5, 25, 2)) + "M5 20h0M15 20h0"
    drawing.write_text(lines_svg(f'<path d="{strokes}"/>', 'viewBox="0 0 90 30"'))
    assert main([str(drawing), "-o", str(csv), "--quiet"]) == 0
    soak = Soak(csv, driver)
    interruptions = 0
    for seed in range(2):
        outcome = soak.draw(np.random.default_rng(seed))
        assert (outcome.lost, outcome.claimed, outcome.undoubted) == ([], [], [])
        assert outcome.off_mm <= soak.bound_mm
        interruptions += outcome.dead + outcome.reset
    assert interruptions > 2
    assert "not confirmed by the controller" in capsys.readouterr().err
