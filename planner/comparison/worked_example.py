"""The documents' worked example of damped least squares: its iterations as printed, in centimetres and degrees.

Three prints contradict the document's own equations; ERRATA holds what those give.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.kinematics.frame_jacobian import chain_frames

TARGET_CM = (5.3, 4.78, 0.0)
LAMBDA_SQUARED = 50.0


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the iteration table; error_plane_cm is the length of the error along the paper."""

    angles_deg: tuple[float, ...]
    position_cm: tuple[float, ...]
    error_cm: tuple[float, ...]
    error_plane_cm: float
    error_height_cm: float
    step_deg: tuple[float, ...] | None


ITERATIONS = (
    Row(
        (0.0, 60.0, -40.0, -50.0, -60.0),
        (11.5286, 0.0, 3.5402),
        (-6.2286, 4.78, -3.5402),
        7.8514,
        3.5402,
        (17.1682, -2.2615, -12.0270, -15.9491, -10.4125),
    ),
    Row(
        (17.1682, 57.7385, -52.0270, -65.9491, -20.7625),
        (9.6749, 2.9890, 0.3852),
        (-4.3749, 1.7910, -0.3852),
        4.7273,
        0.3852,
        (11.3460, 1.0395, -5.3620, -8.8522, -5.3466),
    ),
    Row(
        (28.5132, 58.7780, -57.3891, -74.8012, -16.5877),
        (7.9239, 4.3048, -0.3949),
        (-2.6239, 0.4752, 0.3949),
        2.6665,
        0.3949,
        (11.3460, 1.0395, -5.3620, -8.8522, -5.3466),
    ),
    Row(
        (35.0355, 60.6811, -59.9308, -80.4039, -10.3464),
        (6.8336, 4.7913, -0.4937),
        (-1.5336, -0.0113, 0.4937),
        1.5336,
        0.4937,
        (3.4528, 1.7899, -1.2973, -3.7633, -2.0649),
    ),
    Row(
        (38.4883, 62.4710, -61.2281, -84.1672, -7.0757),
        (6.2037, 4.9326, -0.4196),
        (-0.9037, -0.1526, 0.4196),
        0.9165,
        0.4196,
        (1.7675, 1.4167, -0.7017, -2.5655, -1.3689),
    ),
    Row(
        (40.2558, 63.8877, -61.9298, -86.7327, -5.2251),
        (5.8406, 4.9454, -0.3187),
        (-0.5406, -0.1654, 0.3187),
        0.5653,
        0.3187,
        (0.8927, 1.0451, -0.3913, -1.7422, -0.9131),
    ),
    Row(
        (41.1485, 64.9328, -62.3211, -88.4750, -4.1367),
        (5.6279, 4.9179, -0.2301),
        (-0.3279, -0.1379, 0.2301),
        0.3557,
        0.2301,
        (0.4484, 0.7434, -0.2211, -1.1724, -0.6077),
    ),
    Row(
        (41.5969, 65.6762, -62.5422, -89.6474, -3.4866),
        (5.5011, 4.8836, -0.1612),
        (-0.2011, -0.1036, 0.1612),
        0.2262,
        0.1612,
        (0.2247, 0.5167, -0.1256, -0.7815, -0.4025),
    ),
    Row(
        (41.8217, 66.1929, -62.6678, -90.4289, -3.0962),
        (5.4244, 4.8537, -0.1107),
        (-0.1244, -0.0737, 0.1107),
        0.1446,
        0.1107,
        (0.1125, 0.3532, -0.0716, -0.5166, -0.2651),
    ),
    Row(
        (41.9342, 66.5461, -62.7394, -90.9455, -2.8612),
        (5.3775, 4.8307, -0.0749),
        (-0.0775, -0.0507, 0.0749),
        0.0926,
        0.0749,
        None,
    ),
)

ERRATA: dict[tuple[int, str, int], float] = {
    (1, "angles_deg", 4): -29.7625,
    (2, "angles_deg", 0): 28.5142,
    (2, "step_deg", 0): 6.5213,
    (2, "step_deg", 1): 1.9031,
    (2, "step_deg", 2): -2.5418,
    (2, "step_deg", 3): -5.6026,
    (2, "step_deg", 4): -3.2027,
}
"""(iteration, column, joint): what the equations yield where the print differs. The five step figures are one
erratum, a row printed twice."""

_PRINTED_CM = 1e-4


def documented_start(arm: Arm) -> FloatArray | None:
    """(n_joints,) rad, the configuration that the example starts from; None for an arm that is not the documents': one
    that cannot take it, or whose tip is then elsewhere than they print."""
    angles_deg, position_cm = ITERATIONS[0].angles_deg, ITERATIONS[0].position_cm
    if arm.n_joints != len(angles_deg) or any(joint.file_unit != "deg" for joint in arm.joints):
        return None
    start = arm.from_file_units(angles_deg)
    tip_cm = chain_frames(arm, start[None])[0, -1, :3, 3] / 10
    coupled = np.allclose(arm.complete(start[list(arm.independent_joints)]), start, rtol=0, atol=1e-9)
    return start if coupled and np.allclose(tip_cm, position_cm, rtol=0, atol=_PRINTED_CM) else None
