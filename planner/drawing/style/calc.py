"""Mathematics in CSS values: calc(), min(), max(), clamp() and the other functions of CSS Values 4."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from tinycss2.ast import Node

from planner.drawing.style.tokens import by_comma, significant

Kind = Literal["number", "length", "angle"]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A value in user units (length), degrees (angle), or plain (number)."""

    value: float
    kind: Kind


class NotMathematics(ValueError):
    """Tokens that are no expression, or whose units do not go together."""


Resolve = Callable[[float, str], Quantity]
"""What a number with a unit (lower case; "" and "%" too) comes to. Errors: NotMathematics."""
_CONSTANTS = {"e": math.e, "pi": math.pi, "infinity": math.inf, "-infinity": -math.inf, "nan": math.nan}
_OF_ANGLES = {"sin": math.sin, "cos": math.cos, "tan": math.tan}
_TO_ANGLES = {"asin": math.asin, "acos": math.acos, "atan": math.atan}
_OF_NUMBERS: dict[str, Callable[..., float]] = {"sqrt": math.sqrt, "exp": math.exp, "pow": math.pow, "log": math.log}
_ALIKE = frozenset({"min", "max", "clamp", "hypot", "mod", "rem", "round"})
FUNCTIONS = (
    frozenset({"calc", "-webkit-calc", "abs", "sign", "atan2"}) | _ALIKE | {*_OF_ANGLES, *_TO_ANGLES, *_OF_NUMBERS}
)
_STEPS: dict[str, Callable[[float], float]] = {
    "nearest": lambda x: math.floor(x + 0.5),
    "up": math.ceil,
    "down": math.floor,
    "to-zero": math.trunc,
}


def evaluate(token: Node, resolve: Resolve) -> Quantity:
    """What a number, a dimension, a percentage or a function comes to. Errors: NotMathematics."""
    try:
        return _term(token, resolve)
    except (ArithmeticError, ValueError, RecursionError) as error:
        raise NotMathematics(str(error)) from None


def _term(token: Node, resolve: Resolve) -> Quantity:
    if token.type == "number":
        return resolve(token.value, "")
    if token.type == "percentage":
        return resolve(token.value, "%")
    if token.type == "dimension":
        return resolve(token.value, token.lower_unit)
    if token.type == "ident" and token.lower_value in _CONSTANTS:
        return Quantity(_CONSTANTS[token.lower_value], "number")
    if token.type == "() block":
        return _sum(token.content, resolve)
    if token.type == "function" and token.lower_name in FUNCTIONS:
        return _function(token.lower_name, token.arguments, resolve)
    raise NotMathematics(token.type)


def _sum(tokens: Sequence[Node], resolve: Resolve) -> Quantity:
    """Terms joined by + and -, which stand between blanks, of products joined by * and /."""
    parts = [token for token in tokens if token.type != "comment"]
    terms: list[list[Node]] = [[]]
    signs = [1.0]
    for index, token in enumerate(parts):
        if token.type == "literal" and token.value in "+-":
            around = parts[index - 1 : index] + parts[index + 1 : index + 2]
            if len(around) < 2 or any(other.type != "whitespace" for other in around):
                raise NotMathematics("no blanks around a sign")
            terms.append([])
            signs.append(1.0 if token.value == "+" else -1.0)
        elif token.type != "whitespace":
            terms[-1].append(token)
    found = [_product(term, resolve) for term in terms]
    return Quantity(sum(sign * term.value for sign, term in zip(signs, found, strict=True)), _common_kind(found))


def _product(tokens: Sequence[Node], resolve: Resolve) -> Quantity:
    if len(tokens) % 2 == 0:
        raise NotMathematics("a factor is missing")
    result = _term(tokens[0], resolve)
    for operator, token in zip(tokens[1::2], tokens[2::2], strict=True):
        factor = _term(token, resolve)
        if operator == "*" and "number" in (result.kind, factor.kind):
            kind = factor.kind if result.kind == "number" else result.kind
            result = Quantity(result.value * factor.value, kind)
        elif operator == "/" and factor.kind == "number":
            result = Quantity(result.value / factor.value, result.kind)
        elif operator == "/" and factor.kind == result.kind:
            result = Quantity(result.value / factor.value, "number")
        else:
            raise NotMathematics("units that do not go together")
    return result


def _function(name: str, arguments: Sequence[Node], resolve: Resolve) -> Quantity:
    groups = by_comma(arguments)
    step = "nearest"
    words = significant(groups[0])
    if name == "round" and len(words) == 1 and words[0].type == "ident" and words[0].lower_value in _STEPS:
        step = words[0].lower_value
        del groups[0]
    given = [_sum(group, resolve) for group in groups]
    kind = _common_kind(given)
    values = [quantity.value for quantity in given]
    if name in ("calc", "-webkit-calc") and len(given) == 1:
        return given[0]
    if name in _ALIKE:
        return Quantity(_of_alike(name, values, step), kind)
    if name == "abs" and len(given) == 1:
        return Quantity(abs(values[0]), kind)
    if name == "sign" and len(given) == 1:
        return Quantity(float(values[0] > 0) - float(values[0] < 0), "number")
    if name == "atan2" and len(given) == 2:
        return Quantity(math.degrees(math.atan2(*values)), "angle")
    if name in _OF_ANGLES and len(given) == 1 and kind != "length":
        return Quantity(_OF_ANGLES[name](math.radians(values[0]) if kind == "angle" else values[0]), "number")
    if name in _TO_ANGLES and len(given) == 1 and kind == "number":
        return Quantity(math.degrees(_TO_ANGLES[name](values[0])), "angle")
    if name in _OF_NUMBERS and kind == "number" and len(given) in ((2,) if name == "pow" else (1, 2)):
        return Quantity(_OF_NUMBERS[name](*values), "number")
    raise NotMathematics(name)


def _of_alike(name: str, values: Sequence[float], step: str) -> float:
    """Functions whose arguments and result are of one kind."""
    if name == "min":
        return min(values)
    if name == "max":
        return max(values)
    if name == "hypot":
        return math.hypot(*values)
    if name == "clamp" and len(values) == 3:
        return max(values[0], min(values[1], values[2]))
    if name == "round" and len(values) in (1, 2):
        unit = values[1] if len(values) == 2 else 1.0
        return _STEPS[step](values[0] / unit) * unit
    if name == "mod" and len(values) == 2:
        return values[0] - values[1] * math.floor(values[0] / values[1])
    if name == "rem" and len(values) == 2:
        return math.fmod(values[0], values[1])
    raise NotMathematics(name)


def _common_kind(quantities: Sequence[Quantity]) -> Kind:
    kinds = {quantity.kind for quantity in quantities}
    if len(kinds) != 1:
        raise NotMathematics("units that do not go together")
    return quantities[0].kind
