"""Laws of the link: over any line that loses, and any loss of acknowledgements, all arrives once and in order."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hardware.codecs import cobs, native
from hardware.codecs.native import Fault, Key, Result, State, Status
from hardware.drivers.native.link import Link

_DEPTH = 10


@settings(deadline=None)
@given(st.binary(max_size=700))
def test_unstuffing_undoes_stuffing(message: bytes) -> None:
    stuffed = cobs.stuff(message)
    assert 0 not in stuffed and cobs.unstuff(stuffed) == message
    assert len(stuffed) <= len(message) + 1 + len(message) // 254


class _Controller:
    """The receiver's half, to the letter of PROTOCOL.md; it plays a key frame whenever it is asked to."""

    def __init__(self) -> None:
        self.arrived: list[int] = []
        self.played = 0

    def take(self, frame: bytes) -> bool:
        """Whether a key frame before this one is missing."""
        body = cobs.unstuff(frame[:-1])
        ahead = (body[1] - len(self.arrived)) % 256
        if ahead == 0:
            assert len(self.arrived) - self.played < _DEPTH, "sent without a credit"
            self.arrived.append(int.from_bytes(body[2:4], "little"))
        return 0 < ahead < 128

    def status(self, gap: bool) -> Status:
        free = _DEPTH - (len(self.arrived) - self.played)
        return Status(0, 1, State.RUN, Fault.NONE, Result.DONE, len(self.arrived) % 256, free, gap, self.played)


@settings(deadline=None, max_examples=50, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(1, 300), st.lists(st.booleans(), max_size=400), st.lists(st.booleans(), max_size=400))
def test_all_arrives_once_and_in_order(total: int, frames_lost: list[bool], answers_lost: list[bool]) -> None:
    link, controller = Link(), _Controller()
    link.restart(_DEPTH)
    pushed, now_s = 0, 0.0
    while len(controller.arrived) < total or not link.acknowledged:
        while pushed < total and link.room > 0:
            pushed += 1
            link.push(Key(pushed, (24000,)))
        for stuffed in filter(None, link.outgoing(now_s).split(b"\0")):
            lost = bool(frames_lost) and frames_lost.pop()
            gap = lost or controller.take(stuffed + b"\0")
            if not (answers_lost and answers_lost.pop()):
                link.received(controller.status(gap), now_s)
        controller.played = max(controller.played, len(controller.arrived) - 3)
        now_s += 0.004
        assert now_s < 100.0, "the link came to a standstill"
        if link.room <= 0:
            link.received(controller.status(False), now_s)
    assert controller.arrived == list(range(1, total + 1))
    assert link.counts.frames == total


def test_an_answer_from_before_a_restart_is_passed_over() -> None:
    link = Link()
    link.restart(_DEPTH)
    link.push(Key(1, (24000,)))
    assert native.Reader().feed(link.outgoing(0.0)) == []
    link.received(Status(0, 1, State.RUN, Fault.NONE, Result.DONE, 9, 3, False, 0), 0.0)
    assert not link.acknowledged and link.room == _DEPTH - 1
