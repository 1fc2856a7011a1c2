"""Laws of `svg_to_arm_mm`: it keeps the drawing's shape, mirrors it only if the header says so, and puts it where the
header tells.

The page, not the user space, keeps its shape: a drawing may stretch its own coordinates (preserveAspectRatio="none").
On the page y points down; seen from above the arm, x points away from it and y to the left, so that a map that does
not mirror has a negative determinant. Deviations are told as what they move the far end of the drawing by.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.checking.between import Sweep
from planner.checking.check_result import Finding
from planner.checking.pen import place_of
from planner.drawing.drawing import Drawing
from planner.trajectory import Trajectory

_LARGEST_DRAWING_MM = 10_000.0
_PAGE_TO_ARM = np.array([[0.0, -1.0], [-1.0, 0.0]])
"""Of a page that lies before the arm, its top away from it."""


def map_trouble(trajectory: Trajectory, drawing: Drawing) -> str:
    """Why the map means nothing to this drawing, or nothing."""
    affine = trajectory.svg_to_arm
    if _is_flat(affine):
        return "squeezes the drawing to a line"
    size_mm = float(np.ptp(_corners(drawing, affine), axis=0).max())
    return f"makes the drawing {size_mm:.4g} mm large" if size_mm > _LARGEST_DRAWING_MM else ""


def map_findings(trajectory: Trajectory, drawing: Drawing | None, tolerance_mm: float) -> list[Finding]:
    """The map by itself and, as it can be told with the drawing alone, its shape, scale and turn."""
    affine, told = trajectory.svg_to_arm, trajectory.placement
    trouble = "squeezes the drawing to a line" if _is_flat(affine) else ""
    if not trouble and (np.linalg.det(affine[:, :2]) > 0) != told.mirror:
        trouble = (
            "does not mirror the drawing, and the header says that it is mirrored"
            if told.mirror
            else "mirrors the drawing, and the header does not say so"
        )
    if trouble or drawing is None:
        return [Finding("svg_to_arm_mm", not trouble, remark=trouble)]
    size_mm = float(np.linalg.norm(np.ptp(_corners(drawing, affine), axis=0)))
    mirror = np.diag([-1.0 if told.mirror else 1.0, 1.0])
    # What is left of the map once the page is made of the user space, and the paper of the arm's: scale and turn.
    turn = _PAGE_TO_ARM @ affine[:, :2] @ np.linalg.inv(mirror @ drawing.user_to_page[:, :2])
    scale, angle = np.sqrt(abs(np.linalg.det(turn))), np.arctan2(turn[1, 0] - turn[0, 1], np.trace(turn))
    cosine, sine = np.cos(angle), np.sin(angle)
    distorted = np.abs(turn / scale - np.array([[cosine, -sine], [sine, cosine]])).max() * size_mm
    findings = [
        Finding(
            "svg_to_arm_mm",
            bool(distorted <= tolerance_mm),
            float(distorted),
            tolerance_mm,
            "mm",
            remark="off the drawing's shape on its page",
        )
    ]
    if told.scale is not None:
        off_mm = abs(scale / told.scale - 1) * size_mm if told.scale > 0 else np.inf
        findings.append(
            Finding(
                "scale",
                bool(off_mm <= tolerance_mm),
                float(off_mm),
                tolerance_mm,
                "mm",
                remark=f"at the far end; {scale:.6g} mm on paper for one on the page",
            )
        )
    if told.rotate_deg is not None:
        off_rad = np.radians(told.rotate_deg) - angle
        off_mm = abs(np.arctan2(np.sin(off_rad), np.cos(off_rad))) * size_mm
        findings.append(
            Finding(
                "rotation",
                bool(off_mm <= tolerance_mm),
                float(off_mm),
                tolerance_mm,
                "mm",
                remark=f"at the far end; turned by {np.degrees(angle):.6g} degrees",
            )
        )
    return findings


def within_the_canvas(trajectory: Trajectory, sweep: Sweep, tolerance_mm: float) -> list[Finding]:
    """How far the pen on the paper gets over the sides of the canvas less its margin, where the header tells these."""
    told = trajectory.placement
    points = np.flatnonzero(sweep.down)
    if told.canvas_mm is None or not len(points):
        return []
    near, far, right, left = told.canvas_mm
    margin_mm = told.margin_mm or 0.0
    x, y = sweep.tip_mm[points, :2].T
    over_mm = margin_mm + np.max([near - x, x - far, right - y, y - left], axis=0)
    index = int(np.argmax(over_mm))
    point = int(points[index])
    return [
        Finding(
            "within the canvas",
            bool(over_mm[index] <= tolerance_mm),
            float(over_mm[index]),
            tolerance_mm,
            "mm",
            place_of(trajectory, int(sweep.sample[point]), point, sweep),
            f"over its side, less the margin of {margin_mm:g} mm",
        )
    ]


def _is_flat(affine: FloatArray) -> bool:
    linear = affine[:, :2]
    return bool(abs(np.linalg.det(linear)) <= 1e-9 * np.abs(linear).max() ** 2)


def _corners(drawing: Drawing, affine: FloatArray) -> FloatArray:
    """(n, 2) the points that define the drawing's curves and the frames of its pictures, in arm mm."""
    shapes = drawing.scene.shapes if drawing.scene is not None else ()
    frames = [path for shape in shapes if shape.pixels is not None for path in shape.outline]
    beziers = [outline.beziers for outline in drawing.outlines] + [path.beziers for path in frames]
    points = np.concatenate([curves.reshape(-1, 2) for curves in beziers])
    corners: FloatArray = points @ affine[:, :2].T + affine[:, 2]
    return corners
