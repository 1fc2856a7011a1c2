"""A line and a clock in one: time passes only by sleeping and by waiting for bytes, and nothing depends on the host.

The model at the other end reads what is written at once, answers after a moment, and may die or be reset at any byte
while the line stays up, as behind an adapter of its own power.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from tests.hardware.controllers.lines import Model

_ANSWERS_AFTER_S = 0.004


@dataclass
class Bench:
    """Stands for a Line, its Port and a Clock.

    dies_after, resets_after: so many bytes to the model, and it is gone, or
    there is `anew()` after `boot_s` in which nothing is heard. models: those that there have been, in order."""

    model: Model
    baud: float = 115_200.0
    dies_after: float = math.inf
    resets_after: float = math.inf
    anew: Callable[[], Model] | None = None
    boot_s: float = 0.05
    name: str = "bench"
    latency_s: float = _ANSWERS_AFTER_S
    taken: int = 0
    answers: list[tuple[float, bytes]] = field(default_factory=list)
    models: list[Model] = field(default_factory=list)
    received: bytearray = field(default_factory=bytearray)
    _now_s: float = 0.0
    _deaf_until_s: float = 0.0

    def __post_init__(self) -> None:
        self.models.append(self.model)

    def now_s(self) -> float:
        return self._now_s

    def sleep_until(self, deadline_s: float) -> None:
        self._now_s = max(self._now_s, deadline_s)

    def open(self, usual_baud: int) -> Bench:
        return self

    def seconds(self, size: int) -> float:
        return 10 * size / self.baud

    def write(self, message: bytes) -> None:
        self.received += message
        before, self.taken = self.taken, len(self.received)
        if before < self.resets_after <= self.taken and self.anew is not None:
            self._hear(message[: round(self.resets_after) - before])
            self.model, self._deaf_until_s = self.anew(), self._now_s + self.boot_s
            self.models.append(self.model)
            message = b""
        self._hear(message[: max(min(len(message), round(min(self.dies_after, self.taken)) - before), 0)])

    def read(self, size: int, timeout_s: float = 0.0) -> bytes:
        if not self._come() and timeout_s:
            coming_s = min((at_s for at_s, _ in self.answers), default=math.inf)
            self._now_s = min(max(coming_s, self._now_s), self._now_s + timeout_s)
        come = self._come()
        self.answers = [one for one in self.answers if one[0] > self._now_s]
        if come[size:]:
            self.answers.insert(0, (self._now_s, come[size:]))
        return come[:size]

    def discard_input(self) -> None:
        self.read(1 << 16)

    def close(self) -> None:
        """It can be opened again."""

    def _hear(self, message: bytes) -> None:
        if message and self._now_s >= self._deaf_until_s:
            answer = self.model.receive(message)
            if answer:
                self.answers.append((self._now_s + self.latency_s, answer))

    def _come(self) -> bytes:
        return b"".join(answer for at_s, answer in self.answers if at_s <= self._now_s)
