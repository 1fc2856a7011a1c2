"""An SSC-32U, by its user guide."""

from __future__ import annotations

import re

MOVE = re.compile(r"(?:#\d+P\d+)+T(\d+)")


class Ssc32Model:
    """moves: ({channel: us}, ms) in the order they came. still_moving: so often it answers that it is not there yet."""

    def __init__(self, *, still_moving: int = 0) -> None:
        self.moves: list[tuple[dict[int, int], int]] = []
        self.stopped: list[int] = []
        self.deaf = False
        self._still_moving = still_moving
        self._pending = ""

    def receive(self, message: bytes) -> bytes:
        *lines, self._pending = (self._pending + message.decode("ascii")).split("\r")
        answer = b"".join(self._carry_out(line) for line in lines)
        return b"" if self.deaf else answer

    def _carry_out(self, line: str) -> bytes:
        if line == "VER":
            return b"SSC32-V2.50USB\r"
        if line == "Q":
            self._still_moving -= 1
            return b"+" if self._still_moving >= 0 else b"."
        if line.startswith("STOP"):
            self.stopped.append(int(line[4:]))
            return b""
        move = MOVE.fullmatch(line)
        assert move, f"no command: {line}"
        targets = {int(channel): int(pulse_us) for channel, pulse_us in re.findall(r"#(\d+)P(\d+)", line)}
        assert len(targets) == line.count("#")
        assert all(channel < 32 and 500 <= pulse_us <= 2500 for channel, pulse_us in targets.items())
        assert 1 <= int(move[1]) <= 65535
        self.moves.append((targets, int(move[1])))
        return b""
