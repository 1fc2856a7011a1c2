"""Marks to a calibrated model: robust least squares with priors, by Gauss and Newton.

Minimises `sum_i w_i |(tip_i - model_i(x)) / sd_i|^2 + |x / prior sd|^2`, the weights w of Cauchy's, again and
again from the residuals of a whole mark, so that one that is far off has no say.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.model import ErrorModel, Told, tips_at

_ROUNDS = 40
_HALVINGS = 8
_ANNEALED = 4
"""Descents, each with the noise that the one before left."""
_STILL = 1e-3
_TAIL = 4.0
"""So many standard deviations off, a mark loses half its weight."""
_OTHER_SLACKS = (0.4, 1.8)
_BETTER = 0.5
"""So much less a minimum has to cost to be taken instead."""
_BLUNDER = 0.3
"""Marks of less weight are outliers."""
_SETTLING = 10
_MEDIAN_OF_CHI = 0.9
"""Of the root mean square of two or three normal numbers."""


@dataclass(frozen=True, eq=False, slots=True)
class Marks:
    """Measured tips (m, 3) on the paper, NaN where not seen, with their sd (m,), and what led the servos there.

    falls: (m, 2) what is measured in the place of a height: the height, and this much of x and of y. Where ink begins
    on a line along which the pen comes down tells no more; zero where heights are told by themselves.
    """

    told: Told
    tips_mm: FloatArray
    sd_mm: FloatArray
    falls: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """vector: (n,) in the order of the parameters; covariance: (n, n). residuals_mm: (m, 3) measured less modelled, NaN
    where not seen. weights: (m,), 1 where a mark is believed. noise: factor on the marks' sd that residuals ask for.
    discrepancy_mm: (2,) sd along the paper and of heights of what the model cannot say, from each mark as the others
    predict it. jacobian: (m, 3, n) of the tips at the marks."""

    parameters: Parameters
    vector: FloatArray
    covariance: FloatArray
    residuals_mm: FloatArray
    weights: FloatArray
    noise: float
    discrepancy_mm: FloatArray
    jacobian: FloatArray

    @property
    def model(self) -> ErrorModel:
        return self.parameters.model(self.vector)

    @property
    def sd(self) -> FloatArray:
        """(n,) of the vector's entries."""
        sd: FloatArray = np.sqrt(np.diag(self.covariance))
        return sd

    @property
    def outliers(self) -> BoolArray:
        """(m,)"""
        return self.weights < _BLUNDER

    @property
    def rms_mm(self) -> float:
        """Along the paper, of the marks that are believed."""
        inside = self.residuals_mm[~self.outliers, :2]
        return float(np.sqrt(np.nanmean((inside**2).sum(axis=1))))

    def tip_sd_mm(self, jacobian: FloatArray) -> FloatArray:
        """(k, 3) sd of the tip where its derivatives by the vector are `jacobian` (k, 3, n)."""
        variance = np.einsum("kij,jl,kil->ki", jacobian, self.covariance, jacobian)
        variance += self.discrepancy_mm[[0, 0, 1]] ** 2
        sd: FloatArray = np.sqrt(variance)
        return sd


def fit(parameters: Parameters, sets: Sequence[Marks]) -> Fit:
    """The most probable vector given all sets of marks.

    On which side of its slack a joint stands depends on the slack, so that there are several minima: each joint is
    tried with less and with more than was found.
    """
    problem = _Problem(parameters, sets)
    vector, noise = np.zeros(len(parameters.names)), np.inf
    for _ in range(_ANNEALED):
        noise = min(problem.noise_at(vector), noise)
        vector = problem.descended(vector, noise)
    for joint in range(len(parameters.prior.curves)):
        for share in _OTHER_SLACKS:
            slack = float(parameters.model(vector).slack[joint])
            other = problem.descended(parameters.with_slack(vector, joint, share * slack), noise)
            if problem.cost(other, noise) < problem.cost(vector, noise) - _BETTER:
                vector = other
    noise = problem.noise_at(vector)
    return problem.fit_at(problem.descended(vector, noise), noise)


class _Problem:
    """The function to be minimised, and how. `noise` multiplies the sd of all marks."""

    def __init__(self, parameters: Parameters, sets: Sequence[Marks]) -> None:
        self._parameters, self._sets = parameters, sets
        self._sd = np.concatenate([marks.sd_mm for marks in sets])[:, None]
        self._seen = np.concatenate([np.isfinite(marks.tips_mm) for marks in sets])

    def noise_at(self, vector: FloatArray) -> float:
        """Factor on the sd that the residuals of most marks ask for, 1 at least."""
        residual, _ = _linearised(self._parameters, vector, self._sets)
        size = np.sqrt(np.nansum((residual / self._sd) ** 2, axis=1) / np.maximum(self._seen.sum(axis=1), 1))
        return max(1.0, float(np.median(size[self._seen.any(axis=1)])) / _MEDIAN_OF_CHI)

    def cost(self, vector: FloatArray, noise: float) -> float:
        """Minus twice the logarithm of the probability, up to a constant."""
        residual, _ = _linearised(self._parameters, vector, self._sets)
        return self._cost(vector, residual, noise)

    def descended(self, vector: FloatArray, noise: float) -> FloatArray:
        """The minimum that steps of Gauss and Newton lead to, each halved until it helps."""
        residual, jacobian = _linearised(self._parameters, vector, self._sets)
        cost = self._cost(vector, residual, noise)
        for _ in range(_ROUNDS):
            step = np.linalg.solve(*self._normal(vector, residual, jacobian, noise))
            for _ in range(_HALVINGS):
                tried = vector + step
                residual, jacobian = _linearised(self._parameters, tried, self._sets)
                reached = self._cost(tried, residual, noise)
                if reached < cost:
                    break
                step = step / 2
            else:
                return vector
            gained, vector, cost = cost - reached, tried, reached
            if gained < _STILL:
                break
        return vector

    def fit_at(self, vector: FloatArray, noise: float) -> Fit:
        residual, jacobian = _linearised(self._parameters, vector, self._sets)
        hessian, _ = self._normal(vector, residual, jacobian, noise)
        covariance = np.asarray(np.linalg.inv(hessian), np.float64)
        weights = self._weights(residual, noise)
        return Fit(
            self._parameters,
            vector,
            covariance,
            residual,
            weights,
            noise,
            _discrepancy(residual, jacobian, covariance, self._sd[:, 0] * noise, weights),
            jacobian,
        )

    def _weights(self, residual: FloatArray, noise: float) -> FloatArray:
        square = np.nansum((residual / (self._sd * noise)) ** 2, axis=1) / np.maximum(self._seen.sum(axis=1), 1)
        weights: FloatArray = 1.0 / (1.0 + square / _TAIL**2)
        return weights

    def _cost(self, vector: FloatArray, residual: FloatArray, noise: float) -> float:
        many = np.maximum(self._seen.sum(axis=1), 1)
        square = np.nansum((residual / (self._sd * noise)) ** 2, axis=1) / many
        return float(
            (many * _TAIL**2 * np.log1p(square / _TAIL**2)).sum()
            + ((vector / self._parameters.sd) ** 2).sum()
            + (self._parameters.flatness(self._parameters.model(vector))[0] ** 2).sum()
        )

    def _normal(
        self, vector: FloatArray, residual: FloatArray, jacobian: FloatArray, noise: float
    ) -> tuple[FloatArray, FloatArray]:
        """Matrix and right side of the normal equations."""
        scale = np.where(self._seen, np.sqrt(self._weights(residual, noise))[:, None] / (self._sd * noise), 0.0)
        rows = (jacobian * scale[:, :, None]).reshape(-1, len(vector))
        right = (np.where(self._seen, residual, 0.0) * scale).ravel()
        flat, rises = self._parameters.flatness(self._parameters.model(vector))
        return (
            rows.T @ rows + rises.T @ rises + np.diag(self._parameters.sd**-2.0),
            rows.T @ right + rises.T @ flat - vector / self._parameters.sd**2,
        )


def _linearised(parameters: Parameters, vector: FloatArray, sets: Sequence[Marks]) -> tuple[FloatArray, FloatArray]:
    model = parameters.model(vector)
    residuals, jacobians = [], []
    for marks in sets:
        change, stands = tips_at(model, marks.told)
        expected, jacobian = change.tip_mm.copy(), parameters.jacobian(model, change, stands)
        expected[:, 2] += (marks.falls * change.tip_mm[:, :2]).sum(axis=1)
        jacobian[:, 2] += np.einsum("mi,mip->mp", marks.falls, jacobian[:, :2])
        residuals.append(marks.tips_mm - expected)
        jacobians.append(jacobian)
    return np.concatenate(residuals), np.concatenate(jacobians)


def _discrepancy(
    residual: FloatArray, jacobian: FloatArray, covariance: FloatArray, sd: FloatArray, weights: FloatArray
) -> FloatArray:
    """(2,) what the errors of marks left out exceed their own expectation by.

    With H the share that a mark has in its own fit, the error of the prediction by the others is (I - H)^-1 r, of
    covariance (I - H)^-1 R. Marks that the others hardly tell of say little.
    """
    left_out: tuple[list[tuple[float, float]], list[tuple[float, float]]] = ([], [])
    for r, J, s, w in zip(residual, jacobian, sd.tolist(), weights.tolist(), strict=True):
        seen = np.flatnonzero(np.isfinite(r))
        if not len(seen) or w < _BLUNDER:
            continue
        keep = np.linalg.inv(np.eye(len(seen)) - w * J[seen] @ covariance @ J[seen].T / s**2)
        errors = keep @ r[seen]
        for axis, error, expected in zip(seen.tolist(), errors.tolist(), np.diag(keep).tolist(), strict=True):
            left_out[axis == 2].append((error**2, expected * s**2))
    return np.sqrt([_excess(np.array(part)) if part else 0.0 for part in left_out])


def _excess(squares: FloatArray) -> float:
    """The variance that squared errors have in common beyond what is expected of each. squares: (n, 2), both of these.

    The most likely one has every square count by its own variance, what is looked for included.
    """
    excess = 0.0
    for _ in range(_SETTLING):
        weight = (squares[:, 1] + excess) ** -2.0
        excess = max(float((weight * (squares[:, 0] - squares[:, 1])).sum() / weight.sum()), 0.0)
    return excess
