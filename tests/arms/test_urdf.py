"""Robot descriptions: the chain is Pinocchio's, limits and couplings are the description's, and faults are told."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arms.arm_file import arm_of_text
from planner.arms.arm_text import arm_toml
from planner.arms.rigid_transform import IDENTITY, RigidTransform
from planner.arms.urdf.import_options import ImportOptions
from planner.arms.urdf.imported import Imported, imported
from planner.arms.urdf.robot import read_urdf
from planner.cli import main
from planner.errors import ArmFileError
from planner.kinematics.frame_jacobian import chain_frames, frame_jacobian
from planner.kinematics.usual_hold import with_usual_hold

_LIMIT = '<limit lower="-2" upper="1.5" velocity="2" effort="1"/>'


def joint(
    name: str, kind: str, parent: str, child: str, origin: str = "", axis: str = "0 0 1", more: str = _LIMIT
) -> str:
    axis = f'<axis xyz="{axis}"/>' if axis else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"<origin {origin}/>{axis}{more}</joint>"
    )


def robot(*joints: str, links: str = "abcdef", head: str = "") -> str:
    return (
        f'{head}<robot name="made-up arm">'
        + "".join(f'<link name="{one}"/>' for one in links)
        + "".join(joints)
        + "</robot>"
    )


def read(text: str, folder: Path, **options: object) -> Imported:
    file = folder / "robot.urdf"
    file.write_text(text, encoding="utf-8")
    return imported(read_urdf(file), ImportOptions(**options))  # type: ignore[arg-type]


def theirs(text: str, arm: Arm, joints: np.ndarray, base: str, tip: str) -> pin.SE3:
    """Where Pinocchio has the tip, in mm; joints that the arm does not have rest at zero."""
    model = pin.buildModelFromXML(text)
    data = model.createData()
    configuration = pin.neutral(model)
    for one, value in zip(arm.joints, joints, strict=True):
        place = model.joints[model.getJointId(one.urdf_name or one.name)]
        position = value if one.kind is JointKind.REVOLUTE else value / 1000
        if place.nq == 2:
            configuration[place.idx_q : place.idx_q + 2] = math.cos(position), math.sin(position)
        else:
            configuration[place.idx_q] = position
    pin.framesForwardKinematics(model, data, configuration)
    pose = data.oMf[model.getFrameId(base)].actInv(data.oMf[model.getFrameId(tip)])
    return pin.SE3(pose.rotation, 1000 * pose.translation)


_coordinates = st.sampled_from([0.0, 0.1, -0.25, 0.0333])
_angles = st.sampled_from([0.0, 1.5707963267948966, -1.5708, 3.14159265358979, 0.3]) | st.floats(-4, 4)
_axes = st.sampled_from(["0 0 1", "0 0 -1", "1 0 0", "0 -1 0", "1 2 -2", "1e-7 0 -1", ""])


@st.composite
def robots(draw: st.DrawFn) -> str:
    joints = []
    kinds = draw(st.lists(st.sampled_from(["revolute", "continuous", "prismatic", "fixed"]), min_size=1, max_size=5))
    kinds.insert(draw(st.integers(0, len(kinds))), "revolute")
    for index, kind in enumerate(kinds):
        xyz, rpy = (" ".join(str(draw(values)) for _ in range(3)) for values in (_coordinates, _angles))
        joints.append(
            joint(f"j-{index}", kind, "abcdefg"[index], "abcdefg"[index + 1], f'xyz="{xyz}" rpy="{rpy}"', draw(_axes))
        )
    return robot(*joints, links="abcdefg"[: len(kinds) + 1])


@settings(max_examples=40, deadline=None)
@given(text=robots(), seed=st.integers(0, 1000))
def test_the_chain_and_its_jacobian_are_pinocchios(
    text: str, seed: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    found = read(text, tmp_path_factory.mktemp("urdf"))
    arm = arm_of_text(arm_toml(found.arm), "made.toml")
    positions = np.random.default_rng(seed).uniform(-1.5, 1.5, arm.n_joints)
    positions[[one.kind is JointKind.PRISMATIC for one in arm.joints]] *= 100
    pose = theirs(text, arm, positions, found.base, found.tip).homogeneous
    np.testing.assert_allclose(chain_frames(arm, positions[None])[0, -1], pose, rtol=0, atol=1e-9)
    step = 1e-4
    for k, column in enumerate(frame_jacobian(arm, positions[None])[0].T):
        moved = step * np.eye(arm.n_joints)[k]
        ahead, behind = (theirs(text, arm, positions + way, found.base, found.tip) for way in (moved, -moved))
        np.testing.assert_allclose(column[:3], (ahead.translation - behind.translation) / (2 * step), atol=1e-4)


def test_limits_names_and_what_no_description_has(tmp_path: Path) -> None:
    text = robot(
        joint("shoulder pan", "revolute", "a", "b"),
        joint("slide", "prismatic", "b", "c", more='<limit lower="0.1" upper="0.4" velocity="0.5"/>'),
        joint("roll", "continuous", "c", "d", more=""),
        joint("held", "revolute", "d", "e", more='<limit lower="0.5" upper="0.5" velocity="1"/>'),
        joint("flange", "fixed", "e", "f", 'xyz="0 0 0.05"'),
    )
    found = read(text, tmp_path, speeding_up_s=0.5, jerking_s=0.1)
    pan, slide, roll = found.arm.joints
    assert (found.base, found.tip) == ("a", "f")
    assert (pan.name, pan.urdf_name, roll.urdf_name) == ("shoulder_pan", "shoulder pan", None)
    assert (pan.minimum, pan.maximum, pan.max_velocity, pan.max_acceleration, pan.max_jerk) == (-2, 1.5, 2, 4, 40)
    assert (slide.minimum, slide.maximum, slide.max_velocity) == (100, 400, 500)
    assert (roll.minimum, roll.maximum) == (-math.pi, math.pi)
    np.testing.assert_allclose(roll.max_velocity, math.radians(90))
    told = "\n".join(found.remarks)
    for part in ("roll has no limits", "roll has no velocity", "held cannot move", "0.5 s", "0.1 s", "--pen-length"):
        assert part in told
    assert arm_of_text(arm_toml(found.arm, found.remarks), "made.toml").joints[0].urdf_name == "shoulder pan"


def test_pen_and_holder_are_a_tool_behind_the_tip(tmp_path: Path) -> None:
    text = robot(joint("turn", "revolute", "a", "b"), joint("end", "fixed", "b", "c", 'xyz="0.2 0 0"'), links="abc")
    plain = read(text, tmp_path).arm
    assert (plain.pen.tool_axis, plain.tool) == ((1.0, 0.0, 0.0), RigidTransform(x_mm=200.0))  # the pen points on
    leaning = read(
        text,
        tmp_path,
        tool=RigidTransform(z_mm=10.0, pitch_rad=math.pi / 6),
        tool_axis=(0.0, 0.0, 1.0),
        pen_length_mm=80.0,
    ).arm
    np.testing.assert_allclose(leaning.tool.matrix[:3, 3], [240.0, 0.0, 10 + 80 * math.cos(math.pi / 6)], atol=1e-9)
    assert leaning.joints[0].origin == IDENTITY


def test_a_mimic_is_a_coupling_in_the_units_of_its_joints(tmp_path: Path) -> None:
    """Whether the joint that is mimicked belongs to the arm, and a slide that mimics a turn too."""
    text = robot(
        joint("lead", "revolute", "a", "b"),
        joint("copy", "revolute", "b", "c", more=_LIMIT + '<mimic joint="lead" multiplier="-0.5" offset="0.25"/>'),
        joint("lift", "prismatic", "c", "d", more=_LIMIT + '<mimic joint="copy" multiplier="0.1" offset="0.02"/>'),
        links="abcd",
    )
    arm = arm_of_text(arm_toml(read(text, tmp_path).arm), "made.toml")
    assert arm.independent_joints == (0,)
    np.testing.assert_allclose(arm.complete(np.array([0.6]))[1:], [-0.05, 15.0], atol=1e-9)
    positions = arm.complete(np.array([0.6]))
    pose = theirs(text, arm, positions, "a", "d").homogeneous
    np.testing.assert_allclose(chain_frames(arm, positions[None])[0, -1], pose, atol=1e-8)


def test_the_first_of_those_that_mimic_a_joint_elsewhere_leads_the_rest(tmp_path: Path) -> None:
    text = robot(
        joint("crank", "revolute", "a", "f", more='<limit lower="-1" upper="1" velocity="1"/>'),
        joint("one", "revolute", "a", "b", more=_LIMIT + '<mimic joint="crank" multiplier="2" offset="0.5"/>'),
        joint("two", "revolute", "b", "c", more=_LIMIT + '<mimic joint="crank" multiplier="-1"/>'),
        links="abcf",
    )
    arm = read(text, tmp_path, tip="c").arm
    assert [one.name for one in arm.joints] == ["one", "two"]
    np.testing.assert_allclose(arm.complete(np.array([1.1])), [1.1, -0.3])  # crank at 0.3
    assert (arm.joints[0].minimum, arm.joints[0].maximum) == (-1.5, 1.5)


FINGERS = (
    joint("turn", "revolute", "a", "b"),
    joint("left", "prismatic", "b", "c"),
    joint("right", "prismatic", "b", "d", more=_LIMIT + '<mimic joint="left"/>'),
)


def test_the_usual_tip_is_a_tool_or_what_fingers_hang_on(tmp_path: Path) -> None:
    assert read(robot(*FINGERS, links="abcd"), tmp_path).tip == "b"
    tool = joint("frame", "fixed", "b", "tool0")
    named = robot(*FINGERS, tool, links="abcd").replace('<link name="a"/>', '<link name="a"/><link name="tool0"/>')
    assert read(named, tmp_path).tip == "tool0"
    assert read(named, tmp_path, tip="d").tip == "d"


BAD = {
    "not XML": ("<robot", "is not well-formed XML"),
    "nothing": ("", "is not well-formed XML"),
    "a simulator's": ("<sdf><model/></sdf>", "is SDF; URDF"),
    "a page": ("<html></html>", "its outermost element is <html>"),
    "xacro": (robot('<xacro:include filename="x"/>'), "is xacro, which URDF is made of: expand it first"),
    "a macro's number": (robot(joint("q", "revolute", "a", "b", 'xyz="${x} 0 0"')), "is xacro"),
    "an entity": ('<!DOCTYPE robot [<!ENTITY x "y">]>' + robot(), "declares an entity, x"),
    "no links": ("<robot/>", "without links"),
    "no joints": (robot(links="a"), "no joint moves beyond link 'a'"),
    "all fixed": (robot(joint("q", "fixed", "a", "b"), links="ab"), "no joint moves"),
    "a floating base": (
        robot(joint("q", "floating", "a", "b"), joint("p", "revolute", "b", "c"), links="abc"),
        "joint q in line 1 is floating: an arm has joints that turn about an axis or slide along one; begin beyond it,"
        " with --base b",
    ),
    "no axis": (robot(joint("q", "revolute", "a", "b", axis="0 0 0"), links="ab"), "its axis has no direction"),
    "a word": (robot(joint("q", "revolute", "a", "b", 'xyz="1 2 up"'), links="ab"), 'origin xyz="1 2 up" has to be 3'),
    "no number": (robot(joint("q", "revolute", "a", "b", 'rpy="nan 0 0"'), links="ab"), "has to be 3 numbers"),
    "limits swapped": (
        robot(joint("q", "revolute", "a", "b", more='<limit lower="1" upper="-1" velocity="1"/>'), links="ab"),
        "lower limit 1 is above its upper limit -1",
    ),
    "a slide without limits": (
        robot(joint("q", "prismatic", "a", "b", more=""), links="ab"),
        "slides and has no limit",
    ),
    "a circle": (robot(joint("q", "revolute", "a", "b"), joint("p", "revolute", "b", "a"), links="ab"), "in a circle"),
    "two parents": (
        robot(joint("q", "revolute", "a", "b"), joint("p", "revolute", "a", "b"), links="ab"),
        "two joints lead to link 'b', q and p",
    ),
    "a parent that is not": (robot(joint("q", "revolute", "z", "b"), links="b"), "hangs on link 'z', which there is"),
    "mimics nobody": (
        robot(joint("q", "revolute", "a", "b", more=_LIMIT + '<mimic joint="p"/>'), links="ab"),
        "mimics joint 'p', which there is not",
    ),
    "mimics itself": (
        robot(joint("q", "revolute", "a", "b", more=_LIMIT + '<mimic joint="q"/>'), links="ab"),
        "mimics itself",
    ),
    "two roots": (
        robot(joint("q", "revolute", "a", "b"), joint("p", "revolute", "c", "d"), links="abcd"),
        "2 links that nothing leads to; name one with --base: links: a, c",
    ),
    "two arms": (
        robot(
            *(joint(f"{way}1", "revolute", "a", way[0]) for way in ("bc", "de")),
            *(joint(f"{way}2", "revolute", way[0], way[1]) for way in ("bc", "de")),
            links="abcde",
        ),
        "choose with --tip: ends: c (2 joints), e (2 joints)",
    ),
    "a mountain": (robot(joint("q", "revolute", "a", "b", 'xyz="0 0 4000"'), links="ab"), "10000 or less"),
}


@pytest.mark.parametrize("kind", BAD)
def test_what_makes_no_arm_is_told_in_a_sentence(kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text, said = BAD[kind]
    source, target = tmp_path / "robot.urdf", tmp_path / "arm.toml"
    source.write_text(text, encoding="utf-8")
    assert main(["arm", "--urdf", str(source), "-o", str(target)]) == 2
    complaint = capsys.readouterr().err
    assert said in complaint and complaint.startswith("plan: error: ") and len(complaint.splitlines()) == 1
    assert not target.exists()


def test_links_that_are_not_there_are_told_with_those_that_are(tmp_path: Path) -> None:
    text = robot(*FINGERS, links="abcd")
    for options in ({"base": "x"}, {"tip": "x"}):
        with pytest.raises(ArmFileError, match=r"has no link 'x' \(--(base|tip)\); links: a, b, c, d"):
            read(text, tmp_path, **options)
    with pytest.raises(ArmFileError, match="link 'a' does not hang on link 'b'"):
        read(text, tmp_path, base="b", tip="a")


def test_the_pen_is_held_as_the_chain_allows(tmp_path: Path) -> None:
    scara = robot(
        joint("q1", "revolute", "a", "b", 'xyz="0 0 0.2"'),
        joint("q2", "revolute", "b", "c", 'xyz="0.1 0 0"'),
        joint("q3", "prismatic", "c", "d", 'xyz="0.1 0 0"'),
        links="abcd",
    )
    arm, remarks = with_usual_hold(read(scara, tmp_path).arm)
    assert arm.pen.hold is PenHold.CONSTRUCTION and arm.pen.tool_axis == (0.0, 0.0, -1.0) and len(remarks) == 1
    pitches = [joint(f"q{k}", "revolute", "abcde"[k], "abcde"[k + 1], 'xyz="0.1 0 0"', "0 1 0") for k in (1, 2, 3)]
    pan = joint("q0", "revolute", "a", "b", 'xyz="0.02 0 0.1" rpy="3.141592653589793 0 0.4"')
    for right_angle in ("3.141592653589793", "3.14159"):  # as descriptions have it
        text = robot(pan.replace("3.141592653589793", right_angle), *pitches, links="abcde")
        found = read(text, tmp_path).arm
        forward = replace(found, pen=replace(found.pen, tool_axis=(1.0, 0.0, 0.0)))
        arm, remarks = with_usual_hold(forward)
        assert arm.pen.hold is PenHold.TOOL_AXIS and not remarks  # its axis stays in a plane: four joints are enough
    arm, remarks = with_usual_hold(read(robot(pan, *pitches[:2], links="abcd"), tmp_path).arm)
    assert arm.pen.hold is PenHold.FREE and "tilt" in remarks[0]


def test_the_command_writes_a_file_that_plans_or_prints_it(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source, target = tmp_path / "robot.urdf", tmp_path / "my_arm.toml"
    shoulder = joint("q", "revolute", "a", "b", 'xyz="0 0 0.1"')
    elbow = joint("p", "revolute", "b", "c", 'xyz="0.1 0 0"', "0 1 0")
    source.write_text(robot(shoulder, elbow, links="abc"), encoding="utf-8")
    assert main(["arm", "--urdf", str(source), "--pen-length", "5cm", "-o", str(target)]) == 0
    assert "2 joints from link a to link c" in capfd.readouterr().out
    assert main(["arm", "--urdf", str(source), "--pen-length", "5cm", "-o", "-"]) == 0
    assert capfd.readouterr().out == target.read_text(encoding="utf-8")
    assert main(["arm", str(target), "--json"]) == 0
    assert '"origin"' in capfd.readouterr().out
    assert main(["arm", str(target)]) == 0
    said = capfd.readouterr().out
    assert "origin of p: x 100 mm, roll -90 deg" in said and "tool: z 50 mm, roll 90 deg" in said
    for wrong in (["-o", "x.txt"], ["scara"], ["--json"], ["--at", "1"], ["--tool-axis", "up"], ["--turn", "0"]):
        assert main(["arm", "--urdf", str(source), *wrong]) == 2
    assert main(["arm", "--tip", "c"]) == 2
    assert "--tip goes with --urdf" in capfd.readouterr().err
