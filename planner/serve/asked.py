"""What the page asks of commands, as their options: of a plan, those that read no file and write none."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from planner.cli.plan import plan_parser
from planner.errors import UsageError

_PAIRS = ("at",)
_SWITCHES = ("mirror", "keep-order", "reverse", "skip-unreachable", "occlude", "no-fit", "fit")
_VALUES = (
    "arm", "method", "timing", "weights", "rate", "tolerance", "speed", "lift", "lowering-speed", "dwell",
    "canvas", "place", "scale", "paper", "orientation", "align", "origin", "margin", "rotate", "copies", "layers",
    "by", "join", "dedup", "simplify", "min-length", "passes", "fill", "fill-angle", "fill-spacing", "fill-inset",
    "fill-by", "stroke-width", "text", "crop", "dpi", "image", "image-line", "image-detail", "image-ink",
    "image-levels", "image-angle",
)  # fmt: skip
_LONGEST = 200


def arguments_of(asked: Mapping[str, Any], arm_word: Callable[[object], str]) -> list[str]:
    """Options for `plan`. Each value is in one word with its option, so that none is taken for another. arm_word: what
    the command line takes for an arm's name. Errors: UsageError for what is unknown, or means nothing."""
    words: list[str] = []
    for name, value in asked.items():
        if name not in (*_PAIRS, *_SWITCHES, *_VALUES):
            raise UsageError(f"there is no option '{name:.40}' here")
        if value is None or value is False or value == "":
            continue
        if name in _SWITCHES:
            if value is not True:
                raise UsageError(f"{name} is on or off, not {value!r:.40}")
            words.append(f"--{name}")
        elif name in _PAIRS:
            words += [f"--{name}", *_numbers(name, value)]
        elif name == "arm":
            words.append(f"--arm={arm_word(value)}")
        else:
            words.append(f"--{name}={_word(name, value)}")
    plan_parser().parse_args(["drawing.svg", *words])
    return words


def command_of(drawing: str, trajectory: str, words: Sequence[str]) -> str:
    """The same for a terminal."""
    return shlex.join(["plan", drawing, *words, "-o", trajectory])


def port_words(asked: Mapping[str, Any]) -> list[str]:
    """Where a controller is. Errors: UsageError."""
    port = asked.get("port")
    if not port:
        return []
    if not isinstance(port, str) or not is_word(port):
        raise UsageError("port is the name of a serial port")
    return [f"--port={port}"]


def is_word(text: str) -> bool:
    """Whether a command can be given it, and a page be told: not too long, all of it characters, and none the end of a
    word to the system."""
    return len(text) <= _LONGEST and "\0" not in text and not any("\ud800" <= sign <= "\udfff" for sign in text)


def number_of(name: str, value: object) -> float:
    """Errors: UsageError for what is no finite number."""
    if not isinstance(value, bool) and isinstance(value, int | float):
        with suppress(OverflowError):
            if math.isfinite(number := float(value)):
                return number
    raise UsageError(f"{name} is a number")


def _word(name: str, value: object) -> str:
    if isinstance(value, bool) or not isinstance(value, str | int | float) or not is_word(str(value)):
        raise UsageError(f"{name} is a text or a number, not {value!r:.40}")
    return str(value)


def _numbers(name: str, value: object) -> list[str]:
    if not isinstance(value, list) or len(value) != 2:
        raise UsageError(f"{name} is two numbers, not {value!r:.40}")
    return [f"{number_of(f'each number of {name}', number):.6f}".rstrip("0").rstrip(".") for number in value]
