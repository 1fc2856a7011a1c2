"""Errata of the source documents: each formula as it is printed and as it is correct, against the chain itself.

Every test holds for the correct version and would fail for the printed one, which it shows to be off. The rows are
those of docs/mathematics.md; misprinted figures of the iteration table and of the SCARA's null space are tested
where the figures are, in tests/inverse_kinematics/test_dls.py and tests/inverse_kinematics/closed_forms.
"""

from __future__ import annotations

from dataclasses import replace
from functools import reduce

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.closed_forms import scara, six_joint, three_joint
from planner.kinematics.frame_jacobian import frame_jacobian
from planner.kinematics.joint_time import joint_time_s
from planner.workspace.canvas import documented_canvas, geometric_reach_mm, optimal_canvas
from tests.arms.chains import dh_frames, dh_matrix, kinematics_of, load_once, model_of

RNG_SEED = 20060101
OFF = 0.05
"""What a wrong version misses by at least: a twentieth of a millimetre or of a radian is far beyond rounding."""
R_MAX_MM, R_MIN_MM = 150.0, 33.0


def bare(name: str) -> Arm:
    """The arm with the documents' chain: no height of the base."""
    arm = load_once(name)
    return replace(arm, joints=(replace(arm.joints[0], d_mm=0.0), *arm.joints[1:]))


def some_configuration(arm: Arm, seed: int = RNG_SEED) -> FloatArray:
    return np.random.default_rng(seed).uniform(arm.minimum, arm.maximum)


def off(printed: FloatArray, correct: FloatArray) -> float:
    return float(np.abs(np.asarray(printed) - correct).max())


def test_order_of_the_four_factors_of_a_dh_row() -> None:
    """Kinematics of the drawing arm: the matrix printed is that of theta first, alpha last, not of the reverse."""
    theta, d, a, alpha = 0.7, 50.0, 30.0, np.pi / 2
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    matrix = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
    turn, twist = dh_matrix(theta, 0, 0, 0), dh_matrix(0, 0, 0, alpha)
    along_x, along_z = dh_matrix(0, 0, a, 0), dh_matrix(0, d, 0, 0)
    np.testing.assert_allclose(reduce(np.matmul, (turn, along_z, along_x, twist)), matrix, atol=1e-12)
    assert off(reduce(np.matmul, (twist, along_x, along_z, turn)), np.array(matrix)) > OFF


@pytest.fixture
def drawing() -> tuple[FloatArray, list[FloatArray]]:
    """A configuration of the drawing arm that no rule holds (q5 too is free), and its frames."""
    joints = np.array([0.4, 1.1, -0.8, -0.5, 0.3])
    return joints, dh_frames(load_once("drawing_arm"), joints)


def test_first_entry_of_a12(drawing: tuple[FloatArray, list[FloatArray]]) -> None:
    joints, frames = drawing
    a12 = np.linalg.inv(frames[1]) @ frames[2]
    assert a12[0, 0] == pytest.approx(np.cos(joints[1]))
    assert abs(a12[0, 0] - np.cos(joints[0])) > OFF


def test_first_entry_of_a04_before_it_is_simplified(drawing: tuple[FloatArray, list[FloatArray]]) -> None:
    (_, s2, s3, s4, _), (c1, c2, c3, c4, _) = np.sin(drawing[0]), np.cos(drawing[0])

    def entry(printed: bool) -> float:
        return float(c1 * (c2 * (c3 * c4 - s3 * (c4 if printed else s4)) - s2 * (s3 * c4 + c3 * s4)))

    assert drawing[1][4][0, 0] == pytest.approx(entry(printed=False))
    assert abs(drawing[1][4][0, 0] - entry(printed=True)) > OFF


def test_middle_entry_of_a04(drawing: tuple[FloatArray, list[FloatArray]]) -> None:
    joints, frames = drawing
    s234 = np.sin(joints[1:4].sum())
    assert frames[4][1, 1] == pytest.approx(-np.sin(joints[0]) * s234)
    assert abs(frames[4][1, 1] + s234) > OFF


@pytest.mark.parametrize("last", [4, 5])
def test_third_row_of_a04_and_of_the_pose(drawing: tuple[FloatArray, list[FloatArray]], last: int) -> None:
    joints, frames = drawing
    total = joints[1:last].sum()
    np.testing.assert_allclose(frames[last][2, :3], [np.sin(total), np.cos(total), 0], atol=1e-12)
    assert off(np.array([np.cos(total), np.sin(total), 0]), frames[last][2, :3]) > OFF


def test_third_row_of_the_start_pose() -> None:
    """Worked example of the drawing arm: the pen points down in it."""
    arm = load_once("drawing_arm")
    row = dh_frames(arm, arm.from_file_units([0, 60, -40, -50, -60]))[-1][2]
    np.testing.assert_allclose(row, [-1, 0, 0, 35.402], atol=5e-4)
    assert off(np.array([0, 1, 0, 35.402]), row) > OFF


def test_largest_radius() -> None:
    """Only where first and last link are of one length, as in the worked example, do plus and minus agree."""
    arm = load_once("drawing_arm")
    shorter = replace(arm, joints=(*arm.joints[:4], replace(arm.joints[4], a_mm=30.0)))
    l1, l5 = 50.0, 30.0
    reach = geometric_reach_mm(model_of(shorter))
    assert reach == pytest.approx(np.sqrt(150.0**2 - (l5 - l1) ** 2), abs=1e-4)
    assert abs(reach - np.sqrt(150.0**2 + (l5 - l1) ** 2)) > OFF


def test_derivative_of_the_area_of_the_drawing() -> None:
    def area(angle: float) -> float:
        return float(2 * np.sin(angle) * R_MAX_MM * (np.cos(angle) * R_MAX_MM - R_MIN_MM))

    def derivative(angle: float, printed: bool) -> float:
        s, c = np.sin(angle), np.cos(angle)
        other = -s * R_MAX_MM - (R_MIN_MM if printed else 0)
        return float(2 * c * R_MAX_MM * (c * R_MAX_MM - R_MIN_MM) + 2 * s * R_MAX_MM * other)

    for angle in (0.3, 0.6, 0.9):
        slope = (area(angle + 1e-5) - area(angle - 1e-5)) / 2e-5
        assert derivative(angle, printed=False) == pytest.approx(slope, rel=1e-6)
        assert abs(derivative(angle, printed=True) - slope) > 1000.0
    best = optimal_canvas(R_MAX_MM, R_MIN_MM)
    assert derivative(float(np.arctan2(best.left_mm, best.far_mm)), printed=False) == pytest.approx(0, abs=1e-6)


def test_root_of_the_printed_derivative() -> None:
    """`r sin 2t = sqrt(2) sin t` has `cos t = sqrt(2) / (2 r)`, printed without the 2: the documents' rectangle is
    the largest one of neither derivative, and the true one has 15.6 % more area."""
    ratio = R_MAX_MM / R_MIN_MM
    correct, printed = np.arccos(np.sqrt(2) / (2 * ratio)), np.arccos(np.sqrt(2) / ratio)
    assert ratio * np.sin(2 * correct) == pytest.approx(np.sqrt(2) * np.sin(correct))
    assert abs(ratio * np.sin(2 * printed) - np.sqrt(2) * np.sin(printed)) > OFF
    best, documented = (make(R_MAX_MM, R_MIN_MM) for make in (optimal_canvas, documented_canvas))
    assert np.arctan2(documented.left_mm, documented.far_mm) == pytest.approx(printed - np.pi / 4)
    area, documented_area = (each.width_mm * each.height_mm for each in (best, documented))
    assert area / documented_area == pytest.approx(1.1555, abs=1e-4)


def test_sides_of_the_drawing() -> None:
    """Sides of 13.6 and 10 cm, as the worked example states, come of the angle only with both radii."""
    angle = np.arccos(np.sqrt(2) * R_MIN_MM / R_MAX_MM) - np.pi / 4
    assert 2 * R_MAX_MM * np.sin(angle) == pytest.approx(135.6, abs=0.05)
    assert R_MAX_MM * np.cos(angle) - R_MIN_MM == pytest.approx(100.8, abs=0.05)
    assert 2 * np.sin(angle) < 1 and np.cos(angle) < 1


def test_pose_of_the_scara() -> None:
    arm = bare("scara")
    q1, q2, q3, q4 = joints = np.array([0.4, 0.9, -110.0, -0.3])
    a1, a2 = (joint.a_mm for joint in arm.joints[:2])
    frame = dh_frames(arm, joints)[-1]

    def pose(turn: float, elbow: float) -> FloatArray:
        c, s = np.cos(turn), np.sin(turn)
        return np.array(
            [
                [c, -s, 0, a2 * np.cos(elbow) + a1 * np.cos(q1)],
                [s, c, 0, a2 * np.sin(elbow) + a1 * np.sin(q1)],
                [0, 0, 1, q3],
                [0, 0, 0, 1],
            ]
        )

    np.testing.assert_allclose(frame, pose(q1 + q2 + q4, q1 + q2), atol=1e-10)
    assert off(pose(q2 + q4, q2), frame) > OFF


def test_slide_of_the_scara_is_in_a23() -> None:
    frames = dh_frames(bare("scara"), np.array([0.4, 0.9, -110.0, -0.3]))
    a23 = np.linalg.inv(frames[2]) @ frames[3]
    np.testing.assert_allclose(a23, dh_matrix(0, -110.0, 0, 0), atol=1e-10)
    assert off(np.eye(4), a23) > OFF


@pytest.mark.parametrize("q2", [0.8, -0.8, 2.2])
def test_elbow_and_shoulder_angle_of_the_scara(q2: float) -> None:
    arm = bare("scara")
    joints = np.array([0.5, q2, -110.0, 0.2])
    a1, a2 = (joint.a_mm for joint in arm.joints[:2])
    x, y = dh_frames(arm, joints)[-1][:2, 3]
    C2 = (x * x + y * y - a1 * a1 - a2 * a2) / (2 * a1 * a2)
    S2 = np.sign(q2) * np.sqrt(1 - C2 * C2)
    assert np.arctan2(S2, C2) == pytest.approx(q2)
    assert abs(np.arctan2(S2 / C2, C2) - q2) > OFF
    S1 = ((a2 * C2 + a1) * y - a2 * S2 * x) / (x * x + y * y)
    C1 = ((a2 * C2 + a1) * x + a2 * S2 * y) / (x * x + y * y)
    assert np.arctan2(S1, C1) == pytest.approx(joints[0])
    assert abs(np.arctan2(S1, joints[0]) - joints[0]) > OFF  # even where the angle wanted were known


def test_the_stretched_scara_is_within_reach() -> None:
    """C2 = 1: a strict inequality would refuse the very pose (2a, 0) that the worked example goes to."""
    arm = bare("scara")
    pose = np.eye(4)
    pose[0, 3] = arm.joints[0].a_mm + arm.joints[1].a_mm
    found = scara.at_pose(arm, pose[None])
    assert found.gap_mm[0] == 0 and found.singular[0]
    np.testing.assert_allclose(dh_frames(arm, found.configurations[0, 0])[-1], pose, atol=1e-9)


def test_joint_differences_of_the_scara_s_worked_example() -> None:
    """End less start; the times printed are right, as they come of absolute values."""
    given = bare("scara")
    arm = replace(
        given,
        joints=tuple(
            replace(joint, max_velocity=speed) for joint, speed in zip(given.joints, (1.0, 2.0, 1.0, 3.0), strict=True)
        ),
    )
    pose = np.eye(4)
    pose[:2, 3] = arm.joints[0].a_mm
    assert arm.joints[0].a_mm == arm.joints[1].a_mm
    starts = scara.at_pose(arm, pose[None]).configurations[0]
    correct = np.radians([[0, -90, 0, 90], [-90, 90, 0, 0]])
    printed = np.radians([[0, -90, 0, -90], [90, 90, 0, 0]])
    np.testing.assert_allclose(np.zeros((2, 4)) - starts, correct, atol=1e-12)
    stretched = np.eye(4)
    stretched[0, 3] = 2 * arm.joints[0].a_mm
    for start, step, misprint in zip(starts, correct, printed, strict=True):
        np.testing.assert_allclose(dh_frames(arm, start + step)[-1], stretched, atol=1e-9)
        assert off(dh_frames(arm, start + misprint)[-1], stretched) > OFF
        assert joint_time_s(arm, start, start + step) == pytest.approx(joint_time_s(arm, start, start + misprint))


def test_null_space_of_the_stretched_scara() -> None:
    a1, a2 = 100.0, 70.0
    jacobian = np.array([[0, 0, 0, 0], [a1 + a2, a2, 0, 0], [0, 0, 1, 0], [1, 1, 0, 1]])  # frame 2, q2 = 0
    np.testing.assert_allclose(jacobian @ [a2, -(a1 + a2), 0, a1], 0, atol=1e-9)
    assert np.abs(jacobian @ [a2, a1 + a2, 0, a1]).max() > OFF


POINTS = [(90.0, 40.0, 30.0), (90.0, 40.0, -30.0), (-70.0, 60.0, 20.0), (-70.0, -60.0, -20.0)]


def three_joint_tip(q1: float, q2: float, q3: float) -> FloatArray:
    return dh_frames(bare("three_joint"), np.array([q1, q2, q3]))[-1][:3, 3]


def elbow_and_lead(point: tuple[float, ...]) -> tuple[float, float, float]:
    """Radius, q3 and the angle between upper arm and the way to the tip, by the documents' law of cosines."""
    _, upper, fore = bare("three_joint").joints
    x, y, z = point
    cosine = (x * x + y * y + z * z - upper.a_mm**2 - fore.a_mm**2) / (2 * upper.a_mm * fore.a_mm)
    q3 = -np.arccos(cosine)
    lead = np.arctan2(fore.a_mm * np.sin(q3), upper.a_mm + fore.a_mm * np.cos(q3))
    return float(np.hypot(x, y)), float(q3), float(lead)


@pytest.mark.parametrize("point", POINTS)
def test_elevation_of_the_three_joint_arm(point: tuple[float, float, float]) -> None:
    """Printed once as atan(y / r) and once as atan(r / z), where it is atan2(z, r)."""
    x, y, z = point
    radius, q3, lead = elbow_and_lead(point)
    waist = np.arctan2(y, x)
    np.testing.assert_allclose(three_joint_tip(waist, np.arctan2(z, radius) - lead, q3), point, atol=1e-9)
    for misprint in (np.arctan(y / radius), np.arctan(radius / z)):
        assert off(three_joint_tip(waist, misprint - lead, q3), np.array(point)) > OFF


@pytest.mark.parametrize("point", POINTS[2:])
def test_arc_tangents_lose_the_quadrant(point: tuple[float, float, float]) -> None:
    x, y, z = point
    radius, q3, lead = elbow_and_lead(point)
    shoulder = np.arctan2(z, radius) - lead
    np.testing.assert_allclose(three_joint_tip(np.arctan2(y, x), shoulder, q3), point, atol=1e-9)
    assert off(three_joint_tip(np.arctan(y / x), shoulder, q3), np.array(point)) > OFF
    found = three_joint.at_tip(bare("three_joint"), np.array([point]), np.zeros(1)).configurations[0]
    assert np.abs(found - [np.arctan2(y, x), shoulder, q3]).max(axis=1).min() < 1e-9


@pytest.fixture(params=range(4))
def decoupled(request: pytest.FixtureRequest) -> tuple[Arm, FloatArray, FloatArray]:
    """The six-joint arm, a configuration with the wrist plain (q5 above 0), and its pose."""
    arm = load_once("six_joint")
    joints = some_configuration(arm, request.param)
    joints[4] = abs(joints[4])
    return arm, joints, dh_frames(arm, joints)[-1]


def test_q4_of_the_six_joint_arm(decoupled: tuple[Arm, FloatArray, FloatArray]) -> None:
    _, joints, pose = decoupled
    (ax, ay, az), q23 = pose[:3, 2], joints[1] + joints[2]
    c1, s1, c23, s23 = np.cos(joints[0]), np.sin(joints[0]), np.cos(q23), np.sin(q23)

    def q4(sign: float) -> float:
        return float(np.arctan2(c1 * ay - s1 * ax, c23 * (c1 * ax + s1 * ay) + sign * s23 * az))

    def miss(sign: float) -> float:
        return abs(float(np.angle(np.exp(1j * (q4(sign) - joints[3])))))

    assert miss(-1.0) < 1e-9
    assert miss(1.0) > 1e-3


def test_elbow_of_the_six_joint_arm(decoupled: tuple[Arm, FloatArray, FloatArray]) -> None:
    """Its forearm is along z4: the law of cosines gives the sine of q3 where the three-joint arm has the cosine."""
    arm, joints, pose = decoupled
    l1, l2, l3, l4 = (arm.joints[0].d_mm, arm.joints[1].a_mm, arm.joints[3].d_mm, arm.joints[5].d_mm)
    centre = pose[:3, 3] - l4 * pose[:3, 2] - [0, 0, l1]
    ratio = (centre @ centre - l2**2 - l3**2) / (2 * l2 * l3)
    assert np.sin(joints[2]) == pytest.approx(ratio, abs=1e-12)
    assert abs(np.cos(joints[2]) - ratio) > 1e-3
    found = six_joint.at_pose(arm, pose[None]).configurations[0]
    np.testing.assert_allclose(np.sin(found[:, 2]), ratio, atol=1e-9)


def test_middle_entry_of_a24(drawing: tuple[FloatArray, list[FloatArray]]) -> None:
    joints, frames = drawing
    (s3, s4), (c3, c4) = np.sin(joints[2:4]), np.cos(joints[2:4])
    a24 = np.linalg.inv(frames[2]) @ frames[4]
    assert a24[1, 1] == pytest.approx(-s3 * s4 + c3 * c4)
    assert abs(a24[1, 1] - (-s3 * c4 + c3 * c4)) > OFF


def test_third_row_of_a04_before_it_is_simplified(drawing: tuple[FloatArray, list[FloatArray]]) -> None:
    """Its second entry begins with minus: plus is off by 2 s2 sin(q3 + q4)."""
    joints, frames = drawing
    (s2, s3, s4), (c2, c3, c4) = np.sin(joints[1:4]), np.cos(joints[1:4])

    def entry(sign: float) -> float:
        return float(sign * s2 * (c3 * s4 + s3 * c4) + c2 * (c3 * c4 - s3 * s4))

    assert entry(-1.0) == pytest.approx(frames[4][2, 1])
    assert entry(1.0) - frames[4][2, 1] == pytest.approx(2 * s2 * np.sin(joints[2] + joints[3]))


def test_the_jacobian_has_a_column_for_each_joint(drawing: tuple[FloatArray, list[FloatArray]]) -> None:
    """Columns for i = 1 to n, the last of them R_0^(n-1) k; one for n + 1 would be a turn that no joint makes."""
    joints, frames = drawing
    jacobian = frame_jacobian(load_once("drawing_arm"), joints[None])[0]
    assert jacobian.shape == (6, 5)
    step = 1e-6
    for i in range(5):
        np.testing.assert_allclose(jacobian[3:, i], frames[i][:3, 2], atol=1e-12)
        moved = dh_frames(load_once("drawing_arm"), joints + step * np.eye(5)[i])[-1]
        spin = (moved[:3, :3] @ frames[-1][:3, :3].T - np.eye(3)) / step
        np.testing.assert_allclose([spin[2, 1], spin[0, 2], spin[1, 0]], jacobian[3:, i], atol=1e-5)


def test_target_of_the_worked_example_on_the_arm() -> None:
    """The canvas point (2, 8) cm: x of a rounded height beside y of an exact width is neither of the two."""
    canvas = documented_canvas(R_MAX_MM, R_MIN_MM)

    def arm_cm(width: float, height: float) -> tuple[float, float]:
        return R_MIN_MM / 10 + height - 8.0, width / 2 - 2.0

    exact = arm_cm(canvas.width_mm / 10, canvas.height_mm / 10)
    np.testing.assert_allclose(exact, (5.38, 4.78), atol=5e-3)
    np.testing.assert_allclose(arm_cm(13.6, 10.0), (5.3, 4.8), atol=1e-9)
    for right in (exact, (5.3, 4.8)):
        assert max(abs(5.3 - right[0]), abs(4.78 - right[1])) > 0.015


def test_products_in_the_first_column_of_the_scara_s_jacobian() -> None:
    """z of p x x2 and of p x y2, with p from the base to the tip, against the Jacobian in frame 2."""
    arm = bare("scara")
    joints = np.array([0.4, 0.9, -110.0, -0.3])
    a1, a2 = (joint.a_mm for joint in arm.joints[:2])
    q1, q12 = joints[0], joints[0] + joints[1]
    c1, s1, c12, s12 = np.cos(q1), np.sin(q1), np.cos(q12), np.sin(q12)
    x, y = a1 * c1 + a2 * c12, a1 * s1 + a2 * s12
    column = frame_jacobian(arm, joints[None], None, 2)[0, :, 0]
    assert column[0] == pytest.approx(x * s12 - y * c12)
    assert abs(column[0] - (x * s12 + y * c12)) > OFF
    assert column[1] == pytest.approx((a2 * c12 + a1 * c1) * c12 + (a2 * s12 + a1 * s1) * s12)
    assert abs(column[1] - ((a2 * c12 + a1 * s1) * c12 + (a2 * s12 + a1 * s1) * s12)) > OFF


def test_null_space_of_the_stretched_scara_s_transposed_jacobian() -> None:
    """Its first two equations are in V2: with V1 in them V1 would be 0, and the result [1, 0, 0, 0] none."""
    a1, a2 = 100.0, 70.0
    jacobian = np.array([[0, 0, 0, 0], [a1 + a2, a2, 0, 0], [0, 0, 1, 0], [1, 1, 0, 1]])  # frame 2, q2 = 0
    v1, v2, v3, wz = 0.3, -0.7, 0.2, 1.1
    np.testing.assert_allclose(jacobian.T @ [v1, v2, v3, wz], [(a1 + a2) * v2 + wz, a2 * v2 + wz, v3, wz])
    assert off(np.array([(a1 + a2) * v1 + wz, a2 * v1 + wz, v3, wz]), jacobian.T @ [v1, v2, v3, wz]) > OFF
    assert not (jacobian.T @ [1, 0, 0, 0]).any()


def test_first_two_transforms_of_the_scara() -> None:
    frames = dh_frames(bare("scara"), np.array([0.4, 0.9, -110.0, -0.3]))
    first, second = frames[1], np.linalg.inv(frames[1]) @ frames[2]
    np.testing.assert_allclose(first @ second, frames[2], atol=1e-10)
    assert off(np.linalg.inv(second) @ second, frames[2]) > OFF  # from 2 to 1 and on to 2: nothing


def test_wrist_centre_of_the_six_joint_arm(decoupled: tuple[Arm, FloatArray, FloatArray]) -> None:
    """p_m is where frames 4 and 5 begin, l4 before p_r, where frame 6 does; frame 3 begins at the elbow."""
    arm, joints, pose = decoupled
    frames = dh_frames(arm, joints)
    centre = pose[:3, 3] - arm.joints[5].d_mm * pose[:3, 2]
    for frame in (4, 5):
        np.testing.assert_allclose(frames[frame][:3, 3], centre, atol=1e-9)
    assert off(frames[6][:3, 3], centre) > OFF and off(frames[3][:3, 3], pose[:3, 3]) > OFF


def test_the_chain_that_errata_are_measured_against_is_the_planner_s() -> None:
    for name in ("drawing_arm", "scara", "three_joint", "six_joint"):
        kinematics = kinematics_of(load_once(name))
        joints = kinematics.arm.complete(kinematics.independent_of(some_configuration(kinematics.arm)))
        np.testing.assert_allclose(
            kinematics.pose(kinematics.independent_of(joints)[None])[0],
            dh_frames(kinematics.arm, joints)[-1],
            atol=1e-9,
        )
