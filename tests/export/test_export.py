"""Exports read back by readers that know nothing of the exporter: what comes back is the trajectory."""

from __future__ import annotations

import csv
import io
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from scipy.interpolate import CubicSpline

from benchmarks.gcode_time import planned_s, read_program
from planner.arms.arm import Arm, JointKind
from planner.arms.arm_file import load_arm
from planner.arms.arm_text import arm_toml
from planner.checking.chain import chain_poses
from planner.checking.check import check_trajectory
from planner.cli import main
from planner.export.resampled import resampled
from planner.trajectory import Trajectory, read_trajectory

_SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20" fill="none" stroke="black">'
    '<path d="M2 10C10 0 20 20 38 4L30 16"/><path d="M5 5h0" stroke-linecap="round"/><path d="M4 16H20"/></svg>'
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("export")


@pytest.fixture(scope="module", params=["drawing_arm", "scara", "six_joint"])
def source(request: pytest.FixtureRequest, folder: Path) -> Path:
    return planned(folder, request.param)


def planned(folder: Path, arm: str) -> Path:
    drawing, target = folder / "line.svg", folder / f"{Path(arm).stem}.csv"
    if not target.exists():
        drawing.write_text(_SVG, encoding="utf-8")
        assert main([str(drawing), "--arm", arm, "-o", str(target), "--quiet"]) == 0
    return target


def exported(source: Path, form: str, *options: str, suffix: str = "out") -> Path:
    target = source.with_name(f"{source.stem}-{form}.{suffix}")
    assert main(["export", str(source), "--format", form, "-o", str(target), "--quiet", *options]) == 0
    return target


def si(arm: Arm, trajectory: Trajectory) -> np.ndarray:
    """Positions in rad and m."""
    scale = [1.0 if joint.kind is JointKind.REVOLUTE else 1e-3 for joint in arm.joints]
    return np.asarray(arm.from_file_units(trajectory.positions) * scale)


@pytest.mark.parametrize("suffix", ["yaml", "json"])
def test_ros2_points_are_the_samples_and_keep_the_limits(source: Path, suffix: str) -> None:
    trajectory = read_trajectory(source)
    arm = load_arm(trajectory.arm)
    text = exported(source, "ros2", suffix=suffix).read_text(encoding="utf-8")
    message = yaml.safe_load(text) if suffix == "yaml" else json.loads(text)
    assert set(message) == {"header", "joint_names", "points"}
    assert message["joint_names"] == [joint.name for joint in arm.joints]
    points = message["points"]
    positions, velocities, accelerations = (
        np.array([point[key] for point in points]) for key in ("positions", "velocities", "accelerations")
    )
    np.testing.assert_allclose(positions, si(arm, trajectory), rtol=1e-11, atol=1e-12)
    times_ns = [point["time_from_start"]["sec"] * 10**9 + point["time_from_start"]["nanosec"] for point in points]
    np.testing.assert_allclose(times_ns, trajectory.times_s * 1e9, atol=1)
    assert all(isinstance(value, float) for point in points[:3] for value in point["positions"])
    scale = si(arm, replace(trajectory, positions=np.ones((1, arm.n_joints))))[0] / arm.from_file_units(
        [1] * arm.n_joints
    )
    assert (np.abs(velocities) <= arm.max_velocity * scale * (1 + 1e-6)).all()
    assert (np.abs(accelerations) <= arm.max_acceleration * scale * (1 + 1e-6)).all()
    assert not velocities[[0, -1]].any() and not accelerations[[0, -1]].any()
    # A difference over two steps is off the velocity by a sixth of jerk times the step's square, at most.
    spline = CubicSpline(trajectory.times_s, positions)
    off = np.abs(velocities - spline(trajectory.times_s, 1))[1:-1]
    assert (off <= arm.max_jerk * scale / trajectory.rate_hz**2 / 4 + 1e-9).all()


def test_ros2_has_the_names_of_the_description_and_the_joints_that_are_asked_for(folder: Path) -> None:
    arm = load_arm("drawing_arm")
    joints = tuple(replace(joint, urdf_name=f"left/{joint.name}") for joint in arm.joints)
    file = folder / "named.toml"
    file.write_text(arm_toml(replace(arm, joints=joints)), encoding="utf-8")
    source = planned(folder, "drawing_arm")
    target = exported(source, "ros2", "--arm", str(file), "--joints", "q3,left/q1", suffix="yaml")
    message = yaml.safe_load(target.read_text(encoding="utf-8"))
    assert message["joint_names"] == ["left/q3", "left/q1"]
    np.testing.assert_allclose(
        [point["positions"] for point in message["points"]],
        np.radians(read_trajectory(source).positions[:, [2, 0]]),
        atol=1e-11,
    )


@pytest.mark.parametrize("controller", ["grblhal", "fluidnc", "marlin"])
def test_gcode_is_the_trajectory_and_a_grbl_takes_little_longer(
    source: Path, controller: str, record_property: pytest.RecordProperty
) -> None:
    trajectory = read_trajectory(source)
    arm = load_arm(trajectory.arm)
    lines = exported(source, "gcode", "--controller", controller).read_text(encoding="ascii").splitlines()
    axes = "XYZABC"[: arm.n_joints]
    marlin = controller == "marlin"
    program = read_program(lines, axes, marlin=marlin)
    assert program.times_s[-1] == pytest.approx(trajectory.duration_s, rel=1e-4)
    back = np.column_stack([np.interp(trajectory.times_s, program.times_s, column) for column in program.positions.T])
    np.testing.assert_allclose(back, trajectory.positions, atol=1e-3 if marlin else 1e-4)
    tips = [chain_poses(arm, arm.from_file_units(rows)).tip_mm for rows in (back, trajectory.positions)]
    assert np.abs(tips[0] - tips[1]).max() < 0.1
    took_s = planned_s(program, arm.to_file_units(arm.max_acceleration), 16)
    longer = took_s.sum() / trajectory.duration_s - 1
    record_property("longer", float(longer))
    assert -1e-6 < longer < 0.08
    assert max(map(len, lines)) < 96 and ("G93" in lines) is not marlin


def test_the_grbl_model_slows_down_for_corners_buffers_and_accelerations() -> None:
    """Known times: a line from rest to rest, a right angle, a reversal, and a buffer too short to run on."""

    def took(*rows: str, blocks: int = 16) -> float:
        program = read_program(["G21", "G90", "G1 X0 Y0 F600", *rows], "XY")
        return float(planned_s(program, np.array([1000.0, 1000.0]), blocks).sum())

    assert took("G1 X100 F6000") == pytest.approx(1.0 + 100 / 1000)  # 100 mm/s, and v / a for the ramps
    assert took("G1 X50 F6000", "G1 X100 F6000") == pytest.approx(1.1)
    assert took("G1 X50 F6000", "G1 X0 F6000") == pytest.approx(1.2)  # it stops where it turns back
    assert 1.1 < took("G1 X50 F6000", "G1 X50 Y50 F6000") < 1.2
    many = [f"G1 X{0.1 * k:.1f} F6000" for k in range(1, 1001)]
    assert took(*many) == pytest.approx(1.0 + 0.1, abs=0.9) and took(*many, blocks=100) == pytest.approx(1.1, abs=1e-3)
    assert took(*many, blocks=4) > took(*many, blocks=16) > took(*many, blocks=100)
    assert took("G93", "G1 X10 F60", "G4 P0.5", "G1 X20 F60") == pytest.approx(2.5, abs=0.1)


def test_a_pen_of_its_own_is_set_where_the_tip_comes_down_and_leaves(folder: Path) -> None:
    source = planned(folder, "drawing_arm")
    strokes = int(read_trajectory(source).stroke.max()) + 1
    lines = exported(source, "gcode", "--pen", "m3", "--pen-down", "700").read_text(encoding="ascii").splitlines()
    assert lines.count("M3 S700") == strokes and lines.count("M3 S0") == strokes + 2
    lines = exported(source, "gcode", "--pen", "Z", "--axes", "XYABC", "--pen-up", "5").read_text().splitlines()
    assert lines.count("G0 Z1000") == strokes and lines.count("G0 Z5") == strokes + 2
    back = read_program(lines, "XYABC")
    assert back.times_s[-1] == pytest.approx(read_trajectory(source).duration_s, rel=1e-5)


def test_lerobot_actions_are_degrees_as_lerobot_counts_them(folder: Path) -> None:
    arm = load_arm("so101")
    source = planned(folder, "so101")
    trajectory = read_trajectory(source)
    head, *frames = map(json.loads, exported(source, "lerobot").read_text(encoding="utf-8").splitlines())
    assert (head["fps"], head["frames"], len(frames)) == (100, trajectory.n_samples, trajectory.n_samples)
    for joint, column in zip(arm.joints, trajectory.positions.T, strict=True):
        assert joint.bus is not None
        counts = joint.bus.count_at_zero + joint.bus.counts_per_unit * np.radians(column)
        middle = sum(joint.bus.count_range) / 2
        told = [frame["action"][f"{joint.name}.pos"] for frame in frames]
        np.testing.assert_allclose(told, (counts - middle) * 360 / 4095, atol=1e-6)
    assert [frame["pen"] for frame in frames] == trajectory.pen.astype(int).tolist()
    plain = json.loads(exported(planned(folder, "scara"), "lerobot").read_text().splitlines()[5])
    np.testing.assert_allclose(
        list(plain["action"].values()), read_trajectory(planned(folder, "scara")).positions[4], atol=1e-6
    )


def test_urscript_is_a_program_of_set_points(folder: Path) -> None:
    source = planned(folder, "six_joint")
    lines = exported(source, "urscript").read_text(encoding="ascii").splitlines()
    assert (lines[0], lines[-2:]) == ("def drawing():", ["end", "drawing()"])
    assert all(line.startswith("  ") for line in lines[1:-2])
    points = [re.fullmatch(r"  servoj\(\[(.*)\], t=0.01, lookahead_time=0.1, gain=300\)", line) for line in lines]
    told = np.array([[float(value) for value in point[1].split(",")] for point in points if point])
    np.testing.assert_allclose(told, np.radians(read_trajectory(source).positions), atol=1e-9)
    assert any(line.startswith("  movej([") for line in lines[:5])


def test_at_1_khz_limits_are_kept_and_the_check_passes(source: Path) -> None:
    trajectory = read_trajectory(source)
    arm = load_arm(trajectory.arm)
    fine = read_trajectory(exported(source, "csv-1khz", suffix="csv"))
    assert fine.rate_hz == 1000
    assert all(finding.passed for finding in check_trajectory(fine, arm).findings)
    assert trajectory.duration_s <= fine.duration_s < 1.15 * trajectory.duration_s
    with source.open(encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert len(rows) - 1 == trajectory.n_samples
    # The same way: every sample of the one is near a place of the other.
    for row in trajectory.positions[:: max(1, trajectory.n_samples // 40)]:
        assert np.abs(fine.positions - row).max(axis=1).min() < 0.25
    for stroke in range(int(trajectory.stroke.max()) + 1):
        ends = [one.positions[np.flatnonzero(one.stroke == stroke)[[0, -1]]] for one in (trajectory, fine)]
        np.testing.assert_allclose(*ends, atol=1e-6)


def test_a_motion_that_was_planned_at_1_khz_is_what_it_was(folder: Path) -> None:
    trajectory = read_trajectory(planned(folder, "drawing_arm"))
    assert resampled(trajectory, load_arm("drawing_arm"), trajectory.rate_hz) is trajectory


def test_mcap_holds_joint_states_and_the_pen(source: Path) -> None:
    trajectory = read_trajectory(source)
    arm = load_arm(trajectory.arm)
    states, pens, times_ns = [], [], []
    for schema, channel, message in make_reader(io.BytesIO(exported(source, "mcap").read_bytes())).iter_messages():
        assert schema is not None and json.loads(schema.data)["type"] == "object"
        content = json.loads(message.data)
        if channel.topic == "/joint_states":
            states.append(content["position"])
            times_ns.append(message.log_time)
            assert content["name"] == [joint.name for joint in arm.joints]
        else:
            pens.append(content["down"])
    np.testing.assert_allclose(states, si(arm, trajectory), atol=1e-12)
    np.testing.assert_allclose(times_ns, trajectory.times_s * 1e9, atol=1)
    assert pens == trajectory.pen.tolist()


@pytest.mark.parametrize("form", ["ros2", "gcode", "lerobot", "csv-1khz", "mcap"])
def test_standard_output_is_a_file_too(form: str, folder: Path, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    source = planned(folder, "drawing_arm")
    assert main(["export", str(source), "--format", form, "-o", "-"]) == 0
    assert capfdbinary.readouterr().out == exported(source, form, suffix="again").read_bytes()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--format", "urscript"], "URScript moves 6 turning joints; drawing_arm has q1, q2, q3, q4, q5"),
        (["--format", "gcode", "--controller", "grbl"], "grbl has 3 axes at most"),
        (["--format", "gcode", "--axes", "XYZ"], "drawing_arm has 5 joints"),
        (["--format", "gcode", "--axes", "XYZAA"], "an axis is named twice"),
        (["--format", "gcode", "--axes", "XYZAG"], "wanted letters of axes"),
        (["--format", "gcode", "--pen", "servo"], "wanted m3 or the letter of an axis"),
        (["--format", "ros2", "--pen", "m3"], "--pen goes with --format gcode"),
        (["--format", "ros2", "--joints", "q1,q9"], "there is no joint 'q9'"),
        (["--format", "ros2", "--joints", "q1,q1"], "named twice"),
        (["--format", "csv-1khz", "--joints", "q1"], "holds all joints"),
        (["--format", "ros2", "--arm", "scara"], "the file moves the joints"),
        (["--format", "rosbag"], "invalid choice"),
        ([], "--format"),
    ],
)
def test_what_cannot_be_written_is_told_and_nothing_is(
    options: list[str], said: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = folder / "never"
    assert main(["export", str(planned(folder, "drawing_arm")), "-o", str(target), *options]) == 2
    complaint = capsys.readouterr().err
    assert said in complaint and len(complaint.splitlines()) == 1 and not target.exists()


def test_a_trajectory_that_breaks_a_limit_is_not_handed_on(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = planned(folder, "drawing_arm").read_text(encoding="utf-8").splitlines()
    cells = text[60].split(",")
    text[60] = ",".join([cells[0], f"{float(cells[1]) + 3:.9f}", *cells[2:]])
    damaged, target = folder / "damaged.csv", folder / "never"
    damaged.write_text("\n".join(text) + "\n", encoding="utf-8")
    assert main(["export", str(damaged), "--format", "ros2", "-o", str(target)]) == 2
    assert "breaks a law of 'plan check'" in capsys.readouterr().err and not target.exists()
