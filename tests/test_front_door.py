"""What `import planner` offers: names, what each takes, what it returns, and how it refuses."""

from __future__ import annotations

import ast
import builtins
import io
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import planner
from planner import Plan, PlanSettings, Trajectory, check, compare, load_arm, plan
from planner.api.inputs import drawing_source
from planner.api.options import PlanOptions
from planner.arms.arm_file import arms_folder
from planner.cli import main
from planner.drawing.svg import read_drawing
from planner.errors import (
    ArmFileError,
    DrawingError,
    OutputError,
    PlannerError,
    TargetBeyondReach,
    TrajectoryFileError,
    UnknownArm,
    UnknownOption,
    UsageError,
)
from planner.settings import ConfigurationWeights, Method

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path stroke="#000" d="M2 2 5 4M7 7l1 0"/></svg>'


@pytest.fixture(scope="module")
def planned() -> Plan:
    return plan(SVG, arm="scara", margin_mm=20)


def test_every_stable_name_is_there_and_nothing_heavy_is_loaded_for_the_package() -> None:
    code = (
        "import sys, planner; names = set(sys.modules);"
        "assert not {'numpy', 'casadi', 'matplotlib', 'planner.errors'} & names, names;"
        "assert set(planner.__all__) <= set(dir(planner));"
        "from planner import PlannerError, PlanSettings, __version__;"
        "assert 'numpy' not in sys.modules;"
        "[getattr(planner, name) for name in planner.__all__];"
        "assert 'pandas' not in sys.modules and 'hardware' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    with pytest.raises(AttributeError, match="no attribute 'plam'"):
        planner.plam  # noqa: B018


def test_type_checkers_see_the_names_that_are_there() -> None:
    tree = ast.parse(Path(planner.__file__).read_text(encoding="utf-8"))
    seen = {
        alias.name: node.module
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        and (node.module or "").startswith("planner.")
        and "entry" not in node.module
        for alias in node.names
    }
    assert {*seen, "__version__"} == set(planner.__all__)
    for name, module in seen.items():
        assert getattr(planner, name) is getattr(sys.modules[str(module)], name)


def test_every_error_of_the_tree_is_offered() -> None:
    def tree(error: type[Exception]) -> set[str]:
        return {error.__name__}.union(*map(tree, error.__subclasses__()))

    public = {name for name in tree(PlannerError) if hasattr(planner.errors, name)}
    assert public <= set(planner.__all__)


def test_keywords_are_the_settings() -> None:
    assert {"arm", *get_type_hints(PlanOptions)} == {field.name for field in fields(PlanSettings)}


def test_a_drawing_is_the_same_however_it_is_given(tmp_path: Path) -> None:
    file = tmp_path / "tilde.svg"
    text = f'<?xml version="1.0" encoding="ISO-8859-1"?>\n<!-- caf\u00e9 -->{SVG}'
    file.write_bytes(text.encode("latin-1"))
    with file.open("rb") as binary, file.open(encoding="latin-1") as in_text:
        given_as = [file, str(file), text, "\n  " + text, text.encode("latin-1"), binary, in_text, io.StringIO(text)]
        drawings = [read_drawing(drawing_source(each)) for each in given_as]
    assert [drawing.source for drawing in drawings] == [
        *["tilde.svg"] * 2,
        *["drawing"] * 3,
        *["tilde.svg"] * 2,
        "drawing",
    ]
    for drawing in drawings:
        assert np.array_equal(drawing.user_to_page, drawings[0].user_to_page)
        for made, wanted in zip(drawing.outlines, drawings[0].outlines, strict=True):
            assert np.array_equal(made.beziers, wanted.beziers)


@given(text=st.text(max_size=30).map(lambda text: "<" + text))
def test_text_that_is_no_svg_is_refused_with_what_is_wrong(text: str) -> None:
    with pytest.raises(DrawingError, match=r"^drawing: "):
        read_drawing(drawing_source(text))


@pytest.mark.parametrize(
    ("drawing", "error", "told"),
    [
        ("", DrawingError, "empty"),
        ("  \n", DrawingError, "empty"),
        (b"", DrawingError, "empty"),
        (io.StringIO(), DrawingError, "empty"),
        ("nowhere.svg", DrawingError, "nowhere.svg: no such file"),
        ("x" * 9999, DrawingError, "cannot be read"),
        ("a\0b", DrawingError, "cannot be read"),
        (Path(), DrawingError, "folder"),
        (42, UsageError, "type int"),
        (None, UsageError, "type NoneType"),
        ([SVG], UsageError, "type list"),
        (type("Odd", (), {"read": lambda self: 3})(), UsageError, "type int"),
    ],
)
def test_what_is_no_drawing_is_refused(drawing: Any, error: type[PlannerError], told: str) -> None:
    with pytest.raises(error, match=told):
        plan(drawing, "scara")


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    file = tmp_path / "gone.svg"
    file.write_bytes(b"<svg>\xff</svg>")
    with file.open("rb") as closed:
        pass
    with file.open(encoding="utf-8") as wrong, file.open("ab") as for_writing:
        for each in (closed, wrong, for_writing):
            with pytest.raises(DrawingError, match=r"gone\.svg: cannot be read"):
                plan(each, "scara")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"rate_hz": 0}, "rate_hz"),
        ({"rate_hz": 49.9}, "rate_hz 49.9 has to be at least 50"),
        ({"rate_hz": 1e9}, "at most 10000"),
        ({"tolerance_mm": -1}, "tolerance_mm"),
        ({"tolerance_mm": "0.1mm"}, "tolerance_mm is a finite number, not '0.1mm'"),
        ({"speed_mm_s": float("nan")}, "speed_mm_s"),
        ({"lowering_speed_mm_s": 0}, "lowering_speed_mm_s 0 has to be positive"),
        ({"dwell_s": -0.1}, "dwell_s"),
        ({"lift_mm": 0}, "lift_mm"),
        ({"margin_mm": None}, "margin_mm"),
        ({"rotate_deg": float("inf")}, "rotate_deg"),
        ({"method": "magic"}, "method is one of path, nlp, dls, closed-form, not 'magic'"),
        ({"canvas": 3}, "canvas is one of"),
        ({"fit": "no"}, "fit is True or False"),
        ({"skip_unreachable": 1}, "skip_unreachable"),
        ({"weights": {"time": -1}}, "weight time"),
        ({"weights": {"speed": 1}}, "unknown option 'speed'; known options: time"),
        ({"weights": dict.fromkeys(("time", "sensitivity", "reversals", "limits"), 0)}, "all zero"),
        ({"weights": 3}, "weights"),
        ({"workers": 0}, "workers"),
        ({"workers": True}, "workers"),
        ({"progress": "yes"}, "progress"),
        ({"settings": {"rate_hz": 100}}, "settings is a PlanSettings"),
        ({"arm": 3}, "type int"),
        ({"tolerence_mm": 0.1}, "unknown option 'tolerence_mm'; known options: .*tolerance_mm"),
    ],
)
def test_options_that_mean_nothing_are_refused_by_name(options: dict[str, Any], told: str) -> None:
    with pytest.raises(UsageError, match=told):
        plan(SVG, **options)


def test_an_unknown_option_is_a_type_error_too() -> None:
    with pytest.raises(TypeError) as caught:
        plan(SVG, colour="red")  # type: ignore[call-arg]
    assert isinstance(caught.value, UnknownOption) and caught.value.name == "colour"


@given(
    rate_hz=st.floats(50, 10_000),
    speed_mm_s=st.floats(0.001, 1e6),
    rotate_deg=st.floats(-1e6, 1e6),
    method=st.sampled_from([*Method, *(method.value for method in Method)]),
)
def test_settings_hold_what_they_were_given(rate_hz: float, speed_mm_s: float, rotate_deg: float, method: Any) -> None:
    settings = PlanSettings(rate_hz=rate_hz, speed_mm_s=speed_mm_s, rotate_deg=rotate_deg, method=method)
    assert (settings.rate_hz, settings.speed_mm_s, settings.rotate_deg) == (rate_hz, speed_mm_s, rotate_deg)
    assert isinstance(settings.method, Method) and settings.method == method


def test_the_plan_is_that_of_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drawing = tmp_path / "lines.svg"
    drawing.write_text(SVG, encoding="utf-8")
    of_command, of_function = tmp_path / "command.csv", tmp_path / "function.csv"
    command = [str(drawing), "-o", str(of_command), "--arm", "so101", "--method", "nlp", "--speed", "40"]
    assert main([*command, "--weights", "time=2", "--quiet"]) == 0
    plan(drawing, "so101", method="nlp", speed_mm_s=40, weights={"time": 2}).save(of_function)
    assert of_function.read_bytes() == of_command.read_bytes()
    base = PlanSettings(arm="so101", method=Method.NLP, weights=ConfigurationWeights(time=2))
    plan(str(drawing), settings=base, speed_mm_s=40).save(of_function)
    assert of_function.read_bytes() == of_command.read_bytes()
    assert capsys.readouterr() == ("", "")


def test_how_a_drawing_is_read_may_be_said_in_words() -> None:
    beyond = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path stroke="#000" d="M2 2H18"/></svg>'
    cut, whole = plan(beyond, "scara", fit=False), plan(beyond, "scara", fit=False, reading={"crop": "none"})
    assert whole.summary.size_mm[0] == pytest.approx(16 * cut.summary.size_mm[0] / 7)
    assert check(whole.trajectory, beyond).passed and check(cut.trajectory, beyond).passed
    with pytest.raises(UsageError, match="crop is one of page, none, not 'paper'"):
        plan(beyond, reading={"crop": "paper"})
    with pytest.raises(UnknownOption):
        plan(beyond, reading={"cropped": "none"})


def test_an_arm_is_a_name_a_file_or_a_value(planned: Plan, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text((arms_folder() / "scara.toml").read_text(encoding="utf-8"), encoding="utf-8")
    for arm in ("scara", file, str(file), load_arm("scara"), load_arm(file)):
        made = plan(SVG, arm, margin_mm=20)
        assert np.array_equal(made.trajectory.positions, planned.trajectory.positions)
        assert made.check().passed
        assert check(made.trajectory, SVG, arm=arm).passed
    assert plan(SVG, load_arm(file), margin_mm=20).trajectory.arm == "scara"
    assert check(plan(SVG, file, margin_mm=20).trajectory).passed
    with pytest.raises(UnknownArm):
        load_arm("nobody")
    with pytest.raises(ArmFileError):
        load_arm(tmp_path / "missing.toml")


def test_progress_is_told_to_whoever_asks_and_what_that_raises_ends_the_plan(
    capsys: pytest.CaptureFixture[str],
) -> None:
    told: list[tuple[str, int, int]] = []
    plan(SVG, "scara", progress=lambda *now: told.append(now))
    assert {stage for stage, _, _ in told} == set(planner.progress.STAGES) - {"writing", "report"}
    assert capsys.readouterr() == ("", "")

    class Stop(Exception):
        pass

    def stop(stage: str, done: int, total: int) -> None:
        raise Stop

    with pytest.raises(Stop):
        plan(SVG, "scara", progress=stop)
    plan(SVG, "scara", progress=True)
    assert capsys.readouterr().out == ""


def test_a_plan_saves_itself_and_is_read_back(planned: Plan, tmp_path: Path) -> None:
    file = tmp_path / "traj.csv"
    planned.save(file)
    read = Trajectory.load(file)
    assert np.allclose(read.positions, planned.trajectory.positions, atol=1e-9)
    for given_as in (file, str(file), read):
        assert check(given_as, SVG).passed
    other = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path stroke="#000" d="M2 7 5 4"/></svg>'
    result = check(read, other, tolerance_mm=0.1)
    assert not result.passed and str(result) == result.text()
    with pytest.raises(OutputError):
        planned.save(tmp_path / "no" / "traj.csv")
    with pytest.raises(TrajectoryFileError):
        check(tmp_path / "none.csv")
    with pytest.raises(UsageError, match="tolerance_mm"):
        check(file, tolerance_mm=0)
    with pytest.raises(UsageError, match="type int"):
        check(3)  # type: ignore[arg-type]


def test_a_data_frame_is_the_file(planned: Plan, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    file = tmp_path / "traj.csv"
    planned.save(file)
    pandas.testing.assert_frame_equal(planned.to_frame(), pandas.read_csv(file, comment="#"), atol=1e-6)


def test_without_pandas_it_says_what_to_install(planned: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    genuine = builtins.__import__

    def without(name: str, *rest: Any) -> Any:
        if name == "pandas":
            raise ImportError(name)
        return genuine(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(UsageError, match=r"pip install 'drawing-arm-planner\[frame\]'"):
        planned.to_frame()


def test_pictures_and_films_go_to_files(planned: Plan, tmp_path: Path) -> None:
    for kind in ("drawing", "speed", "error", "profiles", "phase", "timeline"):
        figure = planned.plot(kind, tmp_path / f"{kind}.png")
        assert figure.axes and (tmp_path / f"{kind}.png").read_bytes().startswith(b"\x89PNG")
    planned.film(tmp_path / "film.html")
    planned.film(tmp_path / "film.gif", speed_factor=40, fps=2)
    assert (tmp_path / "film.gif").read_bytes().startswith(b"GIF8")
    refused = (
        lambda: planned.plot("pie"),
        lambda: planned.plot("speed", tmp_path / "speed.doc"),
        lambda: planned.plot("phase", stroke=99),
        lambda: planned.film(tmp_path / "film.png"),
        lambda: planned.film(tmp_path / "new.gif", fps=0),
    )
    before = set(tmp_path.iterdir())
    for refuse in refused:
        with pytest.raises(UsageError):
            refuse()
    assert set(tmp_path.iterdir()) == before


def test_a_notebook_shows_the_film_in_a_frame_that_can_reach_nothing(tmp_path: Path) -> None:
    from html.parser import HTMLParser

    made = plan(SVG, "scara", margin_mm=20)
    frames: list[dict[str, str | None]] = []

    class Reader(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            frames.append({"tag": tag, **dict(attrs)})

    Reader().feed(made._repr_html_())
    (frame,) = frames
    assert frame["tag"] == "iframe" and frame["sandbox"] == "allow-scripts"
    made.film(tmp_path / "film.html")
    assert frame["srcdoc"] == (tmp_path / "film.html").read_text(encoding="utf-8")
    assert repr(made).startswith("<Plan of drawing on scara: 2 strokes")


def test_methods_are_compared_on_targets_of_three_kinds() -> None:
    single = compare(targets=[(53, 47.8)])
    assert "path" in str(single) and single.as_dict()["methods"] and len(single.convergences) == 1
    assert len(compare(arm="scara", random=5, seed=3).targets.tips_mm) == 5
    along = compare(SVG, load_arm("scara"), margin_mm=20, progress=lambda *now: None)
    assert len(along.targets.strokes) == 2


@pytest.mark.parametrize(
    ("wanted", "error"),
    [
        ({}, UsageError),
        ({"random": 3, "targets": [(1, 2)]}, UsageError),
        ({"random": 0}, UsageError),
        ({"random": 3, "seed": -1}, UsageError),
        ({"targets": []}, UsageError),
        ({"targets": [(1, 2, 3, 4)]}, UsageError),
        ({"targets": [(1, "x")]}, UsageError),
        ({"targets": [(1, float("nan"))]}, UsageError),
        ({"targets": [(9999, 0)]}, TargetBeyondReach),
        ({"random": 3, "colour": "red"}, UnknownOption),
    ],
)
def test_comparisons_that_mean_nothing_are_refused(wanted: dict[str, Any], error: type[PlannerError]) -> None:
    with pytest.raises(error):
        compare(arm="scara", **wanted)
