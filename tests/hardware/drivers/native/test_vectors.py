"""The byte vectors of the protocol, against both sides of it."""

from __future__ import annotations

import ctypes
import json
import subprocess
from typing import Any

import pytest

from hardware.codecs import cobs, native
from hardware.codecs.crc import crc16
from hardware.codecs.native import Channel, End, Fault, Info, Key, Order, Record, Result, State, Status
from tests.hardware.emulator.emulator import FIRMWARE, require_tools

_VECTORS: dict[str, Any] = json.loads((FIRMWARE / "vectors.json").read_text())
_FRAMES = {vector["name"]: vector for vector in _VECTORS["frames"]}
_HOST_FRAMES = {
    "PING": native.order(Order.PING, 0),
    "HELLO of session 0x1234": native.hello(1, 0x1234),
    "CONFIG of two channels, 1000 to 2000 us and 600 to 2400 us, parked at 1500 us": native.config(
        2, [Channel(16000, 32000, 24000), Channel(9600, 38400, 24000)]
    ),
    "ARM at the park pose": native.arm(3, []),
    "ARM at 1500, 1250.5 us": native.arm(4, [24000, 20008]),
    "START": native.order(Order.START, 5),
    "HOLD": native.order(Order.HOLD, 6),
    "STOP": native.order(Order.STOP, 7),
    "CLEAR": native.order(Order.CLEAR, 8),
    "OFF": native.order(Order.OFF, 9),
    "RECALL": native.order(Order.RECALL, 10),
    "KEY of 10 ms to 1500, 1500.0625, 1552, 400, 2600 us": native.sequenced(
        Key(100, (24000, 24001, 24832, 6400, 41600)), 255
    ),
    "KEY of 6553.5 ms whose payload has zeros": native.sequenced(Key(0xFFFF, (0x2000, 0x4000, 0x8000)), 0),
    "END": native.sequenced(End(), 17),
}
_CONTROLLER_FRAMES = {
    "INFO of protocol 2, firmware 2.0, 8 channels of 400 to 2600 us": Info(1, 0x1234, 2, (2, 0), 8, 6400, 41600, ()),
    "INFO with two channels at 1500, 1250.5 us": Info(1, 0x1234, 2, (2, 0), 8, 6400, 41600, (24000, 20008)),
    "STATUS of RUN: 7 expected, 12 free, 70000 reached": Status(
        5, 0x1234, State.RUN, Fault.NONE, Result.DONE, 7, 12, False, 70_000
    ),
    "STATUS of FAULT, stopped, with a gap, last order refused": Status(
        9, 0x1234, State.FAULT, Fault.STOPPED, Result.REFUSED_STATE, 0, 64, True, 0xFFFF_FFFF
    ),
    "RECORD of session 0x1234: 70000 reached, in an under-run": Record(10, 0x1234, 70_000, State.UNDERRUN),
}


def test_every_vector_is_used() -> None:
    assert _FRAMES.keys() == _HOST_FRAMES.keys() | _CONTROLLER_FRAMES.keys()


@pytest.mark.parametrize("name", _HOST_FRAMES)
def test_the_host_sends_them(name: str) -> None:
    assert _HOST_FRAMES[name] == bytes.fromhex(_FRAMES[name]["frame"])


@pytest.mark.parametrize("name", _CONTROLLER_FRAMES)
def test_the_host_reads_them(name: str) -> None:
    reader = native.Reader()
    frame = bytes.fromhex(_FRAMES[name]["frame"])
    assert reader.feed(frame[:5]) == [] and reader.feed(frame[5:]) == [_CONTROLLER_FRAMES[name]]
    assert reader.damaged == 0


@pytest.mark.parametrize("damaged", _VECTORS["damaged"])
def test_the_host_passes_over_damaged_ones(damaged: str) -> None:
    reader = native.Reader()
    good = bytes.fromhex(_FRAMES["STATUS of RUN: 7 expected, 12 free, 70000 reached"]["frame"])
    assert len(reader.feed(bytes.fromhex(damaged) + good)) == 1


@pytest.fixture(scope="module")
def firmware_frames(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """The firmware's frames.c, compiled for this computer."""
    require_tools()
    library = tmp_path_factory.mktemp("frames") / "frames.so"
    subprocess.run(
        ["gcc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-o", library, FIRMWARE / "frames.c"],
        check=True,
    )
    loaded = ctypes.CDLL(str(library))
    loaded.crc16.restype = ctypes.c_uint16
    loaded.frame_decode.restype = loaded.frame_encode.restype = ctypes.c_uint8
    return loaded


@pytest.mark.parametrize("vector", _VECTORS["frames"], ids=lambda vector: vector["name"])
def test_the_firmware_makes_and_reads_them(firmware_frames: ctypes.CDLL, vector: dict[str, str]) -> None:
    body, frame = bytes.fromhex(vector["body"]), bytes.fromhex(vector["frame"])
    made = ctypes.create_string_buffer(64)
    length = firmware_frames.frame_encode(ctypes.create_string_buffer(body, 64), len(body), made)
    assert made.raw[:length] == frame
    read = ctypes.create_string_buffer(frame, 64)
    assert firmware_frames.frame_decode(read, len(frame) - 1) == len(body) and read.raw[: len(body)] == body


def test_the_firmware_refuses_damaged_ones(firmware_frames: ctypes.CDLL) -> None:
    for damaged in _VECTORS["damaged"]:
        for stuffed in filter(None, bytes.fromhex(damaged).split(b"\0")):
            assert firmware_frames.frame_decode(ctypes.create_string_buffer(stuffed, 64), len(stuffed)) == 0


def test_both_compute_the_crc_that_is_published(firmware_frames: ctypes.CDLL) -> None:
    expected = int(_VECTORS["crc_of_123456789"], 16)
    assert crc16(b"123456789") == expected == firmware_frames.crc16(b"123456789", 9)


def test_stuffing_keeps_to_its_definition() -> None:
    assert cobs.stuff(b"") == b"\x01" and cobs.stuff(b"\0") == b"\x01\x01"
    assert cobs.stuff(b"\x11\x22\0\x33") == b"\x03\x11\x22\x02\x33"
    run = bytes(range(1, 255))
    assert cobs.stuff(run) == b"\xff" + run and cobs.stuff(b"\0" + run) == b"\x01\xff" + run
    assert cobs.stuff(run + b"\xff") == b"\xff" + run + b"\x02\xff"
    with pytest.raises(cobs.NotStuffed):
        cobs.unstuff(b"\x05\x01")
