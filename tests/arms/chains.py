"""Arms for tests of the kinematics: those that come along, variants of them, chains made up at random, and the
product of Denavit-Hartenberg matrices that all of them are measured against."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import pi
from pathlib import Path

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from planner.arms.arm import Arm, Coupling, Joint, JointKind, Pen, PenHold, Workspace
from planner.arms.arm_file import arms_folder, load_arm, read_arm_file
from planner.arms.rigid_transform import IDENTITY, RigidTransform
from planner.arrays import FloatArray, frozen
from planner.inverse_kinematics.nlp import NlpSolver
from planner.inverse_kinematics.references import References, references_of
from planner.kinematics.chain import Kinematics
from planner.redundancy.arm_model import ArmModel
from planner.settings import ConfigurationWeights, Method

_WEIGHTS = ConfigurationWeights()

DRAWING_ARMS = ("drawing_arm", "drawing_arm_2022")

load_once = lru_cache(load_arm)
model_of = lru_cache(ArmModel)
"""One model for each arm: tests of the same arm do not wait for its configuration map again."""


def kinematics_of(arm: Arm) -> Kinematics:
    return model_of(arm).kinematics


@lru_cache
def solver_of(arm: Arm) -> NlpSolver:
    return NlpSolver(kinematics_of(arm))


def references_for(arm: Arm, method: Method, weights: ConfigurationWeights = _WEIGHTS) -> References:
    """The method, ready for the arm."""
    return references_of(model_of(arm), method, weights)


def dh_matrix(theta: float, d: float, a: float, alpha: float) -> FloatArray:
    """Rz(theta) Tz(d) Tx(a) Rx(alpha), multiplied out from its four factors."""
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    turn = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    shift = np.array([[1, 0, 0, a], [0, 1, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])
    twist = np.array([[1, 0, 0, 0], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1]])
    return turn @ shift @ twist


def dh_frames(arm: Arm, joints: FloatArray) -> list[FloatArray]:
    """Frames 0..n of one configuration (n_joints,), each 4 x 4 in mm."""
    frames = [np.eye(4)]
    for joint, value in zip(arm.joints, joints, strict=True):
        turn, slide = (value, 0.0) if joint.kind is JointKind.REVOLUTE else (0.0, value)
        row = dh_matrix(joint.theta_rad + turn, joint.d_mm + slide, joint.a_mm, joint.alpha_rad)
        frames.append(frames[-1] @ transform_matrix(joint.origin) @ row)
    frames[-1] = frames[-1] @ transform_matrix(arm.tool)
    return frames


@lru_cache
def transform_matrix(transform: RigidTransform) -> FloatArray:
    """Its turns about fixed axes, roll first, and then its shift; read only."""
    matrix = np.eye(4)
    angles = (transform.roll_rad, transform.pitch_rad, transform.yaw_rad)
    matrix[:3, :3] = Rotation.from_euler("xyz", angles).as_matrix()
    matrix[:3, 3] = transform.x_mm, transform.y_mm, transform.z_mm
    return frozen(matrix)


def tips_by_product(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n, 3) tips of configurations (n, n_joints)."""
    return np.array([dh_frames(arm, configuration)[-1][:3, 3] for configuration in joints])


def variant(folder: Path, lengths_mm: tuple[float, float, float, float, float]) -> Arm:
    """The drawing arm with other links, L1 .. L5, by way of an arm file."""
    head, base, *links = (arms_folder() / "drawing_arm.toml").read_text(encoding="utf-8").split("[[joints]]")
    old = "_mm = 50.0"
    parts = [head, base.replace("d" + old, f"d_mm = {lengths_mm[0]}")]
    parts += [link.replace("a" + old, f"a_mm = {length}") for link, length in zip(links, lengths_mm[1:], strict=True)]
    file = folder / "variant.toml"
    file.write_text("[[joints]]".join(parts), encoding="utf-8")
    arm = read_arm_file(file)
    assert (arm.joints[0].d_mm, *(joint.a_mm for joint in arm.joints[1:])) == lengths_mm
    return arm


def thick(arm: Arm, **thickness_mm: float) -> Arm:
    """The arm with links that thick; unless some are named, with 30 mm for all that have a length."""
    default = None if thickness_mm else 30.0
    return replace(
        arm,
        joints=tuple(
            replace(joint, thickness_mm=thickness_mm.get(joint.name, joint.thickness_mm or default))
            for joint in arm.joints
        ),
    )


_LENGTHS_MM = st.sampled_from([0.0, 20.0, 35.0, 50.0, -15.0])
_TWISTS_RAD = st.one_of(st.sampled_from([0.0, pi / 2, -pi / 2, pi]), st.floats(-pi, pi))


_TRANSFORMS = st.one_of(
    st.just(IDENTITY),
    st.builds(RigidTransform, _LENGTHS_MM, _LENGTHS_MM, _LENGTHS_MM, _TWISTS_RAD, _TWISTS_RAD, _TWISTS_RAD),
)


@st.composite
def chains(draw: st.DrawFn) -> Arm:
    """Two to seven joints of both kinds in any arrangement, with origins and a tool, now and then with a coupling."""
    kinds = draw(
        st.lists(st.sampled_from([JointKind.REVOLUTE, JointKind.REVOLUTE, JointKind.PRISMATIC]), min_size=2, max_size=7)
    )
    joints = tuple(
        Joint(
            f"j{index}",
            kind,
            draw(_TWISTS_RAD),
            draw(_LENGTHS_MM),
            draw(_LENGTHS_MM),
            draw(_TWISTS_RAD),
            -2.0,
            2.0,
            3.0,
            30.0,
            300.0,
            origin=draw(_TRANSFORMS),
        )
        for index, kind in enumerate(kinds)
    )
    turning = [index for index, kind in enumerate(kinds) if kind is JointKind.REVOLUTE]
    couplings: tuple[Coupling, ...] = ()
    if len(turning) > 1 and draw(st.booleans()):
        mimic, *others = draw(st.permutations(turning))
        weights = draw(st.lists(st.floats(-2, 2), min_size=len(others), max_size=len(others)))
        couplings = (Coupling(mimic, draw(st.floats(-pi, pi)), tuple(zip(others, weights, strict=True))),)
    hold = draw(st.sampled_from([PenHold.TOOL_AXIS, PenHold.FREE]))
    return Arm(
        "chain",
        "made for tests",
        joints,
        couplings,
        Pen(hold, (0.6, 0.0, -0.8), 5.0, 1.0),
        Workspace(0.0, 1.0),
        tool=draw(_TRANSFORMS),
    )


def random_configurations(arm: Arm, seed: int, count: int) -> FloatArray:
    """(count, n_independent) configurations with the independent joints anywhere within their limits."""
    independent = list(arm.independent_joints)
    return np.random.default_rng(seed).uniform(
        arm.minimum[independent], arm.maximum[independent], (count, len(independent))
    )


def reachable_configurations(arm: Arm, seed: int, count: int) -> FloatArray:
    """(count, n_independent) configurations with all joints, mimic ones too, within their limits, drawn from 40 times
    as many."""
    independent = random_configurations(arm, seed, 40 * count)
    joints = arm.complete(independent)
    kept = independent[((joints >= arm.minimum) & (joints <= arm.maximum)).all(axis=1)]
    assert len(kept) >= count
    return kept[:count]
