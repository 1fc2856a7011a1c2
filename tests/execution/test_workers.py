"""Whoever does the work, the result is the same; and whatever ends it, nothing half-done is left behind."""

from __future__ import annotations

import operator
import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from planner import pipeline
from planner.arms.arm_file import load_arm
from planner.cli import main
from planner.cli.plan import plan_parser
from planner.errors import ArmFileError, PlannerError, TargetOutOfReach, UsageError
from planner.execution import work_chunks
from planner.execution.workers import ALONE, Workers, executor_of
from planner.pipeline import plan
from planner.placement import pieces
from planner.settings import Method, PlanSettings
from planner.trajectory import read_trajectory, write_trajectory
from tests.drawn_shapes import scribbles, svg_of, tap

ROOT = Path(__file__).resolve().parent.parent


def unheard(stage: str, done: int, total: int) -> None:
    """Progress that nobody looks at."""


@pytest.mark.parametrize("count", [1, 2, 3])
def test_results_come_in_the_order_of_their_chunks(count: int) -> None:
    with executor_of(Workers(count)) as executor:
        for _ in range(2):
            assert list(executor(partial(operator.mul, 2), range(50))) == list(range(0, 100, 2))


@pytest.mark.parametrize("count", [1, 2])
def test_errors_of_workers_keep_their_data(tmp_path: Path, count: int) -> None:
    broken = tmp_path / "broken.toml"
    broken.write_text('name = "broken"\n', encoding="utf-8")
    with executor_of(Workers(count)) as executor, pytest.raises(ArmFileError) as caught:
        list(executor(load_arm, ["drawing_arm", "scara", str(broken), "six_joint"]))
    with pytest.raises(ArmFileError) as told:
        load_arm(str(broken))
    assert caught.value.faults == told.value.faults and len(told.value.faults) > 1


def test_every_error_can_be_sent_from_process_to_process() -> None:
    error = TargetOutOfReach(3, 7, (1.0, 2.0), "too far", "q2", "180 deg")
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is TargetOutOfReach and str(copy) == str(error) and copy.__dict__ == error.__dict__


def test_the_same_bytes_whatever_the_number_of_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipeline, "_SMALL_BYTES", 0)
    monkeypatch.setattr(work_chunks, "_CHUNK_WORK", 150)
    monkeypatch.setattr(pieces, "_WORK", 100)
    monkeypatch.setattr(work_chunks, "_CHUNK_MOVES", 4)
    drawing = scribbles(tmp_path / "scribbles.svg", 8, 60)
    written = []
    for count in (1, 2, 3):
        file = tmp_path / f"{count}.csv"
        write_trajectory(plan(drawing, PlanSettings(), unheard, Workers(count)).trajectory, file)
        written.append(file.read_bytes())
    assert written[0] == written[1] == written[2]


def test_an_infeasible_path_is_the_same_error_whoever_meets_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipeline, "_SMALL_BYTES", 0)
    drawing = scribbles(tmp_path / "scribbles.svg", 8, 100)
    settings = PlanSettings(arm="drawing_arm_2022", method=Method.CLOSED_FORM, fit=False, margin_mm=0.0)
    told = []
    for workers in (ALONE, Workers(2)):
        try:
            told.append(plan(drawing, settings, unheard, workers).summary.lines()[0])
        except PlannerError as error:
            told.append(f"{type(error).__name__} {error}")
    assert told[0] == told[1]


@pytest.mark.parametrize(
    ("text", "workers"), [("1", ALONE), ("12", Workers(12)), ("tcp://host:8786", Workers(cluster="tcp://host:8786"))]
)
def test_workers_are_counted_or_named(text: str, workers: Workers) -> None:
    assert plan_parser().parse_args(["a.svg", "--workers", text]).workers == workers


@pytest.mark.parametrize("text", ["0", "-1", "two", "1.5", "99999", "tcp://host", "http://host:80", "tcp://:80"])
def test_other_workers_are_refused(text: str) -> None:
    with pytest.raises(UsageError, match="--workers"):
        plan_parser().parse_args(["a.svg", f"--workers={text}"])


def test_a_cluster_without_its_extra_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    drawing = scribbles(tmp_path / "scribbles.svg", 1, 10)
    assert main([str(drawing), "--workers", "tcp://localhost:1", "-o", str(tmp_path / "t.csv")]) == 2
    assert "drawing-arm-planner[dask]" in capsys.readouterr().err
    assert not (tmp_path / "t.csv").exists()


def _children(process: int) -> set[int]:
    """All descendants that are alive."""
    found = set()
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            except OSError:
                continue
            if parent == process:
                found |= {int(entry.name)} | _children(int(entry.name))
    return found


def _alive(process: int) -> bool:
    try:
        return (Path("/proc") / str(process) / "stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.fixture
def planning(tmp_path: Path) -> Iterator[tuple[subprocess.Popen[str], set[int]]]:
    """A long plan by two workers, in the middle of its work, and its processes."""
    drawing = scribbles(tmp_path / "long.svg", 60, 100)
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "planner.cli",
            str(drawing),
            "-o",
            str(tmp_path / "long.csv"),
            "--workers",
            "2",
            "--events",
        ],
        cwd=ROOT,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    assert process.stdout is not None
    assert any('"drawing motions"' in line for line in process.stdout)
    deadline = time.monotonic() + 30
    while len(_children(process.pid)) < 3 and time.monotonic() < deadline:  # two, and the tracker of their resources
        time.sleep(0.05)
    time.sleep(0.3)
    yield process, _children(process.pid)
    process.kill()
    process.communicate()


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks into /proc")
@pytest.mark.parametrize(
    ("number", "everyone"),
    [(signal.SIGINT, True), (signal.SIGINT, False), (signal.SIGKILL, False), (signal.SIGTERM, False)],
)
def test_ended_half_way_nothing_is_left(
    planning: tuple[subprocess.Popen[str], set[int]], tmp_path: Path, number: signal.Signals, everyone: bool
) -> None:
    """Ctrl-C reaches the workers too (everyone); a kill only the process that was started."""
    process, children = planning
    assert len(children) >= 2 and process.poll() is None
    if everyone:
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    _, err = process.communicate(timeout=15)
    assert process.returncode == (130 if number is signal.SIGINT else -number)
    assert "Traceback" not in err
    assert number is not signal.SIGINT or err.endswith("plan: interrupted\n")
    deadline = time.monotonic() + 15
    while any(map(_alive, children)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(map(_alive, children))
    assert [path.name for path in tmp_path.iterdir()] == ["long.svg"]


def test_a_folder_is_planned_whole_and_failures_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, out = tmp_path / "drawings", tmp_path / "out"
    folder.mkdir()
    for name in ("one", "two"):
        (folder / f"{name}.svg").write_text(svg_of([tap(10, 10), tap(30, 20)]), encoding="utf-8")
    (folder / "readme.txt").write_text("no drawing", encoding="utf-8")
    arguments = ["batch", str(folder), "-o", str(out), "--workers", "2"]
    assert main(arguments) == 0
    assert sorted(path.name for path in out.iterdir()) == ["one.csv", "two.csv"]
    assert read_trajectory(out / "one.csv").drawing == "one.svg"
    assert "2 of 2 drawings planned" in capsys.readouterr().out
    alone = tmp_path / "alone.csv"
    assert main([str(folder / "one.svg"), "-o", str(alone), "--quiet"]) == 0
    assert alone.read_bytes() == (out / "one.csv").read_bytes()
    (folder / "broken.svg").write_text("<svg", encoding="utf-8")
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert "2 of 3 drawings planned" in captured.out
    assert captured.err.startswith("plan: error: broken.svg: ") and captured.err.count("\n") == 1
    (folder / "large.svg").write_text(
        svg_of([tap(0, 0), tap(900, 0)], 'width="900mm" height="9mm" viewBox="0 0 900 9"'), encoding="utf-8"
    )
    assert main([*arguments, "--no-fit", "--workers", "1"]) == 3
    assert not (out / "large.csv").exists() and not (out / "broken.csv").exists()


@pytest.mark.parametrize(("names", "message"), [((), "no drawings"), (("a.svg", "a.SVG"), "several drawings")])
def test_a_folder_that_means_nothing_is_refused(
    names: tuple[str, ...], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in names:
        (tmp_path / name).write_text(svg_of([tap(1, 1)]), encoding="utf-8")
    if len(names) > len(list(tmp_path.iterdir())):
        pytest.skip("a file system without upper and lower case")
    assert main(["batch", str(tmp_path)]) == 2
    assert message in capsys.readouterr().err
    assert main(["batch", str(tmp_path / "missing")]) == 2
