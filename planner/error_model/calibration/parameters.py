"""What a calibration may change in an error model, as one vector with a prior for each entry."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.error_model.chain import TipChange, tips
from planner.error_model.curve import BEND_SD_DEG
from planner.error_model.model import ErrorModel, Standing

_DEGREE_RAD = float(np.radians(1.0))

# How true arms of one make differ, degrees or mm: potentiometers of hobby servos, encoders of those on a bus.
_POTENTIOMETER_SD = (1.2, 1.6, *BEND_SD_DEG)
_ENCODER_SD = (1.2, 0.3, 0.3, 0.2, 0.2, 0.1, 0.1, 0.05, 0.05, 0.05)
"""Of the correction of a curve's coefficients."""
_SLACK_SD, _BUS_SLACK_SD = 0.8, 0.4
_LENGTH_SD_MM = 0.6
_TWIST_SD = 0.17
_BASE_SD = (1.2, 1.2, 0.6, 0.6, 0.3, 0.3)
"""mm, then degrees."""

CURVE_SIZE = len(_POTENTIOMETER_SD)
BASE_ORDER = ("base x", "base y", "base height", "base yaw", "paper tilt x", "paper tilt y")
FLATTEST, FLATNESS_SD = 0.4, 0.1
"""A curve is hardly ever flatter than so much of its mean slope; the sd of that."""
_SLOPES = 21
_RISE = legendre.legval(np.linspace(-1.0, 1.0, _SLOPES), legendre.legder(np.eye(CURVE_SIZE))).T
"""(_SLOPES, n_coefficients) slopes of the polynomials along the range of a curve."""
_TIGHTEST = 1e-4
"""Slack is never below this, rad or mm."""


@dataclass(frozen=True, eq=False, slots=True)
class Parameters:
    """The entries of the vector: changes of a prior model. names, sd: (n,); sd in rad and mm."""

    prior: ErrorModel
    names: tuple[str, ...]
    sd: FloatArray
    lengths: tuple[tuple[str, int], ...]

    @staticmethod
    def of(prior: ErrorModel, arm: Arm) -> Parameters:
        """What may be changed in the prior model of an arm."""
        joints = [joint.name for joint in arm.joints]
        names: list[str] = []
        sd: list[float] = []
        geometry = prior.geometry
        for joint, revolute in zip(arm.joints, geometry.revolute, strict=True):
            unit = _DEGREE_RAD if revolute else 1.0
            names += [f"{joint.name} curve {k}" for k in range(CURVE_SIZE)]
            sd += [value * unit for value in (_ENCODER_SD if joint.bus else _POTENTIOMETER_SD)]
        for joint, revolute in zip(arm.joints, geometry.revolute, strict=True):
            names.append(f"{joint.name} slack")
            sd.append((_BUS_SLACK_SD if joint.bus else _SLACK_SD) * (_DEGREE_RAD if revolute else 1.0))
        lengths = tuple(
            (kind, k)
            for k in range(len(joints))
            for kind, value in (("d", geometry.d_mm[k]), ("a", geometry.a_mm[k]))
            if abs(value) > 1e-9
        )
        names += [f"{joints[k]} {kind}" for kind, k in lengths]
        sd += [_LENGTH_SD_MM] * len(lengths)
        names += [f"{name} twist" for name in joints[:-1]]  # the last one turns a point
        sd += [_TWIST_SD * _DEGREE_RAD] * (len(joints) - 1)
        names += BASE_ORDER
        sd += [*_BASE_SD[:3], *(value * _DEGREE_RAD for value in _BASE_SD[3:])]
        return Parameters(prior, tuple(names), np.array(sd), lengths)

    def model(self, vector: FloatArray) -> ErrorModel:
        """The model that a vector (n,) means."""
        n, per = len(self.prior.curves), CURVE_SIZE
        curves = tuple(
            replace(curve, coefficients=curve.coefficients + vector[k * per : (k + 1) * per])
            for k, curve in enumerate(self.prior.curves)
        )
        at = n * per
        slack = np.maximum(self.prior.slack + vector[at : at + n], _TIGHTEST)
        at += n
        d, a, alpha = (
            np.array(value) for value in (self.prior.geometry.d_mm, self.prior.geometry.a_mm, self.prior.geometry.alpha)
        )
        for kind, k in self.lengths:
            (d if kind == "d" else a)[k] += vector[at]
            at += 1
        alpha[:-1] += vector[at : at + n - 1]
        at += n - 1
        return ErrorModel(
            curves,
            slack,
            replace(self.prior.geometry, d_mm=d, a_mm=a, alpha=alpha, base=self.prior.geometry.base + vector[at:]),
        )

    @property
    def file_units(self) -> tuple[tuple[str, float], ...]:
        """Of every entry: its unit in files, and how much of the inner unit that is."""
        revolute = dict(
            zip(
                (name.split(" ")[0] for name in self.names if name.endswith(" slack")),
                self.prior.geometry.revolute.tolist(),
                strict=True,
            )
        )
        degrees = ("deg", _DEGREE_RAD)
        return tuple(
            degrees
            if name.endswith(" twist")
            or name in BASE_ORDER[3:]
            or (name.split(" ")[0] in revolute and revolute[name.split(" ")[0]] and not name.endswith((" d", " a")))
            else ("mm", 1.0)
            for name in self.names
        )

    def values(self, vector: FloatArray) -> FloatArray:
        """(n,) what the entries of a vector (n,) come to: lengths, slack and the base in full, curves as changes."""
        model = self.model(vector)
        n, per = len(model.curves), CURVE_SIZE
        geometry = model.geometry
        lengths = [(geometry.d_mm if kind == "d" else geometry.a_mm)[k] for kind, k in self.lengths]
        return np.concatenate((vector[: n * per], model.slack, lengths, geometry.alpha[:-1], geometry.base))

    def slack_of(self, vector: FloatArray) -> FloatArray:
        """(n_joints,) the entries of a vector (n,) that are joints' slack."""
        slack: FloatArray = vector[self.slack_entries]
        return slack

    @property
    def slack_entries(self) -> slice:
        n = len(self.prior.curves)
        return slice(n * CURVE_SIZE, n * (CURVE_SIZE + 1))

    def with_slack(self, vector: FloatArray, joint: int, slack: float) -> FloatArray:
        """(n,) the vector with another slack of one joint."""
        changed = vector.copy()
        changed[self.slack_entries.start + joint] = slack - self.prior.slack[joint]
        return changed

    def flatness(self, model: ErrorModel) -> tuple[FloatArray, FloatArray]:
        """How far curves are from rising everywhere: residuals (k,), 0 where a curve's slope is at least FLATTEST of
        its mean, and their derivatives (k, n). No potentiometer stands still while its servo turns."""
        n, per = len(model.curves), CURVE_SIZE
        residuals, rows = np.zeros((n, _SLOPES)), np.zeros((n, _SLOPES, len(self.names)))
        for k, (curve, before) in enumerate(zip(model.curves, self.prior.curves, strict=True)):
            rise = _RISE / before.coefficients[1]
            short = (FLATTEST - rise @ curve.coefficients) / FLATNESS_SD
            residuals[k] = np.maximum(short, 0.0)
            rows[k, :, k * per : (k + 1) * per] = np.where(short[:, None] > 0, rise / FLATNESS_SD, 0.0)
        return residuals.ravel(), rows.reshape(-1, len(self.names))

    def jacobian_at(self, joints: FloatArray, model: ErrorModel | None = None) -> FloatArray:
        """(m, 3, n) derivatives of tips at joints (m, n_joints), each in the middle of its slack, by the vector; of the
        prior model where none is given."""
        model = model or self.prior
        told = np.column_stack([curve.told(joints[:, k]) for k, curve in enumerate(model.curves)])
        return self.jacobian(model, tips(model.geometry, joints), Standing(joints, told, np.zeros_like(joints)))

    def jacobian(self, model: ErrorModel, change: TipChange, stands: Standing) -> FloatArray:
        """(m, 3, n) derivatives of tips by the vector."""
        columns = [
            change.by_joint[:, :, k, None] * curve.basis(stands.told[:, k])[:, None, :]
            for k, curve in enumerate(model.curves)
        ]
        columns.append(change.by_joint * stands.side[:, None, :])
        columns.append(
            np.stack([(change.by_d if kind == "d" else change.by_a)[:, :, k] for kind, k in self.lengths], axis=2)
        )
        columns += [change.by_alpha[:, :, :-1], change.by_base]
        return np.concatenate(columns, axis=2)
