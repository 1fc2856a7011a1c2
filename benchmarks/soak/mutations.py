"""Mutations of text files: what disks, editors, exporters and ill will do to them.

As libFuzzer's: bytes flip, chunks vanish, repeat and come from other files, numbers become extremes, words of the
format turn up anywhere. Equal seeds give equal files.
"""

from __future__ import annotations

import random
import re
from collections.abc import Sequence

EXTREMES = (
    b"0",
    b"-0",
    b"1",
    b"-1",
    b"1e-12",
    b"1e-300",
    b"1e-320",
    b"1e8",
    b"1e9",
    b"-1e9",
    b"1e10",
    b"2147483648",
    b"1e38",
    b"1e300",
    b"1e308",
    b"-1e308",
    b"1e999",
    b"nan",
    b"NaN",
    b"inf",
    b"-inf",
    b"Infinity",
    b"1e",
    b"1.2.3",
    b"0x10",
    b"1_0",
    b"999999999999999999999999",
    b"0.0000000000000000000001",
    b"100%",
    b"1e3mm",
)
_NUMBER = re.compile(rb"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_LONGEST_CHUNK = 400
_LARGEST = 2_000_000


def mutated(
    data: bytes,
    others: Sequence[bytes],
    pieces: Sequence[re.Pattern[bytes]],
    words: Sequence[bytes],
    chance: random.Random,
) -> bytes:
    """The data after one to four mutations.

    others: files to take chunks from; pieces: patterns of what belongs together in such a file (an element, an
    attribute, a row), swapped, repeated and dropped whole; words: of the format.
    """
    for _ in range(chance.choice((1, 1, 2, 3, 4))):
        data = _mutated_once(data, others, pieces, words, chance)[:_LARGEST]
    return data


def _mutated_once(
    data: bytes,
    others: Sequence[bytes],
    pieces: Sequence[re.Pattern[bytes]],
    words: Sequence[bytes],
    chance: random.Random,
) -> bytes:
    kind = chance.choices(
        ("number", "piece", "foreign piece", "word", "flip", "cut", "repeat", "splice"), (8, 5, 4, 3, 1, 1, 1, 1)
    )[0]
    if kind == "number":
        found = list(_NUMBER.finditer(data))
        if found:
            match = chance.choice(found)
            return data[: match.start()] + _number(match[0], chance) + data[match.end() :]
    if kind in ("piece", "foreign piece"):
        pattern = chance.choice(pieces)
        source = chance.choice(others) if kind == "foreign piece" else data
        here, there = list(pattern.finditer(data)), list(pattern.finditer(source))
        if here and there:
            return _with_piece(data, chance.choice(here), chance.choice(there)[0], chance)
    if kind == "word":
        at = chance.randrange(len(data) + 1)
        return data[:at] + chance.choice(words) + data[at:]
    begin = chance.randrange(len(data) + 1)
    end = min(begin + chance.randrange(1, _LONGEST_CHUNK), len(data))
    if kind == "flip" and begin < end:
        return data[:begin] + bytes([data[begin] ^ 1 << chance.randrange(8)]) + data[begin + 1 :]
    if kind == "cut":
        return data[:begin] + data[end:]
    if kind == "repeat":
        return data[:end] + data[begin:end] * chance.choice((1, 2, 50)) + data[end:]
    other = chance.choice(others)
    at = chance.randrange(len(other) + 1)
    return data[:begin] + other[at : at + _LONGEST_CHUNK] + data[begin:]


def _number(text: bytes, chance: random.Random) -> bytes:
    if chance.random() < 0.5:
        return chance.choice(EXTREMES)
    scaled = float(text) * chance.choice((-1, 0.5, 1.001, 10, 1e-3, 1e3, 1e-6, 1e6))
    return repr(scaled).encode()


def _with_piece(data: bytes, place: re.Match[bytes], piece: bytes, chance: random.Random) -> bytes:
    before, after = data[: place.start()], data[place.end() :]
    return before + chance.choice((b"", piece, place[0] + piece, place[0] * 2, piece + place[0])) + after
