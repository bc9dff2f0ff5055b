"""Seeing in a vehicle's telemetry that it can be armed, without a MAVLink library."""

from __future__ import annotations

import socket
from collections.abc import Iterator

#: Number of SYS_STATUS, and what its checksum begins with.
_SYS_STATUS, _SYS_STATUS_EXTRA = 1, 124
#: MAV_SYS_STATUS_PREARM_CHECK, in SYS_STATUS.onboard_control_sensors_health.
_PREARM_CHECK = 0x10000000


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


def says_armable(datagram: bytes) -> bool:
    """Whether a datagram has a SYS_STATUS by which the vehicle can be armed."""
    for number, payload, summed, checksum in _messages(datagram):
        if number == _SYS_STATUS and _checksum(summed + bytes([_SYS_STATUS_EXTRA])) == checksum:
            health = int.from_bytes(payload.ljust(12, b"\0")[8:12], "little")
            if health & _PREARM_CHECK:
                return True
    return False


class Watch:
    """A port of this machine to which the vehicle sends telemetry, and from which nothing is ever sent."""

    def __init__(self) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))

    @property
    def link(self) -> str:
        """As `--link` takes it."""
        return f"udpout:127.0.0.1:{self._socket.getsockname()[1]}"

    def is_armable(self, patience: float) -> bool:
        """Whether the vehicle says so within some seconds."""
        self._socket.settimeout(patience)
        try:
            return says_armable(self._socket.recv(65536))
        except TimeoutError:
            return False

    def close(self) -> None:
        """Closes the port."""
        self._socket.close()
