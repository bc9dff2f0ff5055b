"""Clients that send more than the vehicle can handle slow down nobody but themselves: the flight stays on time, and another client keeps
its telemetry and its answers. Times are those of the kernel, which stamps each datagram as it arrives."""

import select
import signal
import socket
import struct
import subprocess
import sys
import time
from dataclasses import dataclass, field

import pytest
from pymavlink.dialects.v20 import common as mavlink

SO_TIMESTAMPNS = 35
# What one attack lasts, and the quiet time before it, s.
ATTACK, BEFORE = 3.0, 1.5

# Sends the datagrams in a file for some seconds, at a rate or as fast as possible. Over TCP it reads and forgets what comes back.
FLOODER = """
import socket, sys, threading, time
kind, host, port, path, seconds, per_second, connections = sys.argv[1:]
data = open(path, "rb").read()
end, interval = time.monotonic() + float(seconds), 1 / float(per_second) if float(per_second) else 0.0
def flood():
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM if kind == "udp" else socket.SOCK_STREAM)
    link.connect((host, int(port)))
    if kind == "tcp":
        link.settimeout(0.2)
        threading.Thread(target=lambda: drain(link), daemon=True).start()
    due = time.monotonic()
    while time.monotonic() < end:
        try:
            link.send(data)
        except OSError:
            time.sleep(0.001)
        due += interval
        time.sleep(max(0.0, due - time.monotonic()))
def drain(link):
    while True:
        try:
            if not link.recv(1 << 16):
                return
        except OSError:
            pass
threads = [threading.Thread(target=flood, daemon=True) for _ in range(int(connections))]
[thread.start() for thread in threads]
[thread.join(max(0.0, end + 1 - time.monotonic())) for thread in threads]
"""


def packed(message) -> bytes:
    return message.pack(mavlink.MAVLink(None, srcSystem=254, srcComponent=190))


def repeated(*messages, size: int = 60_000) -> bytes:
    """As many frames as fit into a datagram, each with a sequence number of its own."""
    mav, data = mavlink.MAVLink(None, srcSystem=254, srcComponent=190), b""
    while True:
        for message in messages:
            mav.seq = (mav.seq + 1) % 256
            frame = message.pack(mav)
            if len(data) + len(frame) > size:
                return data
            data += frame


def heartbeats() -> bytes:
    return repeated(mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3))


def redesigns() -> bytes:
    """Parameters that each design a controller anew."""
    name = b"MPC_LMPC_POS_N"
    return repeated(*(mavlink.MAVLink_param_set_message(1, 1, PARAMETER, value, mavlink.MAV_PARAM_TYPE_REAL32) for value in VALUES))


def parameter_lists() -> bytes:
    return repeated(mavlink.MAVLink_param_request_list_message(1, 1))


PARAMETER, VALUES = b"AF_MASS", (1.01, 1.02)


@dataclass
class Quiet:
    """A client that measures and asks for little: it counts LOCAL_POSITION_NED with their delay, and the answers to TIMESYNC."""

    address: str
    begun: float = field(default_factory=time.time)

    def __post_init__(self):
        host, port = self.address.rsplit(":", 1)
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self.link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self.link.connect((host, int(port)))
        self.mav = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
        self.positions, self.asked, self.answered, self.heartbeats, self.texts = [], {}, {}, [], []

    def watch(self, seconds: float):
        end, beat, ask = time.time() + seconds, 0.0, 0.0
        while (now := time.time()) < end:
            if now >= beat:
                beat = now + 1
                self.link.send(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3).pack(self.mav))
                self.mav.seq = (self.mav.seq + 1) % 256
            if now >= ask:
                ask, number = now + 0.1, len(self.asked) + 1
                self.asked[number] = time.time()
                self.link.send(mavlink.MAVLink_timesync_message(0, number).pack(self.mav))
                self.mav.seq = (self.mav.seq + 1) % 256
            if select.select([self.link], [], [], 0.02)[0]:
                self.take()

    def take(self):
        data, ancillary, *_ = self.link.recvmsg(2048, 64)
        seconds, nanoseconds = struct.unpack("qq", ancillary[0][2][:16])
        arrived = seconds + nanoseconds * 1e-9
        number = int.from_bytes(data[7:10], "little")
        if data[5] != 1:
            return  # somebody else's, forwarded
        if number == mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED:
            self.positions.append((arrived, arrived - int.from_bytes(data[10:14], "little") / 1000))
        elif number == mavlink.MAVLINK_MSG_ID_TIMESYNC:
            self.answered[struct.unpack("<q", data[18:26].ljust(8, b"\0"))[0]] = arrived
        elif number == mavlink.MAVLINK_MSG_ID_HEARTBEAT:
            self.heartbeats.append(arrived)
        elif number == mavlink.MAVLINK_MSG_ID_STATUSTEXT:
            self.texts.append(data[11:61].split(b"\0")[0].decode())

    def figures(self, begin: float, end: float) -> dict:
        """What it noticed between two moments, beside what it noticed before."""
        before = [delay for arrived, delay in self.positions if arrived < begin]
        during = [delay for arrived, delay in self.positions if begin <= arrived < end]
        first = self.positions[0][0]
        asked = [number for number, sent in self.asked.items() if begin <= sent < end - 0.3]
        answered = [number for number in asked if number in self.answered]
        return {
            "late_ms": round(1000 * (max(during, default=float("inf")) - min(before)), 1),
            "rate": round(len(during) / (end - begin) / (len(before) / (begin - first)), 3),
            "answered": len(answered) / len(asked),
            "answer_ms": round(1000 * max((self.answered[n] - self.asked[n] for n in answered), default=float("inf")), 1),
        }


@pytest.fixture
def flood(tmp_path):
    """Starts flooders: `flood(address, data)` once, at a rate, or as fast as possible."""
    running = []

    def begin(address: str, data: bytes, kind="udp", seconds=ATTACK, per_second=0.0, connections=1):
        path = tmp_path / f"flood{len(running)}"
        path.write_bytes(data)
        host, port = address.rsplit(":", 1)
        arguments = [kind, host, port, str(path), str(seconds), str(per_second), str(connections)]
        running.append(subprocess.Popen([sys.executable, "-c", FLOODER, *arguments]))

    yield begin
    for process in running:
        process.kill()
        process.wait()
