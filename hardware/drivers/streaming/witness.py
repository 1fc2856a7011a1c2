"""What a controller without a queue is known to have done: all that was sent before a question that it has answered.

A line that takes bytes proves nothing: an adapter takes them for a controller that has lost its power. So questions
go along with the set points, one at a time, and only an answer makes those before its question count. Where there are
several witnesses, the servos of a bus, they are asked by turns, and a set point counts once all have answered after it.
"""

from __future__ import annotations

from hardware.drivers.streaming.controller import Controller, Question
from hardware.port import Port
from planner.errors import HardwareError

_PATIENCE_S = 0.5
_MOST_MISSED = 3
"""So many questions in a row without an answer, and nobody is there. Noise may take one."""
_LAST_CHANCE_S = 0.25
"""A host that was kept from listening listens for so long before it believes that there is no answer."""
_LONGEST_ANSWER = 256
_ASK_EVERY_S = 0.05
"""Where a line has no time for a question with every set point."""
_SHARE = 0.8
"""Of the time between two set points, for all that is on the line."""
_TURNAROUND_S = 0.001
"""Servos on a bus answer after up to half a millisecond."""


class Witness:
    """The questions to a controller and what its answers prove. sent: how many set points are proven by an answer to
    what is asked now."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._proven = [0] * controller.witnesses
        self._turn = self._whom = 0
        self._rather = False
        self._received = bytearray()
        self._open: tuple[float, int] | None = None  # when the question was asked, and what an answer proves
        self._ask_s = 0.0
        self._missed = 0
        self.asked = self.answered = 0

    @property
    def proven(self) -> int:
        """So many set points are known to have been carried out."""
        return min(self._proven)

    def listen(self, port: Port, now_s: float) -> None:
        """Take in what has come, and never wait but for an answer that is overdue. Errors: HardwareError."""
        self._received += port.read(_LONGEST_ANSWER)
        if self._open is None or self._answered() or now_s - self._open[0] <= _PATIENCE_S:
            return
        if self._missed + 1 < self._bearable:
            self._miss(port)
        else:
            self._await_answer(port, _LAST_CHANCE_S)

    def due(self, now_s: float) -> bool:
        """Whether it is time for a question: the one before has been answered or given up."""
        return self._open is None and now_s >= self._ask_s

    def next_question(self, rather: int | None = None) -> Question:
        """To the witness whose turn it is, or by turns with that to another one that somebody would rather ask."""
        self._whom = self._turn if rather is None or self._rather else rather
        self._rather = rather is not None and not self._rather
        return self._controller.question(self._whom)

    def asked_now(self, now_s: float, sent: int, *, rarely: bool) -> None:
        """The question has gone out: an answer proves `sent` set points. `rarely`: the line has little time for it."""
        if self._missed:  # what is answered may be the question before
            sent = self._proven[self._whom]
        self._received.clear()
        self._open = now_s, sent
        self._ask_s = now_s + (_ASK_EVERY_S if rarely else 0.0)
        self.asked += 1

    def make_sure(self, port: Port, now_s: float, sent: int) -> None:
        """Ask, alone on the line, until all `sent` set points are proven. Errors: HardwareError."""
        if self._open is not None:
            self._await_answer(port, _PATIENCE_S)
        while self.proven < sent:
            port.write(self.next_question().message)
            self.asked_now(now_s, sent, rarely=False)
            self._await_answer(port, _PATIENCE_S)

    @property
    def _bearable(self) -> int:
        return 1 if self._controller.forgets_resets else _MOST_MISSED

    def _await_answer(self, port: Port, patience_s: float) -> None:
        while not self._answered():
            byte = port.read(1, patience_s)
            self._received += byte
            if not byte or len(self._received) > _LONGEST_ANSWER:
                self._miss(port)
                return

    def _answered(self) -> bool:
        if self._open is None or not self._controller.take_answer(self._whom, self._received):
            return False
        self._proven[self._whom] = max(self._proven[self._whom], self._open[1])
        if self._whom == self._turn:
            self._turn = (self._turn + 1) % len(self._proven)
        self._open, self._missed = None, 0
        self.answered += 1
        return True

    def _miss(self, port: Port) -> None:
        self._missed += 1
        self._open = None
        if self._missed >= self._bearable:
            raise HardwareError(f"{port.name}: the controller no longer answers; check its cable and its power")


def fits(port: Port, set_point: bytes, question: Question, period_s: float) -> bool:
    """Whether a line has the time for a question and its answer with every set point."""
    return seconds(port, set_point, question) <= _SHARE * period_s


def seconds(port: Port, message: bytes, question: Question) -> float:
    """How long a message with a question is on the line, answer included."""
    return port.seconds(len(message) + len(question.message) + question.answer_size) + _TURNAROUND_S
