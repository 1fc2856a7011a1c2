"""What is said of an arm beside its robot description, which knows neither pens nor how fast joints may speed up."""

from __future__ import annotations

from dataclasses import dataclass

from planner.arms.rigid_transform import IDENTITY, RigidTransform


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """base, tip: links; None for the usual ones. name: of the arm; None for the robot's.

    tool: from the tip's frame to that of the pen's holder. tool_axis: out of the nib, a unit vector of the holder's
    frame; None for the usual one. pen_length_mm: from the holder's frame to the tip, along it.
    velocity: of joints whose description has none, deg/s or mm/s. speeding_up_s: how long a joint takes to full speed.
    jerking_s: and to full acceleration. turn_deg: how far joints without limits turn to either side.
    inner_radius_mm: None for a share of the arm's length.
    """

    base: str | None = None
    tip: str | None = None
    name: str | None = None
    tool: RigidTransform = IDENTITY
    tool_axis: tuple[float, float, float] | None = None
    pen_length_mm: float = 0.0
    velocity: float = 90.0
    speeding_up_s: float = 0.2
    jerking_s: float = 0.05
    turn_deg: float = 180.0
    lift_mm: float = 5.0
    inner_radius_mm: float | None = None
