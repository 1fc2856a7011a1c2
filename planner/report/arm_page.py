"""The page about an arm: how it stands, what it reaches, and what its file says."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from planner.arms.arm import Arm
from planner.arms.description import arm_description
from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.plots.poses import plot_poses
from planner.plots.workspace import plot_workspace
from planner.redundancy.arm_model import ArmModel
from planner.report.markup import Markup, Section, definitions, element, joined, table
from planner.report.opening import contents, figure
from planner.report.page import page
from planner.report.pictures import picture
from planner.settings import CanvasKind
from planner.workspace.canvas import canvas_of
from planner.workspace.paper_map import paper_map
from planner.workspace.reach import paper_in_reach

_SHOWN = (0.5, 0.1, 0.9)
"""Where along the canvas, from near to far, configurations are shown."""


def arm_page(arm: Arm) -> Markup:
    """The page as text. An arm that cannot draw has one too, which says why."""
    model = ArmModel(arm)
    try:
        sections = list(_drawing(model))
        verdict = Markup("")
    except PlanError as error:
        sections = []
        verdict = element("p", f"It cannot draw: {error}", class_="bad")
    sections += _file(arm)
    return page(
        f"arm {arm.name}",
        element("h1", arm.name),
        element("p", arm.source, class_="quiet"),
        verdict,
        contents(sections),
        *(one.markup() for one in sections),
    )


def _drawing(model: ArmModel) -> Iterator[Section]:
    """Errors: PlanError where the arm cannot draw."""
    arm = model.arm
    paper = paper_in_reach(model)
    low, high = paper.reach_mm
    canvases: dict[CanvasKind, FloatArray] = {}
    refused: list[str] = []
    for kind in CanvasKind:
        try:
            canvases[kind] = canvas_of(model, kind, arm.pen.lift_mm).corners_arm_mm
        except PlanError as error:
            refused.append(f"{kind}: {error}")
    yield Section(
        "reach",
        "What it reaches",
        definitions(
            (
                ("canvas", f"{paper.width_mm:.0f} × {paper.height_mm:.0f} mm"),
                ("reach", f"{low:.0f} to {high:.0f} mm from the base"),
                ("joints", str(arm.n_joints)),
                ("pen lifts by", f"{arm.pen.lift_mm:g} mm"),
            ),
            class_="facts",
        ),
    )
    joints = configurations_on_canvas(model, paper.corners_arm_mm)
    poses = picture(
        "poses",
        "How it stands",
        "The configurations that it draws in, near, amid and far on its canvas.",
        lambda look: plot_poses(arm, joints, paper.corners_arm_mm, look),
    )
    yield Section(poses.name, poses.heading, figure(poses))
    maps = paper_map(model)
    workspace = picture(
        "workspace",
        "Its paper",
        "The canvases within its reach; how freely the pen moves there, and how far it strays where a joint is off.",
        lambda look: plot_workspace(arm.name, maps, canvases, paper.reach_mm, arm.paper, look),
    )
    none = element("ul", *(element("li", f"no {why}") for why in refused)) if refused else Markup("")
    yield Section(workspace.name, workspace.heading, joined((figure(workspace), none)))


def configurations_on_canvas(model: ArmModel, corners_mm: FloatArray) -> FloatArray:
    """(n, n_joints) on the middle line of the canvas, the middle one first."""
    near, far = corners_mm[:, 0].min(), corners_mm[:, 0].max()
    middle = corners_mm[:, 1].mean()
    tips = np.array([[near + share * (far - near), middle, 0.0] for share in _SHOWN])
    for branch in model.branches():
        independent, exact = branch.configurations_at(tips)
        if exact.all():
            break
    return model.arm.complete(independent)


def _file(arm: Arm) -> list[Section]:
    told = arm_description(arm)
    rows = [
        (
            joint["name"],
            joint["kind"],
            *_numbers(dh, ("theta_deg", "d_mm", "a_mm", "alpha_deg")),
            *_numbers(joint, ("min", "max", "max_velocity", "max_acceleration", "max_jerk")),
            joint["unit"],
        )
        for joint, dh in zip(told["joints"], told["dh"], strict=True)
    ]
    head = ("joint", "kind", "theta", "d", "a", "alpha", "min", "max", "velocity", "acceleration", "jerk", "unit")
    return [Section("file", "What its file says", table(head, rows, n_texts=2))]


def _numbers(row: dict[str, Any], keys: Sequence[str]) -> list[str]:
    return [f"{row[key]:.6g}" for key in keys]
