"""What a report opens with: the sheet, and what somebody wants to know before the pen comes down."""

from __future__ import annotations

from collections.abc import Sequence

from planner.checking.check_result import CheckResult
from planner.counted import clock, counted, metres
from planner.head import PenInk
from planner.pens import hex_of
from planner.plots.look import Theme
from planner.report.markup import Markup, Section, definitions, element, joined
from planner.report.pictures import Picture
from planner.summary import PlanSummary
from planner.trajectory import Trajectory


def figure(picture: Picture) -> Markup:
    """A picture with its caption, in the theme that the reader has."""
    return element(
        "figure",
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


def opening(
    sheet: Picture,
    summary: PlanSummary,
    trajectory: Trajectory,
    check_result: CheckResult,
    accuracy: str,
) -> Markup:
    """The sheet, where to lay it, how long it takes, which pens it takes, and how accurate it becomes, in
    words."""
    width_mm, height_mm = summary.size_mm
    shares = ", ".join(f"{name} {100 * share:.0f} %" for name, _, share in summary.phases.shares())
    answers = [
        ("Where to lay it", summary.where),
        ("How long it takes", f"{clock(summary.duration_s)} ({shares})"),
        ("How large it is", f"{width_mm:.1f} × {height_mm:.1f} mm, {summary.scale:.3g} times its size on the page"),
        ("Which pens", _pens(trajectory)),
        ("How accurate it becomes", accuracy),
        ("The plan", element("span", check_result.verdict(), class_="good" if check_result.passed else "bad")),
    ]
    if summary.hints:
        answers.append(("Hint", summary.hints[0]))
    return element("section", figure(sheet), definitions(answers, class_="answers"), class_="opening")


def contents(sections: Sequence[Section]) -> Markup:
    """Links to all sections."""
    return element(
        "nav",
        element("h2", "Contents"),
        element("ul", *(element("li", one.link()) for one in sections)),
        aria_label="contents",
    )


def account_facts(summary: PlanSummary) -> Markup:
    """The account in figures."""
    return definitions(
        (
            ("takes", clock(summary.duration_s)),
            ("strokes", str(summary.n_strokes)),
            ("of them taps", str(summary.n_taps)),
            ("pen lifts", str(summary.n_lifts)),
            ("drawn", metres(summary.drawn_mm)),
            ("travelled, pen up", metres(summary.travelled_mm)),
            ("mean speed on paper", f"{summary.mean_speed_mm_s:.0f} mm/s"),
            ("samples", f"{summary.n_samples} at {summary.rate_hz:g} Hz"),
        ),
        class_="facts",
    )


def _pens(trajectory: Trajectory) -> Markup:
    if not trajectory.pens:
        return joined(("one pen",))
    pens = [
        joined((element("span", "", class_="swatch", style=f"background: {hex_of(pen.colour)}"), " ", _told(pen)))
        for pen in trajectory.pens
    ]
    changes = len(trajectory.pen_changes)
    after = f"; {counted(changes, 'change')}, for which the arm goes to its park pose and waits" if changes else ""
    return joined((joined(pens, ", then "), after))


def _told(pen: PenInk) -> str:
    return f"{pen.name} ({pen.width_mm:g} mm)" if pen.width_mm else pen.name
