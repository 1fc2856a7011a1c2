"""Every error that reaches a user: one tree, each leaf with its data and its exit code.

Messages are one line: what is wrong, where, and what to do about it.
"""

from __future__ import annotations

from collections.abc import Sequence


class PlannerError(Exception):
    """Base of all expected errors. `exit_code` is what the command line returns."""

    exit_code = 2

    def __reduce__(self) -> tuple[object, ...]:
        """Copied as it stands, without running its constructor again, so that one process can tell another."""
        return BaseException.__new__, (type(self), *self.args), self.__dict__


class UsageError(PlannerError):
    """An option or a combination of options that means nothing."""


class UnknownOption(UsageError, TypeError):
    """A keyword that a function does not take."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        self.name, self.known = name, tuple(known)
        super().__init__(f"unknown option '{name}'; known options: {', '.join(self.known)}")


class DrawingError(PlannerError):
    """A drawing that cannot be read, or holds nothing that a pen can draw."""

    def __init__(self, source: str, reason: str) -> None:
        self.source, self.reason = source, reason
        super().__init__(f"{source}: {reason}")


class ArmFileError(PlannerError):
    """An arm file with one or more faults; all of them are reported at once."""

    def __init__(self, source: str, faults: Sequence[str]) -> None:
        self.source, self.faults = source, tuple(faults)
        super().__init__(f"{source}: " + "; ".join(self.faults))


class UnknownArm(PlannerError):
    """No arm file of that name, and no such file."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        self.name, self.known = name, tuple(known)
        super().__init__(
            f"unknown arm '{name}'; known arms: {', '.join(self.known)} (or give the path of a .toml file)"
        )


class TrajectoryFileError(PlannerError):
    """A trajectory file that is damaged, edited or not ours. `line` counts from 1."""

    def __init__(self, source: str, line: int | None, reason: str) -> None:
        self.source, self.line, self.reason = source, line, reason
        where = source if line is None else f"{source}, line {line}"
        super().__init__(f"{where}: {reason}")


class CalibrationError(PlannerError):
    """A record or marks that no calibration can rest on."""

    def __init__(self, source: str, reason: str) -> None:
        self.source, self.reason = source, reason
        super().__init__(f"{source}: {reason}")


class OutputError(PlannerError):
    """A result that cannot be written where the user wants it."""

    def __init__(self, target: str, reason: str) -> None:
        self.target, self.reason = target, reason
        super().__init__(f"cannot write {target}: {reason}")


class PlanError(PlannerError):
    """The drawing is fine, but this arm cannot draw it so."""

    exit_code = 3


class TargetOutOfReach(PlanError):
    """A point of a stroke that the arm cannot put its pen on.

    `joint` and `limit` name the first limit in the way (None where geometry alone forbids it).
    """

    def __init__(
        self,
        stroke: int,
        point: int,
        position_mm: Sequence[float],
        reason: str,
        joint: str | None = None,
        limit: str | None = None,
    ) -> None:
        self.stroke, self.point, self.reason = stroke, point, reason
        self.position_mm = tuple(float(value) for value in position_mm)
        self.joint, self.limit = joint, limit
        place = ", ".join(f"{value:.1f}" for value in self.position_mm)
        super().__init__(
            f"stroke {stroke}, point {point} at ({place}) mm cannot be reached: {reason}"
            " (make the drawing smaller, move it, or use --skip-unreachable)"
        )


class LinksCollide(PlanError):
    """A pen-up move on which two links, or one and the paper, come too close. `stroke` is the one that it leads to, or
    as many as there are for the last move."""

    def __init__(self, stroke: int, links: tuple[str, str], clearance_mm: float, reason: str) -> None:
        self.stroke, self.links, self.clearance_mm = stroke, links, clearance_mm
        super().__init__(
            f"on the pen-up move before stroke {stroke} {reason}; try another --method, a smaller --lift,"
            " a larger --margin, or --skip-unreachable"
        )


class TargetBeyondReach(PlanError):
    """A single target that the arm cannot put its pen on: gap_mm is how near it gets."""

    def __init__(self, target_mm: Sequence[float], gap_mm: float, *, pointed: bool) -> None:
        self.target_mm, self.gap_mm = tuple(float(value) for value in target_mm), gap_mm
        place = ", ".join(f"{value:g}" for value in self.target_mm)
        held = " with the pen pointed straight at the paper" if pointed else ""
        super().__init__(f"target ({place}) mm is out of reach{held}: the nearest tip found is {gap_mm:.1f} mm away")


class DoesNotFit(PlanError):
    """A drawing kept at its true size that is larger than the canvas."""


class HardwareError(PlannerError):
    """The arm, its controller or the line to it failed."""

    exit_code = 4
