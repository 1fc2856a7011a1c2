"""Servos on a bus: a memory each, of which some bytes move something. Two languages, each by its own description."""

from __future__ import annotations

from abc import ABC, abstractmethod


class BusModel(ABC):
    """goals: {id: count} of every write to the goals. A servo with torque stands at its goal at once, unless stuck.

    noise: so many answers to come are spoilt.
    """

    TORQUE: int
    GOAL: int
    PRESENT: int
    WORD: int
    RAMPS: tuple[int, ...]

    def __init__(self, positions: dict[int, int]) -> None:
        self.memory = {servo: bytearray(b"\x33" * 256) for servo in positions}
        for servo, position in positions.items():
            self.memory[servo][self.TORQUE] = 0
            self.put(servo, self.PRESENT, position)
        self.goals: list[dict[int, int]] = []
        self.stuck: set[int] = set()
        self.dead: set[int] = set()
        self.faults: dict[int, int] = {}
        self.noise = 0
        self._pending = bytearray()

    def receive(self, message: bytes) -> bytes:
        self._pending += message
        answer = b""
        while (instruction := self._take()) is not None:
            answer += self._carry_out(*instruction)
        return answer

    def position(self, servo: int) -> int:
        return self._load(servo, self.PRESENT)

    def _carry_out(self, servo: int, code: int, parameters: bytes) -> bytes:
        if code == 0x83:
            assert servo == 0xFE
            self._write(*self._sync_parts(parameters))
            return b""
        assert servo in self.memory, f"nobody has id {servo}"
        if servo in self.dead:
            return b""
        if code == 0x01:
            assert not parameters
            answer = self._status(servo, b"")
        else:
            assert code == 0x02, f"instruction {code}"
            start, size = self._read_parts(parameters)
            answer = self._status(servo, bytes(self.memory[servo][start : start + size]))
        if self.noise:
            self.noise -= 1
            answer = answer[:-1] + bytes((answer[-1] ^ 0x10,))
        return answer

    def _write(self, start: int, size: int, data: bytes) -> None:
        assert len(data) % (1 + size) == 0
        goals = {}
        for k in range(0, len(data), 1 + size):
            servo, content = data[k], data[k + 1 : k + 1 + size]
            assert servo in self.memory
            assert start in (self.TORQUE, self.GOAL, *self.RAMPS), f"register {start}"
            self.memory[servo][start : start + size] = content
            if start == self.GOAL:
                assert size == self.WORD
                goals[servo] = self._load(servo, self.GOAL)
        if goals:
            self.goals.append(goals)
        for servo, memory in self.memory.items():
            if memory[self.TORQUE] == 1 and servo not in self.stuck:
                assert not any(memory[ramp] for ramp in self.RAMPS), "moved with a ramp of the servo's own"
                memory[self.PRESENT : self.PRESENT + self.WORD] = memory[self.GOAL : self.GOAL + self.WORD]

    @abstractmethod
    def _take(self) -> tuple[int, int, bytes] | None:
        """The next whole instruction: id, code, parameters."""

    @abstractmethod
    def _status(self, servo: int, data: bytes) -> bytes: ...

    @abstractmethod
    def _read_parts(self, parameters: bytes) -> tuple[int, int]: ...

    @abstractmethod
    def _sync_parts(self, parameters: bytes) -> tuple[int, int, bytes]: ...

    @abstractmethod
    def _load(self, servo: int, register: int) -> int: ...

    @abstractmethod
    def put(self, servo: int, register: int, value: int) -> None: ...


class FeetechModel(BusModel):
    TORQUE, GOAL, PRESENT, WORD, RAMPS = 40, 42, 56, 2, (41, 46)

    def _take(self) -> tuple[int, int, bytes] | None:
        if len(self._pending) < 4 or len(self._pending) < self._pending[3] + 4:
            return None
        size = self._pending[3] + 4
        packet = bytes(self._pending[:size])
        del self._pending[:size]
        assert packet[:2] == b"\xff\xff", packet.hex()
        assert sum(packet[2:]) % 256 == 255, packet.hex()
        return packet[2], packet[4], packet[5:-1]

    def _status(self, servo: int, data: bytes) -> bytes:
        body = bytes((servo, len(data) + 2, self.faults.get(servo, 0))) + data
        return b"\xff\xff" + body + bytes((255 - sum(body) % 256,))

    def _read_parts(self, parameters: bytes) -> tuple[int, int]:
        start, size = parameters
        return start, size

    def _sync_parts(self, parameters: bytes) -> tuple[int, int, bytes]:
        return parameters[0], parameters[1], parameters[2:]

    def _load(self, servo: int, register: int) -> int:
        value = int.from_bytes(self.memory[servo][register : register + 2], "little")
        return 32768 - value if value > 32768 else value

    def put(self, servo: int, register: int, value: int) -> None:
        stored = value if value >= 0 else 32768 - value
        self.memory[servo][register : register + 2] = stored.to_bytes(2, "little")


class DynamixelModel(BusModel):
    TORQUE, GOAL, PRESENT, WORD, RAMPS = 64, 116, 132, 4, (108, 112)

    def _take(self) -> tuple[int, int, bytes] | None:
        if len(self._pending) < 7:
            return None
        size = int.from_bytes(self._pending[5:7], "little") + 7
        if len(self._pending) < size:
            return None
        packet = bytes(self._pending[:size])
        del self._pending[:size]
        assert packet[:4] == b"\xff\xff\xfd\x00", packet.hex()
        assert self._crc(packet) == 0, packet.hex()
        return packet[4], packet[7], packet[8:-2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")

    def _status(self, servo: int, data: bytes) -> bytes:
        stuffed = (bytes((0x55, self.faults.get(servo, 0))) + data).replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
        packet = b"\xff\xff\xfd\x00" + bytes((servo,)) + (len(stuffed) + 2).to_bytes(2, "little") + stuffed
        return packet + self._crc(packet + b"\x00\x00").to_bytes(2, "little")

    @staticmethod
    def _crc(packet: bytes) -> int:
        """The remainder of long division; of a packet with its CRC, low byte first, none."""
        message = packet[:-2] + packet[-1:] + packet[-2:-1]
        value = int.from_bytes(message, "big")
        for bit in range(8 * len(message) - 1, 15, -1):
            if value >> bit & 1:
                value ^= 0x18005 << bit - 16
        return value

    def _read_parts(self, parameters: bytes) -> tuple[int, int]:
        return int.from_bytes(parameters[:2], "little"), int.from_bytes(parameters[2:], "little")

    def _sync_parts(self, parameters: bytes) -> tuple[int, int, bytes]:
        return (*self._read_parts(parameters[:4]), parameters[4:])

    def _load(self, servo: int, register: int) -> int:
        return int.from_bytes(self.memory[servo][register : register + 4], "little", signed=True)

    def put(self, servo: int, register: int, value: int) -> None:
        self.memory[servo][register : register + 4] = value.to_bytes(4, "little", signed=True)
