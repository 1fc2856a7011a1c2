"""Orders in any sequence and at any moment: no pulse is longer than a servo may get, and none is left after OFF."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from hardware.codecs import native
from hardware.codecs.native import Channel, Key, Order, State
from tests.hardware.drivers.native.runs import Console
from tests.hardware.emulator.emulator import Build, LockStep, in_lock_step

_MIDDLE = 1500 * 16
_CHANNELS = st.integers(1, 8)
_ARMED_S = 8 * 0.15 + 0.1
_LONGEST_US, _TICK_US = 2600.0, 0.5
_ORDERS = [Order.OFF, Order.ARM, Order.CLEAR, Order.START, Order.HOLD, Order.STOP, Order.PING, Order.RECALL]
_WAITS_S = st.one_of(st.just(0.0), st.floats(0.0, 0.03), st.just(_ARMED_S))


@pytest.fixture(scope="module")
def controller(built: Build, tmp_path_factory: pytest.TempPathFactory) -> Iterator[LockStep]:
    """One that every example adds to."""
    started = in_lock_step(built, tmp_path_factory.mktemp("orders"))
    yield started
    started.emulator.end()


def _config(channels: int) -> list[Channel]:
    return [Channel(400 * 16, 2400 * 16, _MIDDLE)] * channels


def _said(console: Console, what: Order | int) -> bytes:
    """An order, or a CONFIG of so many channels, with a number of its own."""
    Console.sequence = console.next()
    if isinstance(what, Order):
        return native.order(what, Console.sequence)
    return native.config(Console.sequence, _config(what))


def _assert_no_pulse_is_too_long(controller: LockStep, since_s: float) -> None:
    for channel in range(8):
        made = controller.emulator.pulses(channel)
        widths_us = made.widths_us[made.starts_s > since_s]
        assert (widths_us <= _LONGEST_US + _TICK_US).all(), f"channel {channel}: {widths_us.max():.0f} us"


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@example(8, [(0.004 * slot + 0.001, Order.OFF) for slot in range(2)], 1)
@given(_CHANNELS, st.lists(st.tuples(_WAITS_S, st.one_of(_CHANNELS, st.sampled_from(_ORDERS))), max_size=8), _CHANNELS)
def test_no_pin_is_high_after_off(
    controller: LockStep, channels: int, orders: list[tuple[float, Order | int]], then: int
) -> None:
    """Armed; then anything; then OFF, and with it in the same breath a CONFIG of other channels."""
    console, since_s = Console(controller), controller.now_s()
    controller.sleep_until(since_s + 0.01)
    console.give(Order.HELLO, native.hello(console.next(), 1))
    for what in (Order.CLEAR, Order.OFF, channels, Order.ARM):
        controller.write(_said(console, what))
    controller.sleep_until(controller.now_s() + _ARMED_S)
    assert console.give(Order.PING).state is State.READY
    controller.write(native.sequenced(Key(500, (_MIDDLE + 800,) * channels), 0))
    for wait_s, what in orders:
        controller.sleep_until(controller.now_s() + wait_s)
        controller.write(_said(console, what))
    controller.write(_said(console, Order.CLEAR))
    controller.sleep_until(controller.now_s() + _ARMED_S)  # from ARMING to READY: OFF wants an arm that is attached
    for what in (Order.OFF, then):
        controller.write(_said(console, what))
    assert console.give(Order.PING).state is State.OFF
    off_s = controller.now_s()
    controller.sleep_until(off_s + 0.06)
    _assert_no_pulse_is_too_long(controller, since_s)
    assert all((controller.emulator.pulses(channel).starts_s < off_s).all() for channel in range(8))


@pytest.mark.parametrize("moment", range(12))
@pytest.mark.parametrize(("channels", "then"), [(8, 1), (5, 2), (1, 8)])
def test_channels_divided_anew_in_the_midst_of_a_pulse(
    controller: LockStep, channels: int, then: int, moment: int
) -> None:
    """Their pulses come every 20 ms, as ever, from the first on."""
    console, since_s = Console(controller), controller.now_s()
    controller.sleep_until(since_s + 0.01)
    console.give(Order.HELLO, native.hello(console.next(), 1))
    for what in (Order.CLEAR, Order.OFF, channels, Order.ARM):
        controller.write(_said(console, what))
    controller.sleep_until(controller.now_s() + _ARMED_S + 0.02 * moment / 12)
    for what in (Order.OFF, then, Order.ARM):
        controller.write(_said(console, what))
    again_s = controller.now_s()
    controller.sleep_until(again_s + _ARMED_S)
    assert console.give(Order.PING).state is State.READY
    _assert_no_pulse_is_too_long(controller, since_s)
    for channel in range(then):
        starts_s = controller.emulator.pulses(channel).starts_s
        gaps_s = (starts_s[1:] - starts_s[:-1])[starts_s[:-1] > again_s + 0.005]
        assert len(gaps_s)
        assert gaps_s == pytest.approx(0.02, abs=5e-6)
