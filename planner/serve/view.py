"""What the page shows of arms and trajectories, worked out in a process of its own:

`python -m planner.serve.view arm NAME FILE`, `python -m planner.serve.view film traj.csv FILE`.
"""

from __future__ import annotations

import base64
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arms.description import arm_description
from planner.arms.usual_servos import describes_servos
from planner.arrays import FloatArray
from planner.error_model.over_paper import expected_error
from planner.errors import PlanError, PlannerError
from planner.files import written_aside
from planner.kinematics.sensitivity import sideways_error
from planner.pens import hex_of
from planner.pictures import motion_for_film
from planner.plots.motion import link_thicknesses_mm
from planner.plots.player import film_of
from planner.plots.samples import finite_difference
from planner.redundancy.arm_model import ArmModel
from planner.trajectory import Trajectory, read_trajectory
from planner.workspace.paper_map import paper_nodes
from planner.workspace.reach import paper_in_reach

_MOST_POSES = 20_000


def arm_view(arm: Arm) -> dict[str, Any]:
    """The arm's description with its canvas, its home, and a map of its error over the paper, null out of reach: what
    is expected, mm, where the file says how joints are moved, else mm for each degree that a joint is off. Plain values
    for JSON."""
    model = ArmModel(arm)
    try:
        paper, nodes = paper_in_reach(model), paper_nodes(model)
    except PlanError as error:
        return arm_description(arm) | {"canvas_mm": None, "refusal": str(error)}
    figure = expected_error if describes_servos(arm) else sideways_error
    over_paper = nodes.map_of(figure(arm, nodes.joints))
    home = arm.complete(model.configuration_map().home[None])
    return arm_description(arm) | {
        "canvas_mm": paper.corners_arm_mm.round(3).tolist(),
        "reach_mm": [round(edge, 3) for edge in paper.reach_mm],
        "base_mm": arm.paper.T_paper_base[:2, 3].round(3).tolist(),
        "home": (home[0] / arm.per_file_unit).round(4).tolist(),
        "map": {
            "x_mm": nodes.x_mm.round(2).tolist(),
            "y_mm": nodes.y_mm.round(2).tolist(),
            "error_mm": [[None if np.isnan(cell) else round(float(cell), 4) for cell in row] for row in over_paper],
            "is_expected": describes_servos(arm),
        },
    }


def film_view(trajectory: Trajectory, arm: Arm) -> dict[str, Any]:
    """The film, with the joints' positions, extremes and limits in the units of the arm file, how thick links are,
    where the paper is in the base frame, and what is drawn by which pen. Plain values for JSON."""
    every = max(-(-trajectory.n_samples // _MOST_POSES), 1)
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


def main(arguments: list[str]) -> int:
    kind, source, target = arguments
    try:
        if kind == "arm":
            view = arm_view(load_arm(source))
        else:
            trajectory = read_trajectory(Path(source))
            view = film_view(trajectory, load_arm(trajectory.arm))
        with written_aside(Path(target)) as file:
            json.dump(view, file)  # type: ignore[arg-type]
    except PlannerError as error:
        print(f"plan: error: {error}", file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
