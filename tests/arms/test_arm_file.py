"""Arm files: every fault at once with key and value, units converted, names found; and arms told as JSON."""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arms.arm_file import DEFAULT_ARM, arms_folder, known_arms, load_arm, read_arm_file
from planner.arms.description import arm_description
from planner.arms.rigid_transform import RigidTransform
from planner.errors import ArmFileError, UnknownArm
from planner.kinematics.frame_jacobian import chain_frames
from tests.arms.chains import dh_matrix

ARM = """\
name = "mixed"
source = "made for tests"

[pen]
hold = "coupling"
tool_axis = [0.0, 0.0, -2.0]
lift_mm = 4.0

[workspace]
inner_radius_mm = 20.0

[[joints]]
name = "waist"
kind = "revolute"
d_mm = 40.0
alpha_deg = 90.0
min_deg = -90.0
max_deg = 90
max_velocity_deg_s = 360.0
max_acceleration_deg_s2 = 1800.0
max_jerk_deg_s3 = 36000.0
servo = { pulse_at_zero_us = 1500.0, us_per_deg = -10.0, pulse_range_us = [600.0, 2400.0], backlash_deg = 1.0 }

[[joints]]
name = "reach"
kind = "prismatic"
theta_deg = 30.0
min_mm = 10.0
max_mm = 80.0
max_velocity_mm_s = 100.0
max_acceleration_mm_s2 = 1000.0
max_jerk_mm_s3 = 20000.0

[[joints]]
name = "wrist"
kind = "revolute"
a_mm = 25.0
min_deg = -100.0
max_deg = 100.0
max_velocity_deg_s = 360.0
max_acceleration_deg_s2 = 1800.0
max_jerk_deg_s3 = 36000.0

[[coupling]]
joint = "wrist"
constant_deg = -90.0
coefficients = { waist = -0.5 }
"""

Reader = Callable[..., Arm]


@pytest.fixture
def read(tmp_path: Path) -> Reader:
    def read(*changes: tuple[str, str]) -> Arm:
        text = ARM
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        file = tmp_path / "mixed.toml"
        file.write_text(text, encoding="utf-8")
        return read_arm_file(file)

    return read


def test_units_are_converted(read: Reader) -> None:
    arm = read()
    waist, reach, wrist = arm.joints
    assert (waist.kind, reach.kind) == (JointKind.REVOLUTE, JointKind.PRISMATIC)
    assert (waist.minimum, waist.maximum, waist.alpha_rad) == pytest.approx((-math.pi / 2, math.pi / 2, math.pi / 2))
    assert (waist.max_velocity, waist.max_acceleration, waist.max_jerk) == pytest.approx(
        (2 * math.pi, 10 * math.pi, 200 * math.pi)
    )
    assert (reach.minimum, reach.maximum, reach.max_velocity, reach.max_acceleration, reach.max_jerk) == (
        10,
        80,
        100,
        1000,
        20000,
    )
    assert reach.theta_rad == pytest.approx(math.pi / 6)
    assert (waist.d_mm, wrist.a_mm, wrist.d_mm) == (40, 25, 0)
    assert arm.column_names == ("waist_deg", "reach_mm", "wrist_deg")
    assert arm.couplings[0].joint == 2
    assert arm.couplings[0].constant == pytest.approx(-math.pi / 2)
    assert arm.couplings[0].coefficients == ((0, -0.5),)


def test_slides_and_turns_drive_each_other(read: Reader) -> None:
    """A slide's coupling is in mm, and a coefficient is so many mm for each degree, or degrees for each mm."""
    turned = read(("{ waist = -0.5 }", "{ reach = 3.0 }"))
    assert turned.couplings[0].coefficients == ((1, pytest.approx(math.radians(3.0))),)
    driven = read(
        ('joint = "wrist"\nconstant_deg = -90.0', 'joint = "reach"\nconstant_mm = 40.0'),
        ("{ waist = -0.5 }", "{ waist = 0.25 }"),
    )
    assert driven.couplings[0].constant == 40.0
    np.testing.assert_allclose(driven.complete(np.radians([80.0, 0.0])), [math.radians(80), 60.0, 0.0])


def test_a_joint_has_an_origin_and_the_pen_a_holder(read: Reader) -> None:
    arm = read(
        ("a_mm = 25.0", "a_mm = 25.0\norigin = { x_mm = 3.0, yaw_deg = 90.0 }"),
        ("[workspace]", "[tool]\ny_mm = 5.0\nroll_deg = 90.0\npen_length_mm = 70.0\n\n[workspace]"),
    )
    assert arm.joints[2].origin == RigidTransform(x_mm=3.0, yaw_rad=math.pi / 2)
    # The holder's -z, out of the nib, is the last row's y.
    np.testing.assert_allclose(arm.tool.matrix[:3, 3], [0.0, 75.0, 0.0], atol=1e-12)
    assert arm.tool.roll_rad == pytest.approx(math.pi / 2)


@pytest.mark.parametrize("seed", range(4))
def test_modified_rows_are_the_same_chain(seed: int, tmp_path: Path) -> None:
    """Craig's rows, Rx(alpha) Tx(a) Rz(theta) Tz(d), multiplied out as they stand."""
    random = np.random.default_rng(seed)
    rows = np.column_stack((random.uniform(-180, 180, (4, 2)), random.uniform(-200, 200, (4, 2))))
    text = ARM[: ARM.index("[[joints]]")].replace("[pen]", 'dh = "modified"\n\n[pen]').replace('"coupling"', '"free"')
    limits = "\n".join(f"{key} = 90.0" for key in ("max_deg", "max_velocity_deg_s", "max_acceleration_deg_s2"))
    for index, (theta, alpha, d, a) in enumerate(rows):
        text += f'[[joints]]\nname = "q{index}"\nkind = "revolute"\ntheta_deg = {theta}\nalpha_deg = {alpha}\n'
        text += f"d_mm = {d}\na_mm = {a}\nmin_deg = -90.0\n{limits}\nmax_jerk_deg_s3 = 900.0\n"
    (tmp_path / "craig.toml").write_text(text, encoding="utf-8")
    arm = read_arm_file(tmp_path / "craig.toml")
    joints = random.uniform(-3, 3, 4)
    frame = np.eye(4)
    for joint, (theta, alpha, d, a) in zip(joints, rows, strict=True):
        frame = frame @ dh_matrix(0, 0, a, np.radians(alpha)) @ dh_matrix(np.radians(theta) + joint, d, 0, 0)
    np.testing.assert_allclose(chain_frames(arm, joints[None])[0, -1], frame, atol=1e-9)


def test_a_modified_row_has_no_origin_beside_it(read: Reader) -> None:
    with pytest.raises(ArmFileError, match=r"joints\[2\].origin: not beside dh = 'modified'"):
        read(("[pen]", 'dh = "modified"\n\n[pen]'), ("a_mm = 25.0", "a_mm = 25.0\norigin = { x_mm = 3.0 }"))


def test_what_is_left_out_has_its_documented_value(read: Reader) -> None:
    arm = read()
    assert (arm.pen.clearance_mm, arm.pen.hold, arm.pen.tool_axis) == (1.0, PenHold.COUPLING, (0.0, 0.0, -1.0))
    servo = arm.joints[0].servo
    assert servo is not None
    assert (servo.channel, servo.direction, servo.trim_us, servo.resolution_us, servo.dead_band_us) == (0, 1, 0, 1, 0)
    assert servo.backlash == pytest.approx(math.radians(1))
    assert servo.curve == ((pytest.approx(-math.pi / 2), 2400), (pytest.approx(math.pi / 2), 600))
    assert (arm.joints[1].servo, arm.joints[1].bus, arm.park) == (None, None, None)
    assert all(joint.thickness_mm is None for joint in arm.joints)


def test_servos_of_slides_and_buses_are_kept_per_inner_unit(read: Reader) -> None:
    arm = read(
        (
            "max_jerk_mm_s3 = 20000.0",
            "max_jerk_mm_s3 = 20000.0\nservo = { channel = 7, table = [[10, 900.0], "
            "[50, 1500], [80, 1700]], direction = -1, trim_us = 4, pulse_range_us = [800.0, 1800.0], "
            "backlash_mm = 0.2 }\nbus = { id = 3, count_at_zero = 100.5, counts_per_mm = -20.0, "
            "count_range = [-4000, 90] }",
        ),
        (
            "a_mm = 25.0",
            "a_mm = 25.0\nbus = { id = 1, count_at_zero = 2048, counts_per_deg = 10, count_range = [0, 4095] }",
        ),
    )
    slide, wrist = arm.joints[1:]
    assert slide.servo is not None
    assert slide.bus is not None
    assert wrist.bus is not None
    assert slide.servo.curve == ((10, 900), (50, 1500), (80, 1700))
    assert (slide.servo.channel, slide.servo.direction, slide.servo.trim_us, slide.servo.backlash) == (7, -1, 4, 0.2)
    assert (slide.bus.id, slide.bus.count_at_zero, slide.bus.counts_per_unit, slide.bus.count_range) == (
        3,
        100.5,
        -20,
        (-4000, 90),
    )
    assert wrist.bus.counts_per_unit == pytest.approx(10 * 180 / math.pi)


def test_the_parked_pose_is_completed_by_couplings(read: Reader) -> None:
    arm = read(("[[coupling]]", "[park]\nreach = 20\nwaist = -30.0\n\n[[coupling]]"))
    assert arm.park is not None
    assert arm.to_file_units(np.array(arm.park)) == pytest.approx([-30, 20, -75])


def test_couplings_complete_a_configuration(read: Reader) -> None:
    arm = read()
    assert arm.independent_joints == (0, 1)
    complete = arm.to_file_units(arm.complete(arm.from_file_units([40.0, 30.0, 0.0])[:2]))
    assert complete == pytest.approx([40.0, 30.0, -110.0])


LINE = "pulse_at_zero_us = 1500.0, us_per_deg = -10.0"

FAULTS = {
    "unknown key": (("lift_mm = 4.0", "lift_mm = 4.0\nlift_cm = 1"), ("pen.lift_cm: unknown key (value: 1)",)),
    "unknown key of a joint": (("d_mm = 40.0", "d_mm = 40.0\nmass = 2"), ("joints[0].mass: unknown key (value: 2)",)),
    "missing key": (("lift_mm = 4.0", ""), ("pen.lift_mm: missing",)),
    "missing limit": (("max_jerk_mm_s3 = 20000.0", ""), ("joints[1].max_jerk_mm_s3: missing",)),
    "limits of the other kind": (
        ("min_mm = 10.0", "min_deg = 10.0"),
        ("joints[1].min_mm: missing", "joints[1].min_deg: unknown key (value: 10.0)"),
    ),
    "wrong type": (("lift_mm = 4.0", 'lift_mm = "4"'), ("pen.lift_mm:", "(value: '4')")),
    "true is no number": (("lift_mm = 4.0", "lift_mm = true"), ("pen.lift_mm:", "(value: True)")),
    "not finite": (("a_mm = 25.0", "a_mm = inf"), ("joints[2].a_mm:", "(value: inf)")),
    "no number": (("a_mm = 25.0", "a_mm = nan"), ("joints[2].a_mm:", "(value: nan)")),
    "zero speed": (("max_velocity_mm_s = 100.0", "max_velocity_mm_s = 0"), ("joints[1].max_velocity_mm_s:", "0")),
    "negative radius": (("inner_radius_mm = 20.0", "inner_radius_mm = -1.0"), ("workspace.inner_radius_mm:", "-1.0")),
    "unknown kind": (
        ('kind = "prismatic"', 'kind = "continuous"'),
        ("joints[1].kind: has to be one of 'revolute', 'prismatic' (value: 'continuous'), joint reach",),
    ),
    "no kind": (('kind = "prismatic"', ""), ("joints[1].kind: missing, joint reach",)),
    "a link too long": (("a_mm = 25.0", "a_mm = 1e9"), ("joints[2].a_mm: has to be 10000 or less", "joint wrist")),
    "links too long together": (("a_mm = 25.0", "a_mm = 9990.0"), ("10110 mm together, more than 10000 mm",)),
    "a jerk of nothing": (
        ("max_jerk_mm_s3 = 20000.0", "max_jerk_mm_s3 = 1e-320"),
        ("joints[1].max_jerk_mm_s3: has to be 0.001 or more",),
    ),
    "a long name": (('name = "wrist"\nkind', f'name = "{"w" * 300}"\nkind'), ("64 characters or fewer",)),
    "unknown hold": (('hold = "coupling"', 'hold = "glue"'), ("pen.hold:", "(value: 'glue')")),
    "name with a comma": (('name = "waist"', 'name = "waist,1"'), ("joints[0].name:", "(value: 'waist,1')")),
    "limits swapped": (("min_mm = 10.0", "min_mm = 90.0"), ("joints[1]", "lower limit 90", "upper limit 80")),
    "no thickness": (("a_mm = 25.0", "a_mm = 25.0\nthickness_mm = 0"), ("joints[2].thickness_mm:", "(value: 0)")),
    "thickness of nothing": (("a_mm = 25.0", "thickness_mm = 12"), ("joints[2]", "thickness_mm 12 is that of no link")),
    "name twice": (('name = "reach"', 'name = "waist"'), ("joints[1].name: 'waist' is used twice",)),
    "pulses swapped": (("[600.0, 2400.0]", "[2400.0, 600.0]"), ("joints[0].servo.pulse_range_us: 2400", "600")),
    "three pulses": (("[600.0, 2400.0]", "[600.0, 900.0, 2400.0]"), ("joints[0].servo.pulse_range_us:",)),
    "neither line nor table": (
        ("us_per_deg = -10.0, ", ""),
        ("joints[0].servo: needs pulse_at_zero_us and us_per_deg",),
    ),
    "line and table": (
        ("us_per_deg = -10.0", "us_per_deg = -10.0, table = [[0, 600], [9, 700]]"),
        ("joints[0].servo: a table stands in place of",),
    ),
    "a servo that stands still": (("us_per_deg = -10.0", "us_per_deg = 0"), ("joints[0].servo: us_per_deg 0",)),
    "positions that turn back": (
        (LINE, "table = [[0, 600], [9, 700], [9, 800]]"),
        ("joints[0].servo.table: its positions have to go up, not from 9 to 9",),
    ),
    "pulses that turn back": (
        (LINE, "table = [[0, 600], [9, 700], [10, 650]]"),
        ("joints[0].servo.table: its pulses have to go one way, not from 700 to 650 us at 10",),
    ),
    "pulses that stay": ((LINE, "table = [[0, 600], [9, 600]]"), ("joints[0].servo.table: its pulses", "600 to 600")),
    "one row": ((LINE, "table = [[0, 600]]"), ("joints[0].servo.table:",)),
    "direction 2": (("us_per_deg = -10.0", "us_per_deg = -10.0, direction = 2"), ("joints[0].servo.direction:", "2")),
    "a slide's servo in degrees": (
        (
            "max_jerk_mm_s3 = 20000.0",
            "max_jerk_mm_s3 = 20000.0\nservo = { table = [[0, 600],"
            " [9, 700]], pulse_range_us = [500, 800], backlash_deg = 1 }",
        ),
        ("joints[1].servo.backlash_deg: unknown key",),
    ),
    "counts swapped": (
        ("a_mm = 25.0", "a_mm = 25.0\nbus = { id = 1, count_at_zero = 0, counts_per_deg = 1, count_range = [9, 3] }"),
        ("joints[2].bus.count_range: 9 is not below 3",),
    ),
    "a bus servo that stands still": (
        ("a_mm = 25.0", "a_mm = 25.0\nbus = { id = 1, count_at_zero = 0, counts_per_deg = 0, count_range = [3, 9] }"),
        ("joints[2].bus: 0 counts",),
    ),
    "broadcast as an id": (
        ("a_mm = 25.0", "a_mm = 25.0\nbus = { id = 254, count_at_zero = 0, counts_per_deg = 1, count_range = [3, 9] }"),
        ("joints[2].bus.id:", "254"),
    ),
    "parked in part": (("[[coupling]]", "[park]\nwaist = 0\n[[coupling]]"), ("park.reach: missing",)),
    "parked twice over": (
        ("[[coupling]]", "[park]\nwaist = 0\nreach = 20\nwrist = -90\n[[coupling]]"),
        ("park.wrist: follows from its coupling",),
    ),
    "parks nothing": (
        ("[[coupling]]", "[park]\nwaist = 0\nreach = 20\nhips = 0\n[[coupling]]"),
        ("park: there is no joint 'hips'",),
    ),
    "parked beyond a limit": (
        ("[[coupling]]", "[park]\nwaist = 0\nreach = 90\n[[coupling]]"),
        ("park.reach: 90 mm is outside its limits of 10 to 80",),
    ),
    "parked where the coupling cannot follow": (
        ("[[coupling]]", "[park]\nwaist = 30\nreach = 20\n[[coupling]]"),
        ("park.wrist: -105 deg is outside",),
    ),
    "coupled to nothing": (("{ waist = -0.5 }", "{ hips = -0.5 }"), ("coupling[0]: there is no joint 'hips'", "waist")),
    "couples nothing": (('joint = "wrist"', 'joint = "hand"'), ("coupling[0]: there is no joint 'hand'",)),
    "coupled in another unit": (
        ("constant_deg", "constant_mm"),
        ("coupling[0].constant_mm: joint 'wrist' turns; give constant_deg",),
    ),
    "a tool as long as a street": (("[workspace]", "[tool]\nz_mm = 9900.0\n\n[workspace]"), ("10045 mm together",)),
    "coupled to itself": (("{ waist = -0.5 }", "{ wrist = -0.5 }"), ("'wrist' is itself driven",)),
    "coupled twice": (
        ("[[coupling]]", '[[coupling]]\njoint = "wrist"\nconstant_deg = 0.0\ncoefficients = {}\n\n[[coupling]]'),
        ("coupling[1].joint: 'wrist' is driven by two couplings",),
    ),
    "clearance above the lift": (
        ("lift_mm = 4.0", "lift_mm = 4.0\nclearance_mm = 6.0"),
        ("pen: clearance_mm 6 is above lift_mm 4",),
    ),
    "an axis without direction": (
        ('hold = "coupling"\ntool_axis = [0.0, 0.0, -2.0]', 'hold = "tool_axis"\ntool_axis = [0.0, 0.0, 0.0]'),
        ("pen: tool_axis has no direction",),
    ),
    "an axis in the plane": (("[0.0, 0.0, -2.0]", "[0.0, 1.0]"), ("pen.tool_axis:",)),
    "not TOML": (("[pen]", "[pen"), ("is not TOML",)),
}


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_is_told_with_file_key_and_value(read: Reader, kind: str) -> None:
    change, parts = FAULTS[kind]
    with pytest.raises(ArmFileError) as caught:
        read(change)
    message = str(caught.value)
    assert message.startswith(caught.value.source)
    assert "mixed.toml" in message
    assert "\n" not in message
    for part in parts:
        assert part in message
    assert len(caught.value.faults) == (2 if kind == "limits of the other kind" else 1)


def test_all_faults_are_told_at_once(read: Reader) -> None:
    with pytest.raises(ArmFileError) as caught:
        read(
            ("lift_mm = 4.0", ""),
            ("a_mm = 25.0", "a_mm = nan"),
            ("d_mm = 40.0", "dd_mm = 40.0"),
            ('kind = "prismatic"', 'kind = "sliding"'),
        )
    assert len(caught.value.faults) == 4
    with pytest.raises(ArmFileError) as caught:
        read(('name = "reach"', 'name = "waist"'), ("{ waist = -0.5 }", "{ hips = -0.5 }"))
    assert len(caught.value.faults) == 2


def test_faults_in_form_do_not_hide_faults_in_meaning(read: Reader) -> None:
    """Within a section; what sections contradict each other in shows once each is right by itself."""
    with pytest.raises(ArmFileError) as caught:
        read(
            ("lift_mm = 4.0", "lift_mm = 0.5"),
            ("min_mm = 10.0", "min_mm = 90.0"),
            ("a_mm = 25.0", "a_m = 0.025"),
            ("[600.0, 2400.0]", "[2400.0, 600.0]"),
        )
    assert len(caught.value.faults) == 4


def test_two_joints_on_one_channel_are_told_of_both(read: Reader) -> None:
    servo = "servo = { channel = 0, table = [[0, 600], [9, 700]], pulse_range_us = [500, 800] }"
    with pytest.raises(ArmFileError) as caught:
        read(("a_mm = 25.0", f"a_mm = 25.0\n{servo}"))
    assert caught.value.faults == (
        "joints[0].servo.channel: 0 is another joint's too",
        "joints[2].servo.channel: 0 is another joint's too",
    )


def test_hold_by_coupling_needs_one(read: Reader) -> None:
    with pytest.raises(ArmFileError, match=r"'coupling' needs at least one \[\[coupling\]\]"):
        read((ARM[ARM.index("[[coupling]]") :], ""))


def test_an_arm_has_joints(read: Reader) -> None:
    joints = ARM[ARM.index("[[joints]]") :]
    with pytest.raises(ArmFileError, match="joints: missing"):
        read((joints, ""))


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"= 1", b"[" * 5000, b"a = " + b"[" * 5000, b"name = 1e400"])
def test_any_other_file_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "arm.toml").write_bytes(content)
    with pytest.raises(ArmFileError):
        read_arm_file(tmp_path / "arm.toml")


def test_missing_file_and_folder_are_refused(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    for name in ("none.toml", "folder.toml"):
        with pytest.raises(ArmFileError, match="cannot be read"):
            load_arm(str(tmp_path / name))


@pytest.mark.parametrize("name", ["arm.urdf", "arm.urdf.xacro", "ARM.URDF"])
def test_robot_descriptions_are_refused_with_what_to_do(name: str) -> None:
    with pytest.raises(ArmFileError, match=rf"made of first: plan arm --urdf {name} -o my_arm.toml"):
        load_arm(name)


def test_files_that_are_no_files_are_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "loop.toml").symlink_to(tmp_path / "loop.toml")
    (tmp_path / "large.toml").write_bytes(b"#" * 1_000_001)
    for name, said in (
        ("pipe", "is not a regular file"),
        ("loop", "cannot be read"),
        ("large", "more than 1000000"),
        ("x" * 300, "cannot be read"),
    ):
        with pytest.raises(ArmFileError, match=said):
            load_arm(str(tmp_path / f"{name}.toml"))


_VALUES = st.sampled_from(
    [
        "nan",
        "-inf",
        "0",
        "1e-320",
        "1e9",
        "1" + "0" * 400,
        "-5",
        '"text"',
        "true",
        "[]",
        "{}",
        "[[]]",
        "2026-01-01",
        '"continuous"',
        '"q1"',
        "[0.0, 0.0, 1.0]",
    ]
)


@given(st.sampled_from(ARM.splitlines()), _VALUES)
def test_any_value_is_taken_or_refused_in_plain_words(line: str, value: str) -> None:
    assume(" = " in line)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "arm.toml"
        file.write_text(ARM.replace(line, f"{line.split(' = ')[0]} = {value}", 1), encoding="utf-8")
        try:
            read_arm_file(file)
        except ArmFileError as error:
            said = str(error)
        else:
            return
    assert said.startswith(str(file))
    for word in ("Input", "valid", "pydantic", "tag", "Traceback", "instance"):
        assert word not in said.replace(str(file), "").replace("Invalid", "")


@pytest.mark.parametrize("name", known_arms())
def test_arms_that_come_along_are_found_by_name_from_any_folder(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    arm = load_arm(name)
    assert arm.name == name
    assert load_arm(str(arms_folder() / f"{name}.toml")).column_names == arm.column_names


def test_the_default_arm_comes_along() -> None:
    assert DEFAULT_ARM in known_arms()


@pytest.mark.parametrize("name", ["no_arm", "", "../configs/drawing_arm", "drawing_arm.tom"])
def test_an_unknown_name_lists_the_known_ones(name: str) -> None:
    with pytest.raises(UnknownArm) as caught:
        load_arm(name)
    assert DEFAULT_ARM in str(caught.value)
    assert caught.value.known == known_arms()


def test_description_is_the_file_again(read: Reader) -> None:
    assert json.loads(json.dumps(arm_description(read()))) == {
        "name": "mixed",
        "joints": [
            {
                "name": "waist",
                "kind": "revolute",
                "unit": "deg",
                "min": -90,
                "max": 90,
                "max_velocity": 360,
                "max_acceleration": 1800,
                "max_jerk": 36000,
            },
            {
                "name": "reach",
                "kind": "prismatic",
                "unit": "mm",
                "min": 10,
                "max": 80,
                "max_velocity": 100,
                "max_acceleration": 1000,
                "max_jerk": 20000,
            },
            {
                "name": "wrist",
                "kind": "revolute",
                "unit": "deg",
                "min": -100,
                "max": 100,
                "max_velocity": 360,
                "max_acceleration": 1800,
                "max_jerk": 36000,
            },
        ],
        "dh": [
            {"theta_deg": 0, "d_mm": 40, "a_mm": 0, "alpha_deg": 90},
            {"theta_deg": 30, "d_mm": 0, "a_mm": 0, "alpha_deg": 0},
            {"theta_deg": 0, "d_mm": 0, "a_mm": 25, "alpha_deg": 0},
        ],
        "coupling": [{"joint": "wrist", "constant_deg": -90, "coefficients": {"waist": -0.5}}],
        "pen": {"lift_mm": 4, "clearance_mm": 1},
    }
