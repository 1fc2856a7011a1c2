"""What the page shows of a trajectory. It loads no solver and no plots: people wait for it after every plan."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from planner.arms.arm import Arm
from planner.arms.description import arm_description
from planner.arrays import FloatArray
from planner.pens import hex_of
from planner.pictures import motion_for_film
from planner.plots.film_values import MOST_POSES, film_of
from planner.plots.motion import link_thicknesses_mm
from planner.plots.samples import finite_difference
from planner.trajectory import Trajectory


def film_view(trajectory: Trajectory, arm: Arm) -> dict[str, Any]:
    """The film, with the joints' positions, extremes and limits in the units of the arm file, how thick links are,
    where the paper is in the base frame, and what is drawn by which pen. Plain values for JSON."""
    every = max(-(-trajectory.n_samples // MOST_POSES), 1)
    return film_of(motion_for_film(trajectory, arm)) | {
        "n_samples": trajectory.n_samples,
        "every": every,
        "positions": _packed(trajectory.positions[::every]),
        "joints": arm_description(arm)["joints"],
        "extremes": _extremes(trajectory),
        "thicknesses_mm": link_thicknesses_mm(arm),
        "T_base_paper": arm.paper.T_base_paper.round(9).tolist(),
        "pens": [{"name": pen.name, "colour": hex_of(pen.colour), "width_mm": pen.width_mm} for pen in trajectory.pens],
        "pen_changes": list(trajectory.pen_changes),
    }


def _extremes(trajectory: Trajectory) -> list[dict[str, float]]:
    """Of each joint: its least and greatest position, and its greatest speed and acceleration."""
    positions, rate_hz = trajectory.positions, trajectory.rate_hz
    fastest, hardest = (np.abs(finite_difference(positions, rate_hz, order)[1]).max(axis=0) for order in (1, 2))
    names = ("min", "max", "velocity", "acceleration")
    figures = zip(positions.min(axis=0), positions.max(axis=0), fastest, hardest, strict=True)
    return [dict(zip(names, map(float, joint), strict=True)) for joint in figures]


def _packed(values: FloatArray) -> str:
    """Base64 of 32 bit floats."""
    return base64.b64encode(values.astype("<f4").tobytes()).decode("ascii")
