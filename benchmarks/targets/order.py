"""The order of strokes beside LKH's, in true hop times: both by the planner's own pen-up moves.

LKH is given the time of the hop from each end of a stroke to those that are nearest to it, as the planner makes it, and
what these foretell of all others; then the hops of its own tour, and searches again. It may begin and end anywhere, as
the pen does in the air. Closed strokes begin for it where the planner's order has them begin.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from benchmarks.targets import lkh
from benchmarks.targets.row import Row, missing
from benchmarks.targets.strokes import placed_strokes
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.execution.work_chunks import planned_travel_moves, travel_chunks
from planner.execution.workers import Workers, executor_of
from planner.inverse_kinematics.stroke_configurations import exact_configurations
from planner.motion.timed_stroke import Contact
from planner.pen_drawing import lift_mm
from planner.settings import PlanSettings
from planner.travel.travel_moves import TravelRules
from planner.travel.travel_time_metric import travel_time_metric

_FEWEST, _MOST = 100, 700
_DRAWINGS = 2
_NEAREST = 6
_ROUNDS = 2
_RUNS = 1
_RATE_HZ = 1000.0
"""At which rounding to whole samples is next to nothing."""
_WORKERS = Workers(2)


def against_lkh(files: Sequence[Path], settings: PlanSettings) -> list[Row]:
    what = "pen-up time between strokes, order by LKH in true hop times"
    if absent := missing("elkai", what, "report"):
        return [absent]
    arm = load_arm(settings.arm)
    given = ((drawing, placed_strokes(drawing, arm, settings)) for drawing in files)
    some = [(drawing, strokes) for drawing, strokes in given if _FEWEST <= len(strokes) <= _MOST]
    rows = []
    for drawing, strokes in sorted(some, key=lambda one: -len(one[1]))[:_DRAWINGS]:
        ours_s, best_s = _hop_times(strokes, settings)
        rows.append(
            Row(
                f"{what}: {drawing.stem}, {len(strokes)} strokes",
                "report",
                f"{ours_s:.2f} s, LKH {best_s:.2f} s: {ours_s / best_s:.3f}",
            )
        )
    return rows or [Row(what, "report", f"no drawing of {_FEWEST} to {_MOST} strokes")]


def _hop_times(strokes: Sequence[FloatArray], settings: PlanSettings) -> tuple[float, float]:
    """Seconds between the strokes in their order, and in LKH's."""
    hops = Hops.between(strokes, settings)
    ours = np.arange(len(strokes)) * 2
    ours_s = hops.of_tour(ours)
    towns = np.arange(len(hops.contacts))
    nearest = np.argsort(hops.metric_s + np.where(towns[:, None] // 2 == towns // 2, np.inf, 0.0), axis=1)[:, :_NEAREST]
    hops.know((int(one), int(other)) for one in towns for other in nearest[one])
    best_s = np.inf
    for _ in range(_ROUNDS):
        found = lkh.tour(np.pad(hops.roads(), ((2, 0), (2, 0))), _RUNS) - 2
        best_s = min(best_s, hops.of_tour(found), hops.of_tour((found ^ 1)[::-1]))
    return ours_s, best_s


@dataclass(eq=False, slots=True)
class Hops:
    """Seconds of hops from end to end of strokes: stroke k has the ends 2 k and 2 k + 1. metric_s: what the planner
    ranks them by."""

    context: PlanContext
    rules: TravelRules
    contacts: list[Contact]
    metric_s: FloatArray
    known: dict[tuple[int, int], float] = field(default_factory=dict)

    @staticmethod
    def between(strokes: Sequence[FloatArray], settings: PlanSettings) -> Hops:
        context = PlanContext.of(load_arm(settings.arm), replace(settings, rate_hz=_RATE_HZ))
        model = context.model
        places = np.array([stroke[end] for stroke in strokes for end in (0, -1)])
        tips = np.column_stack((places, np.zeros(len(places))))
        configurations, _ = exact_configurations(model.kinematics, context.references.at(tips), tips)
        embedded = travel_time_metric(model)(places)
        apart = np.linalg.norm(embedded[:, None] - embedded, axis=2)
        rules = TravelRules(
            model.arm.pen.clearance_mm,
            lift_mm(model.arm, settings),
            settings.lowering_speed_mm_s,
            _RATE_HZ,
            settings.tolerance_mm,
        )
        contacts = [Contact(place, one) for place, one in zip(places, configurations, strict=True)]
        return Hops(context, rules, contacts, np.cbrt(32 * apart))

    def know(self, pairs: Iterable[tuple[int, int]]) -> None:
        """Make the hops that have not been made."""
        new = sorted({pair for pair in pairs if pair not in self.known})
        if not new:
            return
        starts, ends = ([self.contacts[pair[end]] for pair in new] for end in (0, 1))
        with executor_of(_WORKERS if len(new) > 500 else Workers(1), self.context.make_ready) as executor:
            made = [
                move
                for some in executor(planned_travel_moves, travel_chunks(self.context, self.rules, starts, ends))
                for move in some
            ]
        self.known.update((pair, (len(move.joints) - 1) / _RATE_HZ) for pair, move in zip(new, made, strict=True))

    def of_tour(self, entered: FloatArray) -> float:
        """Between strokes that are entered at these ends."""
        pairs = [(int(one) ^ 1, int(other)) for one, other in pairwise(entered)]
        self.know(pairs)
        return sum(self.known[pair] for pair in pairs)

    def roads(self) -> FloatArray:
        """(n, n) the same both ways: the mean of what is known, else what the metric foretells."""
        at = np.array(list(self.known))
        seconds = np.array(list(self.known.values()))
        told = np.polynomial.Polynomial.fit(self.metric_s[at[:, 0], at[:, 1]], seconds, 3)
        roads = told(np.minimum(self.metric_s, self.metric_s[at[:, 0], at[:, 1]].max()))
        total, count = np.zeros_like(roads), np.zeros_like(roads)
        for one, other in ((at[:, 0], at[:, 1]), (at[:, 1], at[:, 0])):
            np.add.at(total, (one, other), seconds)
            np.add.at(count, (one, other), 1)
        return np.where(count > 0, total / np.maximum(count, 1), np.maximum(roads, self.metric_s))
