"""The tables of a report: joints, strokes, the result of the check, and how the plan was made."""

from __future__ import annotations

import platform
from dataclasses import asdict
from importlib.metadata import version

from planner.arms.arm import Arm
from planner.checking.check_result import CheckResult
from planner.motion.speed_limit import pen_speed_mm_s
from planner.report.markup import Markup, element, joined, table
from planner.report.shares import QUANTITIES, LargestShare, largest_shares
from planner.settings import PlanSettings
from planner.stroke_figures import StrokeFigures
from planner.trajectory import TRAVELLING, Trajectory

_N_STROKES = 20
_MADE_WITH = ("drawing-arm-planner", "numpy", "scipy", "casadi", "ruckig", "matplotlib")


def joints(trajectory: Trajectory, arm: Arm) -> Markup:
    def told(largest: LargestShare) -> Markup:
        where = "pen up" if largest.stroke == TRAVELLING else f"stroke {largest.stroke}"
        return joined((f"{100 * largest.share:.1f} %", element("small", f"{largest.time_s:.2f} s, {where}")))

    return joined(
        (
            element(
                "p",
                "The largest share of each limit that a joint uses, and when; of a position, how far from the "
                "middle of its range towards an end. Derivatives are differences of the samples.",
            ),
            table(
                ("joint", *QUANTITIES),
                [
                    (joint.name, *map(told, row))
                    for joint, row in zip(arm.joints, largest_shares(trajectory, arm), strict=True)
                ],
            ),
        )
    )


def strokes(figures: StrokeFigures, speed_mm_s: float) -> Markup:
    lost_s = figures.lost_s(speed_mm_s)
    costly = (-lost_s).argsort(kind="stable")[:_N_STROKES].tolist()
    rows = [
        (
            str(stroke),
            f"{begins:.2f}",
            f"{lasts:.2f}",
            f"{lost:.2f}",
            *((f"{length:.2f}", f"{mean:.1f}", f"{top:.1f}") if length > 0 else ("tap", "", "")),
        )
        for stroke, begins, lasts, lost, length, mean, top in zip(
            figures.index.tolist(),
            figures.begins_s.tolist(),
            figures.duration_s.tolist(),
            lost_s.tolist(),
            figures.length_mm.tolist(),
            figures.mean_speed_mm_s.tolist(),
            figures.top_speed_mm_s.tolist(),
            strict=True,
        )
    ]
    head = ("stroke", "begins (s)", "takes (s)", "loses (s)", "length (mm)", "mean (mm/s)", "fastest (mm/s)")
    return joined(
        (
            element(
                "p",
                f"A stroke loses the time that it takes beyond its length at {speed_mm_s:g} mm/s, the cap on the "
                "pen's speed: in corners, at the limits of joints, and at rest.",
            ),
            element("h3", f"The first {min(_N_STROKES, len(rows))} of {len(rows)}"),
            table(head, rows[:_N_STROKES]),
            element("h3", f"The {len(costly)} that lose most"),
            table(head, [rows[place] for place in costly]),
        )
    )


def check(check_result: CheckResult) -> Markup:
    """Faults first, as they are what one has come for."""
    rows = []
    for finding in sorted(check_result.findings, key=lambda finding: finding.passed):
        mark, kind = ("note", "quiet") if finding.is_note else ("ok", "good") if finding.passed else ("fault", "bad")
        joint = finding.place.joint if finding.place is not None and finding.place.joint else ""
        figures = [
            value if value is None else f"{round(value, 9) + 0.0:.5g}" for value in (finding.worst, finding.limit)
        ]
        rows.append(
            (
                element("span", mark, class_=kind),
                finding.check,
                joint,
                *(text or "" for text in figures),
                finding.unit,
                finding.remark,
                str(finding.place or ""),
            )
        )
    return joined(
        (
            element(
                "p",
                "By mathematics of the check's own, at the samples and between them, against the arm's limits and "
                "the drawing. ",
                element("code", "plan check"),
                " tells the same of the file.",
            ),
            table(("", "law", "joint", "worst", "limit", "unit", "remark", "place"), rows, n_texts=8),
        )
    )


def making(command: str, settings: PlanSettings, arm: Arm, trajectory: Trajectory) -> Markup:
    """What was typed, and all that it amounts to."""
    weights = ", ".join(f"{name} {value:g}" for name, value in asdict(settings.weights or arm.weights).items())
    lift_mm = arm.pen.lift_mm if settings.lift_mm is None else settings.lift_mm
    used = [
        ("arm", f"{arm.name}: {arm.source}"),
        ("method", settings.method.value),
        ("weights", weights),
        ("rate", f"{settings.rate_hz:g} Hz"),
        ("tolerance", f"{settings.tolerance_mm:g} mm"),
        ("pen's speed on paper, at most", f"{pen_speed_mm_s(arm, settings):g} mm/s"),
        ("lowering, at most", f"{settings.lowering_speed_mm_s:g} mm/s"),
        ("rest before a stroke", f"{settings.dwell_s:g} s"),
        ("lift", f"{lift_mm:g} mm"),
        ("canvas", settings.canvas.value),
        ("scaled to the canvas", _yes(settings.is_fitted)),
        ("margin", f"{settings.margin_mm:g} mm"),
        ("turned by", f"{settings.rotate_deg:g}°"),
        ("out of reach left out", _yes(settings.skip_unreachable)),
        ("text", settings.reading.text + (f", of {settings.reading.font}" if settings.reading.font else "")),
        ("ink beyond the page cut off", _yes(settings.reading.crop == "page")),
        ("lines under fills left out", _yes(settings.reading.occlude)),
        ("pixels to the inch", f"{settings.reading.dpi:g}"),
        ("svg_to_arm_mm", " ".join(f"{value:.6g}" for value in trajectory.svg_to_arm_mm)),
    ]
    made_with = [("Python", platform.python_version()), *((name, version(name)) for name in _MADE_WITH)]
    return joined(
        (
            element("pre", element("code", command)),
            element("h3", "Settings"),
            table(("setting", "value"), used, n_texts=2),
            element("h3", "Versions"),
            table(("package", "version"), made_with, n_texts=2),
        )
    )


def _yes(value: bool) -> str:
    return "yes" if value else "no"
