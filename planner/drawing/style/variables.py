"""Custom properties: `var()` and `env()` replaced by what they stand for (CSS Custom Properties 1, section 3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress

import tinycss2
from tinycss2.ast import Node

from planner.drawing.style.tokens import is_comma, significant

LENGTH_LIMIT = 1 << 16
"""Characters that all that is put into one value may come to: variables that double one another would take all memory.
"""
_CHAIN_LIMIT = 100


class Unresolvable(ValueError):
    """A variable that is not defined and has no fallback, a circle, or a value beyond the limit."""


def substituted(value: str, variables: Mapping[str, str]) -> str:
    """Errors: Unresolvable."""
    tokens = _Substitution(variables).replaced(tinycss2.parse_component_value_list(value))
    return str(tinycss2.serialize(tokens)).replace("/**/", " ").strip()


def resolved(variables: Mapping[str, str], inherited: Mapping[str, str]) -> dict[str, str]:
    """What custom properties come to, with others that are inherited; those in a circle are not defined at all."""
    result = dict(inherited)
    pending = dict(variables)
    while pending:
        _resolve(next(iter(pending)), pending, result, ())
    return result


def _resolve(name: str, pending: dict[str, str], result: dict[str, str], within: tuple[str, ...]) -> set[str]:
    """Resolve a custom property after those that it refers to; those of `within` that are in a circle with it."""
    value = pending[name]
    chain = (*within, name)
    circle: set[str] = set()
    if len(chain) > _CHAIN_LIMIT:
        circle.update(chain)
    else:
        for other in _referred(tinycss2.parse_component_value_list(value)) if "(" in value else ():
            if other in chain:
                circle.update(chain[chain.index(other) :])
            elif other in pending:
                circle |= _resolve(other, pending, result, chain)
    pending.pop(name)
    if name not in circle:
        with suppress(Unresolvable):  # as if it had not been defined
            result[name] = substituted(value, result) if "(" in value else value
    return circle


def _referred(tokens: Sequence[Node]) -> list[str]:
    """The variables that a value names, in order, those in fallbacks too."""
    found: list[str] = []
    for token in tokens:
        if token.type == "function":
            if token.lower_name == "var":
                found.extend(name.value for name in token.arguments if name.type == "ident" and name.value[:2] == "--")
            found.extend(_referred(token.arguments))
        elif token.type in ("() block", "[] block", "{} block"):
            found.extend(_referred(token.content))
    return list(dict.fromkeys(found))


class _Substitution:
    def __init__(self, variables: Mapping[str, str]) -> None:
        self._variables = variables
        self._left = LENGTH_LIMIT

    def replaced(self, tokens: Sequence[Node]) -> list[Node]:
        result: list[Node] = []
        for token in tokens:
            if token.type == "function" and token.lower_name in ("var", "env"):
                result.extend(self._value_of(token))
                continue
            if token.type == "function":
                token.arguments = self.replaced(token.arguments)
            elif token.type == "() block":
                token.content = self.replaced(token.content)
            result.append(token)
        return result

    def _value_of(self, call: Node) -> list[Node]:
        arguments = list(call.arguments)
        comma = next((index for index, token in enumerate(arguments) if is_comma(token)), None)
        names = significant(arguments[:comma])
        if len(names) != 1 or names[0].type != "ident":
            raise Unresolvable
        value = self._variables.get(names[0].value) if call.lower_name == "var" else None
        if value is None:
            if comma is None:
                raise Unresolvable
            return self.replaced(arguments[comma + 1 :])
        self._left -= len(value) + 1
        if self._left < 0:
            raise Unresolvable
        return list(tinycss2.parse_component_value_list(value))
