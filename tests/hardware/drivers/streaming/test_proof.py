"""A stroke counts as drawn only if the controller has carried it out, however it dies or is reset while its line lives.

Every law is over all controllers that stream, in a time of the tests' own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.drivers.driver import Driver
from hardware.drivers.table import make_driver
from hardware.playback.player import play
from hardware.playback.program import Program
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.errors import HardwareError
from planner.trajectory import TRAVELLING
from tests.hardware.controllers.bench import Bench
from tests.hardware.controllers.lines import Model
from tests.hardware.drivers.streaming.test_set_points import MAKERS, heard
from tests.hardware.observed import Observed

N = 300
RATE_HZ = 100.0
STROKE, TRAVEL = 4, 3
"""Set points of strokes and between them, as short as taps: 40 ms."""
LABELS = np.where(np.arange(N) % (STROKE + TRAVEL) < STROKE, np.arange(N) // (STROKE + TRAVEL), TRAVELLING)
N_STROKES = int(LABELS.max()) + 1
LAST = [int(np.flatnonzero(np.equal(LABELS, stroke))[-1]) for stroke in range(N_STROKES)]
DOUBT_S = {"maestro": 0.05, "maestro-crc": 0.05, "ssc32": 0.05, "feetech": 0.15, "dynamixel": 0.5}
"""How long what was sent last may be in doubt while all is well; a slow bus is asked by turns, at 20 Hz in all."""


def _arm(name: str) -> Arm:
    return load_arm("so101" if name in ("feetech", "dynamixel") else "drawing_arm")


def _program(arm: Arm) -> Program:
    """Every set point is another one, and half-way within all ranges."""
    positions = np.tile((arm.minimum + arm.maximum) / 2, (N, 1))
    positions[:, 0] += np.linspace(0.0, 0.2, N)
    return Program(positions, LABELS, np.arange(float(N)), RATE_HZ, 0, 0)


def _driver(name: str, bench: Bench) -> Driver:
    baud = {"feetech": 1e6, "dynamixel": 57_600.0}.get(name, 115_200.0)
    bench.baud = baud
    return make_driver(name, _arm(name), bench, bench)  # type: ignore[arg-type]


class Run(Observed):
    """A run on `bench`, and why it ended."""

    def __init__(self, name: str, bench: Bench) -> None:
        super().__init__()
        arm, self._bench = _arm(name), bench
        self.begins, self.failure = 0, ""
        try:
            play(_program(arm), arm, _driver(name, bench), bench, observers=[self])
        except HardwareError as error:
            self.failure = str(error)

    def connected(self) -> None:
        self.begins = heard(self._bench.model)

    def executed(self, bench: Bench) -> list[int]:
        """The strokes of which every set point was heard, by a model that was not reset."""
        n = heard(bench.models[0]) - self.begins
        return [stroke for stroke in range(N_STROKES) if LAST[stroke] < n]


@cache
def _whole(name: str, latency_s: float) -> tuple[int, int]:
    """Bytes to the model until it is attached, and until all is over."""
    bench = Bench(MAKERS[name](), latency_s=latency_s)
    _driver(name, bench).connect(_program(_arm(name)).park)
    attached, bench = bench.taken, Bench(MAKERS[name](), latency_s=latency_s)
    run = Run(name, bench)
    assert run.failure == ""
    assert run.strokes_finished == list(range(N_STROKES))
    return attached, bench.taken


@pytest.mark.parametrize("name", MAKERS)
@settings(max_examples=25)
@given(share=st.floats(0.0, 1.0), latency_s=st.sampled_from([0.0, 0.001, 0.016, 0.1]))
def test_a_controller_that_dies_at_a_line_that_lives_has_drawn_all_that_counts(
    name: str, share: float, latency_s: float
) -> None:
    attached, whole = _whole(name, latency_s)
    bench = Bench(MAKERS[name](), dies_after=attached + share * (whole - attached - 1), latency_s=latency_s)
    run = Run(name, bench)
    assert "no longer answers" in run.failure
    assert run.strokes_finished == list(range(len(run.strokes_finished)))
    assert set(run.strokes_finished) <= set(run.executed(bench))
    assert set(run.executed(bench)) <= set(run.strokes_sent)


@pytest.mark.parametrize("name", MAKERS)
def test_what_is_in_doubt_while_all_is_well_is_little(name: str) -> None:
    bench, behind = Bench(MAKERS[name]()), list[int]()
    driver = _driver(name, bench)
    program = _program(_arm(name))
    driver.connect(program.park)
    for k, positions in enumerate(program.positions, start=1):
        bench.sleep_until(bench.now_s() + 1 / RATE_HZ)
        driver.send(positions, 1 / RATE_HZ)
        behind.append(k - driver.executed())
    assert max(behind) <= DOUBT_S[name] * RATE_HZ
    driver.flush()
    assert driver.executed() == N


@pytest.mark.parametrize("name", MAKERS)
@settings(max_examples=25)
@given(share=st.floats(0.0, 0.95), latency_s=st.sampled_from([0.0, 0.004, 0.016]))
def test_a_reset_at_a_line_that_lives_is_noticed(name: str, share: float, latency_s: float) -> None:
    attached, whole = _whole(name, latency_s)
    bench = Bench(
        MAKERS[name](),
        resets_after=attached + 1 + math.floor(share * (whole - attached)),
        anew=_anew(name),
        latency_s=latency_s,
    )
    run = Run(name, bench)
    assert run.failure
    assert set(run.strokes_finished) <= set(run.executed(bench))


def _anew(name: str) -> Callable[[], Model]:
    """A board as it comes up: without pulses, without torque, and with what limits it has by itself."""

    def make() -> Model:
        model = MAKERS[name]()
        if name.startswith("maestro"):
            model.limited = set()  # type: ignore[attr-defined]
        return model

    return make


@pytest.mark.parametrize("name", ["feetech", "dynamixel"])
def test_nothing_is_said_on_a_shared_line_while_a_servo_answers(name: str) -> None:
    bench = Bench(MAKERS[name]())
    driver, program = _driver(name, bench), _program(_arm(name))
    driver.connect(program.park)
    free_s = 0.0
    for positions in program.positions:
        before, asked, start_s = bench.taken, len(bench.answers), bench.now_s() + 1 / RATE_HZ
        bench.sleep_until(start_s)
        driver.send(positions, 1 / RATE_HZ)
        assert bench.now_s() >= free_s - 1e-9
        answered = bench.answers[-1][1] if bench.answers and bench.answers[-1][0] > bench.now_s() else b""
        free_s = bench.now_s() + bench.seconds(bench.taken - before + len(answered))
        assert asked <= 1


@pytest.mark.parametrize("name", ["feetech", "dynamixel"])
def test_an_answer_to_a_question_that_was_given_up_proves_nothing(name: str) -> None:
    """It comes from the same servo after it was asked again, and was on its way before the servo died."""
    bench = Bench(MAKERS[name](), latency_s=0.9)
    run = Run(name, bench)
    assert set(run.strokes_finished) <= set(run.executed(bench))
