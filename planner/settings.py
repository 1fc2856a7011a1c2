"""What a user can ask of the planner, with the defaults; lengths in mm, times in s."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import StrEnum
from math import inf

from planner.checked import number_in, one_of
from planner.errors import UsageError

MIN_RATE_HZ, MAX_RATE_HZ = 50.0, 10_000.0
"""Below 50 samples a second the straight lines that controllers draw between samples leave the paper's tolerance."""
MIN_TOLERANCE_MM = 0.001


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

    time: little joint motion for a millimetre of pen; sensitivity: little drawn error, along the paper and in height,
    from joints that run late or stand wrong; reversals: joints that stand still rather than go back and forth, for the
    sake of the gears; limits: away from them.
    """

    time: float = 1.0
    sensitivity: float = 1.0
    reversals: float = 0.0
    limits: float = 1.0

    def __post_init__(self) -> None:
        """Errors: UsageError for a weight below zero, and where all are zero."""
        names = [field.name for field in fields(self)]
        for name in names:
            object.__setattr__(self, name, number_in(f"weight {name}", getattr(self, name), zero=True))
        if not any(getattr(self, name) for name in names):
            raise UsageError("the weights are all zero; at least one has to be positive")


DEFAULT_WEIGHTS = ConfigurationWeights()


@dataclass(frozen=True, slots=True)
class PlanSettings:
    """Settings of one plan. Errors: UsageError for a value that means nothing.

    Attributes:
        arm: The name of an arm, or of its ``.toml`` file.
        method: How configurations are found.
        rate_hz: Samples a second, 50 to 10 000.
        tolerance_mm: How far the pen may be off the drawing.
        speed_mm_s: Cap on the pen's speed on the paper, None for the arm's own.
        lowering_speed_mm_s: Cap on its vertical speed when it comes down.
        dwell_s: Rest on the paper after lowering.
        lift_mm: Travel height, None for the arm's own.
        canvas: The rectangle of the paper that is drawn on.
        fit: Whether the drawing is scaled to the canvas, or keeps its true size.
        margin_mm: Kept free along the edges of the canvas.
        rotate_deg: How far the drawing is turned before it is placed.
        skip_unreachable: Leave out what the arm cannot reach, and say so, instead of failing.
        weights: What method `path` spends the arm's redundancy on, None for the arm's own.
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

    def __post_init__(self) -> None:
        numbers = {
            "rate_hz": number_in("rate_hz", self.rate_hz, minimum=MIN_RATE_HZ, maximum=MAX_RATE_HZ),
            "tolerance_mm": number_in("tolerance_mm", self.tolerance_mm, minimum=MIN_TOLERANCE_MM),
            "speed_mm_s": None if self.speed_mm_s is None else number_in("speed_mm_s", self.speed_mm_s),
            "lowering_speed_mm_s": number_in("lowering_speed_mm_s", self.lowering_speed_mm_s),
            "dwell_s": number_in("dwell_s", self.dwell_s, zero=True),
            "lift_mm": None if self.lift_mm is None else number_in("lift_mm", self.lift_mm),
            "margin_mm": number_in("margin_mm", self.margin_mm, zero=True),
            "rotate_deg": number_in("rotate_deg", self.rotate_deg, zero=True, minimum=-inf),
        }
        choices = {
            "method": one_of("method", self.method, Method),
            "canvas": one_of("canvas", self.canvas, CanvasKind),
        }
        for name, value in {**numbers, **choices}.items():
            object.__setattr__(self, name, value)
        for name in ("fit", "skip_unreachable"):
            if not isinstance(getattr(self, name), bool):
                raise UsageError(f"{name} is True or False, not {getattr(self, name)!r:.40}")
        if not isinstance(self.arm, str):
            raise UsageError(f"arm is the name of an arm or of its .toml file, not {self.arm!r:.40}")
        if not isinstance(self.weights, ConfigurationWeights | None):
            raise UsageError(f"weights is a ConfigurationWeights, not {self.weights!r:.40}")
