"""Seeing in a vehicle's telemetry that it can be armed, without a MAVLink library."""

from __future__ import annotations

import socket
from collections.abc import Iterator

#: Number of SYS_STATUS, and what its checksum begins with.
_SYS_STATUS, _SYS_STATUS_EXTRA = 1, 124
#: MAV_SYS_STATUS_PREARM_CHECK, in SYS_STATUS.onboard_control_sensors_health.
_PREARM_CHECK = 0x10000000
#: MAV_SYS_STATUS_SENSOR: what an armable vehicle needs.
_CHECKS = {
    0x1: "gyroscope", 0x2: "accelerometer", 0x4: "magnetometer", 0x8: "barometer", 0x20: "GPS", 0x2000: "height estimate",
    0x4000: "position estimate", 0x8000: "rotors", 0x10000: "radio", 0x100000: "fence", 0x200000: "attitude estimate",
    0x2000000: "battery", 0x4000000: "proximity sensor",
}  # fmt: skip


def _checksum(data: bytes) -> int:
    """X.25, as MAVLink uses it."""
    checksum = 0xFFFF
    for byte in data:
        low = (byte ^ checksum) & 0xFF
        low = (low ^ (low << 4)) & 0xFF
        checksum = (checksum >> 8) ^ (low << 8) ^ (low << 3) ^ (low >> 4)
    return checksum


def _messages(datagram: bytes) -> Iterator[tuple[int, bytes, bytes, int]]:
    """Number, payload, what the checksum is over, and checksum of each message of MAVLink 2."""
    at = 0
    while at + 12 <= len(datagram) and datagram[at] == 0xFD:
        length, signed = datagram[at + 1], datagram[at + 2] & 1
        end = at + 10 + length
        if end + 2 > len(datagram):
            return
        number = int.from_bytes(datagram[at + 7 : at + 10], "little")
        yield number, datagram[at + 10 : end], datagram[at + 1 : end], int.from_bytes(datagram[end : end + 2], "little")
        at = end + 2 + 13 * signed


def failed_checks(datagram: bytes) -> list[str] | None:
    """What keeps the vehicle from being armed by the last SYS_STATUS of a datagram, if it has one; nothing when it can be armed."""
    found = None
    for number, payload, summed, checksum in _messages(datagram):
        if number == _SYS_STATUS and _checksum(summed + bytes([_SYS_STATUS_EXTRA])) == checksum:
            enabled, health = (int.from_bytes(payload.ljust(12, b"\0")[at : at + 4], "little") for at in (4, 8))
            failed = [name for bit, name in _CHECKS.items() if enabled & bit and not health & bit]
            found = [] if health & _PREARM_CHECK else failed or ["an arming check that its status does not name"]
    return found


class Watch:
    """A port of this machine to which the vehicle sends telemetry, and from which nothing is ever sent."""

    def __init__(self) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        #: What has kept the vehicle from being armed so far; None if it has not said.
        self.failed: list[str] | None = None

    @property
    def link(self) -> str:
        """As `--link` takes it."""
        return f"udpout:127.0.0.1:{self._socket.getsockname()[1]}"

    def is_armable(self, patience: float) -> bool:
        """Whether the vehicle says so within some seconds."""
        self._socket.settimeout(patience)
        try:
            said = failed_checks(self._socket.recv(65536))
        except TimeoutError:
            return False
        self.failed = self.failed if said is None else said
        return said == []

    @property
    def reason(self) -> str:
        """Why the vehicle cannot be armed."""
        if self.failed is None:
            return "it has sent no status, as while its time stands still"
        return f"not healthy: {', '.join(self.failed)}"

    def close(self) -> None:
        """Closes the port."""
        self._socket.close()
