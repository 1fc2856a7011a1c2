"""Targets all over the paper, each from the arm's home: how many the nonlinear program solves, beside the restarts of
the Robotics Toolbox."""

from __future__ import annotations

import time

import numpy as np

from benchmarks.targets.row import Row, missing
from planner.arms.arm import Arm, PenHold
from planner.arms.arm_file import known_arms, load_arm
from planner.arrays import FloatArray
from planner.comparison.targets import random_targets
from planner.inverse_kinematics.nlp import NlpSolver
from planner.inverse_kinematics.references import home_of
from planner.kinematics.limits import within_limits
from planner.redundancy.arm_model import ArmModel

_TARGETS = 1000
_RIVAL = "roboticstoolbox"


def far_targets() -> list[Row]:
    """A row for each arm that comes along; the rival where it can say what the arm is: a table without couplings whose
    pen an axis points."""
    rows = []
    for name in known_arms():
        arm = load_arm(name)
        model = ArmModel(arm, cache=False)
        targets, home = random_targets(model.kinematics, _TARGETS, 1).tips_mm, home_of(model)
        solver = NlpSolver(model.kinematics)
        solver.solve(targets[0], home)
        began = time.process_time()
        found = solver.solve_sequence(targets, home, settle=False)
        each_ms = (time.process_time() - began) / len(targets) * 1e3
        n_solved = int(found.converged.sum())
        told = f"{n_solved} of {_TARGETS}, {each_ms:.2f} ms each"
        if arm.pen.hold is PenHold.TOOL_AXIS and not arm.couplings and missing(_RIVAL, "", "") is None:
            told += "; Robotics Toolbox " + _by_rival(arm, targets, home)
        rows.append(Row(f"NLP, random targets in reach of {name}, from home", "all", told, n_solved == _TARGETS))
    return rows


def _by_rival(arm: Arm, targets_mm: FloatArray, home: FloatArray) -> str:
    """Levenberg-Marquardt with up to 100 restarts within the joint limits, in metres; spin about the pen is free."""
    import roboticstoolbox

    links = [
        (roboticstoolbox.RevoluteDH if joint.file_unit == "deg" else roboticstoolbox.PrismaticDH)(
            **({"d": joint.d_mm / 1e3} if joint.file_unit == "deg" else {"theta": joint.theta_rad}),
            a=joint.a_mm / 1e3,
            alpha=joint.alpha_rad,
            offset=joint.theta_rad if joint.file_unit == "deg" else joint.d_mm / 1e3,
            qlim=np.array([joint.minimum, joint.maximum]) / (1.0 if joint.file_unit == "deg" else 1e3),
        )
        for joint in arm.joints
    ]
    chain = roboticstoolbox.DHRobot(links).ets()
    scale = np.array([1.0 if joint.file_unit == "deg" else 1e3 for joint in arm.joints])
    n_solved, began = 0, time.process_time()
    for target in targets_mm:
        pose = np.eye(4)
        pose[:3, :3] = _pointing_down(np.array(arm.pen.tool_axis))
        pose[:3, 3] = target / 1e3
        found = chain.ik_LM(pose, q0=home / scale, mask=np.array([1, 1, 1, 1, 1, 0]), joint_limits=True, tol=1e-12)
        joints = np.ravel(found.q) * scale
        n_solved += bool(np.all(found.success)) and bool(within_limits(arm, joints))
    return f"{n_solved}, {(time.process_time() - began) / len(targets_mm) * 1e3:.2f} ms each"


def _pointing_down(tool_axis: FloatArray) -> FloatArray:
    """(3, 3) a rotation that takes the tool axis straight down."""
    side = np.cross(tool_axis, np.eye(3)[int(np.abs(tool_axis).argmin())])
    side /= np.linalg.norm(side)
    own = np.column_stack((tool_axis, side, np.cross(tool_axis, side)))
    return np.column_stack(([0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0])) @ own.T
