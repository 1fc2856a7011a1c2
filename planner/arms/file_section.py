"""What every section of an arm file has in common: unknown keys are faults, numbers are finite and within what arms on
a desk or in a workshop have, types are strict; and what is wrong is told in the file's own words."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

LONGEST_MM = 10_000.0
"""Of one length, and of all of an arm together: what is beyond that is a slip of the unit, and would be computed on for
hours."""

_LEAST, _GREATEST = 1e-3, 1e9

Number = Annotated[float, Field(allow_inf_nan=False, ge=-_GREATEST, le=_GREATEST)]
NotNegative = Annotated[float, Field(ge=0, le=_GREATEST, allow_inf_nan=False)]
Limit = Annotated[float, Field(ge=_LEAST, le=_GREATEST, allow_inf_nan=False)]
"""Of speed, acceleration or jerk."""
Length = Annotated[float, Field(ge=-LONGEST_MM, le=LONGEST_MM, allow_inf_nan=False)]
Size = Annotated[float, Field(gt=0, le=LONGEST_MM, allow_inf_nan=False)]


class Section(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


_SENTENCES = {
    "extra_forbidden": "unknown key",
    "missing": "missing",
    "union_tag_not_found": "missing",
    "union_tag_invalid": "has to be one of {expected_tags}",
    "literal_error": "has to be {expected}",
    "float_type": "has to be a number",
    "int_type": "has to be a whole number",
    "int_from_float": "has to be a whole number",
    "string_type": "has to be a text in quotes",
    "list_type": "has to be a list",
    "dict_type": "has to be a table of keys and values",
    "model_type": "has to be a table of keys and values",
    "model_attributes_type": "has to be a table of keys and values",
    "finite_number": "has to be a finite number",
    "greater_than": "has to be more than {gt:g}",
    "greater_than_equal": "has to be {ge:g} or more",
    "less_than": "has to be less than {lt:g}",
    "less_than_equal": "has to be {le:g} or less",
    "too_short": "has to have {min_length} entries or more, not {actual_length}",
    "too_long": "has to have {max_length} entries or fewer, not {actual_length}",
    "string_too_long": "has to have {max_length} characters or fewer",
}


def told(detail: Any) -> tuple[str, str]:
    """The key that a complaint of the reader is about, and what is wrong with it in one sentence."""
    key = ""
    for part in detail["loc"]:
        if part not in ("revolute", "prismatic"):  # the union's tag, which is no key of the file
            key += f"[{part}]" if isinstance(part, int) else (f".{part}" if key else str(part))
    kind = detail["type"]
    if kind.startswith("union_tag"):
        key, value = f"{key}.kind", detail.get("ctx", {}).get("tag")
    else:
        value = detail["input"]
    sentence = _SENTENCES.get(kind)
    message = (
        detail["msg"].removeprefix("Value error, ") if sentence is None else sentence.format(**detail.get("ctx", {}))
    )
    # A whole section says less than what is wrong with it.
    is_section = value is None or isinstance(value, dict | BaseModel)
    return key, message + ("" if is_section else f" (value: {value!r:.60})")
