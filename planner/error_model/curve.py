"""The smooth curve of a servo: where its joint stands, by what the servo is told.

A Legendre series in what is told, laid over the range that the joint's limits ask for, and straight beyond: a
correction at a limit is within reach.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from planner.arrays import FloatArray

DEGREE = 9
BEND_SD_DEG = (1.8, 1.4, 1.1, 0.9, 0.7, 0.5, 0.35, 0.25)
"""Prior of the coefficients from the second power on: potentiometers bend smoothly."""
_GRID = 400
_FEWEST_ROWS = 5
_LEAST_ROUGH = 1e-5
"""rad or mm: what rounding leaves."""
_ENDS = legendre.legvander(np.array([-1.0, 1.0]), DEGREE)
_END_SLOPES = np.array([[(-1.0) ** (k + 1) * k * (k + 1) / 2, k * (k + 1) / 2] for k in range(DEGREE + 1)]).T
"""Of the Legendre polynomials at both ends: P_k'(1) = k (k + 1) / 2."""


@dataclass(frozen=True, eq=False, slots=True)
class Curve:
    """position = sum of coefficients[k] P_k(v), v = (told - middle) / half; straight on where |v| > 1.

    Position in rad or mm; coefficients: (DEGREE + 1,).
    """

    middle: float
    half: float
    coefficients: FloatArray

    def basis(self, told: FloatArray) -> FloatArray:
        """(n, DEGREE + 1) derivatives of the positions at told (n,) by the coefficients."""
        v = (told - self.middle) / self.half
        inside = np.clip(v, -1.0, 1.0)
        beyond = (v - inside)[..., None]
        ends = np.where(beyond > 0, _END_SLOPES[1], _END_SLOPES[0])
        basis: FloatArray = legendre.legvander(inside, DEGREE) + beyond * ends
        return basis

    def position(self, told: FloatArray) -> FloatArray:
        """(n,) positions of what is told (n,)."""
        position: FloatArray = self.basis(told) @ self.coefficients
        return position

    def slope(self, told: FloatArray) -> FloatArray:
        """Position by what is told, rad or mm per us or count."""
        inside = np.clip((told - self.middle) / self.half, -1.0, 1.0)
        return np.asarray(legendre.legval(inside, legendre.legder(self.coefficients)), np.float64) / self.half

    def told(self, position: FloatArray) -> FloatArray:
        """(n,) what to tell the servo for positions (n,); the curve has to be monotone."""
        grid = self.middle + self.half * np.linspace(-1.0, 1.0, _GRID)
        at = self.position(grid)
        rising = at[-1] > at[0]
        told: FloatArray = np.interp(position, at if rising else at[::-1], grid if rising else grid[::-1])
        for _ in range(3):
            told = told - (self.position(told) - position) / self.slope(told)
        return told

    @property
    def is_monotone(self) -> bool:
        return self.flattest > 0

    @property
    def flattest(self) -> float:
        """Its least slope as a share of the mean one; 0 or less where the curve turns back."""
        slope = self.slope(self.middle + self.half * np.linspace(-1.0, 1.0, _GRID))
        return float((slope / slope.mean()).min())


def smooth_curve(points: FloatArray, low: float, high: float, scale: float) -> Curve:
    """The curve through points (n, 2) of position and what is told; their roughness is noise of reading.

    Laid over positions `low` to `high`. scale: inner units in a rad of the priors. Points ascend in position; two make
    a straight line. Least squares, the bends held to their prior as far as the points are rough.
    """
    ends = np.interp([low, high], points[:, 0], points[:, 1])
    first, last = (points[1] - points[0]), (points[-1] - points[-2])
    ends[0] += min(low - points[0, 0], 0.0) * first[1] / first[0]
    ends[1] += max(high - points[-1, 0], 0.0) * last[1] / last[0]
    near = points[(points[:, 0] > low) & (points[:, 0] < high)]
    if points[0, 0] <= low:
        near = np.vstack(([low, ends[0]], near))
    if points[-1, 0] >= high:
        near = np.vstack((near, [high, ends[1]]))
    curve = Curve(float(ends.mean()), float(np.ptp(ends)) / 2, np.zeros(DEGREE + 1))
    bends = np.diag(_roughness(points) / (scale * np.radians(BEND_SD_DEG)))
    system = np.vstack((curve.basis(near[:, 1]), np.hstack((np.zeros((len(bends), 2)), bends))))
    right = np.concatenate((near[:, 0] / scale, np.zeros(len(bends))))
    coefficients = np.linalg.lstsq(system, right, rcond=None)[0]
    return Curve(curve.middle, curve.half, np.asarray(coefficients * scale, np.float64))


def _roughness(points: FloatArray) -> float:
    """sd in position of the noise in points (n, 2), from their third differences, which smooth curves have none of
    (for independent noise the variance of these is 20-fold). The least where points are too few to tell."""
    if len(points) < _FEWEST_ROWS:
        return _LEAST_ROUGH
    slope = (points[-1, 0] - points[0, 0]) / (points[-1, 1] - points[0, 1])
    off = points[:, 0] - points[0, 0] - slope * (points[:, 1] - points[0, 1])
    return max(float(np.sqrt(np.mean(np.diff(off, n=3) ** 2) / 20)), _LEAST_ROUGH)
