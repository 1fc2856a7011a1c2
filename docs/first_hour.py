"""The first hour of an arm that is not as its file says, by the commands of `docs/hardware.md`, with a pen and a phone
that are not there: `make_figures.py` shows what comes of it.

The arm, the pen and the phone are those of the tests: the arm is drawn at random about what its file says, ink is laid
on the printed sheet where it brings the pen to the paper, and a camera looks at it.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from hardware.clock import InstantClock
from hardware.compensation.servo_values import own_calibration
from hardware.jog.adjustments import paper_under
from hardware.motion.tip import link_nodes_mm
from hardware.simulation.simulated_arm import Servos, SimulatedArm
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arms.arm_text import arm_toml
from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.cli import main
from planner.error_model.calibration.files import Record, read_record
from planner.error_model.pattern.touch import Heights
from planner.error_model.sheet.marks import read_marks
from planner.error_model.sheet.pdf import write_sheet
from tests.error_model.photo.rendering import Camera, Ink, drawn_sheet, photograph
from tests.judge.inking import traces
from tests.judge.true_arm import TrueArm, random_arm

ARM = "drawing_arm_2022"
_SEED = 9
_ROWS, _BEYOND = 41, 1.15
"""Of a curve in the file, and how far it goes beyond the limits of its joint."""


def first_hour(drawing: Path) -> None:
    """Everything from the printed sheet to the calibrated drawing, in the current folder."""
    run("pattern", "--arm", ARM, "-o", "pattern.csv", "--marks", "marks.csv", "--sheet", "sheet.pdf")
    run("run", "pattern.csv", "--fast", "--record", "pulses.csv", "--quiet")
    Path("true.toml").write_text(arm_toml(photographed(Path())), encoding="utf-8")
    run("measure", "photo.jpg", "--marks", "marks.csv", "-o", "measured.csv", "--picture", "reading.png", "--quiet")
    run("calibrate", ARM, "--record", "pulses.csv", "--marks", "measured.csv", "-o", "my_arm_2.toml")
    for name, planned_for in (("before", ARM), ("after", "my_arm_2.toml")):
        run(str(drawing), "--arm", planned_for, "-o", f"{name}.csv", "--quiet")
        rehearsal = ["--fast", "--servos", "real", "--true-arm", "true.toml", "--quiet"]
        run("run", f"{name}.csv", *rehearsal, "--picture", f"{name}.png")
        run("predict", f"{name}.csv", "--plot", f"predicted_{name}.png")


def photographed(folder: Path) -> Arm:
    """Lays ink on the sheet of the pattern that was run in a folder, and leaves photo.jpg there; the arm that drew."""
    arm = load_arm(ARM)
    true_arm = as_file(arm, random_arm(arm, np.random.default_rng(_SEED)))
    marks, record = read_marks(folder / "marks.csv"), read_record(folder / "pulses.csv", arm)
    tip_mm = tips_of(arm, true_arm, record)
    at_marks = np.searchsorted(record.times_s, [mark.t_s for mark in marks])
    depth_mm = Heights.for_arm(arm).reach_mm  # that marks are meant to have
    jogged_mm = tip_mm[at_marks, 2].mean() + depth_mm  # with a card, plan jog finds the paper's height
    true_arm = paper_under(true_arm, np.array([0.0, 0.0, jogged_mm]), 0.0)
    tip_mm[:, 2] -= jogged_mm
    layout = write_sheet(folder / "sheet.pdf", arm.name, marks)
    ink = [Ink(trace.points_mm, trace.width_mm) for trace in traces(tip_mm, record.period_s)]
    sheet = drawn_sheet(folder / "sheet.pdf", layout.origin_page_mm, ink)
    photo = photograph(sheet, Camera(tilt_deg=24, roll_deg=3, shadows=1, shadow_depth=0.2))
    cv2.imwrite(str(folder / "photo.jpg"), photo)
    return true_arm


def as_file(arm: Arm, true: TrueArm) -> Arm:
    """A true arm of the tests as a file would have it."""
    joints = []
    for k, joint in enumerate(arm.joints):
        assert joint.servo is not None
        pulses_us = true.middle_us[k] + _BEYOND * true.half_us[k] * np.linspace(-1, 1, _ROWS)
        angles = joint.servo.direction * true.angles(np.repeat(pulses_us[:, None], arm.n_joints, axis=1))[:, k]
        order = np.argsort(angles)
        servo = replace(
            joint.servo,
            curve=tuple(zip(angles[order].tolist(), pulses_us[order].tolist(), strict=True)),
            trim_us=0.0,
            pulse_range_us=(float(pulses_us[0]), float(pulses_us[-1])),
            backlash=float(true.play_low[k] + true.play_high[k]),
            dead_band_us=float(true.dead_band[k]) * float(np.ptp(pulses_us) / np.ptp(angles)),
            lag_s=float(true.lag_s[k]),
        )
        lengths = {"d_mm": float(true.d_mm[k]), "a_mm": float(true.a_mm[k]), "alpha_rad": float(true.alpha[k])}
        joints.append(replace(joint, servo=servo, **lengths))
    paper = PaperPose.of(np.asarray(np.linalg.inv(true.T_sheet_base), np.float64))
    return replace(arm, joints=tuple(joints), paper=paper, closed_form=None)


def tips_of(arm: Arm, true_arm: Arm, record: Record) -> FloatArray:
    """(n, 3) where the pen of `true_arm` is, told by the file of `arm` what the record says."""
    clock = InstantClock()
    driver = SimulatedArm(arm, clock, Servos.REAL, true_arm)
    positions = own_calibration(arm).to_joints(record.told)
    driver.connect(positions[0])
    for time_s, position in zip(record.times_s.tolist(), positions, strict=True):
        clock.sleep_until(time_s)
        driver.send(position, record.period_s)
    return link_nodes_mm(true_arm, driver.recording.positions)[:, -1]


def run(*arguments: str) -> None:
    if main(list(arguments)):
        raise SystemExit(1)
