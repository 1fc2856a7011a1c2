"""Whether marks can belong to a record at all, before and after they are fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.error_model.calibration.files import Measured, Record
from planner.error_model.calibration.fit import Fit, Marks, fit
from planner.error_model.calibration.parameters import Parameters
from planner.errors import CalibrationError

_STRANGE_MM = 15.0
"""No arm that is built after its file draws most of its marks so far from where they are meant to be."""
DOUBTFUL, POOR = 2.0, 3.0
"""Marks are poorly explained where residuals are so many times larger than they were measured to be."""
_BETTER = 0.4
"""Of the residuals: a fit with one joint turned round has to leave less."""


def refuse_mirrored(name: str, record: Record, measured: Measured, first_joint: str) -> None:
    """Errors: CalibrationError where marks are the mirror image of what the record drew."""
    meant, drawn = _pairs(record, measured)
    if _median_mm(drawn - meant) > _STRANGE_MM and _misfit(meant * (1.0, -1.0), drawn) < _BETTER * _misfit(
        meant, drawn
    ):
        raise CalibrationError(
            name,
            "the marks are a mirror image of those of the record: was the photo mirrored, or an axis measured the "
            f"wrong way, or does joint {first_joint} turn the other way than the arm file says?",
        )


def refuse_another_sheet(name: str, record: Record, measured: Measured) -> None:
    """Errors: CalibrationError where most marks are nowhere near what the record drew, saying what they look like."""
    meant, drawn = _pairs(record, measured)
    off = _median_mm(drawn - meant)
    if off <= _STRANGE_MM:
        return
    if _misfit(meant, drawn) < _STRANGE_MM / 2:
        raise CalibrationError(
            name,
            f"the marks are those of the record, but turned or moved by {off:.0f} mm: measure "
            "them in the sheet's frame, x away from the arm and y to its left",
        )
    raise CalibrationError(
        name,
        f"the marks lie {off:.0f} mm from those of the record: is it that of another pattern, "
        "or the photo of another sheet?",
    )


def _pairs(record: Record, measured: Measured) -> tuple[FloatArray, FloatArray]:
    """(k, 2) where marks that were seen are meant to be, and where they are."""
    seen = np.isfinite(measured.tips_mm[:, 0])
    at = np.array([np.flatnonzero(record.stroke == mark)[0] for mark in measured.marks[seen].tolist()])
    meant, drawn = record.meant_mm[at], measured.tips_mm[seen, :2]
    return meant, drawn


def _median_mm(off_mm: FloatArray) -> float:
    return float(np.median(np.hypot(*off_mm.T)))


def wrong_direction(arm: Arm, parameters: Parameters, found: Fit, sets: Sequence[Marks]) -> int | None:
    """The joint whose direction has to be changed for the marks to be explained, if there is one."""
    if found.noise <= POOR:
        return None
    noises = []
    for k in range(arm.n_joints):
        about_zero = -parameters.prior.curves[k].coefficients
        in_its_range = np.concatenate((-about_zero[:1], about_zero[1:]))
        noises.append(min(_noise_with(parameters, k, other, sets) for other in (about_zero, in_its_range)))
    best = int(np.argmin(noises))
    return best if noises[best] < _BETTER * found.noise else None


def _noise_with(parameters: Parameters, joint: int, coefficients: FloatArray, sets: Sequence[Marks]) -> float:
    """What residuals ask for where one joint has another curve."""
    curves = list(parameters.prior.curves)
    curves[joint] = replace(curves[joint], coefficients=coefficients)
    return fit(replace(parameters, prior=replace(parameters.prior, curves=tuple(curves))), sets).noise


def _misfit(meant: FloatArray, drawn: FloatArray) -> float:
    """Median distance in mm after the best rigid motion (Kabsch)."""
    a, b = meant - meant.mean(axis=0), drawn - drawn.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1.0, np.sign(np.linalg.det(u @ v))]) @ v
    return float(np.median(np.hypot(*(a @ turn - b).T)))
