"""A film as numbers, for any player."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
import numpy.typing as npt

from planner.arrays import FloatArray
from planner.plots.ink import inks_of
from planner.plots.motion import Motion, is_seen_square_on, seen_from_the_side
from planner.plots.paper_extent import base_of, paper_sides_mm, view_mm

MOST_POSES = 20_000
_POINTS_A_POSE = 5
_LARGEST = 32_000  # of a 16 bit number


def film_of(
    motion: Motion,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
    *,
    most: int = MOST_POSES,
) -> dict[str, Any]:
    """The motion for a player, as plain values for JSON. Of a long motion it holds some `most` configurations, between
    which the arm moves evenly; what the pen draws it holds to a twentieth of a millimetre, or in five times as many
    points, and two a stroke."""
    trajectory = motion.trajectory
    n_poses = int(np.clip((motion.end_s - motion.begin_s) * trajectory.rate_hz + 1, 2, most))
    nodes_mm = motion.nodes_mm(np.linspace(motion.begin_s, motion.end_s, n_poses))
    side = seen_from_the_side(motion.arm, nodes_mm)
    samples, begins = motion.pen_lines(_POINTS_A_POSE * most)
    inks = inks_of(trajectory, motion.tip_mm[:, :2])
    corners = np.empty((0, 2)) if canvas_corners_mm is None else canvas_corners_mm
    low, high = view_mm(
        [nodes_mm[..., :2].reshape(-1, 2), motion.tip_mm[:, :2], corners], reach_mm, base_of(motion.arm.paper)
    )
    margin_mm = 0.04 * float((high - low).max())
    scale_mm = max(float(np.abs(nodes_mm).max()), float(np.abs(motion.tip_mm).max()), 1.0) / _LARGEST
    near, far, right, left = paper_sides_mm(trajectory, motion.tip_mm[:, :2])
    return {
        "name": trajectory.title,
        "arm": motion.arm.name,
        "rate": trajectory.rate_hz,
        "begin": motion.begin_s,
        "end": motion.end_s,
        "speed": motion.speed_factor,
        "scale": scale_mm,
        "nodes": nodes_mm.shape[1],
        "poses": _numbers(nodes_mm / scale_mm, "<i2"),
        "line": _numbers(motion.tip_mm[samples, :2] / scale_mm, "<i2"),
        "samples": _numbers(samples, "<u4"),
        "begins": _numbers(begins, "u1"),
        "pen": _numbers(trajectory.pen_of_stroke[trajectory.stroke[samples]], "<u2"),
        "inks": [[ink.colour, ink.width_mm] for ink in inks],
        "paper": [[near, right], [far, right], [far, left], [near, left]],
        "reach": reach_mm,
        "base": base_of(motion.arm.paper),
        "level": is_seen_square_on(motion.arm),
        "canvas": corners.tolist(),
        "above": [*low.tolist(), *high.tolist()],
        "beside": [
            float(side[..., 0].min()) - margin_mm,
            min(float(side[..., 1].min()), 0.0) - margin_mm,
            float(side[..., 0].max()) + margin_mm,
            float(side[..., 1].max()) + margin_mm,
        ],
    }


def _numbers(values: npt.NDArray[np.generic], kind: str) -> str:
    """Base64 of values as little-endian numbers of a kind, rounded."""
    return base64.b64encode(np.rint(values).astype(kind).tobytes()).decode("ascii")
