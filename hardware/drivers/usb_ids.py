"""Which controller a serial device is likely to be, by the ids that USB gives it."""

from __future__ import annotations

_MAESTRO = "Pololu Maestro: --driver maestro on the first of its two ports"
_ARDUINO = "Arduino: --driver native"
_LIKELY = {
    (0x1FFB, 0x0089): _MAESTRO,
    (0x1FFB, 0x008A): _MAESTRO,
    (0x1FFB, 0x008B): _MAESTRO,
    (0x1FFB, 0x008C): _MAESTRO,
    (0x2341, 0x0001): _ARDUINO,
    (0x2341, 0x0043): _ARDUINO,
    (0x2341, 0x0243): _ARDUINO,
    (0x2A03, 0x0043): _ARDUINO,
    (0x1A86, 0x7523): "Arduino with a CH340: --driver native",
    (0x1A86, 0x55D3): "adapter for bus servos with a CH343, as on the SO-101: --driver feetech",
    (0x0403, 0x6014): "ROBOTIS U2D2: --driver dynamixel",
    (0x0403, 0x6001): "FTDI chip, as on the SSC-32U and on Arduino Nanos: --driver ssc32 or native",
    (0x0403, 0x6015): "FTDI chip, as on the SSC-32U: --driver ssc32",
    (0x10C4, 0xEA60): "CP210x chip, on adapters of all kinds",
}


def likely_controller(usb_id: tuple[int, int] | None) -> str:
    """In words, with the driver to try; empty where there is nothing to go by."""
    return "" if usb_id is None else _LIKELY.get(usb_id, "")
