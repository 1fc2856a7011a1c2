"""What the vendors' SDKs write to and read from, in place of their serial port."""

from __future__ import annotations


class SdkPort:
    """Keeps what is sent; answers with what it is given. Never waits: no packet ever comes later."""

    def __init__(self, answer: bytes = b"") -> None:
        self.sent = b""
        self.answer = bytearray(answer)
        self.is_using = False

    def clearPort(self) -> None:
        pass

    def writePort(self, packet: list[int]) -> int:
        self.sent += bytes(packet)
        return len(packet)

    def readPort(self, length: int) -> bytes:
        taken = bytes(self.answer[:length])
        del self.answer[:length]
        return taken

    def getCurrentTime(self) -> float:
        return 0.0

    def setPacketTimeout(self, length: int) -> None:
        pass

    def setPacketTimeoutMillis(self, milliseconds: float) -> None:
        pass

    def isPacketTimeout(self) -> bool:
        return not self.answer
