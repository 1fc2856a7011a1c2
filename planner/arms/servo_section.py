"""The servo of a joint in an arm file: told by pulses (`servo`), or by counts on a bus (`bus`).

Turning joints are described per degree and slides per millimetre; a servo keeps it per rad or mm.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Literal, Self, TypeVar

from pydantic import AfterValidator, Field, model_validator

from planner.arms.arm import SERVO_LAG_S, BusServo, Servo
from planner.arms.file_section import NotNegative, Number, Section

_End = TypeVar("_End", int, float)


def _ascending(ends: list[_End]) -> list[_End]:
    if ends[0] >= ends[1]:
        raise ValueError(f"{ends[0]:g} is not below {ends[1]:g}")
    return ends


def _monotone(table: list[list[float]]) -> list[list[float]]:
    """Positions go up, and pulses either go up or go down: a pulse has one position."""
    positions, pulses_us = zip(*table, strict=True)
    for low, high in pairwise(positions):
        if low >= high:
            raise ValueError(f"its positions have to go up, not from {low:g} to {high:g}")
    rises = pulses_us[0] < pulses_us[1]
    for row, (before, after) in enumerate(pairwise(pulses_us)):
        if before == after or (before < after) != rises:
            raise ValueError(
                f"its pulses have to go one way, not from {before:g} to {after:g} us at {positions[row + 1]:g}"
            )
    return table


_Row = Annotated[list[Number], Field(min_length=2, max_length=2)]
_Table = Annotated[list[_Row], Field(min_length=2), AfterValidator(_monotone)]
_Pulse = Annotated[float, Field(gt=0, le=4000)]
_PulseRange = Annotated[list[_Pulse], Field(min_length=2, max_length=2), AfterValidator(_ascending)]
_Count = Annotated[int, Field(ge=-(2**31), lt=2**31)]
_CountRange = Annotated[list[_Count], Field(min_length=2, max_length=2), AfterValidator(_ascending)]


class _ServoSection(Section):
    channel: Annotated[int, Field(ge=0, le=31)] | None = None
    pulse_at_zero_us: Number | None = None
    table: _Table | None = None
    trim_us: Number = 0.0
    direction: Literal[1, -1] = 1
    pulse_range_us: _PulseRange
    resolution_us: NotNegative = 1.0
    dead_band_us: NotNegative = 0.0
    lag_s: NotNegative = SERVO_LAG_S

    @property
    @abstractmethod
    def slope(self) -> float | None:
        """us per unit of the file."""

    @property
    @abstractmethod
    def play(self) -> float:
        """Backlash in the unit of the file."""

    @model_validator(mode="after")
    def _has_one_curve(self) -> Self:
        linear = (self.pulse_at_zero_us, self.slope)
        unit = "mm" if isinstance(self, SlidingServoSection) else "deg"
        if self.table is None and None in linear:
            raise ValueError(f"needs pulse_at_zero_us and us_per_{unit}, or a table in their place")
        if self.table is not None and linear != (None, None):
            raise ValueError(f"a table stands in place of pulse_at_zero_us and us_per_{unit}; leave one of them out")
        if self.slope == 0:
            raise ValueError(f"us_per_{unit} 0 moves nothing")
        return self

    def servo(self, place: int, per_file_unit: float) -> Servo:
        """The servo of the joint at `place` in the chain, whose channel that is unless another is given."""
        low_us, high_us = self.pulse_range_us
        curve: Sequence[Sequence[float]]
        if self.table is not None:
            curve = self.table
        else:
            zero_us, slope = self.pulse_at_zero_us or 0.0, self.slope or math.nan
            curve = sorted(
                ((pulse_us - self.trim_us - zero_us) / slope, pulse_us - self.trim_us) for pulse_us in (low_us, high_us)
            )
        return Servo(
            channel=place if self.channel is None else self.channel,
            curve=tuple((position * per_file_unit, pulse_us) for position, pulse_us in curve),
            direction=self.direction,
            trim_us=self.trim_us,
            pulse_range_us=(low_us, high_us),
            resolution_us=self.resolution_us,
            dead_band_us=self.dead_band_us,
            backlash=self.play * per_file_unit,
            lag_s=self.lag_s,
        )


class TurningServoSection(_ServoSection):
    us_per_deg: Number | None = None
    backlash_deg: NotNegative = 0.0

    @property
    def slope(self) -> float | None:
        return self.us_per_deg

    @property
    def play(self) -> float:
        return self.backlash_deg


class SlidingServoSection(_ServoSection):
    us_per_mm: Number | None = None
    backlash_mm: NotNegative = 0.0

    @property
    def slope(self) -> float | None:
        return self.us_per_mm

    @property
    def play(self) -> float:
        return self.backlash_mm


class _BusSection(Section):
    id: Annotated[int, Field(ge=0, le=252)]
    count_at_zero: Number
    count_range: _CountRange
    table: _Table | None = None
    dead_band_counts: NotNegative = 0.0
    lag_s: NotNegative = 0.0

    @property
    @abstractmethod
    def slope(self) -> float:
        """Counts per unit of the file."""

    @property
    @abstractmethod
    def play(self) -> float:
        """Backlash in the unit of the file."""

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.slope == 0:
            raise ValueError("0 counts per unit move nothing")
        return self

    def servo(self, per_file_unit: float) -> BusServo:
        low, high = self.count_range
        rows = None if self.table is None else tuple((at * per_file_unit, count) for at, count in self.table)
        return BusServo(
            self.id,
            self.count_at_zero,
            self.slope / per_file_unit,
            (low, high),
            self.dead_band_counts,
            self.play * per_file_unit,
            rows,
            self.lag_s,
        )


class TurningBusSection(_BusSection):
    counts_per_deg: Number
    backlash_deg: NotNegative = 0.0

    @property
    def slope(self) -> float:
        return self.counts_per_deg

    @property
    def play(self) -> float:
        return self.backlash_deg


class SlidingBusSection(_BusSection):
    counts_per_mm: Number
    backlash_mm: NotNegative = 0.0

    @property
    def slope(self) -> float:
        return self.counts_per_mm

    @property
    def play(self) -> float:
        return self.backlash_mm
