"""What a user can ask of the planner, with the defaults; lengths in mm, times in s."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from enum import StrEnum
from math import inf

from planner.checked import number_in, one_of
from planner.drawing.fill_options import NO_FILL, FillOptions
from planner.drawing.options import AS_A_BROWSER, ReadingOptions
from planner.errors import UsageError
from planner.paper_size import Orientation, PaperSize
from planner.pens import GroupBy, Pen

MIN_RATE_HZ, MAX_RATE_HZ = 50.0, 10_000.0
"""Below 50 samples a second the straight lines that controllers draw between samples leave the paper's tolerance."""
MIN_TOLERANCE_MM = 0.001


class Method(StrEnum):
    """How configurations are found for the points of a stroke."""

    PATH = "path"
    NLP = "nlp"
    DLS = "dls"
    CLOSED_FORM = "closed-form"


class Timing(StrEnum):
    """How the pen goes along what it draws: in the least time along a smooth path, or from target to target by Ruckig,
    at rest in each."""

    OPTIMAL = "optimal"
    RUCKIG = "ruckig"


class CanvasKind(StrEnum):
    """Which rectangle of the paper is drawn on."""

    DOCUMENTED = "documented"
    OPTIMAL = "optimal"
    USABLE = "usable"


class PlaceKind(StrEnum):
    """What of a drawing is fitted, aligned or put somewhere: its page, or the extent of its ink. BEST: its page, turned
    and moved to where it is drawn soonest and most accurately."""

    PAGE = "page"
    INK = "ink"
    BEST = "best"


class Anchor(StrEnum):
    """A corner, the middle of a side, or the middle, as somebody sees it who stands behind the arm."""

    TOP_LEFT = "top-left"
    TOP = "top"
    TOP_RIGHT = "top-right"
    LEFT = "left"
    CENTRE = "centre"
    RIGHT = "right"
    BOTTOM_LEFT = "bottom-left"
    BOTTOM = "bottom"
    BOTTOM_RIGHT = "bottom-right"

    @property
    def fractions(self) -> tuple[float, float]:
        """Of the width from the left, and of the height from the top."""
        across = 0.0 if "left" in self.value else 1.0 if "right" in self.value else 0.5
        down = 0.0 if "top" in self.value else 1.0 if "bottom" in self.value else 0.5
        return across, down


MOST_COPIES = 1000
MOST_PASSES = 20


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
        rate_hz: Samples a second, 50 to 10 000. A command that is not told asks the arm: see `usual_settings`.
        tolerance_mm: How far the pen may be off the drawing; likewise.
        timing: How motions are timed.
        speed_mm_s: Cap on the pen's speed on the paper, None for the arm's own.
        lowering_speed_mm_s: Cap on its vertical speed when it comes down.
        dwell_s: Rest on the paper after lowering.
        lift_mm: Travel height, None for the arm's own.
        canvas: The rectangle of the paper that is drawn on.
        place: What of the drawing is placed: its page, where it has one, or its ink.
        fit: Whether that is scaled to the canvas or the paper, or keeps its true size. None: it is, unless `scale` or
            `at_mm` say otherwise.
        scale: How large it becomes against its true size.
        paper: The sheet that there is, with its middle on the middle of the canvas; None: all of the canvas.
        orientation: Which way the sheet lies.
        align: Where it goes in what room there is.
        at_mm: Where its `origin` goes instead, mm to the right and down from the top left corner of the paper.
        origin: Which point of it goes there.
        copies: How many, in columns and rows, with a margin between.
        mirror: Left and right change places before it is turned.
        margin_mm: Kept free along the edges of the canvas or the paper.
        rotate_deg: How far the drawing is turned before it is placed.
        join_mm: Ends that are nearer are joined; None: those within twice the tolerance, where the pen stays within it.
        dedup_mm: Of lines that are nearer, one is drawn; 0: all are.
        simplify_mm: Points are dropped that change a line by less.
        min_length_mm: Shorter strokes are left out.
        passes: How often each line is drawn.
        keep_order: Strokes are drawn in the order of the drawing. reverse: in the opposite one.
        fill: How areas are filled, and strokes that are wider than the pen's line.
        layers: Those that are drawn, by name or number; None: all but those that are not to be plotted.
        by: What tells which pen draws a line; None: one pen draws all, or the nearest of the `pens` in colour.
        pens: The pens that there are, in the order in which they draw.
        skip_unreachable: Leave out what the arm cannot reach, and say so, instead of failing.
        weights: What method `path` spends the arm's redundancy on, None for the arm's own.
        reading: How the drawing is read.
        cache: What is computed of an arm is looked for on disk, and kept there.
    """

    arm: str = "drawing_arm"
    method: Method = Method.PATH
    timing: Timing = Timing.OPTIMAL
    rate_hz: float = 100.0
    tolerance_mm: float = 0.05
    speed_mm_s: float | None = None
    lowering_speed_mm_s: float = 30.0
    dwell_s: float = 0.0
    lift_mm: float | None = None
    canvas: CanvasKind = CanvasKind.USABLE
    place: PlaceKind = PlaceKind.PAGE
    fit: bool | None = None
    scale: float | None = None
    paper: PaperSize | None = None
    orientation: Orientation = Orientation.AUTO
    align: Anchor = Anchor.CENTRE
    at_mm: tuple[float, float] | None = None
    origin: Anchor = Anchor.TOP_LEFT
    copies: tuple[int, int] = (1, 1)
    mirror: bool = False
    margin_mm: float = 5.0
    rotate_deg: float = 0.0
    join_mm: float | None = None
    dedup_mm: float = 0.0
    simplify_mm: float = 0.0
    min_length_mm: float = 0.0
    passes: int = 1
    keep_order: bool = False
    reverse: bool = False
    fill: FillOptions = NO_FILL
    layers: tuple[str, ...] | None = None
    by: GroupBy | None = None
    pens: tuple[Pen, ...] = ()
    skip_unreachable: bool = False
    weights: ConfigurationWeights | None = None
    reading: ReadingOptions = AS_A_BROWSER
    cache: bool = True

    def __post_init__(self) -> None:
        numbers = {
            "rate_hz": number_in("rate_hz", self.rate_hz, minimum=MIN_RATE_HZ, maximum=MAX_RATE_HZ),
            "tolerance_mm": number_in("tolerance_mm", self.tolerance_mm, minimum=MIN_TOLERANCE_MM),
            "speed_mm_s": None if self.speed_mm_s is None else number_in("speed_mm_s", self.speed_mm_s),
            "lowering_speed_mm_s": number_in("lowering_speed_mm_s", self.lowering_speed_mm_s),
            "dwell_s": number_in("dwell_s", self.dwell_s, zero=True),
            "lift_mm": None if self.lift_mm is None else number_in("lift_mm", self.lift_mm),
            "margin_mm": number_in("margin_mm", self.margin_mm, zero=True),
            "scale": None if self.scale is None else number_in("scale", self.scale),
            "join_mm": None if self.join_mm is None else number_in("join_mm", self.join_mm, zero=True),
            "dedup_mm": number_in("dedup_mm", self.dedup_mm, zero=True),
            "simplify_mm": number_in("simplify_mm", self.simplify_mm, zero=True),
            "min_length_mm": number_in("min_length_mm", self.min_length_mm, zero=True),
            "rotate_deg": number_in("rotate_deg", self.rotate_deg, zero=True, minimum=-inf),
        }
        choices = {
            "method": one_of("method", self.method, Method),
            "timing": one_of("timing", self.timing, Timing),
            "canvas": one_of("canvas", self.canvas, CanvasKind),
            "place": one_of("place", self.place, PlaceKind),
            "orientation": one_of("orientation", self.orientation, Orientation),
            "align": one_of("align", self.align, Anchor),
            "origin": one_of("origin", self.origin, Anchor),
        }
        if self.by is not None:
            choices["by"] = one_of("by", self.by, GroupBy)
        for name, value in {**numbers, **choices}.items():
            object.__setattr__(self, name, value)
        for name in ("cache", "fit", "keep_order", "mirror", "reverse", "skip_unreachable"):
            if not isinstance(getattr(self, name), bool) and not (name == "fit" and self.fit is None):
                raise UsageError(f"{name} is True or False, not {getattr(self, name)!r:.40}")
        self._check_placement()
        if not isinstance(self.arm, str):
            raise UsageError(f"arm is the name of an arm or of its .toml file, not {self.arm!r:.40}")
        if not isinstance(self.weights, ConfigurationWeights | None):
            raise UsageError(f"weights is a ConfigurationWeights, not {self.weights!r:.40}")
        if not isinstance(self.reading, ReadingOptions):
            raise UsageError(f"reading is a ReadingOptions, not {self.reading!r:.40}")

    def with_pen(self, pen: Pen, speed_mm_s: float, speed_share: float) -> PlanSettings:
        """The settings for what one pen draws, at that share of the speed that it has, or else of `speed_mm_s`."""
        own_mm_s = pen.speed_mm_s if pen.speed_mm_s is not None else self.speed_mm_s
        if speed_share != 1.0:
            own_mm_s = speed_share * (speed_mm_s if own_mm_s is None else own_mm_s)
        return replace(
            self,
            speed_mm_s=own_mm_s,
            lift_mm=self.lift_mm if pen.lift_mm is None else pen.lift_mm,
            lowering_speed_mm_s=pen.lowering_speed_mm_s or self.lowering_speed_mm_s,
        )

    @property
    def pens_by(self) -> GroupBy | None:
        """What tells which pen draws a line; None where one pen draws all."""
        if self.by is not None or not self.pens:
            return self.by
        return GroupBy.LAYER if any(pen.layers for pen in self.pens) else GroupBy.COLOUR

    @property
    def is_fitted(self) -> bool:
        """Whether the drawing is scaled to what room there is."""
        return self.scale is None and self.at_mm is None if self.fit is None else self.fit

    def _check_placement(self) -> None:
        if self.fit and (self.scale is not None or self.at_mm is not None):
            other = "scale" if self.scale is not None else "at"
            raise UsageError(
                f"fit and {other} contradict each other: a drawing that fills its room has neither choice; leave"
                " one of them out"
            )
        if self.at_mm is not None:
            if self.align is not Anchor.CENTRE:
                raise UsageError(
                    "at and align contradict each other: either one says where the drawing goes; leave one of them out"
                )
            x, y = self.at_mm
            place = number_in("at", x, zero=True, minimum=-inf), number_in("at", y, zero=True, minimum=-inf)
            object.__setattr__(self, "at_mm", place)
        elif self.origin is not Anchor.TOP_LEFT:
            raise UsageError(
                "origin says which point of the drawing goes to at, and there is no at: give one, or leave origin out"
            )
        if self.place is PlaceKind.BEST:
            others = {"at": self.at_mm is not None, "align": self.align is not Anchor.CENTRE}
            for other, is_there in others.items():
                if is_there:
                    raise UsageError(
                        f"place best and {other} contradict each other: either one says where it goes; leave one out"
                    )
            if tuple(self.copies) != (1, 1):
                raise UsageError(
                    "place best and copies contradict each other: copies lie in rows and columns; leave one out"
                )
        if self.orientation is not Orientation.AUTO and self.paper is None:
            raise UsageError("orientation says which way the paper lies, and there is no paper: name one")
        if not isinstance(self.paper, PaperSize | None):
            raise UsageError(f"paper is a PaperSize, not {self.paper!r:.40}")
        if self.layers is not None and not (self.layers and all(isinstance(layer, str) for layer in self.layers)):
            raise UsageError(f"layers are names, one at least, not {self.layers!r:.40}")
        if not all(isinstance(pen, Pen) for pen in self.pens):
            raise UsageError(f"pens are values of Pen, not {self.pens!r:.40}")
        if not isinstance(self.fill, FillOptions):
            raise UsageError(f"fill is a FillOptions, not {self.fill!r:.40}")
        if not isinstance(self.passes, int) or not 1 <= self.passes <= MOST_PASSES:
            raise UsageError(f"passes is a whole number, 1 to {MOST_PASSES}, not {self.passes!r:.40}")
        columns, rows = self.copies
        if not (isinstance(columns, int) and isinstance(rows, int) and columns >= 1 and rows >= 1):
            raise UsageError(f"copies are columns and rows, one of each at least, not {self.copies!r:.40}")
        if columns * rows > MOST_COPIES:
            raise UsageError(f"{columns} x {rows} copies are more than {MOST_COPIES}: ask for fewer")
