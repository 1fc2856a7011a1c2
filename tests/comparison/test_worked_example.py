"""The documents' worked example through the command line: nine iterations, to the printed decimals."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from planner.arms.arm_file import known_arms
from planner.cli import main
from planner.comparison.convergence import convergence
from planner.comparison.worked_example import ERRATA, ITERATIONS, documented_start
from tests.arms.chains import kinematics_of, load_once

HALF_A_DIGIT = 0.5e-4 * (1 + 1e-6)


def printed(index: int, column: str) -> list[float]:
    """With the errata put right."""
    return [ERRATA.get((index, column, place), value) for place, value in enumerate(getattr(ITERATIONS[index], column))]


@pytest.fixture(scope="module")
def compared(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict[str, object]]:
    """The table and the JSON of the example."""
    folder = tmp_path_factory.mktemp("example")
    with pytest.MonkeyPatch.context() as patch:
        lines: list[str] = []
        patch.setattr("planner.cli.compare.print_summary", lambda told: lines.extend(told))
        assert main(["compare", "--target", "53", "47.8", "0", "--json", str(folder / "example.json")]) == 0
    return "\n".join(lines), json.loads((folder / "example.json").read_text())


def test_every_printed_figure_is_on_the_screen(compared: tuple[str, dict[str, object]]) -> None:
    lines = compared[0].splitlines()
    first = next(index for index, line in enumerate(lines) if line.startswith(" i    q1 deg"))
    rows = [[float(cell) for cell in line.split()] for line in lines[first + 1 : first + 1 + len(ITERATIONS)]]
    for index, row in enumerate(rows):
        assert row[0] == index
        assert row[1:6] == pytest.approx(printed(index, "angles_deg"), rel=0, abs=1.01e-4)  # either side's last digit
        lengths_cm = [
            *ITERATIONS[index].position_cm,
            ITERATIONS[index].error_plane_cm,
            ITERATIONS[index].error_height_cm,
        ]
        assert row[6:] == pytest.approx([10 * value for value in lengths_cm], rel=0, abs=1.01e-3)
    assert lines[first + 1 + len(ITERATIONS)].startswith("The documents print the same figures")
    assert lines[first + 2 + len(ITERATIONS) :] == [
        "  iteration 1, q5: -20.7625 printed, -29.7625 by their equations",
        "  iteration 2, q1: 28.5132 printed, 28.5142 by their equations",
    ]


def test_every_printed_figure_is_in_the_json(compared: tuple[str, dict[str, object]]) -> None:
    found = compared[1]
    documented = found["methods"][0]  # type: ignore[index]
    assert (documented["method"], documented["iterations"], documented["solved_share"]) == ("dls", 9, 1.0)
    assert list(found["start"].values()) == pytest.approx(ITERATIONS[0].angles_deg)  # type: ignore[attr-defined]
    (towards,) = found["convergence"]  # type: ignore[misc]
    assert towards["converged"] and towards["target_mm"] == [53.0, 47.8, 0.0]
    assert [row["i"] for row in towards["iterations"]] == list(range(10))
    for index, row in enumerate(towards["iterations"]):
        for column, values in (
            ("angles_deg", row["joints"].values()),
            ("position_cm", np.array(row["tip_mm"]) / 10),
            ("error_cm", np.array(row["error_mm"]) / 10),
        ):
            assert list(values) == pytest.approx(printed(index, column), rel=0, abs=HALF_A_DIGIT)
        assert row["error_along_mm"] / 10 == pytest.approx(ITERATIONS[index].error_plane_cm, rel=0, abs=HALF_A_DIGIT)
        assert row["error_across_mm"] / 10 == pytest.approx(ITERATIONS[index].error_height_cm, rel=0, abs=HALF_A_DIGIT)
        if ITERATIONS[index].step_deg is not None:
            assert list(row["step"].values()) == pytest.approx(printed(index, "step_deg"), rel=0, abs=HALF_A_DIGIT)
    last = documented["postures"][0]
    assert list(last.values()) == pytest.approx(printed(9, "angles_deg"), rel=0, abs=HALF_A_DIGIT)


def test_another_start_is_another_way_there(tmp_path: Path) -> None:
    target = tmp_path / "other.json"
    assert (
        main(["compare", "--target", "5.3cm", "4.78cm", "--start", "10", "70", "-40", "-50", "--json", str(target)])
        == 0
    )
    found = json.loads(target.read_text())
    assert list(found["start"].values()) == pytest.approx([10, 70, -40, -50, -70])
    assert found["convergence"][0]["iterations"][0]["joints"] == found["start"]


def test_only_the_documented_arm_has_the_documented_start_and_prints() -> None:
    assert [name for name in known_arms() if documented_start(load_once(name)) is not None] == ["drawing_arm"]
    arm = load_once("drawing_arm")
    start = documented_start(arm)
    assert start is not None
    example = np.array([53.0, 47.8, 0.0])
    assert convergence(kinematics_of(arm), example, start).printed == ITERATIONS
    assert convergence(kinematics_of(arm), np.array([53.1, 47.8, 0.0]), start).printed == ()
    assert convergence(kinematics_of(arm), example, np.append(start[:1] + 0.01, start[1:])).printed == ()


def test_a_target_out_of_reach_never_converges() -> None:
    arm = load_once("drawing_arm")
    start = documented_start(arm)
    assert start is not None
    found = convergence(kinematics_of(arm), np.array([300.0, 0.0, 0.0]), start)
    assert not found.converged and len(found.steps) == 2001
