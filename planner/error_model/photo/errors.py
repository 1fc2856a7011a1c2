"""What a picture can be that marks cannot be read from."""

from __future__ import annotations

from planner.errors import PlannerError


class PhotoError(PlannerError):
    """A picture that is none, or not one of the sheet that it should be of."""

    def __init__(self, source: str, reason: str) -> None:
        self.source, self.reason = source, reason
        super().__init__(f"{source}: {reason}")
