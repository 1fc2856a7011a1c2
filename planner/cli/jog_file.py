"""`plan jog`: the arm file, and what was found since it was read."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import IO, cast

from planner.arms.arm import Arm
from planner.arms.arm_edit import edited
from planner.arms.arm_file import arm_file_text, load_arm, read_arm_file
from planner.errors import ArmFileError, UsageError
from planner.files import written_aside


class FoundArm:
    """The arm file as it is, and as it becomes by what is found. target: None where there is none to write."""

    def __init__(self, name_or_file: str, target: Path | None) -> None:
        """Errors: UnknownArm, ArmFileError."""
        self.before = self._saved = load_arm(name_or_file)
        self._text, self._target = arm_file_text(name_or_file), target

    def holds(self, arm: Arm) -> bool:
        """Whether all that was found of the arm is in the file."""
        return arm is self._saved

    def write(self, arm: Arm) -> str:
        """The name of the file. Errors: UsageError, OutputError; then it is as it was."""
        if self._target is None:
            raise UsageError("nowhere to save it: give -o ARM.toml")
        text = edited(self._text, self.before, arm, f"{arm.name} as found by plan jog.")
        with tempfile.TemporaryDirectory() as folder:
            tried = Path(folder) / self._target.name
            tried.write_text(text, encoding="utf-8")
            try:
                read_arm_file(tried)
            except ArmFileError as error:
                raise UsageError(f"what was found makes no arm file yet: {'; '.join(error.faults)}") from error
        with written_aside(self._target) as file:
            cast("IO[str]", file).write(text)
        self._saved = arm
        return str(self._target)
