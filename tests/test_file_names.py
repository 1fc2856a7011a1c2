"""File names on the command line: `-` is standard input and output everywhere, and names that are none are told so."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from planner.cli import main
from planner.trajectory import read_trajectory
from tests.drawn_shapes import lines_svg

DRAWING = lines_svg('<path d="M2 2 20 25 38 4"/>', 'viewBox="0 0 40 30"')
LONG = "a" * 300


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a drawing and its trajectory."""
    folder = tmp_path_factory.mktemp("desk")
    (folder / "drawing.svg").write_text(DRAWING)
    assert main([str(folder / "drawing.svg"), "-o", str(folder / "traj.csv"), "--quiet"]) == 0
    return folder


Command = Callable[..., tuple[int, bytes, str]]


@pytest.fixture
def command(
    desk: Path, monkeypatch: pytest.MonkeyPatch, capfdbinary: pytest.CaptureFixture[bytes]
) -> Iterator[Command]:
    """Runs a command in the desk's folder with bytes on standard input: exit code, standard output, standard error."""
    monkeypatch.chdir(desk)
    before = os.dup(0)

    def run(*arguments: str, given: bytes = b"") -> tuple[int, bytes, str]:
        with tempfile.TemporaryFile() as file:
            file.write(given)
            file.seek(0)
            os.dup2(file.fileno(), 0)
            code = main(arguments)
        told = capfdbinary.readouterr()
        return code, told.out, told.err.decode()

    yield run
    os.dup2(before, 0)
    os.close(before)


@pytest.mark.parametrize("arguments", [["-"], ["drawing.svg", "-o", "-"], ["drawing.svg", "-o", "/dev/stdout"]])
def test_a_plan_on_standard_output_is_rows_alone(desk: Path, command: Command, arguments: list[str]) -> None:
    code, rows, told = command(*arguments, given=DRAWING.encode())
    assert code == 0 and not (desk / "-").exists()
    (desk / "piped.csv").write_bytes(rows)
    assert read_trajectory(desk / "piped.csv").n_samples == read_trajectory(desk / "traj.csv").n_samples
    assert "samples at 50 Hz" in told and "wrote -" not in told


def test_every_command_reads_standard_input(desk: Path, command: Command) -> None:
    rows = (desk / "traj.csv").read_bytes()
    code, check_result, told = command("check", "-", "--drawing", "drawing.svg", "--json", "-", given=rows)
    assert code == 0 and json.loads(check_result)["passed"] and "passed" in told
    assert command("run", "-", "--dry-run", given=rows)[0] == 0
    code, picture, told = command("plot", "-", "-o", "-", given=rows)
    assert code == 0 and picture.startswith(b"\x89PNG") and told == ""
    assert json.loads(command("compare", "-", "--json", "-", given=DRAWING.encode())[1])["arm"] == "drawing_arm"


def test_standard_output_in_a_file_is_added_to(desk: Path) -> None:
    target = desk / "kept.txt"
    target.write_bytes(b"before\n")
    with target.open("ab") as file:
        subprocess.run(
            [sys.executable, "-m", "planner.cli", "drawing.svg", "-o", "/dev/stdout", "--quiet"],
            cwd=desk,
            stdout=file,
            check=True,
        )
    assert target.read_bytes() == b"before\n" + (desk / "traj.csv").read_bytes()


def test_a_pipe_serves_plan_and_report(desk: Path) -> None:
    """And a reader of rows that goes away is no error. The report is one without pictures."""
    without = "import sys; from planner.report import pictures; pictures.write_figure = lambda *_: None;"
    command = f"{without} from planner.cli import main; sys.exit(main())"
    plan = [sys.executable, "-c", command, "-", "-o", "-", "--quiet", "--report", "report"]
    with subprocess.Popen(
        plan, cwd=desk, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdin is not None and process.stdout is not None and process.stderr is not None
        process.stdout.close()
        process.stdin.write(DRAWING.encode())
        process.stdin.close()
        assert process.stderr.read() == b""
    assert process.returncode == 0
    assert "nothing missing" in (desk / "report" / "index.html").read_text()


@pytest.mark.parametrize(
    "arguments",
    [
        [""],
        [LONG],
        ["."],
        ["/"],
        ["a\0b.svg"],
        ["drawing.svg", "-o", ""],
        ["drawing.svg", "-o", LONG],
        ["drawing.svg", "-o", "/dev/full"],
        ["drawing.svg", "-o", "nowhere/traj.csv"],
        ["drawing.svg", "-o", "drawing.svg"],
        ["drawing.svg", "-o", "a\0b"],
        ["drawing.svg", "--report", LONG],
        ["drawing.svg", "--report", ""],
        ["drawing.svg", "--report", "-"],
        ["drawing.svg", "--report", "drawing.svg"],
        ["check", ""],
        ["check", LONG],
        ["check", "."],
        ["check", "traj.csv", "--json", LONG],
        ["check", "traj.csv", "--json", "/dev/full"],
        ["check", "traj.csv", "--drawing", LONG],
        ["plot", "traj.csv", "-o", f"{LONG}.png"],
        ["plot", "traj.csv", "-o", ""],
        ["run", LONG],
        ["run", ""],
        ["run", "traj.csv", "--fast", "--picture", f"{LONG}.png"],
        ["compare", LONG],
        ["compare", ""],
        ["compare", "--target", "53", "47", "--json", LONG],
        ["batch", LONG],
        ["batch", ""],
        ["batch", ".", "-o", LONG],
    ],
)
def test_a_name_that_is_no_file_is_told_in_one_line(
    desk: Path, arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(desk)
    before = sorted(path.name for path in desk.iterdir())
    assert main([*arguments]) == 2
    told = capsys.readouterr()
    assert told.err.startswith("plan: error: ") and told.err.count("\n") == 1 and told.out == ""
    assert sorted(path.name for path in desk.iterdir()) == before


def test_standard_input_is_read_once(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "-", "--drawing", "-"]) == 2
    assert "standard input can be read only once" in capsys.readouterr().err
