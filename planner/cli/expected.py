"""What an arm is expected to make of a drawing of lines and circles all over its canvas."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from planner.error_model.prediction import Prediction

_DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 120 40" fill="none" stroke="black">
<path d="M0 0H120V40H0ZM0 20H120M40 0V40M80 0V40M0 40L40 0L80 40L120 0"/>
<circle cx="20" cy="20" r="15"/><circle cx="60" cy="20" r="15"/><circle cx="100" cy="20" r="15"/></svg>
"""


def expected(arm_toml: str) -> Prediction:
    """The prediction for the arm that the text of a file describes. Errors: PlannerError."""
    from planner.arms.arm_file import load_arm
    from planner.arms.usual_settings import usual_rate_hz
    from planner.cli.predict import prediction_of
    from planner.pipeline import plan
    from planner.settings import PlanSettings

    with tempfile.TemporaryDirectory() as folder:
        drawing = Path(folder) / "lines.svg"
        drawing.write_text(_DRAWING, encoding="utf-8")
        arm = Path(folder) / "arm.toml"
        arm.write_text(arm_toml, encoding="utf-8")
        loaded = load_arm(str(arm))
        settings = PlanSettings(arm=str(arm), rate_hz=usual_rate_hz(loaded))
        trajectory = plan(drawing, settings, lambda stage, done, total: None).trajectory
        return prediction_of(loaded, trajectory, drawing, seed=0)
