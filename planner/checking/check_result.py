"""What a check found: one finding a law, with its worst figure and where that is; as text and as JSON."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

_JOINT_LAWS = frozenset({"position", "velocity", "acceleration", "jerk"})
_INK_LAWS = frozenset({"nothing extra", "nothing missing"})


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
    figure and the limit that it is held to, in `unit`. middle: of what is allowed, from where both count.
    """

    check: str
    passed: bool
    worst: float | None = None
    limit: float | None = None
    unit: str = ""
    place: Place | None = None
    remark: str = ""
    is_note: bool = False
    middle: float = 0.0

    @property
    def share(self) -> float:
        """How much of its limit is used; 0 where there are no figures."""
        if self.worst is None or self.limit is None or self.limit == self.middle:
            return 0.0
        return (self.worst - self.middle) / (self.limit - self.middle)

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

    def verdict(self) -> str:
        """One line: whether it passed, and how near it comes to what it must not do."""
        laws = [finding for finding in self.findings if not finding.is_note]
        told = [f"{len(laws)} laws" if self.passed else f"{len(self.faults)} of {len(laws)} laws broken"]
        limits = [(finding.share, finding) for finding in laws if finding.check.split()[0] in _JOINT_LAWS]
        if limits:
            share, nearest = max(limits, key=lambda one: one[0])
            joint = nearest.place.joint if nearest.place else None
            told.append(f"nearest to a limit: {nearest.check}{f' of {joint}' if joint else ''} {100 * share:.0f} %")
        ink = [finding for finding in laws if finding.check in _INK_LAWS and finding.worst is not None]
        if ink:
            worst = max(ink, key=lambda finding: finding.share)
            told.append(f"ink within {worst.worst:.3f} of {worst.limit:g} {worst.unit}")
        return f"{'passed' if self.passed else 'FAILED'}: {'; '.join(told)}"

    def text(self) -> str:
        """The verdict, then one line a finding, without a line end at the end."""
        return "\n".join([self.verdict(), *map(str, self.findings)])

    def __str__(self) -> str:
        return self.text()

    def as_dict(self) -> dict[str, Any]:
        """The same as values for JSON; lengths in mm, times in s, the rest in the unit that is named."""
        return {"passed": self.passed, "findings": [asdict(finding) for finding in self.findings]}
