"""Targets per second of the closed forms, beside general solvers on the same targets.

    OMP_NUM_THREADS=1 python benchmarks/closed_forms.py [--targets N] [--compared N] [--seed N]

Targets are the poses of random configurations within the limits. A closed form gives all branches of a million of them;
ikpy, pin (closed-loop inverse kinematics) and the Robotics Toolbox's compiled Levenberg-Marquardt solver (`ik_LM`),
where they are installed (extra `benchmark`), give one configuration to each of the first few, from the middle of
the ranges and with their own restarts.

A target counts as solved where the tip is met to 0.01 mm and, unless the arm holds the tip alone, the axes of the frame
to 1e-4. Of the solved ones `outside` is the share whose configuration breaks a joint limit, whole turns taken off; for
closed forms, whose branches none keeps the limits. The error is the worst of the solved ones.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from importlib.util import find_spec

import numpy as np

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arms.arm_file import load_arm
from planner.arrays import BoolArray, FloatArray
from planner.inverse_kinematics.closed_forms import FAMILIES
from planner.inverse_kinematics.closed_forms.branches import Branches
from planner.kinematics.limits import within_limits

ARMS = ("drawing_arm", "scara", "three_joint", "six_joint", "stanford")
Solver = Callable[[FloatArray], FloatArray]
"""A pose (4, 4) in mm to joints (n_joints,), rad or mm; NaN where the solver gives up."""


def fixed_parts(arm: Arm) -> tuple[list[FloatArray], FloatArray]:
    """The chain as fixed transforms in metres, one before each joint, which acts along z, and one after the last."""
    before, after = [], np.eye(4)
    for joint in arm.joints:
        c, s = np.cos(joint.theta_rad), np.sin(joint.theta_rad)
        ca, sa = np.cos(joint.alpha_rad), np.sin(joint.alpha_rad)
        revolute = joint.kind is JointKind.REVOLUTE
        turn = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        shift = np.array([[1, 0, 0, joint.a_mm / 1e3], [0, ca, -sa, 0], [0, sa, ca, joint.d_mm / 1e3], [0, 0, 0, 1]])
        before.append(after if revolute else after @ turn)
        after = turn @ shift if revolute else shift
    return before, after


def poses(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n, 4, 4) in mm of joints (n, n_joints)."""
    before, after = fixed_parts(arm)
    pose = np.tile(np.eye(4), (len(joints), 1, 1))
    for fixed, joint, value in zip(before, arm.joints, joints.T, strict=True):
        moved = np.tile(np.eye(4), (len(joints), 1, 1))
        if joint.kind is JointKind.REVOLUTE:
            moved[:, 0, 0] = moved[:, 1, 1] = np.cos(value)
            moved[:, 1, 0] = np.sin(value)
            moved[:, 0, 1] = -moved[:, 1, 0]
        else:
            moved[:, 2, 3] = value / 1e3
        pose = pose @ fixed @ moved
    pose = pose @ after
    pose[:, :3, 3] *= 1e3
    return pose


def misses(arm: Arm, joints: FloatArray, target: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distance of the tip (n,) in mm, and the greatest difference of axes (n,), 0 where only the tip is held."""
    difference = poses(arm, joints) - target
    turned = np.abs(difference[:, :3, :3]).max(axis=(1, 2)) * (arm.n_joints > 3)
    return np.linalg.norm(difference[:, :3, 3], axis=1), turned


def middle(arm: Arm) -> FloatArray:
    return (arm.minimum + arm.maximum) / 2


def in_si(arm: Arm) -> FloatArray:
    """(n_joints,) rad or m in one rad or mm."""
    return np.array([1.0 if joint.kind is JointKind.REVOLUTE else 1e-3 for joint in arm.joints])


def in_metres(pose: FloatArray) -> FloatArray:
    scaled = pose.copy()
    scaled[:3, 3] /= 1e3
    return scaled


def ikpy_solver(arm: Arm) -> Solver:
    from ikpy.chain import Chain
    from ikpy.link import OriginLink, URDFLink

    before, after = fixed_parts(arm)
    si = in_si(arm)
    along = {
        JointKind.REVOLUTE: {"rotation": [0, 0, 1]},
        JointKind.PRISMATIC: {"translation": [0, 0, 1], "joint_type": "prismatic"},
    }
    links = [OriginLink()]
    for fixed, joint, unit in zip(before, arm.joints, si, strict=True):
        links.append(
            URDFLink(
                joint.name,
                fixed[:3, 3],
                _roll_pitch_yaw(fixed),
                **along[joint.kind],
                bounds=(joint.minimum * unit, joint.maximum * unit),
            )
        )
    links.append(URDFLink("tool", after[:3, 3], _roll_pitch_yaw(after), joint_type="fixed"))
    chain = Chain(links, active_links_mask=[False, *[True] * arm.n_joints, False])
    start = np.concatenate(([0.0], middle(arm) * si, [0.0]))
    whole = "all" if arm.n_joints > 3 else None

    def solve(pose: FloatArray) -> FloatArray:
        found = chain.inverse_kinematics_frame(in_metres(pose), initial_position=start, orientation_mode=whole)
        return found[1:-1] / si

    return solve


def _roll_pitch_yaw(transform: FloatArray) -> list[float]:
    r = transform[:3, :3]
    return [
        float(np.arctan2(r[2, 1], r[2, 2])),
        float(np.arctan2(-r[2, 0], np.hypot(r[2, 1], r[2, 2]))),
        float(np.arctan2(r[1, 0], r[0, 0])),
    ]


def pin_solver(arm: Arm, iterations: int = 200, step: float = 0.5, damping: float = 1e-8) -> Solver:
    import pinocchio as pin

    before, after = fixed_parts(arm)
    si = in_si(arm)
    model = pin.Model()
    last = 0
    for fixed, joint in zip(before, arm.joints, strict=True):
        kind = pin.JointModelRZ() if joint.kind is JointKind.REVOLUTE else pin.JointModelPZ()
        last = model.addJoint(last, kind, pin.SE3(fixed), joint.name)
    data = model.createData()
    tool = pin.SE3(after)
    start = middle(arm) * si

    def solve(pose: FloatArray) -> FloatArray:
        q = start.copy()
        target = pin.SE3(in_metres(pose))
        for _ in range(iterations):
            pin.forwardKinematics(model, data, q)
            error_pose = target.actInv(data.oMi[last] * tool)
            jacobian = tool.toActionMatrixInverse() @ pin.computeJointJacobian(model, data, q, last)
            if arm.n_joints > 3:
                error = pin.log6(error_pose).vector
                jacobian = pin.Jlog6(error_pose) @ jacobian
            else:
                error = error_pose.translation
                jacobian = error_pose.rotation @ jacobian[:3]
            if np.linalg.norm(error) < 1e-7:
                break
            gram = jacobian @ jacobian.T + damping * np.eye(len(error))
            q = q - step * jacobian.T @ np.linalg.solve(gram, error)
        return q / si

    return solve


def toolbox_solver(arm: Arm) -> Solver:
    import roboticstoolbox as rtb

    si = in_si(arm)
    links = []
    for joint, unit in zip(arm.joints, si, strict=True):
        limits = [joint.minimum * unit, joint.maximum * unit]
        if joint.kind is JointKind.REVOLUTE:
            links.append(
                rtb.RevoluteDH(
                    d=joint.d_mm / 1e3, a=joint.a_mm / 1e3, alpha=joint.alpha_rad, offset=joint.theta_rad, qlim=limits
                )
            )
        else:
            links.append(
                rtb.PrismaticDH(
                    theta=joint.theta_rad,
                    a=joint.a_mm / 1e3,
                    alpha=joint.alpha_rad,
                    offset=joint.d_mm / 1e3,
                    qlim=limits,
                )
            )
    chain = rtb.DHRobot(links).ets()
    start = middle(arm) * si
    weights = np.array([1.0, 1, 1, 1, 1, 1] if arm.n_joints > 3 else [1.0, 1, 1, 0, 0, 0])

    def solve(pose: FloatArray) -> FloatArray:
        found = chain.ik_LM(in_metres(pose), q0=start, tol=1e-13, mask=weights, joint_limits=True)
        return found.q / si if found.success else np.full(arm.n_joints, np.nan)

    return solve


OTHERS: dict[str, tuple[str, Callable[[Arm], Solver]]] = {
    "ikpy": ("ikpy", ikpy_solver),
    "pin, CLIK": ("pinocchio", pin_solver),
    "Robotics Toolbox, ik_LM": ("roboticstoolbox", toolbox_solver),
}


def row(arm: Arm, solver: str, n: int, seconds: float, solved: BoolArray, outside: BoolArray, off: FloatArray) -> None:
    worst = f"{off[solved].max():.1e}" if solved.any() else "-"
    broken = f"{outside[solved].mean():.1%}" if solved.any() else "-"
    rate = f"{n / seconds:,.0f}"
    print(f"| {arm.name} | {solver} | {n} | {rate} | {solved.mean():.1%} | {broken} | {worst} |", flush=True)


def closed_form(arm: Arm, target: FloatArray, joints: FloatArray) -> None:
    family = FAMILIES[arm.name]
    tip = np.ascontiguousarray(target[:, :3, 3])
    heading = np.arctan2(target[:, 1, 0], target[:, 0, 0]) - np.arctan2(tip[:, 1], tip[:, 0])
    chosen = joints[:, 1:4].sum(axis=1) if arm.name == "drawing_arm" else heading
    calls: dict[str, Callable[[], Branches]] = {}
    if arm.pen.hold is not PenHold.TOOL_AXIS:  # whose `at_tip` meets poses that point down, not these
        calls["at_tip"] = lambda: family.at_tip(arm, tip, chosen)
    if family.at_pose is not None:
        at_pose = family.at_pose
        calls["at_pose"] = lambda: at_pose(arm, target)
    for name, call in calls.items():
        call()
        began = time.perf_counter()
        branches = call()
        seconds = time.perf_counter() - began
        inside = within_limits(arm, arm.complete(branches.configurations))
        best = np.where(inside.any(axis=1), inside.argmax(axis=1), branches.exist.argmax(axis=1))
        found = arm.complete(branches.configurations[np.arange(len(target)), best])
        off, turned = misses(arm, found, target)
        solved = (off < 0.01) & (turned < 1e-4)
        count = branches.configurations.shape[1]
        row(arm, f"closed form, {name}, {count} branches", len(target), seconds, solved, ~inside.any(axis=1), off)


def compared(arm: Arm, target: FloatArray) -> None:
    revolute = np.array([joint.kind is JointKind.REVOLUTE for joint in arm.joints])
    for name, (package, build) in OTHERS.items():
        if find_spec(package) is None:
            print(f"| {arm.name} | {name} | not installed | | | | |")
            continue
        solve = build(arm)
        solve(target[0])
        began = time.perf_counter()
        found = np.array([solve(pose) for pose in target])
        seconds = time.perf_counter() - began
        found -= np.where(revolute, 2 * np.pi * np.rint((found - middle(arm)) / (2 * np.pi)), 0.0)
        off, turned = misses(arm, found, target)
        outside = ((found < arm.minimum - 1e-6) | (found > arm.maximum + 1e-6)).any(axis=1)
        row(arm, name, len(target), seconds, (off < 0.01) & (turned < 1e-4), outside, off)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--targets", type=int, default=1_000_000, help="for the closed forms")
    parser.add_argument("--compared", type=int, default=200, help="of them, for the other solvers")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    print("| arm | solver | targets | targets/s | solved | outside | worst error, mm |")
    print("|---|---|---:|---:|---:|---:|---:|")
    for name in ARMS:
        arm = load_arm(name)
        independent = list(arm.independent_joints)
        joints = np.empty((0, arm.n_joints))
        while len(joints) < options.targets:
            drawn = arm.complete(
                rng.uniform(arm.minimum[independent], arm.maximum[independent], (options.targets, len(independent)))
            )
            joints = np.concatenate((joints, drawn[((drawn >= arm.minimum) & (drawn <= arm.maximum)).all(axis=1)]))
        joints = joints[: options.targets]
        target = poses(arm, joints)
        closed_form(arm, target, joints)
        compared(arm, target[: options.compared])


if __name__ == "__main__":
    main()
