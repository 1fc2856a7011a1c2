"""The calibration walk: a pattern is drawn, a photo of it is read, and the arm file that comes of it is kept."""

from __future__ import annotations

import asyncio
import json
import shlex
import shutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields
from importlib.util import find_spec
from pathlib import Path
from typing import IO, Any, cast

from planner.errors import OutputError, UsageError
from planner.files import written_aside
from planner.serve.arms import Arms
from planner.serve.asked import is_word
from planner.serve.child import Child, error_of, listen, start
from planner.serve.run import Playable

KEY = "calibration"
SHEET, READING = "sheet.pdf", "reading.png"
PHOTOS = (".jpg", ".jpeg", ".png", ".tif", ".tiff")
_PATTERN, _MARKS, _RECORD, _MEASURED, _FOUND = "pattern.csv", "marks.csv", "pulses.csv", "measured.csv", "found.json"
_WALK = "walk.json"


@dataclass(slots=True)
class Walk:
    """How far it is. arm: that is calibrated, "" before the first; target: what came of it, once there is one. busy:
    the command that is at work; failed: the one that went wrong, and error why. drawn: how the run of the pattern
    ended. said: what each command said, by its name; commands: the same for a terminal. readings: how many photos were
    read."""

    arm: str = ""
    target: str = ""
    busy: str = ""
    failed: str = ""
    error: str = ""
    drawn: str = ""
    said: dict[str, list[str]] = field(default_factory=dict)
    commands: dict[str, str] = field(default_factory=dict)
    readings: int = 0


class Calibration:
    """One walk at a time, in a folder that outlives the server. changed: called when it has. arm_saved: when an arm
    file has been written. Errors: OutputError where the folder cannot be had."""

    def __init__(self, folder: Path, arms: Arms, changed: Callable[[], None], arm_saved: Callable[[], None]) -> None:
        self.folder, self._arms = folder, arms
        self._changed, self._arm_saved = changed, arm_saved
        self._task: asyncio.Task[None] | None = None
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise OutputError(str(folder), error.strerror or str(error)) from error
        self.walk = self._kept()

    def state(self) -> dict[str, Any]:
        """The walk, which of its files there are, and what was found."""
        found = None
        with suppress(OSError, ValueError):
            found = json.loads((self.folder / _FOUND).read_text(encoding="utf-8"))
        steps = {"pattern": _PATTERN, "drawn": _RECORD, "measure": _MEASURED, "calibrate": _FOUND}
        return asdict(self.walk) | {
            "has": [step for step, file in steps.items() if self.walk.busy != step and self._has(file)],
            "found": found,
            "reads_photos": find_spec("cv2") is not None,
        }

    def begin(self, asked: Mapping[str, Any]) -> None:
        """Make a pattern for an arm, in the place of the walk before. Errors: UsageError."""
        word = self._arms.word(asked.get("arm"))
        count = asked.get("count", 49)
        if isinstance(count, bool) or not isinstance(count, int):
            raise UsageError("count is how many marks there are to be")
        words = ["pattern", f"--arm={word}", "-o", _PATTERN, "--marks", _MARKS, "--sheet", SHEET, f"--count={count}"]
        self._refuse_while_busy()
        self._clear()
        self.walk = Walk(arm=str(asked["arm"]))
        self._work("pattern", words)

    def playable(self) -> Playable:
        """The pattern, with a record of what servos are told. Errors: UsageError where there is none yet."""
        self._refuse_while_busy()
        if not self._has(_PATTERN):
            raise UsageError("there is no pattern yet: make one first")
        return Playable(KEY, "the pattern", self.folder, _PATTERN, self._ended, (f"--record={_RECORD}",))

    def read_photo(self, name: str, content: bytes, bar: str) -> None:
        """Read the marks in a picture of the sheet. bar: length of its bars by a ruler, mm, "" for as it should be.
        Errors: UsageError, OutputError."""
        suffix = Path(name).suffix.lower()
        if suffix not in PHOTOS:
            raise UsageError(f"'{name:.60}' is not a photo: its name should end in {', '.join(PHOTOS)}")
        if not is_word(bar):
            raise UsageError("bar is how long its bars are by a ruler, in mm")
        self._refuse_while_busy()
        if not self._has(_RECORD):
            raise UsageError("the pattern is not drawn yet")
        photo = f"photo{suffix}"
        try:
            (self.folder / photo).write_bytes(content)
        except OSError as error:
            raise OutputError(photo, error.strerror or str(error)) from error
        words = ["measure", photo, "--marks", _MARKS, "-o", _MEASURED, "--picture", READING]
        self._forget(_MEASURED, READING, _FOUND)
        self._work("measure", [*words, *([f"--bar={bar}"] if bar else [])])

    def calibrate(self, asked: Mapping[str, Any]) -> None:
        """Find out how the arm is, and save it under a name. Errors: UsageError."""
        target = self._arms.file_to_write(asked.get("target"), over=self.walk.target)
        self._refuse_while_busy()
        if not self._has(_MEASURED):
            raise UsageError("no marks have been measured yet")
        word = self._arms.word(self.walk.arm)
        files = ["--record", _RECORD, "--marks", _MEASURED, "-o", str(target), "--json", _FOUND]
        self._forget(_FOUND)
        self._work("calibrate", ["calibrate", word, *files], target.stem)

    async def close(self) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait([self._task])

    def _work(self, name: str, words: Sequence[str], target: str = "") -> None:
        walk = self.walk
        walk.busy, walk.failed, walk.error = name, "", ""
        walk.commands[name] = shlex.join(["plan", *words])
        walk.said.pop(name, None)
        self._task = asyncio.get_running_loop().create_task(self._command(name, words, target))
        self._changed()

    async def _command(self, name: str, words: Sequence[str], target: str) -> None:
        walk, child = self.walk, None
        printed: list[str] = []
        try:
            child = await start(words, self.folder, behind=True)
            code = await listen(child, printed.append)
            if code:
                walk.failed, walk.error = name, error_of(child, code)
            else:
                walk.said[name] = [*_without_files(printed), *_without_files(child.notes)]
                if target:
                    walk.target = target
                    self._arm_saved()
                walk.readings += name == "measure"
        except OSError as error:
            walk.failed, walk.error = name, str(error)
        finally:
            walk.busy, self._task = "", None
            await _ended(child)
            self._keep()
            self._changed()

    def _ended(self, how: str, complete: bool) -> None:
        self.walk.drawn = how
        self._forget(_MEASURED, READING, _FOUND)
        self._keep()
        self._changed()

    def _refuse_while_busy(self) -> None:
        if self.walk.busy:
            raise UsageError("wait until the step before is done")

    def _has(self, file: str) -> bool:
        return (self.folder / file).is_file()

    def _forget(self, *files: str) -> None:
        for file in files:
            (self.folder / file).unlink(missing_ok=True)

    def _keep(self) -> None:
        """Write down how far it is, where the disk allows it."""
        with suppress(OutputError), written_aside(self.folder / _WALK) as file:
            cast("IO[str]", file).write(json.dumps(asdict(self.walk)))

    def _kept(self) -> Walk:
        """Of an earlier server; one that cannot be read is forgotten."""
        known = {field.name for field in fields(Walk)}
        try:
            said = json.loads((self.folder / _WALK).read_text(encoding="utf-8"))
            return Walk(**{key: value for key, value in said.items() if key in known})
        except (OSError, ValueError, TypeError, AttributeError):
            self._clear()
            return Walk()

    def _clear(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(exist_ok=True)


async def _ended(child: Child | None) -> None:
    if child is not None and child.process.returncode is None:
        await child.end()


def _without_files(lines: Sequence[str]) -> list[str]:
    return [line.removeprefix("warning: ") for line in lines if not line.startswith("wrote ")]
