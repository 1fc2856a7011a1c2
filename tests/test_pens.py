"""Layers and pens: who draws what, in which order, and what is wrong with a file of pens."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.checking.check import check_trajectory
from planner.cli import main
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.layer_name import LayerName
from planner.drawing.pen_groups import chosen_layers, only, pen_groups
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing
from planner.errors import TrajectoryFileError, UsageError
from planner.pens import GroupBy, Pen, colour_of, hex_of
from planner.pens_file import read_pens
from planner.pipeline import plan
from planner.progress import unreported
from planner.settings import PlanSettings
from planner.trajectory import read_trajectory

LINE = np.linspace((0.0, 0.0), (30.0, 0.0), 4)[None]
channel = st.integers(0, 255)


def drawing_of(*outlines: tuple[str, tuple[int, int, int], float]) -> Drawing:
    lines = tuple(Outline(LINE + np.array([0.0, row]), *told) for row, told in enumerate(outlines))
    return Drawing("drawn.svg", lines, np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), (100.0, 100.0))


LAYERED = drawing_of(
    ("1 sky", (255, 0, 0), 0.5),
    ("2+S50 sea", (0, 0, 255), 0.5),
    ("%3 grid", (0, 0, 0), 0.2),
    ("1 sky", (0, 0, 250), 1.0),
)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("sky", LayerName(None, True, False, 1.0, 0.0, None)),
        ("%3 grid", LayerName(3, False, False, 1.0, 0.0, None)),
        ("!12 +S50 +D500+h40 gold", LayerName(12, True, True, 0.5, 0.5, 40)),
        ("4+S999 a", LayerName(4, True, False, 1.0, 0.0, None)),
        ("  +s30+S70+S0b", LayerName(None, True, False, 0.7, 0.0, None)),
        ("%5 +D20", LayerName(5, False, False, 1.0, 0.02, None)),
        ("5%name", LayerName(5, True, False, 1.0, 0.0, None)),
        ("%5 name", LayerName(5, False, False, 1.0, 0.0, None)),
        (" ! sea", LayerName(None, True, True, 1.0, 0.0, None)),
        ("wow!", LayerName(None, True, False, 1.0, 0.0, None)),
        ("C+S50 and A+D4", LayerName(None, True, False, 1.0, 0.0, None)),
        ("7 sky +S50", LayerName(7, True, False, 1.0, 0.0, None)),
        ("", LayerName(None, True, False, 1.0, 0.0, None)),
    ],
)
def test_names_of_layers_ask_for_what_axidraw_users_mean(name: str, told: LayerName) -> None:
    assert LayerName.of(name) == told


@given(st.text())
def test_any_name_is_a_name(name: str) -> None:
    assert 0.01 <= LayerName.of(name).speed_share <= 1.1


def test_layers_are_chosen_by_name_and_number() -> None:
    assert [outline.layer for outline in chosen_layers(LAYERED, None).outlines] == ["1 sky", "2+S50 sea", "1 sky"]
    assert chosen_layers(LAYERED, None).skipped == {"layer that is not to be plotted (%)": 1}
    assert [outline.layer for outline in chosen_layers(LAYERED, ("3", "2+S50 sea")).outlines] == [
        "2+S50 sea",
        "%3 grid",
    ]
    with pytest.raises(UsageError, match=r"has no layer 'moon'; it has 1 sky, 2\+S50 sea"):
        chosen_layers(LAYERED, ("1", "moon"))


@given(
    st.sampled_from(GroupBy),
    st.lists(st.tuples(st.sampled_from("abc"), st.tuples(channel, channel, channel), st.floats(0.0, 3.0)), min_size=1),
)
def test_every_line_has_one_pen_and_pens_can_be_told_apart(
    by: GroupBy, told: list[tuple[str, tuple[int, int, int], float]]
) -> None:
    drawing = drawing_of(*told)
    groups = pen_groups(drawing, by, (), 2.0)
    drawn = [outline for group in groups for outline in group.outlines]
    assert sorted(map(id, drawn)) == sorted(map(id, drawing.outlines))
    assert len({group.pen for group in groups}) == len(groups)
    for group in groups:
        assert only(drawing, by, group.kinds, 2.0).outlines == group.outlines


def test_pens_draw_what_is_nearest_to_them_in_their_own_order() -> None:
    pens = (Pen("blue", (0, 0, 200)), Pen("green", (0, 255, 0)), Pen("warm", (200, 30, 0)))
    groups = pen_groups(chosen_layers(LAYERED, None), GroupBy.COLOUR, pens, 1.0)
    assert [(group.pen.name, group.kinds) for group in groups] == [
        ("blue", ("#0000ff", "#0000fa")),
        ("warm", ("#ff0000",)),
    ]
    wide = (Pen("fine", width_mm=0.3), Pen("broad", width_mm=2.0))
    groups = pen_groups(LAYERED, GroupBy.WIDTH, wide, 2.0)
    assert [(group.pen.name, group.kinds) for group in groups] == [("fine", ("1.00", "0.40")), ("broad", ("2.00",))]


def test_layers_go_to_the_pens_that_name_them() -> None:
    pens = (Pen("ink", layers=("1 sky", "2+S50 sea")), Pen("%3 grid"))
    groups = pen_groups(LAYERED, GroupBy.LAYER, pens, 1.0)
    assert [(group.pen.name, group.halts, group.speed_share) for group in groups] == [
        ("ink", True, 1.0),
        ("ink", False, 0.5),
        ("%3 grid", True, 1.0),
    ]
    with pytest.raises(UsageError, match="no pen draws layer '%3 grid'; name it in the layers of one of ink"):
        pen_groups(LAYERED, GroupBy.LAYER, pens[:1], 1.0)
    halting = replace(LAYERED, outlines=tuple(replace(one, layer=f"!{one.layer}") for one in LAYERED.outlines))
    assert all(group.halts for group in pen_groups(halting, GroupBy.LAYER, (), 1.0))


@given(st.tuples(channel, channel, channel))
def test_colours_go_and_come_back(colour: tuple[int, int, int]) -> None:
    assert colour_of(hex_of(colour)) == colour and colour_of(hex_of(colour).upper()) == colour


PENS = '[[pen]]\nname = "blue"\ncolour = "#00f"\nwidth_mm = 0.5\nspeed_mm_s = 40\nlayers = ["sky"]\n'


def test_a_file_of_pens_is_read(tmp_path: Path) -> None:
    (tmp_path / "pens.toml").write_text(PENS + '[[pen]]\nname = "black"\nlift_mm = 6\nlowering_speed_mm_s = 20')
    assert read_pens(tmp_path / "pens.toml") == (
        Pen("blue", (0, 0, 255), 0.5, ("sky",), 40.0),
        Pen("black", lift_mm=6.0, lowering_speed_mm_s=20.0),
    )


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (PENS + PENS, "two pens are called 'blue'"),
        (PENS.replace("0.5", '"thin"'), "pen 1: width_mm is a number"),
        (PENS.replace("0.5", "-1"), "pen 1: .*width of pen 'blue'"),
        (PENS.replace("#00f", "blue"), "pen 1: 'blue' is no colour such as"),
        (PENS.replace("width_mm", "height_mm").replace("0.5", "-101"), "pen 1: height_mm of pen 'blue' -101"),
        (PENS.replace("colour", "color"), "pen 1: unknown key 'color'"),
        (PENS.replace('name = "blue"\n', ""), "pen 1: has no name"),
        (PENS.replace('["sky"]', '"sky"'), "layers is a list"),
        ("", r"holds tables \[\[pen\]\]"),
        ("[pen]\nname = 'x'", r"holds tables \[\[pen\]\]"),
        ("[[pen]", "not readable TOML"),
    ],
)
def test_a_faulty_file_of_pens_is_refused_with_its_place(tmp_path: Path, text: str, fault: str) -> None:
    (tmp_path / "pens.toml").write_text(text)
    with pytest.raises(UsageError, match=rf"pens\.toml.*{fault}"):
        read_pens(tmp_path / "pens.toml")
    with pytest.raises(UsageError, match="cannot be read"):
        read_pens(tmp_path / "none.toml")


SVG = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 60" width="100mm" height="60mm" fill="none"
 xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" stroke="#00f">
<g inkscape:groupmode="layer" inkscape:label="a  &#10;b, &quot;c&quot; ✏"><path d="M10 10H40"/></g>
<g inkscape:groupmode="layer" inkscape:label="2 sea"><path stroke="red" d="M10 40C30 10 60 60 90 30"/></g>
<g inkscape:groupmode="layer" inkscape:label="%grid"><path d="M0 30H100"/></g></svg>"""


def test_pens_draw_one_after_the_other_in_register(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(SVG, encoding="utf-8")
    assert main(["d.svg", "-o", "all.csv", "--by", "layer", "--quiet"]) == 0
    whole = read_trajectory(Path("all.csv"))
    assert [pen.name for pen in whole.pens] == ['a b, "c" ✏', "2 sea"] and len(whole.pen_changes) == 1
    assert whole.pen_of_stroke.tolist() == [0, 1]
    assert main(["d.svg", "-o", "by.csv", "--by", "layer", "--split", "--quiet"]) == 0
    assert main(["d.svg", "-o", "sea.csv", "--layers", "2", "--quiet"]) == 0
    parts = [read_trajectory(path) for path in sorted(Path().glob("by_*.csv"))]
    for part in (*parts, read_trajectory(Path("sea.csv"))):
        assert part.svg_to_arm_mm == whole.svg_to_arm_mm
    for path in Path().glob("*.csv"):
        assert main(["check", str(path), "--drawing", "d.svg"]) == 0, path
    # The arm is at rest, away from the paper, where the pen is changed.
    change = whole.pen_changes[0]
    np.testing.assert_array_equal(whole.positions[change - 1], whole.positions[change + 1])
    assert not whole.pen[change]
    assert main(["run", "all.csv", "--fast", "--quiet"]) == 0
    assert main(["run", "all.csv", "--quiet"]) == 2  # nobody is at a terminal to change the pen


def test_layers_are_listed_as_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(
        SVG.replace("H40", "H140").replace("</svg>", '<g id="words"><text y="20" fill="black">ill</text></g></svg>'),
        encoding="utf-8",
    )

    def listed(*options: str) -> dict[str, str]:
        assert main(["d.svg", "--list-layers", *options]) == 0
        lines = capsys.readouterr().out.splitlines()
        return dict(line.rsplit(": ", 1) for line in lines)

    usual = listed()
    assert usual['a b, "c" ✏'].startswith("1 line, 90 mm") and len(usual) == 4
    assert listed("--crop", "none")['a b, "c" ✏'].startswith("1 line, 130 mm")
    assert len(listed("--text", "skip")) == 3
    assert len(chosen_layers(read_drawing(Path("d.svg")), ('a b, "c" ✏',)).outlines) == 1
    assert listed("--text", "outline") != usual
    assert main(["d.svg", "--list-layers", "--font", "none.ttf"]) == 2


def _longer(arm: Arm, height_mm: float) -> Arm:
    """The arm with its last link made longer along the pen."""
    x, _, z = (height_mm * component for component in arm.pen.tool_axis)
    joints = list(arm.joints)
    last = max(index for index, joint in enumerate(joints) if joint.a_mm or joint.d_mm or joint.file_unit == "mm")
    joints[last] = replace(joints[last], a_mm=joints[last].a_mm + x, d_mm=joints[last].d_mm + z)
    return replace(arm, joints=tuple(joints))


@pytest.mark.parametrize(("name", "tilt_deg"), [("drawing_arm", 0.0), ("scara", 0.0), ("so101", 0.2)])
def test_a_pen_that_sticks_out_further_draws_as_one_of_an_arm_with_a_longer_pen(name: str, tilt_deg: float) -> None:
    arm = load_arm(name)
    tilt = np.radians(tilt_deg)
    arm = replace(arm, paper=replace(arm.paper, tilt_x_rad=tilt, tilt_y_rad=-tilt / 2, z_mm=5 * tilt_deg))
    drawing = SvgInMemory("d", SVG.encode())
    pens = (Pen("short", layers=('a  \nb, "c" ✏',), height_mm=-2.0), Pen("long", layers=("2 sea",), height_mm=6.5))
    planned = plan(drawing, PlanSettings(arm=name, by=GroupBy.LAYER, pens=pens), unreported, arm=arm)
    assert check_trajectory(planned.trajectory, arm, planned.drawing).faults == ()
    for part, pen in zip(planned.by_pen, pens, strict=True):
        assert check_trajectory(part, arm, planned.drawing).faults == ()
        of_usual_length = replace(part, pens=tuple(replace(one, height_mm=0.0) for one in part.pens))
        assert check_trajectory(of_usual_length, _longer(arm, pen.height_mm), planned.drawing).faults == ()
        assert not check_trajectory(of_usual_length, arm, planned.drawing).passed
    with pytest.raises(UsageError, match="three_joint does not keep its pen upright"):
        load_arm("three_joint").holding(1.0)


def test_pens_of_several_heights_are_played_and_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(SVG, encoding="utf-8")
    Path("pens.toml").write_text('[[pen]]\nname="a"\ncolour="#00f"\nheight_mm=-1\n[[pen]]\nname="b"\nheight_mm=7')
    assert (
        main(["d.svg", "-o", "t.csv", "--by", "colour", "--pens", "pens.toml", "--quiet", "--layers", "2,%grid"]) == 0
    )
    trajectory = read_trajectory(Path("t.csv"))
    assert [pen.height_mm for pen in trajectory.pens] == [-1.0, 7.0]
    assert set(trajectory.pen_heights_mm[trajectory.pen]) == {-1.0, 7.0}
    assert main(["check", "t.csv", "--drawing", "d.svg"]) == 0
    for options in ([], ["--from-stroke", "1"]):
        assert main(["run", "t.csv", "--fast", "--quiet", "--picture", "drawn.svg", *options]) == 0
        drawn = Path("drawn.svg").read_text().count("<polyline")
        assert drawn == 2 - len(options) // 2
    told = Path("t.csv").read_text()
    Path("untold.csv").write_text(re.sub("# pen_heights_mm.*\n", "", told))
    assert main(["check", "untold.csv"]) == 1
    for faulty in ("7", "7 x", "1 2 3"):
        Path("t.csv").write_text(re.sub("(# pen_heights_mm:).*", rf"\1 {faulty}", told))
        with pytest.raises(TrajectoryFileError, match="pen_heights_mm"):
            read_trajectory(Path("t.csv"))
