"""What the streaming driver needs of a controller without a queue."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol, runtime_checkable

from hardware.clock import Clock
from hardware.compensation.servo_values import Calibration
from hardware.port import Port
from planner.arrays import FloatArray

STAGGER_S = 0.3
"""Between servos that jump to their first pulse, so that their currents do not add up."""


class Question(NamedTuple):
    """A message that asks for a controller's state, and how many bytes its answer has."""

    message: bytes
    answer_size: int


class Controller(Protocol):
    """Moves servos at once to commanded values, (n_joints,) in the calibration's unit and ranges.

    Methods that are handed a port may raise HardwareError.
    """

    usual_baud: int
    calibration: Calibration

    witnesses: int
    """How many there are that each answer for themselves alone: one board, or every servo of a bus."""

    forgets_resets: bool
    """Whether nothing tells of a reset any more once the next set point has come. Then a question has to go ahead of
    the set point, and an answer that fails to come may be all that is ever seen of a reset. Where a reset stays
    visible, questions go behind, so that nothing else is on a shared line while the answer comes, and noise may
    take a few of them."""

    def attach(self, port: Port, values: FloatArray, clock: Clock) -> FloatArray:
        """Make sure that everything answers, and power the servos; their values then.

        Those that do not measure their position are sent to `values`, one after another.
        """

    def set_point(self, values: FloatArray, duration_s: float) -> bytes:
        """The message that sends the servos to `values`, within `duration_s` where the controller can time it."""

    def confirm(self, port: Port, values: FloatArray, clock: Clock) -> None:
        """Return once the servos are at `values`, as far as the controller knows; HardwareError if they do not."""

    def halt(self, port: Port) -> None:
        """The servos hold where they are."""

    def question(self, witness: int) -> Question:
        """What asks witness 0, 1, ... for its state."""

    def take_answer(self, witness: int, received: bytearray) -> bool:
        """Whether the whole answer to `question(witness)` has come; it is taken from `received`.

        Errors: HardwareError where the answer is a fault, or tells of a reset.
        """


@runtime_checkable
class MeasuringController(Controller, Protocol):
    """One whose servos measure where they are, and tell it with their answers."""

    def measure(self, measured: Callable[[int, float], None]) -> None:
        """From now on, call measured(witness, value) with each answer; witness k moves joint k."""
