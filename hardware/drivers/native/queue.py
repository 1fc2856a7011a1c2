"""The queue of key frames on the controller: what waits for it, what is on it, and what the arm has reached of it.

It does no I/O and has no clock, as the link below it: bytes are handed out, and statuses are handed in.
"""

from __future__ import annotations

from collections import deque

from hardware.codecs import native
from hardware.codecs.native import End, Key, State, Status
from hardware.drivers.native.link import Counts, Link
from planner.errors import HardwareError

AHEAD_S = 0.65
"""No more motion than this is on the controller: it outlasts a stall of 0.4 s, and a pause waits no longer for it."""
_SHARE = 0.9
"""Of that, the motion that as many key frames as fit hold at least."""


class Queue:
    """Set points in the order that they are to be reached, merged into key frames no shorter than the queue needs.

    executed: set points known to have been reached. keys_reached: key frames reached, as the controller counts them,
    modulo native.COUNTED. underruns: times that the controller ran out of key frames. shortest_key_s: set points are
    merged until they last so long.
    """

    def __init__(self) -> None:
        self._link = Link()
        self.underruns = 0
        self.restart(0, 0)

    def restart(self, free: int, reached: int) -> None:
        """Begin anew with room for `free` key frames, `reached` being what the controller has counted before."""
        self.shortest_key_s = _SHARE * AHEAD_S / free if free else 0.0
        self.keys_reached = reached
        self._link.restart(free)
        self._ahead: deque[tuple[int, float]] = deque()  # for each key not reached: set points by its end, duration
        self._merging: tuple[tuple[int, ...], float] | None = None
        self.count_from_here()

    def count_from_here(self) -> None:
        """Set points count from 0 again. All that were added have to be reached."""
        self._added = self.executed = 0

    def cut_short(self, free: int, reached: int) -> None:
        """As `restart`, in the midst of a run: what is added next comes after what was executed."""
        executed = self.executed
        self.restart(free, reached)
        self._added = self.executed = executed

    @property
    def counts(self) -> Counts:
        """What the link has sent, over all restarts."""
        return self._link.counts

    @property
    def is_merging(self) -> bool:
        """Whether set points wait to be pushed."""
        return self._merging is not None

    @property
    def is_empty(self) -> bool:
        """Whether every key frame pushed has been reached."""
        return not self._ahead

    @property
    def has_arrived(self) -> bool:
        """Whether the controller has all that was pushed."""
        return self._link.acknowledged

    @property
    def is_full(self) -> bool:
        """Whether the next key frame has to wait, for a free slot or for motion to be played."""
        return self._link.room <= 0 or sum(duration_s for _, duration_s in self._ahead) >= AHEAD_S

    def add(self, pulses: tuple[int, ...], duration_s: float) -> bool:
        """Add a set point, pulses by channel in 1/16 us; whether it is time to push.

        Set points too close for the queue are merged: the last of them stands for all.
        """
        self._added += 1
        if self._merging is not None:
            duration_s += self._merging[1]
        self._merging = pulses, duration_s
        return duration_s >= self.shortest_key_s

    def push(self) -> None:
        """Make a key frame of the set points added since the last one. Push only while the queue is not full.

        Errors: HardwareError where it lasts longer than a key frame can.
        """
        if self._merging is None:
            return
        (pulses, duration_s), self._merging = self._merging, None
        duration = max(round(duration_s * native.UNITS_PER_S), 1)
        if duration > 0xFFFF:
            raise HardwareError(
                f"a set point comes {duration_s:g} s after the one before it; a key frame can last"
                f" {native.LONGEST_KEY_S:g} s at most"
            )
        self._link.push(Key(duration, pulses))
        self._ahead.append((self._added, duration_s))

    def push_end(self) -> None:
        """The motion ends here: running out of key frames is no under-run."""
        self._link.push(End())

    def drop(self) -> None:
        """Forget what has not arrived."""
        self._link.restart(0)

    def outgoing(self, now_s: float) -> bytes:
        """The frames that are due."""
        return self._link.outgoing(now_s)

    def received(self, status: Status, before: State | None, now_s: float) -> None:
        """Take in a status. before: the state that the controller was in, None if that is not known."""
        self._link.received(status, now_s)
        for _ in range(min((status.reached - self.keys_reached) % native.COUNTED, len(self._ahead))):
            self.executed, _ = self._ahead.popleft()
            self.keys_reached = (self.keys_reached + 1) % native.COUNTED
        if status.state is State.UNDERRUN and before not in (None, State.UNDERRUN):
            self.underruns += 1
