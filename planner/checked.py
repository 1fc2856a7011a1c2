"""Values that a caller gives, checked: each fault is a UsageError that names the value."""

from __future__ import annotations

import math
from enum import StrEnum
from numbers import Real
from typing import TypeVar

from planner.errors import UsageError

Choice = TypeVar("Choice", bound=StrEnum)


def number_in(
    name: str, value: object, *, zero: bool = False, minimum: float = 0.0, maximum: float = math.inf
) -> float:
    """The value as a float. Errors: UsageError unless it is a finite number in the range; zero counts with `zero`."""
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise UsageError(f"{name} is a finite number, not {value!r:.40}")
    value = float(value)
    if not minimum <= value <= maximum or (value == 0 and not zero):
        least = f"at least {minimum:g}" if minimum or zero else "positive"
        most = "" if maximum == math.inf else f" and at most {maximum:g}"
        raise UsageError(f"{name} {value:g} has to be {least}{most}")
    return value


def one_of(name: str, value: object, choices: type[Choice]) -> Choice:
    """The choice of that value. Errors: UsageError naming those that there are."""
    known = [choice.value for choice in choices]
    if not isinstance(value, str) or value not in known:
        raise UsageError(f"{name} is one of {', '.join(known)}, not {value!r:.40}")
    return choices(value)
