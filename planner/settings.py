"""What a user can ask of the planner, with the defaults; lengths in mm, times in s."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Method(StrEnum):
    """How configurations are found for the points of a stroke."""

    PATH = "path"
    NLP = "nlp"
    DLS = "dls"
    CLOSED_FORM = "closed-form"


class CanvasKind(StrEnum):
    """Which rectangle of the paper is drawn on."""

    DOCUMENTED = "documented"
    OPTIMAL = "optimal"
    USABLE = "usable"


@dataclass(frozen=True, slots=True)
class ConfigurationWeights:
    """What method `path` spends the arm's redundancy on; only the ratios of the weights count.

    time: little joint motion for a millimetre of pen; sensitivity: joint errors move the pen little across the
    paper; reversals: joints that stand still rather than go back and forth (backlash); limits: away from them.
    """

    time: float = 1.0
    sensitivity: float = 1.0
    reversals: float = 1.0
    limits: float = 1.0


EVEN_WEIGHTS = ConfigurationWeights()

WHERE_SLACK_IS_TAKEN_UP = ConfigurationWeights(time=1.0, sensitivity=0.0, reversals=0.0, limits=0.0)
"""What draws best once a calibration has taken the rest away: little motion of joints for a millimetre of pen. What a
joint that lags makes of the line goes with its speed, and one at rest floats in what is left of its slack."""


@dataclass(frozen=True, slots=True)
class PlanSettings:
    """Settings of one plan.

    speed_mm_s: cap on the pen's speed on the paper, None for the arm's own. lowering_speed_mm_s: cap on its vertical
    speed when it comes down. dwell_s: rest on the paper after lowering. lift_mm: travel height, None for the arm's own.
    weights: None for the arm's own.
    """

    arm: str = "drawing_arm"
    method: Method = Method.PATH
    rate_hz: float = 100.0
    tolerance_mm: float = 0.05
    speed_mm_s: float | None = None
    lowering_speed_mm_s: float = 30.0
    dwell_s: float = 0.0
    lift_mm: float | None = None
    canvas: CanvasKind = CanvasKind.USABLE
    fit: bool = True
    margin_mm: float = 5.0
    rotate_deg: float = 0.0
    skip_unreachable: bool = False
    weights: ConfigurationWeights | None = None
