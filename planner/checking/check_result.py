"""What a check found: one finding a law, with its worst figure and where that is; as text and as JSON."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from planner.counted import counted


@dataclass(frozen=True, slots=True)
class Place:
    """Where to look. What does not apply is None.

    time_s may lie between samples, sample is then the one before; line counts from 1 in the file that
    the trajectory was read from; tip_mm is in the arm's base frame, svg_user in the drawing's coordinates.
    """

    time_s: float | None = None
    sample: int | None = None
    line: int | None = None
    joint: str | None = None
    stroke: int | None = None
    tip_mm: tuple[float, ...] | None = None
    svg_user: tuple[float, float] | None = None

    def __str__(self) -> str:
        parts = []
        if self.stroke is not None:
            parts.append(f"stroke {self.stroke}")
        if self.time_s is not None:
            parts.append(f"{self.time_s:.3f} s")
        if self.line is not None:
            parts.append(f"line {self.line}")
        if self.tip_mm is not None:
            parts.append("tip at (" + ", ".join(f"{value:.2f}" for value in self.tip_mm) + ") mm")
        if self.svg_user is not None:
            parts.append("in the drawing ({:.2f}, {:.2f})".format(*self.svg_user))
        return ", ".join(parts)


@dataclass(frozen=True, slots=True)
class Finding:
    """One law and how the trajectory stands to it.

    check: the law's name. passed: always True for a note, which has no limit. worst, limit: the worst
    figure and the limit that it is held to, in `unit`.
    """

    check: str
    passed: bool
    worst: float | None = None
    limit: float | None = None
    unit: str = ""
    place: Place | None = None
    remark: str = ""
    is_note: bool = False

    @property
    def words(self) -> str:
        """The law, of which joint, and the figures: everything but whether it passed and where."""
        joint = "" if self.place is None or self.place.joint is None else f" of {self.place.joint}"
        figures = ""
        if self.worst is not None:
            worst = round(self.worst, 9) + 0.0  # no "-0"
            figures = f"{worst:.5g}" + ("" if self.limit is None else f" of {self.limit:.5g}")
        told = " ".join(filter(None, (figures, self.unit, self.remark)))
        return f"{self.check}{joint}" + (f": {told}" if told else "")

    def __str__(self) -> str:
        mark = "note " if self.is_note else "ok   " if self.passed else "FAULT"
        place = "" if self.place is None or not str(self.place) else f" ({self.place})"
        colon = ":" if place and ":" not in self.words else ""
        return f"{mark} {self.words}{colon}{place}"


@dataclass(frozen=True, slots=True)
class CheckResult:
    """All findings, in the order in which they are told."""

    findings: tuple[Finding, ...]

    @property
    def passed(self) -> bool:
        return all(finding.passed for finding in self.findings)

    @property
    def faults(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self.findings if not finding.passed)

    def text(self) -> str:
        """One line a finding and one for the sum, without a line end at the end."""
        total = "passed" if self.passed else f"FAILED: {counted(len(self.faults), 'fault')}"
        return "\n".join([*map(str, self.findings), total])

    def __str__(self) -> str:
        return self.text()

    def as_dict(self) -> dict[str, Any]:
        """The same as values for JSON; lengths in mm, times in s, the rest in the unit that is named."""
        return {"passed": self.passed, "findings": [asdict(finding) for finding in self.findings]}
