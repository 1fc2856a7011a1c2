"""The settings of a plan as keywords."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import TypedDict

from planner.drawing.fill_options import FillOptions
from planner.drawing.options import ReadingOptions
from planner.errors import UnknownOption, UsageError
from planner.paper_size import PaperSize, paper_size
from planner.pens import Pen
from planner.settings import ConfigurationWeights, PlanSettings


class PlanOptions(TypedDict, total=False):
    """Keywords of `plan` and `compare`: those of `PlanSettings` but the arm. Choices may be given by their names, and
    weights and how to read as mappings."""

    method: str
    timing: str
    rate_hz: float
    tolerance_mm: float
    speed_mm_s: float | None
    lowering_speed_mm_s: float
    dwell_s: float
    lift_mm: float | None
    canvas: str
    place: str
    fit: bool | None
    scale: float | None
    paper: PaperSize | str | None
    orientation: str
    align: str
    at_mm: tuple[float, float] | None
    origin: str
    copies: tuple[int, int]
    mirror: bool
    margin_mm: float
    rotate_deg: float
    join_mm: float | None
    dedup_mm: float
    simplify_mm: float
    min_length_mm: float
    passes: int
    keep_order: bool
    reverse: bool
    fill: FillOptions | Mapping[str, object]
    layers: tuple[str, ...] | None
    by: str | None
    pens: tuple[Pen, ...]
    skip_unreachable: bool
    weights: ConfigurationWeights | Mapping[str, float] | None
    reading: ReadingOptions | Mapping[str, object]
    cache: bool


def settings_with(settings: PlanSettings | None, arm: str | None, options: PlanOptions) -> PlanSettings:
    """The settings, or the usual ones, with an arm and options in place of what they say.

    Errors: UnknownOption, UsageError.
    """
    if settings is not None and not isinstance(settings, PlanSettings):
        raise UsageError(f"settings is a PlanSettings, not a value of type {type(settings).__name__}")
    require_known(options, [field.name for field in fields(PlanSettings)])
    changes: dict[str, object] = dict(options) if arm is None else {**options, "arm": arm}
    parts: dict[str, type] = {"weights": ConfigurationWeights, "reading": ReadingOptions, "fill": FillOptions}
    for name, kind in parts.items():
        value = changes.get(name)
        if isinstance(value, Mapping):
            require_known(value, [field.name for field in fields(kind)])
            changes[name] = kind(**value)
    if isinstance(paper := changes.get("paper"), str):
        changes["paper"] = paper_size(paper)
    return replace(settings or PlanSettings(), **changes)  # type: ignore[arg-type]  # they check themselves


def require_known(given: Mapping[str, object], known: list[str]) -> None:
    """Errors: UnknownOption for the first name that is not known."""
    for name in given:
        if name not in known:
            raise UnknownOption(str(name), known)
