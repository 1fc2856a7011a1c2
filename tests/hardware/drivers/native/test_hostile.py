"""Whatever comes down the line: no crash, no pulse outside its range, and nothing that CLEAR does not mend."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hardware.codecs import native
from hardware.codecs.native import Order, State
from tests.hardware.drivers.native.runs import JOINTS, RANGE_US, Console
from tests.hardware.emulator.emulator import Build, LockStep, in_lock_step

_FRAMES = 100_000
_KINDS = [*Order, 0x00, 0x0A, 0x10, 0x11, 0x81, 0x82, 0xFF]
_TICK_US = 0.5
"""The edges of a pulse are right to a tick."""


def _assert_mended(console: Console) -> None:
    console.line.write(b"\0")
    assert console.give(Order.CLEAR).state in (State.OFF, State.ARMING, State.READY)


def _assert_in_range(controller: LockStep, shortest_us: float, longest_us: float) -> None:
    for channel in range(8):
        widths_us = controller.emulator.pulses(channel).widths_us
        assert ((widths_us >= shortest_us - _TICK_US) & (widths_us <= longest_us + _TICK_US)).all()


def test_random_frames(controller: LockStep) -> None:
    """As fast as the line takes them, while armed."""
    console = Console(controller)
    console.arm()
    random = np.random.default_rng(3)
    for _ in range(_FRAMES // 1000):
        noise = random.integers(1, 256, (1000, 16), dtype=np.uint8)
        lengths = random.integers(1, 16, 1000)
        controller.write(b"".join(row[:length].tobytes() + b"\0" for row, length in zip(noise, lengths, strict=True)))
        controller.sleep_until(controller.now_s() + 0.55)
        controller.read(1 << 20, 0.0)
    controller.sleep_until(controller.now_s() + 3.0)
    assert console.give(Order.PING).state is State.READY
    _assert_mended(console)
    _assert_in_range(controller, *RANGE_US)


@st.composite
def _near_valid(draw: st.DrawFn) -> bytes:
    """A frame with a CRC that fits, and perhaps nothing else that does; or one damaged at one place."""
    kind = draw(st.sampled_from(_KINDS))
    words = draw(
        st.lists(
            st.one_of(st.sampled_from([0, 1, 77, 6400, 11200, 24000, 36800, 41600, 0xFFFF]), st.integers(0, 0xFFFF)),
            max_size=25,
        )
    )
    payload = b"".join(word.to_bytes(2, "little") for word in words) + draw(st.sampled_from([b"", b"\x05"]))
    frame = bytearray(native.frame(kind, draw(st.integers(0, 255)), payload))
    if draw(st.booleans()):
        frame[draw(st.integers(0, len(frame) - 1))] ^= 1 << draw(st.integers(0, 7))
    return bytes(frame)


@pytest.fixture(scope="module")
def long_lived(built: Build, tmp_path_factory: pytest.TempPathFactory) -> Iterator[LockStep]:
    """One controller that every example adds to."""
    controller = in_lock_step(built, tmp_path_factory.mktemp("hostile"))
    yield controller
    controller.emulator.end()


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(_near_valid(), min_size=1, max_size=12), st.booleans())
def test_frames_that_nearly_fit(long_lived: LockStep, frames: list[bytes], armed: bool) -> None:
    console = Console(long_lived)
    if armed and console.arm().state is not State.READY:
        console.give(Order.CLEAR)
    long_lived.write(b"".join(frames))
    long_lived.sleep_until(long_lived.now_s() + 0.1)
    _assert_mended(console)
    _assert_in_range(long_lived, 400.0, 2600.0)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.tuples(
            st.integers(0, 3), st.integers(1, 300), st.lists(st.integers(0, 0xFFFF), min_size=JOINTS, max_size=JOINTS)
        ),
        max_size=8,
    )
)
def test_key_frames_of_any_pulses_stay_in_the_ranges_set(
    long_lived: LockStep, keys: list[tuple[int, int, list[int]]]
) -> None:
    console = Console(long_lived)
    long_lived.write(b"\0")
    console.give(Order.HELLO, native.hello(console.next(), 1))
    console.give(Order.CLEAR)
    console.give(Order.OFF)
    console.arm()
    console.give(Order.HELLO, native.hello(console.next(), 2))
    since_s = long_lived.now_s()
    shortest, longest = (int(16 * bound) for bound in RANGE_US)
    for sequence, (kind, duration, pulses) in enumerate(keys):
        aimed = pulses if kind == 0 else [shortest + pulse % (longest - shortest) for pulse in pulses]
        long_lived.write(native.sequenced(native.Key(duration, tuple(aimed)), sequence))
    console.give(Order.START)
    long_lived.sleep_until(long_lived.now_s() + 0.3)
    _assert_mended(console)
    for channel in range(JOINTS):
        made = long_lived.emulator.pulses(channel)
        widths_us = made.widths_us[made.starts_s > since_s]
        assert len(widths_us)
        assert widths_us.min() >= RANGE_US[0] - _TICK_US
        assert widths_us.max() <= RANGE_US[1] + _TICK_US
