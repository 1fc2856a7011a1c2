"""The page about a plan, which holds all that it shows and asks nothing of any network."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import IO, cast

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.checking.chain import chain_poses
from planner.checking.check_result import CheckResult
from planner.drawing.drawing import Drawing
from planner.errors import OutputError
from planner.files import written_aside
from planner.motion.speed_limit import pen_speed_mm_s
from planner.plots.look import Theme
from planner.redundancy.arm_model import ArmModel
from planner.report.markup import Markup, clean, definitions, element, joined, section, table
from planner.report.pictures import pictures
from planner.report.shares import QUANTITIES, LargestShare, largest_shares
from planner.settings import PlanSettings
from planner.stroke_figures import StrokeFigures, stroke_figures
from planner.summary import PlanSummary, clock
from planner.trajectory import TRAVELLING, Trajectory

_N_STROKES = 20
_MADE_WITH = ("drawing-arm-planner", "numpy", "scipy", "casadi", "ruckig", "matplotlib")
_NEVER_SENT = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
"""The page loads nothing, and a browser is told not to even if something in it asked."""


@dataclass(frozen=True, eq=False, slots=True)
class Planned:
    """All that the page tells of. command: what was typed. reach_mm: inner and outer radius of what the pen reaches on
    the paper."""

    command: str
    settings: PlanSettings
    summary: PlanSummary
    trajectory: Trajectory
    model: ArmModel
    drawing: Drawing
    check_result: CheckResult
    reach_mm: tuple[float, float]


def write_report(planned: Planned, target: Path) -> None:
    """Write the page, whole or not at all, in the place of one that is there; folders that are missing are made.
    Errors: OutputError."""
    page = report_page(planned)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(str(target.parent), error.strerror or str(error)) from error
    with written_aside(target) as file:
        cast("IO[str]", file).write(page)


def report_page(planned: Planned) -> Markup:
    """The page as text, the same for the same plan."""
    trajectory, summary = planned.trajectory, planned.summary
    tip_mm = chain_poses(planned.model.arm, planned.model.arm.from_file_units(trajectory.positions)).tip_mm.T
    heading = clean(trajectory.drawing) or "trajectory"
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=_NEVER_SENT),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", f"{heading} on {planned.model.arm.name}"),
        element("style", Markup(files(__package__).joinpath("page.css").read_text(encoding="utf-8"))),
    )
    body = element(
        "body",
        element("h1", heading),
        element("p", f"on {planned.model.arm.name}, by method {trajectory.method}", class_="quiet"),
        _check_result_in_brief(planned.check_result),
        _facts(summary),
        _warnings(summary.warnings),
        section("Pictures", *_figures(planned, tip_mm)),
        section("Joints", *_joints(trajectory, planned.model.arm)),
        section(
            "Strokes",
            *_strokes(stroke_figures(trajectory, tip_mm), pen_speed_mm_s(planned.model.arm, planned.settings)),
        ),
        section("Check", *_check(planned.check_result)),
        section("How it was made", *_making(planned)),
    )
    return Markup(f"<!doctype html>\n{element('html', head, body, lang='en')}\n")


def _check_result_in_brief(check_result: CheckResult) -> Markup:
    n_faults = len(check_result.faults)
    told = "check passed" if check_result.passed else f"check failed: {n_faults} fault{'' if n_faults == 1 else 's'}"
    return element("p", told, class_=f"check-result {'good' if check_result.passed else 'bad'}")


def _facts(summary: PlanSummary) -> Markup:
    width_mm, height_mm = summary.size_mm
    return joined(
        (
            definitions(
                (
                    ("takes", clock(summary.duration_s)),
                    ("on paper", f"{width_mm:.1f} × {height_mm:.1f} mm"),
                    ("of its size on the page", f"{summary.scale:.3g} times"),
                    ("strokes", str(summary.n_strokes)),
                    ("of them taps", str(summary.n_taps)),
                    ("drawn", f"{summary.drawn_mm / 1000:.2f} m"),
                    ("travelled, pen up", f"{summary.travelled_mm / 1000:.2f} m"),
                    ("mean speed on paper", f"{summary.mean_speed_mm_s:.0f} mm/s"),
                    ("samples", f"{summary.n_samples} at {summary.rate_hz:g} Hz"),
                ),
                class_="facts",
            ),
            table(
                ("phase", "time (s)", "share"),
                [(name, f"{seconds:.2f}", f"{100 * share:.1f} %") for name, seconds, share in summary.phases.shares()],
            ),
        )
    )


def _warnings(warnings: Sequence[str]) -> Markup:
    if not warnings:
        return section("Warnings", element("p", "None.", class_="quiet"))
    return section(
        f"Warnings ({len(warnings)})",
        element("ul", *(element("li", warning) for warning in warnings), class_="warnings"),
    )


def _figures(planned: Planned, tip_mm: FloatArray) -> list[Markup]:
    return [
        element(
            "figure",
            element("h3", picture.heading),
            element(
                "div",
                element(
                    "picture",
                    element("source", media="(prefers-color-scheme: dark)", srcset=picture.sources[Theme.DARK]),
                    element("img", src=picture.sources[Theme.LIGHT], alt=f"{picture.heading}: {picture.caption}"),
                ),
                class_="scrolls",
                tabindex="0",
            ),
            element("figcaption", picture.caption),
        )
        for picture in pictures(
            planned.trajectory, planned.model, planned.drawing, tip_mm, planned.reach_mm, planned.settings
        )
    ]


def _joints(trajectory: Trajectory, arm: Arm) -> list[Markup]:
    def told(largest: LargestShare) -> Markup:
        where = "pen up" if largest.stroke == TRAVELLING else f"stroke {largest.stroke}"
        return joined((f"{100 * largest.share:.1f} %", element("small", f"{largest.time_s:.2f} s, {where}")))

    return [
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
    ]


def _strokes(figures: StrokeFigures, speed_mm_s: float) -> list[Markup]:
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
    return [
        element(
            "p",
            f"A stroke loses the time that it takes beyond its length at {speed_mm_s:g} mm/s, the cap on the "
            "pen's speed: in corners, at the limits of joints, and at rest.",
        ),
        element("h3", f"The first {min(_N_STROKES, len(rows))} of {len(rows)}"),
        table(head, rows[:_N_STROKES]),
        element("h3", f"The {len(costly)} that lose most"),
        table(head, [rows[place] for place in costly]),
    ]


def _check(check_result: CheckResult) -> list[Markup]:
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
    return [
        element(
            "p",
            "By mathematics of the check's own, at the samples and between them, against the arm's limits and "
            "the drawing. ",
            element("code", "plan check"),
            " tells the same of the file.",
        ),
        table(("", "law", "joint", "worst", "limit", "unit", "remark", "place"), rows, n_texts=8),
    ]


def _making(planned: Planned) -> list[Markup]:
    settings = planned.settings
    weights = ", ".join(
        f"{name} {value:g}" for name, value in asdict(settings.weights or planned.model.arm.weights).items()
    )
    lift_mm = planned.model.arm.pen.lift_mm if settings.lift_mm is None else settings.lift_mm
    used = [
        ("arm", f"{planned.model.arm.name}: {planned.model.arm.source}"),
        ("method", settings.method.value),
        ("weights", weights),
        ("rate", f"{settings.rate_hz:g} Hz"),
        ("tolerance", f"{settings.tolerance_mm:g} mm"),
        ("pen's speed on paper, at most", f"{pen_speed_mm_s(planned.model.arm, settings):g} mm/s"),
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
        ("svg_to_arm_mm", " ".join(f"{value:.6g}" for value in planned.trajectory.svg_to_arm_mm)),
    ]
    made_with = [("Python", platform.python_version()), *((name, version(name)) for name in _MADE_WITH)]
    return [
        element("pre", element("code", planned.command)),
        element("h3", "Settings"),
        table(("setting", "value"), used, n_texts=2),
        element("h3", "Versions"),
        table(("package", "version"), made_with, n_texts=2),
    ]


def _yes(value: bool) -> str:
    return "yes" if value else "no"
