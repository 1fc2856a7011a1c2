"""One thing moves the arm at a time, whoever asks for it."""

from __future__ import annotations

from planner.errors import UsageError


class Turn:
    """Whose turn it is; "" for nobody's."""

    def __init__(self) -> None:
        self._doing = ""

    def take(self, doing: str) -> None:
        """doing: such as "drawing", for whoever comes next. Errors: UsageError where somebody else has it."""
        if self._doing:
            raise UsageError(f"the arm is {self._doing}: stop that first")
        self._doing = doing

    def give_back(self) -> None:
        self._doing = ""
