"""`--events`: what programs that drive the commands are told, and what they can ask of a run."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from planner.cli import main
from tests.drawn_shapes import lines_svg

PAGE = 'viewBox="0 0 60 60" width="60mm" height="60mm"'
STAGES = ["reading", "placing", "joining", "ordering strokes", "drawing motions", "travels", "writing"]


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("events")
    drawing = folder / "d.svg"
    drawing.write_text(lines_svg('<path d="M5 5 H55 V55 H5 Z"/><path d="M15 10 L45 50"/>', PAGE))
    assert main([str(drawing), "-o", str(folder / "t.csv"), "--quiet"]) == 0
    return folder / "t.csv"


@contextmanager
def driven(command: str, *options: str) -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(
        [sys.executable, "-m", "planner", command, "--events", *options],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def events_of(process: subprocess.Popen[str]) -> Iterator[dict[str, Any]]:
    assert process.stdout is not None
    for line in process.stdout:
        yield json.loads(line)


def press(process: subprocess.Popen[str], key: str) -> None:
    assert process.stdin is not None
    process.stdin.write(key)
    process.stdin.flush()


def test_a_plan_tells_its_stages_in_order_and_what_it_wrote(planned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = planned.with_name("again.csv")
    assert main([str(planned.with_name("d.svg")), "-o", str(target), "--events"]) == 0
    *told, done = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    stages = list(dict.fromkeys(event["stage"] for event in told))
    assert stages == [stage for stage in STAGES if stage in stages] and len(stages) > 3
    shares = [event["done"] / event["total"] for event in told]
    assert shares == sorted(shares) and shares[0] >= 0.0 and shares[-1] <= 1.0
    assert done["event"] == "done" and done["files"] == [str(target)]
    assert any("strokes" in line for line in done["summary"])
    assert target.read_bytes() == planned.read_bytes()


def test_events_and_a_result_do_not_share_standard_output(planned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(planned.with_name("d.svg")), "-o", "-", "--events"]) == 2
    said = capsys.readouterr()
    assert "--events" in said.err and not said.out


def test_a_program_pauses_a_run_lets_it_go_on_and_stops_it(planned: Path) -> None:
    with driven("run", str(planned)) as process:
        events = events_of(process)
        assert next(events) == {"event": "connected", "strokes": 2}
        seen = [next(events)]
        press(process, "p")
        while not seen[-1]["paused"]:
            seen.append(next(events))
        press(process, "p")
        while seen[-1]["paused"]:
            seen.append(next(events))
        press(process, "q")
        seen += events
        assert process.wait() == 130
    ended = seen.pop()
    assert ended["event"] == "ended" and ended["how"] == "stopped" and ended["parked"] and not ended["complete"]
    samples = [event["sample"] for event in seen]
    assert samples == sorted(samples) and seen[-1]["reached"] < seen[-1]["total"]
    assert all(event["left_s"] > 0 for event in seen)


def test_a_run_stops_and_parks_when_the_program_that_drives_it_is_gone(planned: Path) -> None:
    with driven("run", str(planned)) as process:
        events = events_of(process)
        next(events)
        assert process.stdin is not None
        process.stdin.close()
        *_, ended = events
        assert process.wait() == 130
    assert ended["how"] == "stopped" and ended["parked"]


def test_a_program_is_asked_for_pens_and_answers(tmp_path: Path) -> None:
    drawing = tmp_path / "two.svg"
    drawing.write_text(lines_svg('<path d="M10 10 H30" stroke="blue"/><path d="M10 20 H30" stroke="red"/>', PAGE))
    trajectory = tmp_path / "two.csv"
    assert main([str(drawing), "-o", str(trajectory), "--by", "colour", "--quiet"]) == 0
    with driven("run", str(trajectory)) as process:
        asked = []
        for event in events_of(process):
            if event["event"] == "insert":
                asked.append(event)
                press(process, " ")
        assert process.wait() == 0
    assert [event["number"] for event in asked] == [1] and asked[0]["pen"]
    assert event["event"] == "ended" and event["complete"]


def test_an_arm_is_jogged_by_a_program_that_is_told_what_came_of_it(tmp_path: Path) -> None:
    target = tmp_path / "mine.toml"
    with driven("jog", "--arm", "drawing_arm_2022", "-o", str(target)) as process:
        told = events_of(process)
        first = next(told)
        assert first["event"] == "stands" and first["saved"] and not first["pen_is_up"]
        name, here = first["chosen"], first["joints"][0]["at"]
        press(process, "move 2\n")
        moved = next(told)["joints"][0]
        assert moved["at"] == pytest.approx(here + 2) and moved["told"] != first["joints"][0]["told"]
        press(process, "move 400\nnonsense\n")
        for word in (name, "nonsense"):
            assert word in next(told)["why"]
            assert next(told)["joints"][0] == moved
        press(process, "high\nsave\n")
        assert not next(told)["saved"]
        assert next(told) == {"event": "saved", "file": str(target)}
        assert next(told)["saved"] and target.exists()
        press(process, "quit\n")
        assert not list(told) and process.wait() == 0


def test_stop_overtakes_the_commands_before_it() -> None:
    with driven("jog", "--arm", "drawing_arm") as process:
        told = events_of(process)
        next(told)
        press(process, "move 1\n" * 2000 + "move -1\n" * 2000 + "stop\n")
        seen = list(told)
        assert seen[-1] == {"event": "stopped"} and len(seen) < 4000
        assert process.wait() == 130


def test_events_of_a_jog_take_no_script(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = tmp_path / "moves.txt"
    script.write_text("show\n")
    assert main(["jog", "--arm", "drawing_arm", "--events", "--script", str(script)]) == 2
    assert "standard input" in capsys.readouterr().err
