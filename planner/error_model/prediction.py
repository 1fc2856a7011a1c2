"""How well an arm is going to draw: its program played many times by arms that could be this one.

Each play draws what the file leaves open: slack about what was found, the servos' lag and when they look for pulses,
and a smooth error of place and height all over the paper, as large as the calibration left it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from planner.arms.arm import Arm
from planner.arms.slack import FRAME_S, delays_s, half_slack, leads_s
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.error_model.believed import believed
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.cause import Cause, differing_lags, left_open, slack_of, unmeasured
from planner.error_model.chain import tips
from planner.error_model.left_open import errors_by, too_high_mm

INK_MM = 1.5
"""A sprung pen leaves ink up to so far above the paper."""
_PLAYS = 16
_LAG_SPREAD = 0.25
"""Servos of one kind differ by so much of their lag (standard deviation)."""
_WAVES = 8
_WAVE_MM = 70.0
_WITHIN_S = 0.3
_WORTH_A_WORD_MM = 0.005


@dataclass(frozen=True, eq=False, slots=True)
class Played:
    """What is played: sent and meant, (n, n_joints), rad or mm; stroke: (n,); rate_hz."""

    sent: FloatArray
    meant: FloatArray
    stroke: IntArray
    rate_hz: float


@dataclass(frozen=True, eq=False, slots=True)
class Along:
    """What is expected along the lines, at the n samples that draw.

    meant_mm: (n, 2) on the paper. stroke: (n,). off_mm: (n,) distance from the line, rms over the arms. missing: (n,)
    share of the arms that leave no ink there. one_mm: (n, 2) where the pen of one of the arms goes. one_inks: (n,)
    whether it leaves ink.
    """

    meant_mm: FloatArray
    stroke: IntArray
    off_mm: FloatArray
    missing: FloatArray
    one_mm: FloatArray
    one_inks: BoolArray


@dataclass(frozen=True, slots=True)
class Prediction:
    """rms_mm, p95_mm: distance of ink from the lines that are meant, over the time that the pen draws. rms_interval_mm:
    95 of 100 arms. missing_share: of that time with the pen more than INK_MM above the paper; crushed_share: as far
    below. causes: the dearest first. along: the same sample by sample."""

    rms_mm: float
    p95_mm: float
    rms_interval_mm: tuple[float, float]
    missing_share: float
    crushed_share: float
    causes: tuple[Cause, ...]
    along: Along = field(compare=False, repr=False)

    def as_dict(self) -> dict[str, object]:
        return {
            "rms_mm": self.rms_mm,
            "p95_mm": self.p95_mm,
            "rms_interval_mm": list(self.rms_interval_mm),
            "missing_share": self.missing_share,
            "crushed_share": self.crushed_share,
            "causes": [{"cause": cause.name, "mm": cause.mm, "cure": cause.cure} for cause in self.causes],
        }

    def summary(self) -> str:
        low, high = self.rms_interval_mm
        return (
            f"off by {self.rms_mm:.2f} mm rms ({low:.2f} to {high:.2f}), {self.p95_mm:.2f} mm for 95 %; "
            f"{100 * self.missing_share:.1f} % of the ink missing"
        )

    def lines(self) -> list[str]:
        low, high = self.rms_interval_mm
        return [
            f"lines are going to be off by {self.rms_mm:.2f} mm rms ({low:.2f} to {high:.2f}), 95 % of them by "
            f"less than {self.p95_mm:.2f} mm",
            f"ink missing: {100 * self.missing_share:.1f} %; pressed more than {INK_MM:g} mm too deep: "
            f"{100 * self.crushed_share:.1f} %",
            *(cause.text() for cause in self.causes if cause.mm >= _WORTH_A_WORD_MM),
        ]


def predicted(arm: Arm, played: Played, seed: int = 0) -> Prediction:
    """The prediction for an arm. Errors: ArmFileError where its file does not say how joints are moved."""
    random = np.random.default_rng(seed)
    arms = _Arms.drawn(arm, played, random)
    meant_mm = _tips(arm, played.meant[None])[0]
    line = _Line(meant_mm, played.stroke, round(_WITHIN_S * played.rate_hz))
    tip_mm = _tips(arm, arms.play(played))
    whole = tip_mm + arms.fields
    drawn = played.stroke >= 0
    if arm.accuracy is None:
        whole[..., 2] -= too_high_mm(whole, drawn, random)[:, None]
    off = line.distances(whole)[:, drawn]
    height = whole[:, drawn, 2]
    missing = height > INK_MM
    per_arm = np.sqrt((off**2).mean(axis=1))
    low, high = np.percentile(per_arm, (2.5, 97.5)).tolist()
    return Prediction(
        float(np.sqrt((off**2).mean())),
        float(np.percentile(off, 95)),
        (low, high),
        float(missing.mean()),
        float((height < -INK_MM).mean()),
        _causes(arm, played, arms, line),
        Along(
            meant_mm[drawn, :2],
            played.stroke[drawn],
            np.sqrt((off**2).mean(axis=0)),
            missing.mean(axis=0),
            whole[0, drawn, :2],
            ~missing[0],
        ),
    )


def expected_rms_mm(arm: Arm, played: Played, seed: int = 0) -> float:
    """`rms_mm` of the prediction for the same arms wherever a drawing lies, so that places can be compared: what is
    left open at rest by a calibration, alike at all places, counts by its variance across the lines.
    Errors: as `predicted`."""
    arms = _Arms.drawn(arm, played, np.random.default_rng(seed))
    line = _Line(_tips(arm, played.meant[None])[0], played.stroke, round(_WITHIN_S * played.rate_hz))
    at_rest = (arms.fields, 0.0) if arm.accuracy is None else (0.0 * arms.fields, arm.accuracy.tip_mm)
    off = line.distances(_tips(arm, arms.play(played)) + at_rest[0])[:, played.stroke >= 0]
    return float(np.hypot(np.sqrt((off**2).mean()), at_rest[1]))


@dataclass(frozen=True, eq=False, slots=True)
class _Arms:
    """slack, lag_s, phase_s: (k, n_joints) of k arms; fields: (k, n, 3) errors in mm that are there at rest."""

    slack: FloatArray
    lag_s: FloatArray
    phase_s: FloatArray
    frame_s: FloatArray
    fields: FloatArray

    @staticmethod
    def drawn(arm: Arm, played: Played, random: np.random.Generator) -> _Arms:
        n = arm.n_joints
        slack_sd, fields = _left_open(arm, played, random)
        slack = np.maximum(half_slack(arm) + slack_sd * random.normal(size=(_PLAYS, n)), 0.0)
        frame_s = np.array([FRAME_S if joint.servo else 0.0 for joint in arm.joints])
        lag_s = (delays_s(arm) - frame_s / 2) * np.exp(_LAG_SPREAD * random.normal(size=(_PLAYS, n)))
        return _Arms(slack, lag_s, random.uniform(0.0, 1.0, (_PLAYS, n)) * frame_s, frame_s, fields)

    def play(self, played: Played) -> FloatArray:
        """(k, n, n_joints) where the joints go."""
        n, period_s = len(played.sent), 1 / played.rate_hz
        times = np.arange(n)[None, :, None] * period_s
        frame = np.maximum(self.frame_s, 1e-9)
        seen = np.floor((times - self.phase_s[:, None]) / frame) * frame + self.phase_s[:, None]
        rows = np.clip(np.floor(np.where(self.frame_s > 0, seen, times) / period_s + 1e-6), 0, n - 1).astype(np.int64)
        goals = played.sent[rows, np.arange(played.sent.shape[1])]
        share = np.where(self.lag_s > 0, -np.expm1(-period_s / np.maximum(self.lag_s, 1e-9)), 1.0)
        joints = np.empty_like(goals)
        motor = stands = goals[:, 0]
        for k in range(n):
            motor = motor + share * (goals[:, k] - motor)
            stands = np.minimum(np.maximum(stands, motor - self.slack), motor + self.slack)
            joints[:, k] = stands
        return joints


@dataclass(frozen=True, eq=False, slots=True)
class _Line:
    """What is meant to be drawn: points (n, 3), mm, and the stroke of each (n,). within: points to look for the nearest
    in, before and after."""

    points_mm: FloatArray
    stroke: IntArray
    within: int

    def distances(self, tips_mm: FloatArray) -> FloatArray:
        """(k, n) how far tips (k, n, 3) are from the line of their own stroke, across the paper."""
        n = len(self.points_mm)
        nearest = np.full(tips_mm.shape[:2], np.inf)
        here = np.arange(n)
        for shift in range(-self.within, self.within + 1):
            first, last = np.clip(here + shift, 0, n - 1), np.clip(here + shift + 1, 0, n - 1)
            same = (self.stroke[first] == self.stroke) & (self.stroke[last] == self.stroke)
            begin = self.points_mm[first, :2]
            along = self.points_mm[last, :2] - begin
            to_tip = tips_mm[..., :2] - begin
            share = np.clip((to_tip * along).sum(axis=-1) / np.maximum((along**2).sum(axis=-1), 1e-12), 0.0, 1.0)
            away = np.hypot(*np.moveaxis(to_tip - share[..., None] * along, -1, 0))
            nearest = np.where(same, np.minimum(nearest, away), nearest)
        return nearest


def _tips(arm: Arm, joints: FloatArray) -> FloatArray:
    """(k, n, 3) tips of joints (k, n, n_joints)."""
    flat = tips(believed(arm).geometry, joints.reshape(-1, arm.n_joints)).tip_mm
    return flat.reshape(*joints.shape[:2], 3)


def _left_open(arm: Arm, played: Played, random: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """What the file leaves open: sd of slack (n_joints,), and errors (_PLAYS, n, 3) in mm of tips at rest."""
    if arm.accuracy is not None:
        places_mm = _tips(arm, played.meant[None])[0, :, :2]
        tip_sd_mm = np.array([arm.accuracy.tip_mm] * 2 + [arm.accuracy.height_mm])
        return np.array(arm.accuracy.slack), np.stack([_field(places_mm, tip_sd_mm, random) for _ in range(_PLAYS)])
    parameters = Parameters.of(believed(arm), arm)
    vectors = random.normal(size=(_PLAYS, len(parameters.sd))) * parameters.sd
    return parameters.slack_of(parameters.sd), errors_by(parameters, vectors, played.meant)


def _field(places_mm: FloatArray, sd_mm: FloatArray, random: np.random.Generator) -> FloatArray:
    """(n, 3) a smooth random error at places (n, 2): waves of about _WAVE_MM in all directions."""
    wave = random.normal(0.0, 2 * np.pi / _WAVE_MM / np.sqrt(2), (3, _WAVES, 2))
    phase = random.uniform(0.0, 2 * np.pi, (3, _WAVES))
    heights = random.normal(size=(3, _WAVES)) * np.sqrt(2 / _WAVES)
    field = (heights * np.cos(np.einsum("nd,cwd->ncw", places_mm, wave) + phase)).sum(axis=2)
    scaled: FloatArray = field * sd_mm
    return scaled


def _causes(arm: Arm, played: Played, arms: _Arms, line: _Line) -> tuple[Cause, ...]:
    """What each cause adds to the mean square: all that is there at rest to the whole, and each of the others to what
    is there without that, in which it would be lost."""
    drawn = played.stroke >= 0
    few = replace(arms, **{key: getattr(arms, key)[: _PLAYS // 4] for key in ("slack", "lag_s", "phase_s", "fields")})

    def square(those: _Arms, sent: FloatArray) -> float:
        tip_mm = _tips(arm, those.play(replace(played, sent=sent))) + those.fields
        return float((line.distances(tip_mm)[:, drawn] ** 2).mean())

    def difference(whole: float, less: float) -> float:
        return float(np.sqrt(max(whole - less, 0.0)))

    moving = replace(few, fields=0 * few.fields)
    while_moving = square(moving, played.sent)
    at_rest_mm = difference(square(few, played.sent), while_moving)
    alike = replace(moving, lag_s=np.broadcast_to(moving.lag_s.mean(axis=1, keepdims=True), moving.lag_s.shape))
    found = [
        unmeasured(at_rest_mm) if arm.accuracy is None else left_open(at_rest_mm, arm.accuracy.marks),
        differing_lags(difference(while_moving, square(alike, played.sent))),
    ]
    shift = leads_s(arm, 1 / played.rate_hz) * played.rate_hz
    rows = np.arange(len(played.meant))
    for k, joint in enumerate(arm.joints):
        if not moving.slack[:, k].any():
            continue
        sent, slack = played.sent.copy(), moving.slack.copy()
        sent[:, k] = np.interp(rows + shift[k], rows, played.meant[:, k])
        slack[:, k] = 0.0
        found.append(slack_of(joint.name, difference(while_moving, square(replace(moving, slack=slack), sent))))
    return tuple(sorted(found, key=lambda cause: -cause.mm))
