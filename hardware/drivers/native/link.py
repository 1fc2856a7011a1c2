"""Go-back-N: every key frame arrives once and in order over a line that damages and loses bytes.

The sender keeps what is not acknowledged, and sends all of it again from where the controller says that something is
missing, or where no acknowledgement comes (Tanenbaum, Computer Networks, 3.4.2). Credits, the free slots in
every acknowledgement, keep it from sending what the controller has no room for.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from hardware.codecs import native

_WINDOW = 5
"""Frames on the way: enough to keep the line busy, few enough that an order is not stuck behind them."""
_UNANSWERED_S = 0.03
"""What is not acknowledged after so long is sent again."""
_SETTLING_S = 0.005
"""After going back, complaints for so long are about what was on the way before."""


@dataclass(slots=True)
class Counts:
    """frames: sent for the first time; again: sent once more; gone_back: times that the sender went back."""

    frames: int = 0
    again: int = 0
    gone_back: int = 0


class Link:
    """The sender's side. It does no I/O and has no clock: time is handed in, bytes are handed out."""

    def __init__(self) -> None:
        self.counts = Counts()
        self.restart(0)

    def restart(self, free: int) -> None:
        """Both sides count from 0 again, with room for `free` key frames; what was not acknowledged is forgotten."""
        self._waiting: deque[native.Key | native.End] = deque()
        self._base = 0  # sequence number of the first one waiting
        self._sent = 0  # of those waiting, since going back
        self._ever_sent = 0  # of those waiting
        self._free = free
        self._since_s = 0.0  # the last time that something was sent or acknowledged
        self._back_s = float("-inf")

    @property
    def acknowledged(self) -> bool:
        """Whether all has arrived."""
        return not self._waiting

    @property
    def room(self) -> int:
        """Key frames that the controller will have room for after those that wait here."""
        return self._free - self._keys(len(self._waiting))

    def push(self, what: native.Key | native.End) -> None:
        """Send this after all before it. Push no more than there is room for."""
        self._waiting.append(what)

    def outgoing(self, now_s: float) -> bytes:
        """What is to be sent now."""
        if self._sent and now_s - self._since_s > _UNANSWERED_S:
            self._go_back(now_s)
        frames = []
        while self._sent < min(len(self._waiting), _WINDOW) and self._keys(self._sent + 1) <= self._free:
            frames.append(native.sequenced(self._waiting[self._sent], (self._base + self._sent) % 256))
            self._sent += 1
            if self._sent > self._ever_sent:
                self._ever_sent = self._sent
                self.counts.frames += 1
            else:
                self.counts.again += 1
        if frames:
            self._since_s = now_s
        return b"".join(frames)

    def received(self, status: native.Status, now_s: float) -> None:
        """Take an acknowledgement in."""
        arrived = (status.expected - self._base) % 256
        if arrived > self._ever_sent:
            return  # of before a restart
        for _ in range(arrived):
            self._waiting.popleft()
        self._base = status.expected
        self._sent = max(self._sent - arrived, 0)
        self._ever_sent -= arrived
        self._free = status.free
        if arrived:
            self._since_s = now_s
        if status.gap and self._sent and now_s - self._back_s > _SETTLING_S:
            self._go_back(now_s)

    def _go_back(self, now_s: float) -> None:
        self._sent = 0
        self._back_s = self._since_s = now_s
        self.counts.gone_back += 1

    def _keys(self, count: int) -> int:
        """Key frames among the first `count` that wait."""
        return sum(isinstance(self._waiting[index], native.Key) for index in range(count))
