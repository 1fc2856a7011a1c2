"""Packets of Dynamixel 2.0, beside those of the vendor's SDK."""

from __future__ import annotations

import importlib

from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.codecs import dynamixel
from hardware.codecs.status import Status
from tests.hardware.codecs.bus_words import DATA, NOISE, SERVOS
from tests.hardware.codecs.sdk_port import SdkPort

sdk = importlib.import_module("dynamixel_sdk")


def status_packet(servo: int, error: int, data: bytes) -> bytes:
    """An answer put together by parts of the vendor's SDK, which otherwise only reads them."""
    handler = sdk.Protocol2PacketHandler()
    length = len(data) + 4
    plain = [*b"\xff\xff\xfd\x00", servo, length & 255, length >> 8, 0x55, error, *data, 0, 0]
    packet = bytes(handler.addStuffing(plain))
    return packet[:-2] + handler.updateCRC(0, packet, len(packet) - 2).to_bytes(2, "little")


def test_examples_of_the_protocols_description() -> None:
    assert dynamixel.ping(1) == bytes.fromhex("FF FF FD 00 01 03 00 01 19 4E")
    assert dynamixel.read(1, 132, 4) == bytes.fromhex("FF FF FD 00 01 07 00 02 84 00 04 00 1D 15")
    assert dynamixel.sync_write(116, {1: dynamixel.word(150), 2: dynamixel.word(170)}) == bytes.fromhex(
        "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87"
    )


@settings(max_examples=40)
@given(servo=SERVOS, register=st.integers(0, 200), size=st.integers(1, 8), data=DATA)
def test_instructions_are_those_of_the_vendors_sdk(
    servo: int, register: int, size: int, data: dict[int, bytes]
) -> None:
    port, handler = SdkPort(), sdk.Protocol2PacketHandler()
    handler.readTx(port, servo, register, size)
    assert port.sent == dynamixel.read(servo, register, size)
    port.sent, port.is_using = b"", False
    handler.ping(port, servo)
    assert port.sent == dynamixel.ping(servo)
    port.sent, port.is_using = b"", False
    group = sdk.GroupSyncWrite(port, handler, register, len(next(iter(data.values()))))
    for one, content in data.items():
        group.addParam(one, list(content))
    group.txPacket()
    if b"\xff\xff\xfd" not in port.sent[8:]:  # the SDK works stuffing out, and then sends the packet without it
        assert port.sent == dynamixel.sync_write(register, data)


@settings(max_examples=40)
@given(data=st.lists(st.sampled_from([0xFD, 0xFF]), min_size=1, max_size=12).map(bytes))
def test_stuffing_is_that_of_the_vendors_sdk(data: bytes) -> None:
    plain = [*b"\xff\xff\xfd\x00\xfe", len(data) + 8, 0, 0x83, 116, 0, len(data), 0, 7, *data, 0, 0]
    stuffed = sdk.Protocol2PacketHandler().addStuffing(plain)
    assert dynamixel.sync_write(116, {7: data})[:-2] == bytes(stuffed)[:-2]
    assert b"\xff\xff\xfd\x00" not in dynamixel.sync_write(116, {7: data})[4:]


@given(
    noise=NOISE,
    servo=SERVOS,
    data=st.lists(st.sampled_from([0, 1, 0xFD, 0xFF]), max_size=8).map(bytes),
    cut=st.integers(0, 11),
)
def test_an_answer_is_found_behind_noise_and_only_when_whole(noise: bytes, servo: int, data: bytes, cut: int) -> None:
    packet = status_packet(servo, 0, data)
    received = bytearray(packet[:cut])
    if cut < len(packet):
        assert dynamixel.take_status(received) is None
        received += packet[cut:]
    assert dynamixel.take_status(received) == Status(servo, (), data)
    assert not received
    # Noise in front may look like the beginning of an answer, which ends no later than the longest could.
    received = bytearray(noise + packet + bytes(64) + packet)
    found = []
    while (status := dynamixel.take_status(received)) is not None:
        found.append(status)
    assert found[-1] == Status(servo, (), data)


@given(count=st.integers(-(2**31), 2**31 - 1))
def test_a_position_comes_back(count: int) -> None:
    assert dynamixel.count(dynamixel.word(count)) == count


def test_faults_are_told_in_words_and_answers_agree_with_the_vendors_sdk() -> None:
    packet = status_packet(3, 0x87, dynamixel.word(2048))
    assert dynamixel.take_status(bytearray(packet)) == Status(
        3,
        ("a register that is closed to it now", "a hardware fault: too hot, overloaded or wrong voltage"),
        dynamixel.word(2048),
    )
    assert sdk.Protocol2PacketHandler().read4ByteTxRx(SdkPort(packet), 3, 132) == (2048, 0, 0x87)


@given(position=st.integers(0, 119), data=st.binary(min_size=4, max_size=4))
def test_a_flipped_bit_is_no_answer(position: int, data: bytes) -> None:
    packet = bytearray(status_packet(7, 0, data))
    packet[position // 8 % len(packet)] ^= 1 << position % 8
    assert dynamixel.take_status(packet) is None
