"""From an SVG drawing to a timed joint trajectory for an arm that holds a pen.

`from planner import plan` and the other names of `__all__` are stable; all else is private. Each is imported when it is
first used, so that nothing heavy is loaded before it is needed.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from planner.api.judging import check, compare
    from planner.api.planning import load_arm, plan
    from planner.api.result import Plan
    from planner.drawing.options import ReadingOptions
    from planner.errors import (
        ArmFileError,
        CalibrationError,
        DoesNotFit,
        DrawingError,
        HardwareError,
        LinksCollide,
        OutputError,
        PlanError,
        PlannerError,
        TargetBeyondReach,
        TargetOutOfReach,
        TrajectoryFileError,
        UnknownArm,
        UnknownOption,
        UsageError,
    )
    from planner.settings import CanvasKind, ConfigurationWeights, Method, PlanSettings
    from planner.trajectory import Trajectory

DISTRIBUTION = "drawing-arm-planner"
"""The name under which package managers know all this."""
__version__ = "0.1.0"

__all__ = [
    "ArmFileError",
    "CalibrationError",
    "CanvasKind",
    "ConfigurationWeights",
    "DoesNotFit",
    "DrawingError",
    "HardwareError",
    "LinksCollide",
    "Method",
    "OutputError",
    "Plan",
    "PlanError",
    "PlanSettings",
    "PlannerError",
    "ReadingOptions",
    "TargetBeyondReach",
    "TargetOutOfReach",
    "Trajectory",
    "TrajectoryFileError",
    "UnknownArm",
    "UnknownOption",
    "UsageError",
    "__version__",
    "check",
    "compare",
    "load_arm",
    "plan",
]

_HOMES = {
    "Plan": "planner.api.result",
    "ReadingOptions": "planner.drawing.options",
    "Trajectory": "planner.trajectory",
    "check": "planner.api.judging",
    "compare": "planner.api.judging",
    "load_arm": "planner.api.planning",
    "plan": "planner.api.planning",
    **dict.fromkeys(("CanvasKind", "ConfigurationWeights", "Method", "PlanSettings"), "planner.settings"),
}
"""Where the names are defined; those that are not here are errors."""


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module 'planner' has no attribute '{name}'")
    try:
        value: object = getattr(import_module(_HOMES.get(name, "planner.errors")), name)
    except ImportError as error:
        from planner.entry.damage import damage

        complaint = damage(error)
        if complaint is None:
            raise
        raise ImportError(complaint) from error
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
