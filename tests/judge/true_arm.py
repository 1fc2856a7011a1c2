"""True arms: what somebody holds in the hand, drawn at random about what an arm file says.

Nothing here knows the planner's error model. Curves are a cubic through the measured shape plus sines; play and dead
band are two elements in series; frames have a phase of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray

_SINES = 3


@dataclass(frozen=True, eq=False)
class TrueArm:
    """An arm with every error. All arrays have one entry a joint, angles in rad, lengths in mm.

    shape: (n, 4) cubic of the joint's angle in its normalised pulse, lowest power first; sines: (n, 3, 3) amplitude,
    half-turns over the range and phase of each; middle_us, half_us: what normalises pulses. T_sheet_base: (4, 4).
    play_low, play_high: how far the joint may stand below and above its gear.
    """

    theta: FloatArray
    d_mm: FloatArray
    a_mm: FloatArray
    alpha: FloatArray
    middle_us: FloatArray
    half_us: FloatArray
    shape: FloatArray
    sines: FloatArray
    play_low: FloatArray
    play_high: FloatArray
    dead_band: FloatArray
    resolution_us: float
    frame_s: float
    phase_s: FloatArray
    lag_s: FloatArray
    max_speed: float
    T_sheet_base: FloatArray

    def angles(self, pulses_us: FloatArray) -> FloatArray:
        """(..., n) where the servos would turn the joints, rad."""
        u = (pulses_us - self.middle_us) / self.half_us
        angle = self.shape[:, 0] + u * (self.shape[:, 1] + u * (self.shape[:, 2] + u * self.shape[:, 3]))
        for k in range(_SINES):
            amplitude, turns, phase = self.sines[:, k].T
            angle = angle + amplitude * np.sin(np.pi * turns * u + phase)
        return angle

    def tip_mm(self, joints: FloatArray) -> FloatArray:
        """(m, 3) the tip of the pen over the sheet at joints (m, n)."""
        m = len(joints)
        point, turn = np.zeros((m, 3)), np.broadcast_to(np.eye(3), (m, 3, 3))
        for k in range(joints.shape[1]):
            angle = joints[:, k] + self.theta[k]
            c, s = np.cos(angle), np.sin(angle)
            ca, sa = np.cos(self.alpha[k]), np.sin(self.alpha[k])
            zero = np.zeros(m)
            step = np.stack((self.a_mm[k] * c, self.a_mm[k] * s, zero + self.d_mm[k]), axis=1)
            point = point + np.einsum("mij,mj->mi", turn, step)
            local = np.stack(
                (
                    np.stack((c, -s * ca, s * sa), 1),
                    np.stack((s, c * ca, -c * sa), 1),
                    np.stack((zero, zero + sa, zero + ca), 1),
                ),
                1,
            )
            turn = turn @ local
        return point @ self.T_sheet_base[:3, :3].T + self.T_sheet_base[:3, 3]


def random_arm(arm: Arm, rng: np.random.Generator, *, gravity: tuple[str, ...] = ()) -> TrueArm:
    """A true arm of the kind of `arm`. gravity: names of joints that their load keeps on one side of their play."""
    n = arm.n_joints
    middle, half, shape, sines = np.empty(n), np.empty(n), np.empty((n, 4)), np.empty((n, _SINES, 3))
    us_per_rad = np.empty(n)
    for k, joint in enumerate(arm.joints):
        assert joint.servo is not None
        table = np.array(joint.servo.curve)
        angle, pulse = joint.servo.direction * table[:, 0], table[:, 1] + joint.servo.trim_us
        inside = np.linspace(joint.minimum, joint.maximum, 60)
        order = np.argsort(angle)
        ends = np.interp([joint.minimum, joint.maximum], angle[order], pulse[order])
        middle[k], half[k] = ends.mean(), abs(np.diff(ends)[0]) / 2
        u = (np.interp(inside, angle[order], pulse[order]) - middle[k]) / half[k]
        slope = np.polyfit(u, inside, 1)
        shape[k] = (slope[1], slope[0] * rng.uniform(0.95, 1.05), 0.0, 0.0)
        # The bend: a square, a cube and sines, whose line residual is drawn between 0.4 and 1.3 degrees.
        bend = rng.normal(0, (1.0, 0.7))
        waves = np.column_stack(
            (
                rng.normal(0, (0.7, 0.4, 0.25)),
                rng.uniform((0.5, 1.0, 1.6), (1.0, 1.6, 2.4)),
                rng.uniform(0, 2 * np.pi, _SINES),
            )
        )
        grid = np.linspace(-1, 1, 81)
        values = bend[0] * grid**2 + bend[1] * grid**3 + sum(a * np.sin(np.pi * f * grid + p) for a, f, p in waves)
        line = np.polyfit(grid, values, 1)
        rough = np.sqrt(np.mean((values - np.polyval(line, grid)) ** 2))
        scale = np.radians(rng.uniform(0.4, 1.3)) / rough
        shape[k] += scale * np.array([-line[1], -line[0], bend[0], bend[1]])
        waves[:, 0] *= scale
        sines[k] = waves
        us_per_rad[k] = abs(half[k] / shape[k, 1])
    shape[:, 0] += np.radians(rng.uniform(-2, 2, n))
    play = np.radians(rng.uniform(0.5, 1.5, n))
    low, high = play.copy(), play.copy()
    for name in gravity:
        k = [joint.name for joint in arm.joints].index(name)
        low[k], high[k] = play[k], -play[k]  # always at the lower end
    fixed = np.array([[joint.theta_rad, joint.d_mm, joint.a_mm, joint.alpha_rad] for joint in arm.joints])
    has_length = np.abs(fixed[:, 1:3]) > 0
    lengths = fixed[:, 1:3] + has_length * rng.uniform(-1, 1, (n, 2))
    return TrueArm(
        theta=fixed[:, 0],
        d_mm=lengths[:, 0],
        a_mm=lengths[:, 1],
        alpha=fixed[:, 3] + np.radians(rng.uniform(-0.3, 0.3, n)),
        middle_us=middle,
        half_us=half,
        shape=shape,
        sines=sines,
        play_low=low,
        play_high=high,
        dead_band=rng.uniform(3, 7, n) / us_per_rad,
        resolution_us=0.5,
        frame_s=0.02,
        phase_s=rng.uniform(0, 0.02, n),
        lag_s=rng.uniform(0.012, 0.03, n),
        max_speed=np.radians(450.0),
        T_sheet_base=_pose(
            rng.uniform(-2, 2, 2),
            np.radians(rng.uniform(-1, 1)),
            rng.uniform(-1, 1),
            np.radians(rng.uniform(-0.5, 0.5, 2)),
        ),
    )


def _pose(place_mm: FloatArray, yaw: float, height_mm: float, tilts: FloatArray) -> FloatArray:
    cy, sy, (tx, ty) = np.cos(yaw), np.sin(yaw), tilts
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    about_x = np.array([[1, 0, 0], [0, np.cos(tx), -np.sin(tx)], [0, np.sin(tx), np.cos(tx)]])
    about_y = np.array([[np.cos(ty), 0, np.sin(ty)], [0, 1, 0], [-np.sin(ty), 0, np.cos(ty)]])
    pose = np.eye(4)
    pose[:3, :3] = about_z @ about_x @ about_y
    pose[:3, 3] = (*place_mm, height_mm)
    return pose
