"""Component values of CSS, as tinycss2 gives them: the few steps that every reader of a value takes."""

from __future__ import annotations

from collections.abc import Iterable

import tinycss2
from tinycss2.ast import Node

_BLANK = frozenset({"whitespace", "comment"})


def significant(tokens: Iterable[Node]) -> list[Node]:
    """Without blanks and comments."""
    return [token for token in tokens if token.type not in _BLANK and not _is_end(token)]


def _is_end(token: Node) -> bool:
    """Whether it only says that the text ends within a string or a url(), which closes them."""
    return bool(token.type == "error" and token.kind in ("eof-in-string", "eof-in-url"))


def component_values(text: str) -> list[Node]:
    """Those of a text, without blanks and comments."""
    return significant(tinycss2.parse_component_value_list(text))


def by_comma(tokens: Iterable[Node]) -> list[list[Node]]:
    """What stands between commas, blanks and all: one group where there is no comma."""
    groups: list[list[Node]] = [[]]
    for token in tokens:
        if is_comma(token):
            groups.append([])
        else:
            groups[-1].append(token)
    return groups


def is_comma(token: Node) -> bool:
    return bool(token.type == "literal" and token.value == ",")


def is_word(token: Node, word: str) -> bool:
    """Whether it is a keyword, in any case of letters."""
    return bool(token.type == "ident" and token.lower_value == word)


def text_of(tokens: Iterable[Node]) -> str:
    """Written out, without comments and the blanks around; "" for what nests too deeply to be a value of anything."""
    try:
        return str(tinycss2.serialize([token for token in tokens if token.type != "comment"])).strip()
    except RecursionError:
        return ""
