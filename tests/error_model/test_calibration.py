"""From marks of true arms, which know nothing of the model, to arms that predict where other marks come."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.arms.arm_file import read_arm_file
from planner.arms.arm_text import arm_toml
from planner.arms.usual_settings import usual_clearance_mm
from planner.arrays import FloatArray
from planner.error_model.believed import believed
from planner.error_model.calibration.calibrate import Calibrated, calibrate
from planner.error_model.calibration.files import Touches, read_marks, read_record
from planner.error_model.calibration.sheets import rows_of_marks
from planner.error_model.calibration.summary import as_json, lines, warnings
from planner.error_model.chain import tips as tips_of
from planner.error_model.drawn import drawn_joints
from planner.error_model.lag import lagged
from planner.error_model.model import Told, tips_at
from planner.error_model.pattern.touch import SLOPE, Heights
from planner.error_model.prediction import Along, Prediction
from planner.errors import CalibrationError
from planner.redundancy.arm_model import ArmModel
from tests.error_model.conftest import Drawn
from tests.judge import playing
from tests.judge.true_arm import TrueArm, random_arm

NOTHING = Prediction(
    0.0,
    0.0,
    (0.0, 0.0),
    0.0,
    0.0,
    (),
    Along(np.empty((0, 2)), np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty((0, 2)), np.empty(0, np.bool_)),
)


def told_for_marks(drawn: Drawn) -> Told:
    lag_s = np.full(drawn.arm.n_joints, 0.02)
    return Told.of(lagged(drawn.record.told, lag_s, 0.01), rows_of_marks(drawn.record, drawn.marks))


def errors_mm(found: Calibrated, true: TrueArm, fresh: Drawn) -> tuple[FloatArray, FloatArray]:
    """(m, 3) by how much the calibrated arm is wrong about marks that it has not seen, and what it says of that."""
    change, stands = tips_at(found.fit.model, told_for_marks(fresh))
    sd = found.fit.tip_sd_mm(found.fit.parameters.jacobian(found.fit.model, change, stands))
    return fresh.tips_mm(true, sd_mm=0.0) - change.tip_mm, sd


def rms(errors: FloatArray) -> float:
    return float(np.sqrt((errors[:, :2] ** 2).sum(axis=1).mean()))


def test_marks_tell_where_other_marks_come_and_how_surely(
    sheet49: Drawn, fresh: Drawn, true_arms: list[TrueArm], tmp_path_factory: pytest.TempPathFactory
) -> None:
    inside, sizes = [], []
    for seed, true in enumerate(true_arms):
        found = calibrate(sheet49.arm, [sheet49.sheet(sheet49.tips_mm(true, seed))])
        errors, sd = errors_mm(found, true, fresh)
        sizes.append(rms(errors))
        inside.append(np.abs(errors) < 1.96 * sd)
        assert found.before_mm > 2.0
        assert not found.outliers
        slack = (true.play_low + true.play_high) / 2 + true.dead_band
        np.testing.assert_allclose(found.fit.model.slack, slack, atol=np.radians(0.35))
    assert np.mean(sizes) < 0.45
    assert 0.9 <= np.mean(inside) <= 0.995
    # All that was found is in the file.
    file = tmp_path_factory.mktemp("arm") / "arm.toml"
    file.write_text(arm_toml(found.arm, ["as calibrated"]))
    change, _ = tips_at(believed(read_arm_file(file)), told_for_marks(fresh))
    assert rms(fresh.tips_mm(true, sd_mm=0.0) - change.tip_mm) < sizes[-1] + 0.05


def test_how_sure_tips_are_is_told_where_drawings_are_drawn(sheet49: Drawn, true_arms: list[TrueArm]) -> None:
    """The canvas has edges and corners which marks hardly come to: an arm is further off there, and that is known."""
    joints = drawn_joints(ArmModel(sheet49.arm))
    off, sure = [], []
    for seed, true in enumerate(true_arms):
        found = calibrate(sheet49.arm, [sheet49.sheet(sheet49.tips_mm(true, seed))])
        model, accuracy = found.fit.model, found.arm.accuracy
        told = np.column_stack([curve.told(joints[:, k]) for k, curve in enumerate(model.curves)])
        off.append(np.abs(true.tip_mm(true.angles(told)) - tips_of(model.geometry, joints).tip_mm))
        assert accuracy is not None
        sure.append((accuracy.tip_mm, accuracy.height_mm))
    errors, (tip_mm, height_mm) = np.concatenate(off), np.mean(sure, axis=0)
    assert 1 / 1.5 < tip_mm / np.sqrt((errors[:, :2] ** 2).mean()) < 1.5
    assert 1 / 1.5 < height_mm / np.sqrt((errors[:, 2] ** 2).mean()) < 1.5
    assert errors.max() < 1.5


def test_the_clearance_follows_what_is_known_of_the_height_unless_somebody_chose_another(
    sheet49: Drawn, true_arms: list[TrueArm]
) -> None:
    """At the clearance the true arm's pen has left the paper at 95 of 100 places."""
    sheet = sheet49.sheet(sheet49.tips_mm(true_arms[0]))
    found = calibrate(sheet49.arm, [sheet])
    clearance_mm = found.arm.pen.clearance_mm
    assert clearance_mm == usual_clearance_mm(found.arm) != sheet49.arm.pen.clearance_mm
    joints = drawn_joints(ArmModel(sheet49.arm))
    told = np.column_stack([curve.told(joints[:, k]) for k, curve in enumerate(found.fit.model.curves)])
    too_low_mm = (
        tips_of(found.fit.model.geometry, joints).tip_mm[:, 2] - true_arms[0].tip_mm(true_arms[0].angles(told))[:, 2]
    )
    assert (too_low_mm < clearance_mm).mean() >= 0.95
    assert f"the pen is clear of the paper from {clearance_mm:g} mm on" in "\n".join(lines(found, NOTHING))
    own = replace(sheet49.arm, pen=replace(sheet49.arm.pen, clearance_mm=1.3))
    again = replace(sheet49.arm, accuracy=found.arm.accuracy, pen=replace(own.pen, clearance_mm=clearance_mm))
    assert calibrate(own, [sheet]).arm.pen.clearance_mm == 1.3
    assert calibrate(again, [sheet]).arm.pen.clearance_mm == clearance_mm


def test_gravity_that_keeps_joints_on_one_side_is_found(sheet49: Drawn) -> None:
    true = random_arm(sheet49.arm, np.random.default_rng(9), gravity=("q2", "q3"))
    found = calibrate(sheet49.arm, [sheet49.sheet(sheet49.tips_mm(true))])
    np.testing.assert_allclose(found.fit.model.slack[[1, 2]], true.dead_band[[1, 2]], atol=np.radians(0.2))


def test_two_sheets_tell_more_than_one(sheet49: Drawn, fresh: Drawn, true_arms: list[TrueArm]) -> None:
    first, second = sheet49.sheet(sheet49.tips_mm(true_arms[0])), fresh.sheet(fresh.tips_mm(true_arms[0], 1))
    one, both = calibrate(sheet49.arm, [first]), calibrate(sheet49.arm, [first, second])
    assert both.arm.accuracy is not None and one.arm.accuracy is not None
    assert both.arm.accuracy.marks == 49 + 25
    assert both.fit.sd.sum() < one.fit.sd.sum()


def test_a_mark_that_is_far_off_is_named_and_not_believed(
    sheet49: Drawn, fresh: Drawn, true_arms: list[TrueArm]
) -> None:
    tips = sheet49.tips_mm(true_arms[1])
    clean = rms(errors_mm(calibrate(sheet49.arm, [sheet49.sheet(tips)]), true_arms[1], fresh)[0])
    tips[17, 0] += 5.0
    found = calibrate(sheet49.arm, [sheet49.sheet(tips)])
    assert [outlier.mark for outlier in found.outliers] == [17]
    assert "mark 17 is 5" in warnings(found)[0] or "mark 17 is 4" in warnings(found)[0]
    assert rms(errors_mm(found, true_arms[1], fresh)[0]) < clean + 0.1


def test_marks_that_lie_further_off_than_they_can_are_doubted(sheet49: Drawn, true_arms: list[TrueArm]) -> None:
    tips_mm = sheet49.tips_mm(true_arms[1])
    assert not any("further" in line for line in warnings(calibrate(sheet49.arm, [sheet49.sheet(tips_mm)])))
    said = warnings(calibrate(sheet49.arm, [sheet49.sheet(tips_mm, sd_mm=0.04)]))
    assert any("times further from where the calibrated arm has them than their sd_mm allows" in line for line in said)


def test_marks_that_were_exchanged_are_named(sheet49: Drawn, true_arms: list[TrueArm]) -> None:
    tips = sheet49.tips_mm(true_arms[1])
    tips[[4, 30]] = tips[[30, 4]]
    found = calibrate(sheet49.arm, [sheet49.sheet(tips)])
    assert found.exchanged == ((4, 30),)


def test_without_heights_it_goes_on_and_says_so(sheet49: Drawn, fresh: Drawn, true_arms: list[TrueArm]) -> None:
    tips = sheet49.tips_mm(true_arms[2])
    tips[:, 2] = np.nan
    found = calibrate(sheet49.arm, [sheet49.sheet(tips)])
    assert any("ink may be missing" in line for line in warnings(found))
    assert rms(errors_mm(found, true_arms[2], fresh)[0]) < 0.7


def test_lines_beside_marks_tell_heights(sheet49: Drawn, fresh: Drawn, true_arms: list[TrueArm]) -> None:
    """A stroke is seen where its ink begins: nothing else of the tip's height is known."""
    record = sheet49.record
    reach_mm = Heights.for_arm(sheet49.arm).reach_mm
    high_mm = np.median(sheet49.tips_mm(true_arms[2])[:, 2]) + reach_mm  # as the card trick leaves it
    pose = true_arms[2].T_sheet_base - np.outer([0, 0, high_mm, 0], [0, 0, 0, 1])
    true = replace(true_arms[2], T_sheet_base=pose)
    tips = sheet49.tips_mm(true)
    tips[:, 2] = np.nan
    told = playing.Record(record.times_s, record.stroke, record.meant_mm, record.told)
    random, rows = np.random.default_rng(0), []
    times_s = record.times_s[sheet49.pattern.zero_samples + sheet49.approach]
    moments_s = times_s[:, None] + np.arange(-0.7, 0.7, 0.005)
    ways = true.tip_mm(playing.play(true, told, moments_s.ravel())).reshape(*moments_s.shape, 3)
    for mark, (touch, at_s, way) in enumerate(zip(sheet49.pattern.touches, times_s, ways, strict=True)):
        down = np.flatnonzero(way[:, 2] <= 0)
        if len(down) and down[0] > 0:
            along = (touch.end_mm - touch.begin_mm) / np.linalg.norm(touch.end_mm - touch.begin_mm)
            rows.append((at_s, *(way[down[0], :2] + random.normal(0, 0.2, 2)), *(SLOPE * along), mark))
    table = np.array(rows)
    assert len(table) > 20
    touches = Touches(table[:, 0], table[:, 1:3], table[:, 3:5], table[:, 5].astype(np.int64))
    found = calibrate(sheet49.arm, [sheet49.sheet(tips, touches=touches)])
    errors, _ = errors_mm(found, true, fresh)
    assert rms(errors) < 0.5
    assert np.sqrt(np.mean(errors[:, 2] ** 2)) < 0.8  # on a first sheet a third of the lines begin too high or low


def test_what_cannot_be_is_refused(sheet49: Drawn, fresh: Drawn, true_arms: list[TrueArm]) -> None:
    tips = sheet49.tips_mm(true_arms[0])
    with pytest.raises(CalibrationError, match="5 marks were seen; 12 at least are needed"):
        calibrate(sheet49.arm, [sheet49.sheet(tips[:5])])
    with pytest.raises(CalibrationError, match="mirror image"):
        calibrate(sheet49.arm, [sheet49.sheet(tips * (1, -1, 1))])
    with pytest.raises(CalibrationError, match="turned or moved"):
        calibrate(sheet49.arm, [sheet49.sheet(tips[:, [1, 0, 2]] * (-1, 1, 1))])
    with pytest.raises(CalibrationError, match="another pattern"):
        calibrate(sheet49.arm, [sheet49.sheet(np.random.default_rng(0).permutation(tips))])
    with pytest.raises(CalibrationError, match="mark 25 is not in the record"):
        calibrate(
            fresh.arm,
            [
                fresh.sheet(tips[:25]),
                replace(
                    fresh.sheet(tips[:25]), measured=replace(fresh.sheet(tips[:25]).measured, marks=np.arange(1, 26))
                ),
            ],
        )


@pytest.mark.parametrize(("joint", "in_its_range"), [(1, False), (3, False), (2, True)])
def test_a_joint_that_turns_the_other_way_is_named(
    joint: int, in_its_range: bool, sheet49: Drawn, true_arms: list[TrueArm]
) -> None:
    true, turned = true_arms[0], sheet49.arm.joints[joint]
    shape, sines = true.shape.copy(), true.sines.copy()
    shape[joint] *= -1
    shape[joint, 0] += in_its_range * (turned.minimum + turned.maximum)
    sines[joint, :, 0] *= -1
    tips = sheet49.tips_mm(replace(true, shape=shape, sines=sines))
    with pytest.raises(CalibrationError, match=f"joint q{joint + 1} seems to turn the other way"):
        calibrate(sheet49.arm, [sheet49.sheet(tips)])


@pytest.mark.parametrize("joint", [1, 2])
def test_a_curve_that_would_not_be_monotone_is_refused_by_the_name_of_its_joint(
    joint: int, sheet49: Drawn, true_arms: list[TrueArm]
) -> None:
    """A joint that turns back towards the ends of its pulses, as no servo does."""
    shape = true_arms[0].shape.copy()
    shape[joint, 3] -= 0.8 * shape[joint, 1]
    tips = sheet49.tips_mm(replace(true_arms[0], shape=shape))
    with pytest.raises(CalibrationError, match=rf"curve of joint q{joint + 1} would not be monotone.*measure again"):
        calibrate(sheet49.arm, [sheet49.sheet(tips)])


def test_findings_are_told_in_words_and_figures(sheet49: Drawn, true_arms: list[TrueArm]) -> None:
    found = calibrate(sheet49.arm, [sheet49.sheet(sheet49.tips_mm(true_arms[0]))])
    text = "\n".join(lines(found, NOTHING))
    assert "joint q3: " in text and "of slack from end to end" in text
    assert "only together are known: q1 curve 0 and base yaw" in text
    told = as_json(found, NOTHING)
    assert set(told) == {
        "parameters",
        "rms_mm",
        "outliers",
        "unidentifiable",
        "predicted_rms_mm",
        "predicted_rms_interval_mm",
    }
    parameters = told["parameters"]
    assert isinstance(parameters, dict)
    assert parameters["q1 d"]["unit"] == "mm" and parameters["q1 slack"]["unit"] == "deg"
    assert parameters["q2 a"]["value"] == pytest.approx(50, abs=3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("mark,x_mm\n1,2\n", "has no column y_mm"),
        ("mark,x_mm,y_mm\n1,2,3\n1,2,3\n", "mark 1 is there twice"),
        ("mark,x_mm,y_mm\n1.5,2,3\n", "line 2: mark is no whole number"),
        ("mark,x_mm,y_mm\n1,2,three\n", "line 2: 'three' is not a finite number"),
        ("mark,x_mm,y_mm,sd_mm\n1,2,3,0\n", "line 2: sd_mm 0 is not above 0"),
        ("mark,x_mm,y_mm\n1,2\n", "line 2: has 2 cell"),
    ],
)
def test_marks_that_cannot_be_read_are_refused(
    text: str, message: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    file = tmp_path_factory.mktemp("marks") / "m.csv"
    file.write_text(text)
    with pytest.raises(CalibrationError, match=message):
        read_marks(file)


def test_a_record_of_another_arm_is_refused(sheet49: Drawn, tmp_path_factory: pytest.TempPathFactory) -> None:
    file = tmp_path_factory.mktemp("record") / "r.csv"
    file.write_text("t_s,stroke,x_mm,y_mm,a_us\n0,0,0,0,1500\n")
    with pytest.raises(CalibrationError, match="a record of arm 'drawing_arm_2022' has t_s,stroke,x_mm,y_mm,q1_us"):
        read_record(file, sheet49.arm)
