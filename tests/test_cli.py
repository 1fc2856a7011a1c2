from __future__ import annotations

import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from planner.account import PhaseTimes
from planner.cli import EXIT_DEFECT, main
from planner.cli.plan import plan_parser
from planner.cli.plan_options import settings_of
from planner.cli.terminal import progress
from planner.counted import counted
from planner.drawing.fill_options import FillBy, FillKind, FillOptions, WideStrokes
from planner.drawing.options import ReadingOptions
from planner.errors import DoesNotFit, DrawingError, TargetOutOfReach
from planner.execution.workers import Workers
from planner.paper_size import Orientation, paper_size
from planner.pens import GroupBy, Pen
from planner.settings import Anchor, CanvasKind, ConfigurationWeights, Method, PlaceKind, PlanSettings, Timing
from planner.summary import PlanSummary
from planner.trajectory import Trajectory, read_trajectory, write_trajectory
from tests.drawn_shapes import lines_svg

ROOT = Path(__file__).resolve().parent.parent
USUAL = replace(PlanSettings(), rate_hz=50.0)
"""Nobody says a rate: it is that of the arm's servos."""
HEAVY = ("casadi", "loky", "matplotlib", "numpy", "pydantic", "rich", "ruckig", "scipy", "shapely", "tinycss2")


def _sweep(duration_s: float = 1.0) -> Trajectory:
    """q1 turns by 40 degrees, the pen on the paper."""
    n = round(duration_s * 100) + 1
    u = np.linspace(0, 1, n)
    q1_deg = 40 * (10 * u**3 - 15 * u**4 + 6 * u**5)
    return Trajectory(
        arm="drawing_arm",
        drawing="arc.svg",
        method="path",
        rate_hz=100.0,
        columns=("q1_deg", "q2_deg", "q3_deg", "q4_deg", "q5_deg"),
        positions=np.column_stack((q1_deg, *np.tile([[60.0], [-60.0], [-60.0], [-30.0]], n))),
        pen=np.ones(n, dtype=bool),
        stroke=np.zeros(n, dtype=np.int64),
        svg_to_arm_mm=(1, 0, 0, 1, 0, 0),
    )


@dataclass
class _Summary:
    warnings: list[str] = field(default_factory=lambda: ["2 texts were left out"])

    def lines(self) -> list[str]:
        return ["1 stroke", "1.00 s"]


@dataclass
class _Plan:
    trajectory: Trajectory
    summary: _Summary

    @property
    def warnings(self) -> list[str]:
        return self.summary.warnings

    def lines(self) -> list[str]:
        return self.summary.lines()


@pytest.fixture
def drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A drawing in the current folder."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "arc.svg"
    path.write_text(lines_svg('<path d="M2 2 20 25 38 4"/>', 'viewBox="0 0 40 30"'))
    return path


@pytest.fixture
def planned(monkeypatch: pytest.MonkeyPatch) -> Callable[[BaseException | None], list[Any]]:
    """Put a planner in place that notes what it is asked and hands back the sweep, or raises."""

    def install(error: BaseException | None = None) -> list[Any]:
        asked: list[Any] = []

        def plan(
            drawing: Path, settings: PlanSettings, report: Callable[[str, int, int], None], workers: Workers
        ) -> _Plan:
            asked.append((drawing, settings))
            report("travels", 1, 2)
            if error is not None:
                raise error
            return _Plan(_sweep(), _Summary())

        module = ModuleType("planner.pipeline")
        module.plan = plan  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, "planner.pipeline", module)
        return asked

    return install


@pytest.fixture
def sweep_csv(tmp_path: Path) -> Path:
    path = tmp_path / "traj.csv"
    write_trajectory(_sweep(), path)
    return path


def _one_line(capsys: pytest.CaptureFixture[str]) -> str:
    captured = capsys.readouterr()
    assert captured.err.startswith("plan: error: ")
    assert captured.err.count("\n") == 1
    assert captured.err.endswith("\n")
    assert "Traceback" not in captured.err
    assert captured.out == ""
    return captured.err


def test_a_plan_is_written_summed_up_and_warned_of(
    drawing: Path, planned: Callable[..., list[Any]], capsys: pytest.CaptureFixture[str]
) -> None:
    asked = planned()
    assert main([str(drawing)]) == 0
    captured = capsys.readouterr()
    assert captured.out == "1 stroke\n1.00 s\nwrote arc.csv\n"
    assert captured.err == "plan: warning: 2 texts were left out\n"
    assert asked == [(drawing, USUAL)]
    assert read_trajectory(drawing.with_name("arc.csv")).n_samples == 101

    assert main(["-o", "other.csv", "--quiet", str(drawing)]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == "plan: warning: 2 texts were left out\n"
    assert Path("other.csv").read_bytes() == Path("arc.csv").read_bytes()


def test_every_setting_has_an_option(drawing: Path, planned: Callable[..., list[Any]]) -> None:
    asked = planned()
    pens = drawing.with_name("pens.toml")
    pens.write_text('[[pen]]\nname = "blue"')
    assert (
        main(
            [
                str(drawing),
                "--arm",
                "drawing_arm_2022",
                "--method",
                "closed-form",
                "--timing",
                "ruckig",
                "--rate",
                "50",
                "--tolerance",
                "0.01cm",
                "--speed",
                "4cm/s",
                "--lowering-speed",
                "20",
                "--dwell",
                "0.25",
                "--lift",
                "96px",
                "--canvas",
                "optimal",
                "--place",
                "ink",
                "--no-fit",
                "--scale",
                "50%",
                "--paper",
                "a6",
                "--orientation",
                "portrait",
                "--at",
                "10",
                "2cm",
                "--origin",
                "centre",
                "--copies",
                "2x3",
                "--mirror",
                "--margin",
                "0.5in",
                "--rotate",
                "-90",
                "--skip-unreachable",
                "--no-cache",
                "--join",
                "0.2",
                "--dedup",
                "--simplify",
                "0.1",
                "--min-length",
                "0.5",
                "--passes",
                "2",
                "--keep-order",
                "--reverse",
                "--fill",
                "cross",
                "--fill-angle",
                "30",
                "--fill-spacing",
                "1",
                "--fill-inset",
                "0.2",
                "--fill-by",
                "lightness",
                "--stroke-width",
                "passes",
                "--layers",
                "1,sky",
                "--by",
                "layer",
                "--pens",
                str(pens),
                "--weights",
                "time=3,reversals=0",
                "--text",
                "outline",
                "--font",
                "a.ttf",
                "--crop",
                "none",
                "--occlude",
                "--dpi",
                "72",
            ]
        )
        == 0
    )
    wanted = PlanSettings(
        arm="drawing_arm_2022",
        method=Method.CLOSED_FORM,
        timing=Timing.RUCKIG,
        rate_hz=50,
        tolerance_mm=0.1,
        speed_mm_s=40,
        lowering_speed_mm_s=20,
        dwell_s=0.25,
        lift_mm=25.4,
        canvas=CanvasKind.OPTIMAL,
        place=PlaceKind.INK,
        fit=False,
        scale=0.5,
        paper=paper_size("a6"),
        orientation=Orientation.PORTRAIT,
        at_mm=(10.0, 20.0),
        origin=Anchor.CENTRE,
        copies=(2, 3),
        mirror=True,
        margin_mm=12.7,
        rotate_deg=-90,
        skip_unreachable=True,
        cache=False,
        join_mm=0.2,
        dedup_mm=0.05,
        simplify_mm=0.1,
        min_length_mm=0.5,
        passes=2,
        keep_order=True,
        reverse=True,
        fill=FillOptions(FillKind.CROSS, 30.0, 1.0, 0.2, FillBy.LIGHTNESS, WideStrokes.PASSES),
        layers=("1", "sky"),
        by=GroupBy.LAYER,
        pens=(Pen("blue"),),
        weights=ConfigurationWeights(time=3, reversals=0),
        reading=ReadingOptions("outline", Path("a.ttf"), "none", True, 72.0),
    )
    [(_, settings)] = asked
    default = PlanSettings()
    for one in fields(PlanSettings):
        if one.name == "align":  # which --at excludes
            continue
        assert getattr(wanted, one.name) != getattr(default, one.name), f"{one.name} is not varied here"
        value = getattr(wanted, one.name)
        assert getattr(settings, one.name) == (
            value if isinstance(value, ConfigurationWeights | ReadingOptions) else pytest.approx(value)
        )
    assert main([str(drawing), "--align", "top-left"]) == 0
    assert asked[1][1] == replace(USUAL, align=Anchor.TOP_LEFT)


@pytest.mark.parametrize(
    "text", ["time", "speed=1", "time=-1", "time=nan", "time=0,sensitivity=0,reversals=0,limits=0"]
)
def test_weights_that_mean_nothing_are_refused(drawing: Path, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(drawing), "--weights", text]) == 2
    assert "--weights" in capsys.readouterr().err


def test_the_defaults_are_those_of_the_settings() -> None:
    assert settings_of(plan_parser().parse_args(["a.svg"])) == USUAL


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "required: DRAWING.svg"),
        (["--rate", "0"], "'0' has to be positive"),
        (["--rate", "nan"], "'nan' is not a finite number"),
        (["--rate", "1e6"], "'1e6' is more than 10000"),
        (["--tolerance", "1e-9"], "'1e-9' is less than 0.001 mm"),
        (["--speed", "-3"], "'-3' has to be positive"),
        (["--speed", "3mm"], "'3mm' is not a speed"),
        (["--speed", "fast"], "'fast' is not a speed"),
        (["--margin", "3furlongs"], "'3furlongs' is not a length; wanted a number, plain or with mm, cm, in, px"),
        (["--margin", "1e999"], "'1e999' is not a finite number"),
        (["--margin=-1mm"], "'-1mm' has to be zero or more"),
        (["--lift", "0"], "'0' has to be positive"),
        (["--lift", "5mm/s"], "'5mm/s' is not a length"),
        (["--rotate", "inf"], "'inf' is not a finite number"),
        (["--method", "magic"], "invalid choice: 'magic'"),
        (["--text", "loud"], "invalid choice: 'loud' (choose from"),
        (["--crop", "paper"], "invalid choice: 'paper' (choose from"),
        (["--dpi", "0"], "'0' has to be positive"),
        (["--dpi", "5"], "'5' is less than 10"),
        (["--no-such-option"], "unrecognized arguments: --no-such-option"),
        (["--skip"], "unrecognized arguments: --skip"),
    ],
)
def test_usage_errors_are_one_line_and_exit_2(
    arguments: list[str],
    message: str,
    drawing: Path,
    planned: Callable[..., list[Any]],
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked = planned()
    assert main([str(drawing), *arguments] if arguments else []) == 2
    error = _one_line(capsys)
    assert message in error
    assert "see plan --help" in error
    assert asked == []


@pytest.mark.parametrize(
    ("error", "code", "message"),
    [
        (DrawingError("a.svg", "nothing to draw"), 2, "a.svg: nothing to draw"),
        (
            TargetOutOfReach(3, 7, (1, 2), "q2 would be at 190 deg", "q2", "180 deg"),
            3,
            "stroke 3, point 7 at (1.0, 2.0)",
        ),
        (DoesNotFit("it is 300 mm wide"), 3, "300 mm wide"),
        (MemoryError(), 2, "not enough memory"),
        (
            ZeroDivisionError("division by\nzero"),
            EXIT_DEFECT,
            "defect of the planner, not of the input: ZeroDivisionError",
        ),
    ],
)
def test_errors_are_one_line_with_their_code_and_leave_no_file(
    error: BaseException,
    code: int,
    message: str,
    drawing: Path,
    planned: Callable[..., list[Any]],
    capsys: pytest.CaptureFixture[str],
) -> None:
    planned(error)
    assert main([str(drawing)]) == code
    assert message in _one_line(capsys)
    assert list(drawing.parent.iterdir()) == [drawing]


def test_a_defect_shows_its_traceback_on_request(
    drawing: Path, planned: Callable[..., list[Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    planned(ZeroDivisionError())
    monkeypatch.setenv("PLAN_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        main([str(drawing)])


def test_an_interrupt_ends_with_130(
    drawing: Path, planned: Callable[..., list[Any]], capsys: pytest.CaptureFixture[str]
) -> None:
    planned(KeyboardInterrupt())
    assert main([str(drawing)]) == 130
    assert capsys.readouterr().err == "plan: interrupted\n"


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("no/such/traj.csv", "there is no folder"),
        (".", "it is a folder"),
        ("arc.svg", "it is what is being read"),
        ("link.svg", "it is what is being read"),
    ],
)
def test_an_impossible_output_is_refused_before_the_work(
    output: str, message: str, drawing: Path, planned: Callable[..., list[Any]], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("link.svg").symlink_to(drawing)
    asked = planned()
    assert main([str(drawing), "-o", output]) == 2
    assert message in _one_line(capsys)
    assert asked == []
    assert drawing.read_text().startswith("<svg")


def test_an_unwritable_folder_is_refused_before_the_work(
    drawing: Path,
    planned: Callable[..., list[Any]],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked = planned()
    # What the system says of a locked folder; to the superuser it would say otherwise.
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path).name != "locked")
    Path("locked").mkdir()
    assert main([str(drawing), "-o", "locked/traj.csv"]) == 2
    assert "locked is not writable" in _one_line(capsys)
    assert asked == []


def test_a_drawing_named_like_a_command_is_planned_by_its_path(
    drawing: Path, planned: Callable[..., list[Any]], capsys: pytest.CaptureFixture[str]
) -> None:
    asked = planned()
    drawing.rename("check")
    assert main(["./check"]) == 0
    assert asked[0][0] == Path("check")
    assert Path("check.csv").exists()
    assert main(["check"]) == 2
    assert "see plan check --help" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments", [["-h"], *([name, "--help"] for name in ("batch", "lines", "run", "check", "plot", "compare", "arm"))]
)
def test_every_command_explains_itself_with_examples(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 0
    text = capsys.readouterr().out
    assert "examples:\n  plan " in text
    assert max(map(len, text.splitlines())) <= 120


def test_help_loads_nothing_heavy_and_answers_at_once() -> None:
    script = (
        "import sys; from planner.cli import main; code = main(['--help']); "
        f"sys.exit(code or ','.join(m for m in {HEAVY} if m in sys.modules) or 0)"
    )
    began = time.perf_counter()
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""
    assert done.returncode == 0
    assert time.perf_counter() - began < 2  # 0.1 s on a machine of its own


def test_a_plan_loads_what_a_plan_needs(tmp_path: Path) -> None:
    drawing = tmp_path / "box.svg"
    drawing.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" fill="none" stroke="red">'
        '<path d="M0 0H40V20H0Z"/><path d="M10 5H20M20.1 5L25 8 30 5M50 5C50 8 60 8 60 5"/></svg>'
    )
    unneeded = (
        "hardware",
        "importlib.metadata",
        "loky",
        "matplotlib",
        "multiprocessing",
        "numpy.f2py",
        "numpy.ma",
        "planner.best_place",
        "planner.inverse_kinematics.closed_forms",
        "planner.inverse_kinematics.dls",
        "planner.inverse_kinematics.nlp",
        "planner.redundancy.plane_map",
        "pydantic",
        "rich",
        "scipy",
    )
    script = (
        "import sys; from planner.cli import main;"
        f" code = main([{str(drawing)!r}, '-o', {str(tmp_path / 'box.csv')!r}, '--quiet']); "
        f"sys.exit(code or ','.join(m for m in {unneeded} if m in sys.modules) or 0)"
    )
    for _ in range(2):  # the first keeps the arm and its maps, for which more is needed
        done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""
    assert done.returncode == 0


def test_a_small_plan_looks_for_no_garbage_and_neither_does_its_end(tmp_path: Path) -> None:
    drawing = tmp_path / "box.svg"
    drawing.write_text('<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H40V20H0Z" stroke="red"/></svg>')
    script = (
        "import gc, sys; from planner.entry.command import main; looks = [];"
        " gc.callbacks.append(lambda *look: looks.append(look)); main();"
        " sys.exit(f'{len(looks)} times, {gc.get_freeze_count()}' if looks or not gc.get_freeze_count() else 0)"
    )
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", script, str(drawing), "-o", str(tmp_path / "box.csv"), "--quiet"],
            cwd=ROOT,
            capture_output=True,
            text=True,
        )
    assert done.stderr == ""
    assert done.returncode == 0


def test_run_loads_no_solver_and_no_pictures(sweep_csv: Path) -> None:
    light = [name for name in HEAVY if name not in ("numpy", "pydantic")]
    script = (
        f"import sys; from planner.cli import main; code = main(['run', {str(sweep_csv)!r}, '--fast']); "
        f"sys.exit(code or ','.join(m for m in {light} if m in sys.modules) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""
    assert done.returncode == 0
    assert done.stdout.startswith("played after ")


def test_run_plays_slower_on_request(sweep_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drawing_s = []
    for factor in ("1", "0.25"):
        assert main(["run", str(sweep_csv), "--dry-run", "--speed-factor", factor]) == 0
        found = re.search(r"([0-9.]+) s for it", capsys.readouterr().out)
        assert found is not None
        drawing_s.append(float(found[1]))
    assert drawing_s == pytest.approx([1.0, 4.0], abs=0.03)
    assert main(["run", str(sweep_csv), "--fast", "--speed-factor", "2"]) == 2
    assert "'2' is more than 1" in _one_line(capsys)


@pytest.mark.parametrize("command", [["run", "--fast"], ["check"], ["plot", "-o", "p.png"]])
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("# trajectory: 1", "# trajectory: 7", "format"),
        ("# arm: drawing_arm", "# arm: nobody", "unknown arm 'nobody'"),
        ("0.100000,", "0.150000,", "line 19: time is not on the grid"),
        (",60.000000", ",sixty", "line 9: "),
    ],
)
def test_a_damaged_trajectory_is_refused_by_all(
    command: list[str],
    old: str,
    new: str,
    message: str,
    sweep_csv: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(sweep_csv.parent)
    text = sweep_csv.read_text()
    assert old in text
    sweep_csv.write_text(text.replace(old, new, 1))
    assert main([command[0], str(sweep_csv), *command[1:]]) == 2
    assert message in _one_line(capsys)
    assert list(sweep_csv.parent.iterdir()) == [sweep_csv]


def test_run_refuses_what_check_faults(sweep_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = sweep_csv.read_text().splitlines()
    lines[50] = lines[50].replace(",60.000000", ",200.000000", 1)
    sweep_csv.write_text("\n".join(lines) + "\n")
    assert main(["run", str(sweep_csv), "--fast"]) == 2
    assert "line 51: breaks a law of 'plan check' for arm 'drawing_arm' (the file names" in _one_line(capsys)
    check_result = sweep_csv.with_suffix(".json")
    assert main(["check", str(sweep_csv), "--json", str(check_result)]) == 1
    assert "line 51" in capsys.readouterr().out
    assert json.loads(check_result.read_text())["passed"] is False


def test_pictures_of_both_kinds(sweep_csv: Path, drawing: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(sweep_csv), "-o", "profiles.png"]) == 0
    assert main(["plot", str(sweep_csv), "-o", "paper.svg", "--kind", "drawing", "--drawing", str(drawing)]) == 0
    assert Path("profiles.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in Path("paper.svg").read_text()
    assert main(["plot", str(sweep_csv), "-o", "picture.bmp"]) == 2
    assert ".png" in _one_line(capsys)
    assert main(["plot", str(sweep_csv), "-o", "p.png", "--drawing", str(drawing)]) == 2
    assert "--kind drawing" in _one_line(capsys)


def test_arms_are_listed_and_described(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["arm"]) == 0
    assert re.search(r"^drawing_arm +5 joints ", capsys.readouterr().out, re.MULTILINE)
    assert main(["arm", "drawing_arm"]) == 0
    text = capsys.readouterr().out
    assert "coupling: q5 = -90 deg - q2 - q3 - q4" in text
    assert re.search(r"^q3 +revolute +0 +0 +50 +0 +-150 +30 +400 ", text, re.MULTILINE)
    assert main(["arm", "drawing_arm", "--json"]) == 0
    described = json.loads(capsys.readouterr().out)
    assert list(described) == ["name", "joints", "dh", "coupling", "pen", "reach_mm", "canvas"]
    assert described["reach_mm"]["min"] == pytest.approx(33, abs=0.5)
    assert described["reach_mm"]["max"] == pytest.approx(148.5, abs=0.7)
    assert len(described["canvas"]["corners_arm_mm"]) == 4
    assert main(["arm", "nobody"]) == 2
    assert "known arms: drawing_arm, drawing_arm_2022" in _one_line(capsys)


def test_an_arm_that_reaches_no_paper_is_described_and_drawn_without(
    sweep_csv: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (ROOT / "configs" / "drawing_arm.toml").read_text()
    high = sweep_csv.with_name("high.toml")
    high.write_text(text.replace("d_mm = 50.0", "d_mm = 500.0", 1))
    assert main(["arm", str(high)]) == 0
    assert re.search(r"^canvas: none \(.+\)$", capsys.readouterr().out, re.MULTILINE)
    assert main(["arm", str(high), "--json"]) == 0
    described = json.loads(capsys.readouterr().out)
    assert described["reach_mm"] is described["canvas"] is None
    picture = sweep_csv.with_name("paper.png")
    assert main(["plot", str(sweep_csv), "--kind", "drawing", "--arm", str(high), "-o", str(picture)]) == 0
    assert picture.stat().st_size > 1000


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("terminal", "quiet", "shows"), [(True, False, True), (True, True, False), (False, False, False)]
)
def test_progress_is_for_terminals(terminal: bool, quiet: bool, shows: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    stderr = _Terminal() if terminal else io.StringIO()
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setenv("TERM", "xterm")
    with progress(quiet=quiet) as show:
        show("timing [strokes]", 3, 4)
    assert ("timing [strokes]" in stderr.getvalue() and "75%" in stderr.getvalue()) is shows
    assert bool(stderr.getvalue()) is shows


@pytest.mark.parametrize(
    ("command", "doing"),
    [("check {}", "checking"), ("plot {} -o {}.png --kind sheet", "drawing"), ("run {} --dry-run", "examining")],
)
def test_what_takes_long_is_said_from_the_first_moment_on(
    command: str, doing: str, sweep_csv: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trajectory = tmp_path / "t.csv"
    trajectory.write_bytes(sweep_csv.read_bytes())
    monkeypatch.setenv("TERM", "xterm")
    for quiet in (False, True):
        monkeypatch.setattr(sys, "stderr", stderr := _Terminal())
        assert main([*command.replace("{}", str(trajectory)).split(), *["--quiet"] * quiet]) < 2
        assert (doing in stderr.getvalue()) is not quiet


def _start(*arguments: str, stdout: Any = subprocess.PIPE) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "planner.cli", *arguments], cwd=ROOT, text=True, stdout=stdout, stderr=subprocess.PIPE
    )


def _wait_until_playing(process: subprocess.Popen[str]) -> None:
    """A handler for SIGTERM is set exactly while a trajectory is played."""
    status = Path(f"/proc/{process.pid}/status")
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        caught = re.search(r"^SigCgt:\s*(\w+)", status.read_text(), re.MULTILINE)
        if caught and int(caught[1], 16) >> (signal.SIGTERM - 1) & 1:
            return
        time.sleep(0.02)
    pytest.fail("the trajectory never began to play")


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="looks into /proc")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_lifts_the_pen_and_ends_with_130(tmp_path: Path, number: int) -> None:
    path = tmp_path / "long.csv"
    write_trajectory(_sweep(60.0), path)
    process = _start("run", str(path))
    _wait_until_playing(process)
    time.sleep(0.3)
    process.send_signal(number)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 130
    assert err == "plan: --resume goes on from stroke 0 of 0..0\n"
    assert out.startswith("stopped after ")
    assert "the pen rests 5.00 mm above the paper, the arm is parked" in out


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="looks into /proc")
def test_a_second_ctrl_c_stops_at_once(tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    write_trajectory(_sweep(3.0), path)
    process = _start("run", str(path))
    _wait_until_playing(process)
    time.sleep(2.2)  # on the paper, and far enough from the park pose for the way back to take a while
    process.send_signal(signal.SIGINT)
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=20)
    assert process.returncode == 130
    assert out.startswith("emergency stop after ")
    assert "the arm holds where it is" in out


def test_a_reader_that_goes_away_is_no_error() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    process = _start("arm", stdout=writer)
    os.close(writer)
    _, err = process.communicate(timeout=20)
    assert (process.returncode, err) == (0, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_behind_standard_output_is_an_error() -> None:
    with Path("/dev/full").open("w") as full:
        process = _start("arm", stdout=full)
        _, err = process.communicate(timeout=20)
    assert process.returncode == 2
    assert err == "plan: error: cannot write to standard output: No space left on device\n"


def test_a_quiet_check_prints_the_faults_alone(sweep_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (["check", str(sweep_csv), "--quiet"], ["--quiet", "check", str(sweep_csv)]):
        loud = main(["check", str(sweep_csv)])
        faults = [line for line in capsys.readouterr().out.splitlines() if line.startswith("FAULT")]
        assert main(arguments) == loud
        assert capsys.readouterr().out.splitlines() == faults


@pytest.mark.parametrize(
    ("start", "what"),
    [
        (b"\x89PNG\r\n\x1a\n", "a picture, but it is no whole picture"),
        (b"\xff\xd8\xff\xe0", "a picture, but it is no whole picture"),
        (b"GIF89a", "a picture, but it is no whole picture"),
        (b"8BPS", "this is a picture (Photoshop), not an SVG"),
        (b"%PDF-1.7", "this is a PDF, not an SVG"),
    ],
)
def test_what_is_neither_svg_nor_whole_picture_is_no_drawing(
    start: bytes, what: str, sweep_csv: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "drawing.svg"
    picture.write_bytes(start + bytes(range(256)))
    for arguments in (["check", str(sweep_csv), "--drawing", str(picture)], [str(picture)]):
        assert main(arguments) == 2
        assert f"drawing.svg: {what}" in _one_line(capsys)


@pytest.mark.parametrize(("count", "words"), [(0, "0 strokes"), (1, "1 stroke"), (2, "2 strokes")])
def test_one_is_no_plural(count: int, words: str) -> None:
    assert counted(count, "stroke") == words
    summary = PlanSummary(count, count, count, 10.0, 0.0, PhaseTimes(1, 1, 1, 1, 1), 5.0, count, 100.0)
    assert summary.lines()[0].startswith(words + ["", ", 1 of them a tap", ", 2 of them taps"][count] + ", ")
    assert summary.lines()[-1] == f"{counted(count, 'sample')} at 100 Hz"
