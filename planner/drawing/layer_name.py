"""What the name of an Inkscape layer asks for, by the habits of people who plot with AxiDraw.

A name may begin with `%` (not plotted) or `!` (a halt before it) and with a number. Codes may follow at once, one after
the other: `+S50` asks for half the speed, and `+D500` for a delay of 500 ms. `+H` sets the height of a lowered pen,
which an arm has by its file. Of two codes of a kind the last counts that is in its range; further on, a `+` is text.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_START = re.compile(r"\s*([%!]*)\s*(\d{0,9})((?:\s*\+[SHD]\s*\d{1,9}(?!\d))*)", re.IGNORECASE)
_CODE = re.compile(r"\+([SHD])\s*(\d+)", re.IGNORECASE)
_RANGES = {"S": range(1, 111), "H": range(101), "D": range(1, 10**9)}


@dataclass(frozen=True, slots=True)
class LayerName:
    """number: None where there is none. halts: whether somebody wants to be asked before. speed_share: of the plan's
    speed. delay_s: before the layer. height_percent: None where nothing was said."""

    number: int | None
    is_drawn: bool
    halts: bool
    speed_share: float
    delay_s: float
    height_percent: int | None

    @staticmethod
    def of(name: str) -> LayerName:
        match = _START.match(name)
        assert match is not None  # every text begins so
        codes = {
            letter.upper(): int(digits)
            for letter, digits in _CODE.findall(match[3])
            if int(digits) in _RANGES[letter.upper()]
        }
        return LayerName(
            int(match[2]) if match[2] else None,
            "%" not in match[1],
            "!" in match[1],
            codes.get("S", 100) / 100.0,
            codes.get("D", 0) / 1000.0,
            codes.get("H"),
        )
