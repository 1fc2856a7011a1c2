"""Bytes of the Pololu Maestro, by its user's guide."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.codecs import maestro


def test_examples_of_the_users_guide() -> None:
    assert maestro.set_target(2, 1500.0) == bytes.fromhex("84 02 70 2E")
    assert maestro.set_target(0, 1500.0) == bytes.fromhex("84 00 70 2E")
    assert maestro.get_position(5) == bytes.fromhex("90 05")
    assert maestro.with_crc(bytes.fromhex("83 01")) == bytes.fromhex("83 01 17")
    assert maestro.unlimited(5) == (bytes.fromhex("87 05 00 00"), bytes.fromhex("89 05 00 00"))


@given(channel=st.integers(0, 31), pulse_us=st.floats(0, 4095.8))
def test_only_the_first_byte_has_its_top_bit_set_and_the_pulse_is_the_nearest_step(
    channel: int, pulse_us: float
) -> None:
    command = maestro.with_crc(maestro.set_target(channel, pulse_us))
    assert [byte >> 7 for byte in command] == [1, 0, 0, 0, 0]
    low, high = command[2:4]
    assert abs((low + 128 * high) / 4 - pulse_us) <= 0.125


def test_a_pulse_that_fits_into_no_command_is_no_command() -> None:
    for pulse_us in (4096.0, -0.2):
        with pytest.raises(ValueError, match="fourteen bits"):
            maestro.set_target(0, pulse_us)


@given(command=st.binary(min_size=1, max_size=8), position=st.integers(0, 63))
def test_a_flipped_bit_shows_in_the_crc(command: bytes, position: int) -> None:
    byte, bit = position % len(command), position // 8
    flipped = bytes(value ^ (1 << bit if index == byte else 0) for index, value in enumerate(command))
    assert maestro.with_crc(flipped)[-1] != maestro.with_crc(command)[-1]


def test_replies() -> None:
    assert maestro.position_us(bytes.fromhex("70 17")) == 1500.0
    assert maestro.errors(b"\x00\x00") == []
    assert maestro.errors(bytes.fromhex("18 01")) == [
        "a wrong CRC",
        "a command that it does not know",
        "an error of its script's counter",
    ]
