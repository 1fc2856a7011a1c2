"""What a calibration found, in words and as JSON."""

from __future__ import annotations

import numpy as np

from planner.arms.usual_settings import usual_clearance_mm
from planner.arrays import FloatArray
from planner.error_model.calibration.calibrate import Calibrated
from planner.error_model.calibration.parameters import Parameters
from planner.error_model.calibration.plausible import DOUBTFUL
from planner.error_model.prediction import Prediction


def warnings(found: Calibrated) -> list[str]:
    """What the user should see to."""
    said = [
        f"{outlier.sheet}: mark {outlier.mark} is {outlier.off_mm:.1f} mm off what all others say, and was not believed"
        for outlier in found.outliers
    ]
    said += [f"marks {one} and {other} seem to be exchanged" for one, other in found.exchanged]
    if found.fit.noise > DOUBTFUL:
        said.append(
            f"marks lie {found.fit.noise:.1f} times further from where the calibrated arm has them than their sd_mm "
            f"allows, {found.fit.rms_mm:.2f} mm rms: were they measured well, and is every joint tight?"
        )
    if not found.has_heights:
        said.append(
            "no heights were measured: ink may be missing where the pen is too high (plan measure reads the "
            "lines beside the marks)"
        )
    return said


def lines(found: Calibrated, expected: Prediction) -> list[str]:
    """The findings for people."""
    arm, fit = found.arm, found.fit
    said = [
        f"marks were {found.before_mm:.2f} mm rms from where the arm file had them, and are {fit.rms_mm:.2f} mm "
        "from where the calibrated one has them"
    ]
    for joint, slack, sd in zip(arm.joints, fit.model.slack, _of(fit.parameters, fit.sd, "slack"), strict=True):
        per = joint.per_file_unit
        said.append(
            f"joint {joint.name}: {2 * slack / per:.2f} {joint.file_unit} of slack from end to end "
            f"(+-{2 * sd / per:.2f})"
        )
    paper = arm.paper
    said.append(
        f"the paper lies {paper.x_mm:.1f}, {paper.y_mm:.1f}, {paper.z_mm:.1f} mm off, turned by "
        f"{np.degrees(paper.yaw_rad):.2f} deg and tilted by {np.degrees(paper.tilt_x_rad):.2f} and "
        f"{np.degrees(paper.tilt_y_rad):.2f} deg"
    )
    if arm.accuracy is not None and arm.pen.clearance_mm == usual_clearance_mm(arm):
        said.append(
            f"the pen is clear of the paper from {arm.pen.clearance_mm:g} mm on, as its height is off by "
            f"{arm.accuracy.height_mm:.2g} mm"
        )
    if found.untold:
        said.append(f"the marks tell little of: {', '.join(found.untold)}")
    said += [f"only together are known: {one} and {other}" for one, other in found.gauges]
    low, high = expected.rms_interval_mm
    said.append(f"a drawing is going to be off by {expected.rms_mm:.2f} mm rms ({low:.2f} to {high:.2f})")
    return said


def as_json(found: Calibrated, expected: Prediction) -> dict[str, object]:
    """Values in mm and degrees."""
    fit = found.fit
    units = fit.parameters.file_units
    parameters = {
        name: {"value": float(value / per), "sd": float(sd / per), "unit": unit}
        for name, value, sd, (unit, per) in zip(
            fit.parameters.names, fit.parameters.values(fit.vector), fit.sd, units, strict=True
        )
    }
    return {
        "parameters": parameters,
        "rms_mm": fit.rms_mm,
        "outliers": [
            {"marks": outlier.sheet, "mark": outlier.mark, "off_mm": outlier.off_mm} for outlier in found.outliers
        ],
        "unidentifiable": [*found.untold, *(f"{one} against {other}" for one, other in found.gauges)],
        "predicted_rms_mm": expected.rms_mm,
        "predicted_rms_interval_mm": list(expected.rms_interval_mm),
    }


def _of(parameters: Parameters, vector: FloatArray, kind: str) -> list[float]:
    return [float(value) for name, value in zip(parameters.names, vector, strict=True) if name.endswith(kind)]
