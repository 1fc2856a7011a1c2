"""An arm in a few of the configurations that it draws in, from the side and from above."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.plots.look import USUAL, Look
from planner.plots.motion import arm_nodes, seen_from_the_side
from planner.plots.paper import PAPER_BOTTOM, PAPER_LEFT, PAPER_RIGHT, canvas_outline, place_axes
from planner.plots.paper_extent import base_of, view_mm
from planner.plots.sheet import Sheet

_TITLE, _BETWEEN = 1.6, 2.0
_LINK_PT, _JOINT_PT = 2.6, 5.0
_HIGHEST = 1.2


def plot_poses(arm: Arm, joints: FloatArray, canvas_corners_mm: FloatArray | None, look: Look = USUAL) -> Figure:
    """joints: (n, n_joints), the first drawn boldest."""
    nodes_mm = arm_nodes(arm, joints)
    side = seen_from_the_side(arm, nodes_mm)
    corners = np.empty((0, 2)) if canvas_corners_mm is None else canvas_corners_mm
    low, high = view_mm([nodes_mm[..., :2].reshape(-1, 2), corners], None, base_of(arm.paper))
    with look.style():
        sheet = Sheet(look)
        width = (sheet.width - 2 * (PAPER_LEFT + PAPER_RIGHT) - _BETWEEN) / 2
        above_height = min(float((high[0] - low[0]) / (high[1] - low[1])) * width, _HIGHEST * width)
        reach, height = float(side[..., 0].max() - side[..., 0].min()), float(side[..., 1].max())
        beside_height = min(max(height / max(reach, 1.0), 0.4) * width, _HIGHEST * width)
        beside = sheet.panel(PAPER_LEFT, PAPER_BOTTOM, width, beside_height)
        above = sheet.panel(2 * PAPER_LEFT + PAPER_RIGHT + _BETWEEN + width, PAPER_BOTTOM, width, above_height)
        _links(beside, side, look)
        beside.axhline(0.0, color=look.colours.edge, linewidth=0.8)
        beside.set_aspect("equal", adjustable="datalim")
        beside.set_xlabel("from the base (mm)")
        beside.set_ylabel("over the paper (mm)")
        beside.set_title("from the side", loc="left")
        place_axes(above, low, high, width, look.colours, base_of(arm.paper))
        above.set_title("from above", loc="left")
        if len(corners):
            above.add_patch(canvas_outline(corners, look.colours))
        _links(above, nodes_mm[..., 1::-1], look)
        return sheet.finish(arm.name, arm.source, room=_TITLE)


def _links(axes: Axes, nodes: FloatArray, look: Look) -> None:
    """nodes: (n, n_nodes, 2) as the axes have them."""
    for place, pose in reversed(list(enumerate(nodes))):
        axes.plot(
            *pose.T,
            color=look.colours.link if place == 0 else look.colours.ring_edge,
            linewidth=_LINK_PT if place == 0 else 0.6 * _LINK_PT,
            marker="o",
            markersize=_JOINT_PT if place == 0 else 0.6 * _JOINT_PT,
            solid_capstyle="round",
        )
