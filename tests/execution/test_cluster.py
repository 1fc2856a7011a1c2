"""Work on a Dask cluster: a real scheduler and a worker on this machine, planning the same bytes as one process."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from planner.cli import main
from planner.execution import work_chunks, workers
from tests.drawn_shapes import scribbles

ROOT = Path(__file__).resolve().parent.parent
START_S = 60


@contextmanager
def running(module: str, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """A process that is gone afterwards, whatever happens."""
    process = subprocess.Popen(
        [sys.executable, "-m", module, *arguments], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@pytest.fixture
def scheduler(tmp_path: Path) -> Iterator[Path]:
    """The file that tells where a scheduler without workers listens, on loopback alone."""
    file = tmp_path / "scheduler.json"
    with running(
        "distributed.cli.dask_scheduler",
        "--host",
        "tcp://127.0.0.1",
        "--port",
        "0",
        "--no-dashboard",
        "--no-show",
        "--scheduler-file",
        str(file),
    ) as process:
        deadline = time.monotonic() + START_S
        while not (file.exists() and file.read_text(encoding="utf-8").rstrip().endswith("}")):  # written in full
            assert process.poll() is None and time.monotonic() < deadline, "the scheduler does not start"
            time.sleep(0.05)
        yield file


def test_a_cluster_plans_the_same_bytes(
    scheduler: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(work_chunks, "_CHUNK_WORK", 150)
    monkeypatch.setattr(work_chunks, "_CHUNK_MOVES", 4)
    address = json.loads(scheduler.read_text(encoding="utf-8"))["address"]
    drawing = scribbles(tmp_path / "scribbles.svg", 6, 30)
    alone, shared = tmp_path / "alone.csv", tmp_path / "shared.csv"
    with monkeypatch.context() as hasty:
        hasty.setattr(workers, "_FIRST_ANSWER_S", 0.5)
        assert main([str(drawing), "-o", str(shared), "--quiet", "--workers", address]) == 2
    assert "has no workers" in capfd.readouterr().err and not shared.exists()
    with ExitStack() as until_done:
        # Two threads that share one process, and with it the models of the arm.
        until_done.enter_context(
            running(
                "distributed.cli.dask_worker",
                "--scheduler-file",
                str(scheduler),
                "--no-nanny",
                "--nthreads",
                "2",
                "--no-dashboard",
                "--local-directory",
                str(tmp_path / "worker"),
            )
        )
        until_done.enter_context(monkeypatch.context()).setattr(workers, "_FIRST_ANSWER_S", START_S)
        assert main([str(drawing), "-o", str(shared), "--quiet", "--workers", address]) == 0
    assert main([str(drawing), "-o", str(alone), "--quiet", "--workers", "1"]) == 0
    assert shared.read_bytes() == alone.read_bytes()
    assert capfd.readouterr().err == ""


def test_a_cluster_that_is_not_there_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(workers, "_FIRST_ANSWER_S", 0.5)
    drawing = scribbles(tmp_path / "scribbles.svg", 1, 10)
    assert main([str(drawing), "-o", str(tmp_path / "t.csv"), "--workers", "tcp://127.0.0.1:1"]) == 2
    assert "no Dask scheduler answers at tcp://127.0.0.1:1" in capfd.readouterr().err
    assert not (tmp_path / "t.csv").exists()
