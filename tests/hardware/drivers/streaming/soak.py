"""A drawing on a controller that dies or is reset again and again, resumed until it is done: what is on the paper then?

Everything but time, line and controller is what people run: `plan run` and its journal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import shapely

from hardware.compensation.servo_values import pulse_calibration
from hardware.motion.tip import link_nodes_mm
from hardware.playback.journal import journal_path
from hardware.playback.journal_entry import read_journal
from hardware.simulation.ink import drawn_lines
from planner.arms.arm_file import load_arm
from planner.arrays import BoolArray, FloatArray
from planner.trajectory import TRAVELLING, read_trajectory
from tests.hardware.controllers.bench import Bench
from tests.hardware.controllers.lines import Model
from tests.hardware.controllers.maestro import MaestroModel
from tests.hardware.controllers.ssc32 import Ssc32Model
from tests.hardware.drivers.streaming.on_bench import plan_run
from tests.hardware.rounding import rounding_mm

_SAME_MM = 0.05
"""Strokes are drawn by the same set points in every run, rounded in the same way."""
_ONE_SPOT_MM = 1e-6
_MOST_RUNS = 200
_EVERY = 0.2
"""Of the bytes of an undisturbed run, from one interruption to the next, in the mean."""


@dataclass
class Outcome:
    """What became of one drawing.

    dead, reset: interruptions. twice: how often a stroke was drawn whole that was there already; undoubted: strokes of
    which that is true though no journal had them in doubt or just begun. claimed: strokes that a journal called drawn
    too early; lost: those that never were. off_mm: how far ink is from where the plan has some.
    """

    dead: int = 0
    reset: int = 0
    twice: int = 0
    undoubted: list[int] = field(default_factory=list)
    claimed: list[int] = field(default_factory=list)
    lost: list[int] = field(default_factory=list)
    off_mm: float = 0.0


class Soak:
    """Of one trajectory of pulse servos on one of the drivers `maestro` and `ssc32`.

    bound_mm: how far off the controller's resolution lets ink be. A run that resumes sets off by set points of its own,
    and rounds them as it rounds all others.
    """

    def __init__(self, csv: Path, driver: str) -> None:
        self._csv, self._driver = csv, driver
        trajectory = read_trajectory(csv)
        self._arm, self._stroke = load_arm(trajectory.arm), trajectory.stroke
        self._positions = self._arm.from_file_units(trajectory.positions)
        self._step_us = 1.0 if driver == "ssc32" else 0.25
        self.bound_mm = rounding_mm(self._arm, self._positions[self._stroke != TRAVELLING], self._step_us)
        bench = Bench(self._model())
        assert self._run(bench, resume=False) == 0
        self._whole = bench.taken
        self._planned = _Ink(drawn_lines(self._arm, self._positions))
        self._wanted = self._strokes()

    def draw(self, rng: np.random.Generator) -> Outcome:
        """Once, with interruptions at random."""
        outcome, ink, times = Outcome(), list[FloatArray](), np.zeros(len(self._wanted), dtype=int)
        excused: set[int] = set()
        journal = journal_path(self._csv, simulated=False)
        journal.unlink(missing_ok=True)
        code, left, entry = -1, self._model(), None
        for _ in range(_MOST_RUNS):
            bench = self._disturbed(left, rng, outcome)
            code, before = self._run(bench, resume=entry is not None), entry
            assert code in (0, 4)
            drawn = self._ink(bench.models)
            ink += drawn
            times += self._covered(drawn)
            entry = read_journal(journal)  # none yet where it died while it was attached
            if entry is not None:
                outcome.claimed += np.flatnonzero(times[: entry.next_stroke] == 0).tolist()
                excused |= {*entry.in_doubt, max(entry.next_stroke, entry.last_sent + 1)}
                assert before is None or entry.next_stroke >= before.next_stroke
            if code == 0:
                break
            # What died is switched on anew; what was reset still holds its servos.
            left = bench.models[-1] if len(bench.models) > 1 else self._model()
        assert code == 0
        assert entry is not None
        assert entry.next_stroke == len(times)
        again = np.flatnonzero(times > 1)
        outcome.twice = int(np.sum(times[again] - 1))
        outcome.undoubted = [stroke for stroke in again.tolist() if stroke not in excused]
        outcome.lost = np.flatnonzero(times == 0).tolist()
        outcome.off_mm = max(self._planned.furthest_mm(line) for line in ink)
        return outcome

    def _disturbed(self, model: Model, rng: np.random.Generator, outcome: Outcome) -> Bench:
        at = rng.exponential(_EVERY * self._whole)
        if rng.uniform() < 0.5:
            outcome.dead += 1
            return Bench(model, dies_after=at)
        outcome.reset += 1
        return Bench(model, resets_after=at, anew=self._model, boot_s=rng.uniform(0.03, 0.5))

    def _model(self) -> Model:
        if self._driver == "ssc32":
            return Ssc32Model()
        model = MaestroModel()
        model.limited = set()  # as it comes up, for one that is reset
        return model

    def _run(self, bench: Bench, *, resume: bool) -> int:
        options = ["--driver", self._driver, "--quiet", *(["--resume"] if resume else [])]
        return plan_run(bench, str(self._csv), *options)

    def _ink(self, models: Sequence[Model]) -> list[FloatArray]:
        """Lines (n, 2) in mm that models have left on the paper since they were looked at last."""
        lines = []
        for model in models:
            positions = pulse_calibration(self._arm).to_joints(self._pulses_us(model))
            if len(positions):
                lines += drawn_lines(self._arm, positions)
        return lines

    def _pulses_us(self, model: Model) -> FloatArray:
        """(n, n_joints) of all whole set points of its life since; a model that goes on has forgotten them."""
        n = self._arm.n_joints
        if isinstance(model, Ssc32Model):
            moves = [list(targets.values()) for targets, _ in model.moves if len(targets) == n]
            model.moves.clear()
            return np.array(moves, dtype=float).reshape(-1, n)
        assert isinstance(model, MaestroModel)
        targets, rows = list(model.targets), []
        model.targets.clear()
        while targets:
            if [channel for channel, _ in targets[:n]] == list(range(n)):
                rows.append([value / 4 for _, value in targets[:n]])
                del targets[:n]
            else:
                del targets[:1]
        return np.array(rows).reshape(-1, n)

    def _strokes(self) -> list[FloatArray]:
        """Lines (n, 2) in mm of the strokes alone, lowering and lifting left out, in what the servos can be told."""
        calibration = pulse_calibration(self._arm)
        steps = np.rint(calibration.to_servos(self._positions) / self._step_us)
        tip_mm = link_nodes_mm(self._arm, calibration.to_joints(steps * self._step_us))[:, -1, :2]
        return [tip_mm[self._stroke == stroke] for stroke in range(self._stroke.max() + 1)]

    def _covered(self, drawn: Sequence[FloatArray]) -> BoolArray:
        """(n_strokes,) whether each stroke is there from end to end."""
        ink = _Ink(drawn)
        return np.array([ink.furthest_mm(stroke) <= _SAME_MM for stroke in self._wanted])


class _Ink:
    """Lines (n, 2) in mm, to be measured against."""

    def __init__(self, lines: Sequence[FloatArray]) -> None:
        self._lines = shapely.STRtree([_shape(line) for line in lines])

    def furthest_mm(self, line: FloatArray) -> float:
        """How far off a point of `line` is at the most."""
        points = shapely.points(shapely.get_coordinates(shapely.segmentize(_shape(line), _SAME_MM / 2)))
        _, distance_mm = self._lines.query_nearest(points, return_distance=True, all_matches=False)
        return float(distance_mm.max()) if len(distance_mm) else np.inf


def _shape(line: FloatArray) -> shapely.Geometry:
    return shapely.LineString(line) if np.ptp(line, axis=0).max() > _ONE_SPOT_MM else shapely.Point(line[0])
