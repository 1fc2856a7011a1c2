"""Consistent Overhead Byte Stuffing (Cheshire and Baker, 1999): bytes without a zero, so that a zero ends a frame."""

from __future__ import annotations

_LONGEST_RUN = 254


class NotStuffed(ValueError):
    """Bytes that no message is stuffed into."""


def stuff(message: bytes) -> bytes:
    """`message` without zeros: each is replaced by how far the next one is."""
    stuffed = bytearray()
    runs = message.split(b"\0")
    for index, run in enumerate(runs):
        whole, rest = divmod(len(run), _LONGEST_RUN)
        if whole and rest == 0 and index == len(runs) - 1:
            whole, rest = whole - 1, _LONGEST_RUN  # a full run at the very end needs no empty one after it
        for start in range(0, whole * _LONGEST_RUN, _LONGEST_RUN):
            stuffed += b"\xff" + run[start : start + _LONGEST_RUN]
        stuffed.append(rest + 1)
        stuffed += run[whole * _LONGEST_RUN :]
    return bytes(stuffed)


def unstuff(stuffed: bytes) -> bytes:
    """The message that `stuff` made `stuffed` of. Errors: NotStuffed."""
    message = bytearray()
    at = 0
    while at < len(stuffed):
        code = stuffed[at]
        run = stuffed[at + 1 : at + code]
        if code == 0 or len(run) != code - 1 or 0 in run:
            raise NotStuffed(f"byte {at} points {code} on, which is a zero or beyond the end")
        message += run
        at += code
        if at < len(stuffed) and code != _LONGEST_RUN + 1:
            message.append(0)
    return bytes(message)
