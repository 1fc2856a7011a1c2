"""Packets of Feetech bus servos, beside those of the vendor's SDK."""

from __future__ import annotations

import importlib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.codecs import feetech
from hardware.codecs.status import Status
from tests.hardware.codecs.bus_words import DATA, NOISE, SERVOS
from tests.hardware.codecs.sdk_port import SdkPort

sdk = importlib.import_module("scservo_sdk")


def status_packet(servo: int, error: int, data: bytes) -> bytes:
    """An answer as the protocol's description has it."""
    body = bytes((servo, len(data) + 2, error)) + data
    return b"\xff\xff" + body + bytes((255 - sum(body) % 256,))


def test_examples_of_the_protocols_description() -> None:
    assert feetech.ping(1) == bytes.fromhex("FF FF 01 02 01 FB")
    assert feetech.read(1, 0x38, 2) == bytes.fromhex("FF FF 01 04 02 38 02 BE")
    five = feetech.sync_write(0x2A, {servo: feetech.word(2048) for servo in range(1, 6)})
    assert five[:7] == bytes.fromhex("FF FF FE 13 83 2A 02")


@settings(max_examples=40)
@given(servo=SERVOS, register=st.integers(0, 80), size=st.integers(1, 8), data=DATA)
def test_instructions_are_those_of_the_vendors_sdk(
    servo: int, register: int, size: int, data: dict[int, bytes]
) -> None:
    port = SdkPort()
    handler = sdk.protocol_packet_handler(port, 0)
    handler.readTx(servo, register, size)
    assert port.sent == feetech.read(servo, register, size)
    port.sent, port.is_using = b"", False
    handler.ping(servo)
    assert port.sent == feetech.ping(servo)
    port.sent, port.is_using = b"", False
    group = sdk.GroupSyncWrite(handler, register, len(next(iter(data.values()))))
    for one, content in data.items():
        group.addParam(one, list(content))
    group.txPacket()
    assert port.sent == feetech.sync_write(register, data)


@given(count=st.integers(-32767, 32767))
def test_a_position_comes_back_and_is_the_vendors(count: int) -> None:
    handler = sdk.protocol_packet_handler(SdkPort(), 0)
    assert int.from_bytes(feetech.word(count), "little") == handler.scs_toscs(count, 15)
    assert feetech.count(feetech.word(count)) == count


def test_a_position_beyond_the_word_is_no_word() -> None:
    with pytest.raises(ValueError, match="beyond"):
        feetech.word(32768)


@given(noise=NOISE, servo=SERVOS, data=st.binary(max_size=6), cut=st.integers(0, 11))
def test_an_answer_is_found_behind_noise_and_only_when_whole(noise: bytes, servo: int, data: bytes, cut: int) -> None:
    packet = status_packet(servo, 0, data)
    received = bytearray(packet[:cut])
    if cut < len(packet):
        assert feetech.take_status(received) is None
        received += packet[cut:]
    assert feetech.take_status(received) == Status(servo, (), data)
    assert not received
    # Noise in front may look like the beginning of an answer, which ends no later than the longest could.
    received = bytearray(noise + packet + bytes(64) + packet)
    found = []
    while (status := feetech.take_status(received)) is not None:
        found.append(status)
    assert found[-1] == Status(servo, (), data)


def test_faults_are_told_in_words_and_answers_agree_with_the_vendors_sdk() -> None:
    packet = status_packet(3, 0b100101, b"\x10\x08")
    assert feetech.take_status(bytearray(packet)) == Status(
        3, ("wrong voltage", "overheated", "overloaded"), b"\x10\x08"
    )
    position, result, error = sdk.sms_sts(SdkPort(packet)).ReadPos(3)
    assert (position, result, error) == (feetech.count(b"\x10\x08"), 0, 0b100101)


@given(position=st.integers(0, 63), data=st.binary(min_size=2, max_size=2))
def test_a_flipped_bit_is_no_answer(position: int, data: bytes) -> None:
    packet = bytearray(status_packet(7, 0, data))
    packet[position // 8] ^= 1 << position % 8
    assert feetech.take_status(packet) is None
