"""What is drawn more often than the drawing has it is found wherever it is; what the drawing has twice may be drawn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.checking.check import check_trajectory
from planner.checking.check_result import Finding
from tests.checking.rig import Hand, drawing_of, gantry

Line = Sequence[tuple[float, float]]
FRAME: Line = ((60, -60), (60, 60), (180, 60), (180, -60), (60, -60))
"""Much line, among which a little more is nothing."""


def check_result_on(drawn: Sequence[Line], wanted: Sequence[Line]) -> dict[str, Finding]:
    hand = Hand(60, 0)
    for stroke, line in enumerate(drawn):
        hand.draw(line, stroke)
    return {one.check: one for one in check_trajectory(hand.trajectory(), gantry(), drawing_of(*wanted)).faults}


def dash(length: float, x: float = 100.0, y: float = 10.0) -> Line:
    return (x, y), (x + length, y)


DOT: Line = ((100, 10),)
REPEATED: dict[str, tuple[Sequence[Line], Sequence[Line]]] = {
    "a tap six times": ((FRAME, *[DOT] * 6), (FRAME, DOT)),
    "a tap twice": ((FRAME, DOT, DOT), (FRAME, DOT)),
    "a tap twice, 0.03 mm apart": ((FRAME, DOT, ((100.03, 10.0),)), (FRAME, DOT)),
    "a tap on a line": ((FRAME, ((60, 10),)), (FRAME,)),
    "a tap twice on a line": ((FRAME, ((60, 10),), ((60, 10),)), (FRAME, ((60, 10),))),
    "10 mm of a line twice": ((FRAME, ((60, 0), (60, 10))), (FRAME,)),
    "0.5 mm of a line twice": ((FRAME, ((60, 0), (60, 0.5))), (FRAME,)),
    "a short stroke twice": ((FRAME, dash(2), dash(2)), (FRAME, dash(2))),
    "a short stroke twice, the other way": ((FRAME, dash(2), dash(2)[::-1]), (FRAME, dash(2))),
    "0.2 mm twice": ((FRAME, dash(0.2), dash(0.2)), (FRAME, dash(0.2))),
    "0.1 mm twice": ((FRAME, dash(0.1), dash(0.1)), (FRAME, dash(0.1))),
    "a stroke back and forth": ((FRAME, (*dash(2), (100, 10))), (FRAME, dash(2))),
    "a closed line round twice": (((*FRAME, *FRAME[1:]),), (FRAME,)),
    "a line three times that the drawing has twice": ((FRAME, *[dash(2)] * 3), (FRAME, *[dash(2)] * 2)),
}


@pytest.mark.parametrize("kind", REPEATED)
def test_what_is_repeated_is_found(kind: str) -> None:
    drawn, wanted = REPEATED[kind]
    assert set(check_result_on(drawn, wanted)) == {"nothing twice"}


SOUND: dict[str, tuple[Sequence[Line], Sequence[Line]]] = {
    "taps in one place": ([DOT] * 3, [DOT] * 3),
    "a line that the drawing has twice": ([dash(2)] * 2, [dash(2)] * 2),
    "once what the drawing has twice": ([dash(2), DOT], [dash(2), dash(2)[::-1], DOT, DOT]),
    "a tap on a line": ([dash(2), ((101, 10),)], [dash(2), ((101, 10),)]),
    "a line that crosses itself": ([((90, 0), (110, 20), (110, 0), (90, 20))],) * 2,
    "back and forth": ([(*dash(5), (100, 10))],) * 2,
    "a closed line begun elsewhere": ([FRAME], [(*FRAME[2:], *FRAME[1:3])]),
    "a closed line begun within a side": ([((60, 0), *FRAME[1:], (60, 0))], [FRAME]),
    "a line in two parts": ([((60, 0), (70, 5)), ((70, 5), (80, 10))], [((60, 0), (80, 10))]),
    "two lines in one stroke": ([((60, 0), (70, 5), (80, 0))], [((60, 0), (70, 5)), ((80, 0), (70, 5))]),
    "ends joined over a gap of the tolerance": (
        [((60, 0), (70, 0), (70.04, 0), (80, 0))],
        [((60, 0), (70, 0)), ((70.04, 0), (80, 0))],
    ),
    "hatch closer than the tolerance": ([((80, k / 50), (84, k / 50)) for k in range(6)],) * 2,
    "hatch to and fro in one stroke": ([[(80 + 4 * ((k + 1) // 2 % 2), k // 2 / 20) for k in range(10)]],) * 2,
    "dashes": ([((80 + k / 5, 5), (80.08 + k / 5, 5)) for k in range(6)],) * 2,
}


@pytest.mark.parametrize("kind", SOUND)
def test_what_the_drawing_has_may_be_drawn(kind: str) -> None:
    drawn, wanted = SOUND[kind]
    assert not check_result_on(drawn, wanted)


@settings(max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), step_mm=st.sampled_from([0.03, 0.3, 3.0]))
def test_scribbles_pass_and_a_part_of_them_twice_does_not(seed: int, step_mm: float) -> None:
    steps = np.random.default_rng(seed).normal(0, step_mm, (12, 2))
    scribble = [(x, y) for x, y in np.array([100.0, 0.0]) + np.cumsum(steps, axis=0)]
    assert "nothing twice" not in check_result_on([scribble], [scribble])
    whole_mm = float(np.linalg.norm(np.diff(scribble, axis=0), axis=1).sum())
    apart = ((20, 20), (20 + whole_mm + 1, 20))
    assert set(check_result_on([scribble, apart, apart], [scribble, apart])) == {"nothing twice"}
