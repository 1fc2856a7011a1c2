"""What people prefer: options in files of theirs, found by rule, in force where the command line says nothing.

    [options]            # for every plan
    arm = "my_arm"
    margin = "1cm"
    [presets.fast]       # with --preset fast
    speed = "8cm/s"
    [arms]               # names for arm files
    my_arm = "arms/my_arm.toml"

Files that are named (arms, pens, font) are looked for from where that file is.

One file is the user's own, one may lie beside the drawing (`plan.toml`). What is said nearer goes before: the command
line, then a preset, then the file beside the drawing, then the user's own.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from planner import DISTRIBUTION
from planner.errors import UsageError
from planner.toml_file import read_toml

BESIDE = "plan.toml"
USER_FILE_VARIABLE = "PLAN_CONFIG"
_TABLES = ("options", "presets", "arms")
_FILES = frozenset({"font", "pens"})
"""What names a file: it lies where the file of options says, as arms do."""
_NEVER = frozenset({"help", "version", "output", "preset", "report"})
"""What is said each time."""


@dataclass(frozen=True, slots=True)
class PreferenceFile:
    """One file: options and presets by name as they stand in it, arms as paths."""

    path: Path
    options: Mapping[str, object] = field(default_factory=dict)
    presets: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    arms: Mapping[str, Path] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Preferences:
    """All files that count, the one that goes before first."""

    files: tuple[PreferenceFile, ...]

    def presets(self) -> list[str]:
        return sorted({name for file in self.files for name in file.presets})

    def arms(self) -> dict[str, Path]:
        return {name: path for file in reversed(self.files) for name, path in file.arms.items()}

    def said(self, preset: str | None) -> Iterator[tuple[str, Path, str, object]]:
        """Where it is said, the folder of that file, the option, and its value; what goes before comes last. Errors:
        UsageError for a preset that there is not."""
        for file in reversed(self.files):
            yield from ((str(file.path), file.path.parent, option, value) for option, value in file.options.items())
        if preset is None:
            return
        known = [file for file in reversed(self.files) if preset in file.presets]
        if not known:
            there = ", ".join(self.presets()) or "none"
            files = " or ".join(str(file.path) for file in self.files) or str(user_file())
            raise UsageError(f"there is no preset '{preset:.40}' in {files}; presets: {there}")
        for file in known:
            where = f"{file.path}, preset {preset}"
            yield from ((where, file.path.parent, option, value) for option, value in file.presets[preset].items())


def user_file() -> Path:
    """Where the user's own file is looked for, by the rule of the platform; PLAN_CONFIG names another."""
    named = os.environ.get(USER_FILE_VARIABLE)
    if named:
        return Path(named)
    import platformdirs

    return platformdirs.user_config_path(DISTRIBUTION, appauthor=False) / "config.toml"


def preferences_for(drawing: Path | None) -> Preferences:
    """What counts for a drawing, for all drawings of a folder, or for none. Errors: UsageError for a file that cannot
    be used."""
    try:
        beside = [] if drawing is None else [(drawing if drawing.is_dir() else drawing.parent) / BESIDE]
        paths = [path for path in (*beside, user_file()) if path.is_file()]
    except (OSError, ValueError):  # a name that is none: its reader says what is wrong with it
        return Preferences(())
    return Preferences(tuple(_read(path) for path in paths))


def with_preferences(
    parser: argparse.ArgumentParser, arguments: Sequence[str], preferences: Preferences, preset: str | None
) -> tuple[argparse.Namespace, dict[str, str]]:
    """The options of `arguments` with what people prefer in the place of defaults, and where each of those is said, by
    the option's name. Errors: UsageError."""
    sources: dict[str, str] = {}
    for where, folder, option, value in preferences.said(preset):
        action = _action(parser, where, option)
        if action.dest in _FILES and isinstance(value, str):
            value = str(folder / Path(value).expanduser())
        parser.set_defaults(**{action.dest: _value(action, where, option, value)})
        sources[action.dest] = where
    options = parser.parse_args(arguments)
    arms = preferences.arms()
    if options.arm in arms:
        options.arm = str(arms[options.arm])
    return options, sources


def _action(parser: argparse.ArgumentParser, where: str, option: str) -> argparse.Action:
    actions = {
        text.removeprefix("--"): action
        for action in parser._actions
        for text in action.option_strings
        if text.startswith("--") and not text.startswith("--no-") and action.dest not in _NEVER
    }
    if option not in actions:
        raise UsageError(f"{where}: '{option:.40}' is no option; there are {', '.join(sorted(actions))}")
    return actions[option]


def _value(action: argparse.Action, where: str, option: str, value: object) -> object:
    """A value of a file as the command line would have made it of its text."""
    if isinstance(action, argparse.BooleanOptionalAction | argparse._StoreTrueAction):
        if not isinstance(value, bool):
            raise UsageError(f"{where}: {option} is true or false, not {value!r:.40}")
        return value
    if action.nargs == "?" and value is True:
        return action.const
    parts = value if isinstance(value, list) else [value]
    n_parts = action.nargs if isinstance(action.nargs, int) else 1
    if len(parts) != n_parts or not all(
        isinstance(part, str | int | float) and not isinstance(part, bool) for part in parts
    ):
        wanted = f"{n_parts} values in brackets" if n_parts > 1 else "a text or a number"
        raise UsageError(f"{where}: {option} is {wanted}, not {value!r:.40}")
    try:
        read = [action.type(str(part)) if callable(action.type) else str(part) for part in parts]
    except (argparse.ArgumentTypeError, ValueError) as error:
        raise UsageError(f"{where}: {option}: {error}") from error
    for one in read:
        if action.choices is not None and one not in action.choices:
            raise UsageError(f"{where}: {option} is one of {', '.join(map(str, action.choices))}, not {one!r:.40}")
    return read if n_parts > 1 else read[0]


def _read(path: Path) -> PreferenceFile:
    tables = read_toml(path)
    for name, table in tables.items():
        if name not in _TABLES or not isinstance(table, dict):
            raise UsageError(f"{path}: '{name:.40}' is no table of it; there are {', '.join(_TABLES)}")
    presets = tables.get("presets", {})
    for name, preset in presets.items():
        if not isinstance(preset, dict):
            raise UsageError(f"{path}: preset '{name:.40}' is no table of options")
    arms = tables.get("arms", {})
    for name, file_name in arms.items():
        if not isinstance(file_name, str):
            raise UsageError(f"{path}: arm '{name:.40}' is no name of a file")
    return PreferenceFile(
        path,
        tables.get("options", {}),
        presets,
        {name: path.parent / Path(file_name).expanduser() for name, file_name in arms.items()},
    )
