"""The text of an arm file with what was found about the arm in it, and all else as somebody wrote it: comments, order,
the form of what did not change."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any, Final

import tomlkit

from planner.arms.arm import Arm
from planner.arms.arm_text import arm_toml, value_text

_GONE: Final = object()
_ZERO, _SLOPES = "pulse_at_zero_us", ("us_per_deg", "us_per_mm")
"""A servo's straight line, which is two rows of a table, or in the place of which a table stands."""


def edited(text: str, before: Arm, after: Arm, remark: str) -> str:
    """`text`, the file that was read as `before`, with everything in which `after` differs from that. Both have the
    same joints. `remark` stands at its top, once. A file of modified rows whose links change becomes one of standard
    rows, without its comments: an arm has each of its lengths in another row than such a file."""
    document = tomlkit.parse(text)
    changes = list(_changes(tomllib.loads(arm_toml(before)), tomllib.loads(arm_toml(after))))
    if document.get("dh") == "modified" and any(place[-1] in ("a_mm", "alpha_deg") for place, _ in changes):
        return arm_toml(after, [remark])
    for place, value in changes:
        _change(document, place, value)
    changed, comment = tomlkit.dumps(document), f"# {remark}\n"
    return changed if comment in changed else comment + ("" if changed.startswith("#") else "\n") + changed


def _changes(before: Any, after: Any, place: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    """Where two arms in the form of a file differ, with the new value or _GONE. A section is gone into, one that is new
    too; a list of numbers is one value."""
    new_section = before is _GONE and isinstance(after, dict) and len(place) == 1
    if isinstance(after, dict) and (isinstance(before, dict) or new_section):
        known = {} if new_section else before
        for key in dict.fromkeys((*known, *after)):
            yield from _changes(known.get(key, _GONE), after.get(key, _GONE), (*place, key))
    elif isinstance(after, list) and isinstance(after[0], dict):
        for index, pair in enumerate(zip(before, after, strict=True)):
            yield from _changes(*pair, (*place, index))
    elif before != after:
        yield place, after


def _change(document: Any, place: tuple[str | int, ...], value: Any) -> None:
    section = document
    for key in place[:-1]:
        if isinstance(key, str) and key not in section:  # all that it could say was the usual
            section[key] = tomlkit.table()
        section = section[key]
    if value is _GONE:
        section.pop(place[-1], None)
        return
    if place[-1] == "table" and _ZERO in section:
        slopes = [key for key in _SLOPES if key in section]
        if len(value) == 2:
            (low, first), (high, last) = value
            slope = (last - first) / (high - low)
            _set(section, slopes[0], slope)
            _set(section, _ZERO, first - slope * low)
            return
        for key in (_ZERO, *slopes):
            del section[key]
    _set(section, place[-1], value)


def _set(section: Any, key: str | int, value: Any) -> None:
    """A value in the place of another, which stays as it is written where it is the same one."""
    text = value_text(value)
    if key not in section or not isinstance(value, float) or value_text(float(section[key])) != text:
        section[key] = tomlkit.value(text)
