"""What is said to an arm that is jogged: lines of a script, and the keys that stand for them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from planner.errors import UsageError

if TYPE_CHECKING:
    from hardware.jog.jogging import Jogging

CARD_MM = 0.76
"""A bank card."""

COMMANDS = """\
commands, one a line, # begins a comment:
  joint NAME|NUMBER   choose a joint
  move DEG            turn it by so much (mm for a slide)
  to DEG              turn it to there
  reverse             it turned the wrong way: its direction is the other one, and it stands where it did
  zero [DEG]          it stands at zero now, or at DEG
  low, high           it goes no further than where it stands now
  park                it is parked as it stands now
  pen up, pen down    straight up by the lift height, and back
  card [MM]           the pen just holds a card on the paper (0.76 mm thick): tells the paper's height
  show                pulses, angles and limits
  save                write the arm file
  quit                leave; the arm holds, and what was not saved is lost

keys: 1 to 9 choose, + and - move by a step, [ and ] halve and double it, r reverse, z zero, l and h low and high,
p park, u and d pen up and down, c card, space show, s save, q quit, : any command, x or Esc or Ctrl-C stop at once"""


def carry_out(command: str, jogging: Jogging, save: Callable[[], None]) -> bool:
    """Whether to go on after one command. Errors: UsageError for what is not understood or refused, HardwareError."""
    match command.partition("#")[0].split():
        case []:
            pass
        case ["quit"]:
            return False
        case ["joint", name]:
            jogging.choose(name)
        case ["move", by]:
            jogging.move(_number(by))
        case ["to", position]:
            jogging.go_to(_number(position))
        case ["reverse"]:
            jogging.turn_round()
        case ["zero"]:
            jogging.stands_at(0.0)
        case ["zero", position]:
            jogging.stands_at(_number(position))
        case ["low" | "high" as end]:
            jogging.limit(upper=end == "high")
        case ["park"]:
            jogging.park_here()
        case ["pen", "up"]:
            jogging.pen_up()
        case ["pen", "down"]:
            jogging.pen_down()
        case ["card"]:
            jogging.on_card(CARD_MM)
        case ["card", thickness]:
            jogging.on_card(_number(thickness))
        case ["show"]:
            pass
        case ["save"]:
            save()
        case _:
            raise UsageError(f"'{command.strip()[:40]}' is no command (see plan jog --help)")
    return True


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise UsageError(f"'{text[:30]}' is not a finite number")
    return number
