"""Sections of an arm file that hold a fixed transform."""

from __future__ import annotations

import math

import numpy as np

from planner.arms.file_section import Length, Number, Section
from planner.arms.rigid_transform import RigidTransform


class OriginSection(Section):
    x_mm: Length = 0.0
    y_mm: Length = 0.0
    z_mm: Length = 0.0
    roll_deg: Number = 0.0
    pitch_deg: Number = 0.0
    yaw_deg: Number = 0.0

    def transform(self) -> RigidTransform:
        angles = (math.radians(angle) for angle in (self.roll_deg, self.pitch_deg, self.yaw_deg))
        return RigidTransform(self.x_mm, self.y_mm, self.z_mm, *angles)


class ToolSection(OriginSection):
    """pen_length_mm: how far the tip is beyond the holder's frame, out of the nib."""

    pen_length_mm: Length = 0.0

    def with_pen(self, tool_axis: tuple[float, float, float]) -> RigidTransform:
        """From the last row to the tip; tool_axis is a unit vector of the holder's frame."""
        matrix = self.transform().matrix
        if self.pen_length_mm == 0:
            return self.transform()
        matrix[:3, 3] += matrix[:3, :3] @ (self.pen_length_mm * np.array(tool_axis))
        return RigidTransform.of(matrix)


def frame_values(transform: RigidTransform) -> dict[str, float]:
    """What a section says of a transform, but for zeros."""
    values = {
        "x_mm": transform.x_mm,
        "y_mm": transform.y_mm,
        "z_mm": transform.z_mm,
        "roll_deg": math.degrees(transform.roll_rad),
        "pitch_deg": math.degrees(transform.pitch_rad),
        "yaw_deg": math.degrees(transform.yaw_rad),
    }
    return {key: value for key, value in values.items() if value != 0}
