"""Lines that open, carry bytes and fail: every failure is one sentence that names the line and says what to do."""

from __future__ import annotations

import grp
import os
import pty
import socket
import tty
from collections.abc import Iterator
from pathlib import Path

import pytest

from hardware import port as port_module
from hardware.drivers.usb_ids import likely_controller
from hardware.port import Line, PluggedIn, Port, plugged_in
from planner.cli import main
from planner.errors import HardwareError
from tests.hardware.controllers.lines import Rfc2217, pty_line, tcp_line


class Echo:
    def receive(self, message: bytes) -> bytes:
        return message


def _exchange(port: Port) -> None:
    for _ in range(100):
        port.write(b"?")
        port.read(1, 0.05)


@pytest.fixture
def terminal() -> Iterator[str]:
    """The name of a pseudo-terminal behind which nobody reads."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    yield os.ttyname(slave)
    os.close(slave)
    os.close(master)


@pytest.mark.parametrize("line", [pty_line, tcp_line])
def test_bytes_go_there_and_back_until_the_cable_is_pulled(line) -> None:
    with line(Echo()) as far:
        port = Line(far.name).open(115_200)
        port.write(bytes(range(256)))
        assert port.read(256, 5.0) == bytes(range(256))
        assert port.read(1) == b""
        port.write(b"late")
        assert port.read(4, 5.0) == b"late"
        far.unplug()
        with pytest.raises(HardwareError, match=rf"^{far.name}: the line failed \(.+\); check the cable"):
            _exchange(port)
        port.close()
        port.close()


@pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")  # pyserial's
def test_bytes_go_over_a_bridge_that_speaks_rfc_2217() -> None:
    with tcp_line(Rfc2217(Echo())) as far:
        port = Line(far.name.replace("socket", "rfc2217")).open(115_200)
        port.write(bytes(range(256)))
        assert port.read(256, 5.0) == bytes(range(256))
        port.close()


def test_a_loop_carries_what_it_is_given_and_forgets_it() -> None:
    port = Line("loop://").open(115_200)
    port.write(b"abc")
    assert port.read(8, 0.05) == b"abc"
    port.write(b"abc")
    port.discard_input()
    assert port.read(8, 0.05) == b""
    port.close()


def test_the_time_of_bytes_on_the_line_is_known_for_devices_alone(terminal: str) -> None:
    port = Line(terminal, 9600).open(115_200)
    assert port.seconds(96) == pytest.approx(0.1)
    port.close()
    port = Line(terminal).open(1_000_000)
    assert port.seconds(100) == pytest.approx(0.001)
    port.close()
    port = Line("loop://").open(9600)
    assert port.seconds(96) == 0
    port.close()


def test_a_controller_that_takes_nothing_is_told(terminal: str) -> None:
    port = Line(terminal).open(115_200)
    with pytest.raises(HardwareError, match=f"^{terminal}: the controller takes no more bytes"):
        port.write(bytes(1 << 20))
    port.close()


def test_a_device_that_somebody_has_open_is_told(terminal: str) -> None:
    port = Line(terminal).open(115_200)
    with pytest.raises(HardwareError, match=f"^{terminal}: another program has it open"):
        Line(terminal).open(115_200)
    port.close()
    Line(terminal).open(115_200).close()


@pytest.mark.parametrize("devices", [(), ("/dev/ttyACM0", "/dev/ttyUSB1")])
def test_a_device_that_is_not_there_is_told_with_those_that_are(
    devices: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(port_module, "plugged_in", lambda: [PluggedIn(device, "", None) for device in devices])
    told = "plugged in: /dev/ttyACM0, /dev/ttyUSB1" if devices else "nothing is plugged in"
    with pytest.raises(HardwareError, match=f"^/dev/ttyUSB77: there is no such port; {told}$"):
        Line("/dev/ttyUSB77").open(115_200)


def test_a_device_without_permission_is_told_with_the_group_that_has_it(terminal: str) -> None:
    Path(terminal).chmod(0)
    group = grp.getgrgid(Path(terminal).stat().st_gid).gr_name
    told = "ask whoever" if group == "root" else f"join the group that may: sudo usermod -aG {group} "
    user = os.geteuid()
    if user == 0:  # to whom nothing is forbidden
        os.seteuid(65534)
    try:
        with pytest.raises(HardwareError, match=f"^{terminal}: no permission to open it; {told}"):
            Line(terminal).open(115_200)
    finally:
        os.seteuid(user)


@pytest.mark.parametrize("name", ["/dev/null", "/", __file__])
def test_what_is_no_serial_port_is_told(name: str) -> None:
    with pytest.raises(HardwareError, match=f"^{name}: this is not a serial port; plan ports lists those there are$"):
        Line(name).open(9600)


@pytest.mark.parametrize("name", ["socket://nowhere", "socket://127.0.0.1:99999", "sockets://127.0.0.1:1", "://", ""])
def test_a_name_that_means_nothing_is_told_in_one_line(name: str) -> None:
    with pytest.raises(HardwareError) as caught:
        Line(name).open(115_200)
    assert str(caught.value).startswith(f"{name}: ")
    assert "\n" not in str(caught.value)


def test_a_host_where_nobody_listens_is_told() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"socket://127.0.0.1:{server.getsockname()[1]}"
    with pytest.raises(HardwareError, match=rf"^{url}: cannot be opened \(Connection refused\); plan ports"):
        Line(url).open(115_200)


def test_plan_ports_lists_devices_and_what_they_are_likely_to_be(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        port_module,
        "plugged_in",
        lambda: [
            PluggedIn("/dev/ttyACM0", "Pololu Micro Maestro", (0x1FFB, 0x0089)),
            PluggedIn("/dev/ttyS0", "", None),
        ],
    )
    assert main(["ports"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "/dev/ttyACM0  Pololu Micro Maestro  Pololu Maestro: --driver maestro on the first of its two ports",
        "/dev/ttyS0",
    ]
    monkeypatch.setattr(port_module, "plugged_in", list)
    assert main(["ports"]) == 0
    assert capsys.readouterr().out == "nothing is plugged in\n"


def test_what_this_computer_has_is_listed() -> None:
    for port in plugged_in():
        assert port.device
        assert isinstance(likely_controller(port.usb_id), str)
