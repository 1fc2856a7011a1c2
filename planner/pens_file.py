"""Pens from a TOML file, a table `[[pen]]` for each."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from planner.errors import UsageError
from planner.pens import Pen, colour_of
from planner.toml_file import read_toml

_NUMBERS = ("width_mm", "speed_mm_s", "lift_mm", "lowering_speed_mm_s", "height_mm")
_KEYS = ("name", "colour", "layers", *_NUMBERS)
_MOST_PENS = 100


def read_pens(path: Path) -> tuple[Pen, ...]:
    """The pens of a file, in its order. Errors: UsageError that names file, pen and key."""
    tables = read_toml(path)
    listed = tables.get("pen")
    if set(tables) - {"pen"} or not isinstance(listed, list) or not listed or len(listed) > _MOST_PENS:
        raise UsageError(f"{path}: holds tables [[pen]], 1 to {_MOST_PENS}, and nothing else")
    pens = tuple(_pen(f"{path}, pen {number}", table) for number, table in enumerate(listed, 1))
    names = [pen.name for pen in pens]
    for name in names:
        if names.count(name) > 1:
            raise UsageError(f"{path}: two pens are called '{name}'")
    return pens


def _pen(where: str, table: object) -> Pen:
    if not isinstance(table, Mapping):
        raise UsageError(f"{where}: no table [[pen]]")
    for key in table:
        if key not in _KEYS:
            raise UsageError(f"{where}: unknown key '{key:.40}'; there are {', '.join(_KEYS)}")
    name, colour, layers = table.get("name"), table.get("colour", "#000000"), table.get("layers", [])
    if not isinstance(name, str):
        raise UsageError(f"{where}: has no name")
    if not isinstance(colour, str):
        raise UsageError(f'{where}: colour is a text such as "#0050c8"')
    if not isinstance(layers, list) or not all(isinstance(layer, str) for layer in layers):
        raise UsageError(f"{where}: layers is a list of names")
    numbers: dict[str, float] = {}
    for key in _NUMBERS:
        value = table.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float | None):
            raise UsageError(f"{where}: {key} is a number")
        if value is not None:
            numbers[key] = float(value)
    try:
        return Pen(name, colour_of(colour), layers=tuple(layers), **numbers)
    except UsageError as error:
        raise UsageError(f"{where}: {error}") from error
