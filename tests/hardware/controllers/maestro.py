"""A Pololu Maestro of 24 channels, by its user's guide; stricter than the board in what it forgives."""

from __future__ import annotations


def crc7(message: bytes) -> int:
    """By long division, as the guide works its example: bits lowest first, seven zeros behind them."""
    bits = [byte >> k & 1 for byte in message for k in range(8)] + [0] * 7
    for k in range(len(bits) - 7):
        if bits[k]:
            for offset, bit in enumerate((1, 0, 0, 0, 1, 0, 0, 1)):
                bits[k + offset] ^= bit
    return sum(bit << k for k, bit in enumerate(bits[-7:]))


SIZES = {0x84: 4, 0x87: 4, 0x89: 4, 0x90: 2, 0xA1: 1}


class MaestroModel:
    """targets: (channel, quarter us) in the order they came. errors: bits told, and cleared, when next asked."""

    def __init__(self, *, crc: bool = False, positions: dict[int, int] | None = None, most: int = 1 << 14) -> None:
        self._crc, self._most = crc, most
        self.positions = dict(positions or {})
        self.limited = set(range(24))
        self.targets: list[tuple[int, int]] = []
        self.errors = 0
        self.deaf = False
        self._pending = b""

    def receive(self, message: bytes) -> bytes:
        self._pending += message
        answer = b""
        while self._pending:
            assert self._pending[0] in SIZES, f"no command: {self._pending.hex()}"
            size = SIZES[self._pending[0]] + self._crc
            if len(self._pending) < size:
                break
            command, self._pending = self._pending[:size], self._pending[size:]
            assert all(byte < 0x80 for byte in command[1:]), f"data with the top bit set: {command.hex()}"
            if self._crc:
                assert command[-1] == crc7(command[:-1]), f"wrong CRC: {command.hex()}"
            answer += self._carry_out(*command[: size - self._crc])
        return b"" if self.deaf else answer

    def _carry_out(self, code: int, channel: int = 0, low: int = 0, high: int = 0) -> bytes:
        value = low | high << 7
        match code:
            case 0x84:
                assert channel not in self.limited, "moved with a limit of the board's own"
                self.targets.append((channel, value))
                self.positions[channel] = min(value, self._most)
            case 0x87:
                assert value == 0
            case 0x89:
                assert value == 0
                self.limited.discard(channel)
            case 0x90:
                return self.positions.get(channel, 0).to_bytes(2, "little")
            case 0xA1:
                errors, self.errors = self.errors, 0
                return errors.to_bytes(2, "little")
        return b""
