"""Clients that send more than the vehicle can handle slow down nobody but themselves: the flight stays on time, and another client keeps
its telemetry and its answers. Times are those of the kernel, which stamps each datagram as it arrives."""

import re
import select
import socket
import struct
import subprocess
import sys
import threading
import time
from dataclasses import dataclass

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from test_lockstep import steer

SO_TIMESTAMPNS = 35
# What one attack lasts, and the quiet time before it, s.
ATTACK, BEFORE = 2.0, 1.5

# Sends what is in a file for some seconds, at least once, as fast as possible. Over TCP it reads and forgets what comes back.
FLOODER = """
import socket, sys, threading, time
kind, host, port, path, seconds, connections = sys.argv[1:]
data = open(path, "rb").read()
end = time.monotonic() + float(seconds)
def flood():
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM if kind == "udp" else socket.SOCK_STREAM)
    link.connect((host, int(port)))
    if kind == "tcp":
        link.settimeout(0.2)
        threading.Thread(target=lambda: drain(link), daemon=True).start()
    while True:
        try:
            link.send(data)
        except OSError:
            time.sleep(0.001)
        if time.monotonic() >= end:
            return
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
    """Changes of the mass, each of which designs controllers anew."""
    kind = mavlink.MAV_PARAM_TYPE_REAL32
    return repeated(*(mavlink.MAVLink_param_set_message(1, 1, b"AF_MASS", mass, kind) for mass in (1.01, 1.02)))


def parameter_lists() -> bytes:
    return repeated(mavlink.MAVLink_param_request_list_message(1, 1))


def noise() -> bytes:
    """Each tenth byte could begin a frame of 255 bytes: its checksum is calculated for nothing."""
    return bytes.fromhex("fdff0000000000000000") * 6_000


@dataclass
class Quiet:
    """A client that measures and asks for little: it counts LOCAL_POSITION_NED with their delay, and the answers to TIMESYNC."""

    address: str

    def __post_init__(self):
        host, port = self.address.rsplit(":", 1)
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self.link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self.link.connect((host, int(port)))
        self.mav = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
        self.positions, self.asked, self.answered, self.texts = [], {}, {}, []

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
        # Frames of MAVLink 2, unsigned, one behind the other.
        while data:
            length = 12 + data[1]
            self.take_frame(data[:length], arrived)
            data = data[length:]

    def take_frame(self, frame: bytes, arrived: float):
        number, payload = int.from_bytes(frame[7:10], "little"), frame[10 : 10 + frame[1]].ljust(255, b"\0")
        if frame[5] != 1:
            return  # somebody else's, forwarded
        if number == mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED:
            self.positions.append((arrived, arrived - int.from_bytes(payload[:4], "little") / 1000))
        elif number == mavlink.MAVLINK_MSG_ID_TIMESYNC:
            self.answered[int.from_bytes(payload[8:16], "little")] = arrived
        elif number == mavlink.MAVLINK_MSG_ID_STATUSTEXT:
            self.texts.append(payload[1:51].split(b"\0")[0].decode(errors="replace"))

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
    """Starts flooders, which send `data` for some seconds; no seconds: once."""
    running = []

    def begin(address: str, data: bytes, kind="udp", seconds=ATTACK, connections=1):
        path = tmp_path / f"flood{len(running)}"
        path.write_bytes(data)
        host, port = address.rsplit(":", 1)
        arguments = [kind, host, port, str(path), str(seconds), str(connections)]
        running.append(subprocess.Popen([sys.executable, "-c", FLOODER, *arguments]))

    yield begin
    for process in running:
        process.kill()
        process.wait()


# What floods may cost others: what is sent late and what is flown late look the same. An answer may wait behind a message of another
# client, of which the longest, a redesign, takes 10 ms, however many clients there are.
LATE_MS, RATE, ANSWER_MS, STOP_MS = 20.0, 0.9, 100.0, 100.0


class Machine(threading.Thread):
    """Measures how late the machine lets a program go on that only sleeps: that is not the vehicle's fault."""

    def __init__(self):
        super().__init__(daemon=True)
        self.worst_ms = 0.0
        self.start()

    def run(self):
        while True:
            begin = time.monotonic()
            time.sleep(0.001)
            self.worst_ms = max(self.worst_ms, 1000 * (time.monotonic() - begin))

    def late_ms(self) -> float:
        """What a program may be late that sleeps a few times one after the other."""
        return 4 * self.worst_ms


@dataclass
class Attack:
    data: object
    kind: str = "udp"
    seconds: float = ATTACK
    connections: int = 1
    flooders: int = 1

    def begin(self, flood, vehicle):
        for _ in range(self.flooders):
            flood(vehicle.addresses[self.kind == "tcp"], self.data(), self.kind, self.seconds, self.connections)


ATTACKS = {
    "one datagram of parameter lists": Attack(parameter_lists, seconds=0),
    "three datagrams of redesigns": Attack(redesigns, seconds=0, flooders=3),
    "a flood of redesigns": Attack(redesigns),
    "a flood of heartbeats": Attack(heartbeats),
    "a flood of noise": Attack(noise),
    "30 TCP clients with heartbeats": Attack(heartbeats, kind="tcp", connections=30),
    "30 TCP clients with redesigns": Attack(redesigns, kind="tcp", connections=30),
}
every_attack = pytest.mark.parametrize("attack", ATTACKS.values(), ids=ATTACKS.keys())


@pytest.mark.alone
@every_attack
def test_a_flood_slows_down_only_its_sender(start, flood, attack):
    vehicle, machine = start(links=("udpin:0,onboard", "tcpin:0")), Machine()
    # Its datagrams go through the socket that is flooded.
    quiet = Quiet(vehicle.addresses[0])
    quiet.watch(BEFORE)
    begin = time.time()
    attack.begin(flood, vehicle)
    quiet.watch(ATTACK)
    figures = quiet.figures(begin, time.time() - 0.1)
    late_ms = machine.late_ms()
    assert figures["late_ms"] <= LATE_MS + late_ms and figures["rate"] >= RATE, figures
    assert figures["answered"] == 1.0 and figures["answer_ms"] <= ANSWER_MS + late_ms, figures


@pytest.mark.alone
@every_attack
def test_a_signal_is_answered_under_a_flood(start, flood, attack):
    vehicle, machine = start(links=("udpin:0", "tcpin:0")), Machine()
    attack.begin(flood, vehicle)
    Quiet(vehicle.addresses[0]).watch(0.5)
    begin = time.monotonic()
    assert vehicle.stop() == 0
    assert 1000 * (time.monotonic() - begin) <= STOP_MS + machine.late_ms()


def test_a_tcp_client_keeps_its_heartbeats_among_30_that_flood(start, connect, flood):
    vehicle = start(links=("tcpin:0",))
    client = connect(vehicle, kind="tcp")
    flood(vehicle.addresses[0], redesigns(), "tcp", seconds=4, connections=30)
    beats = [client.wait("HEARTBEAT", timeout=3) for _ in range(4)]
    assert all(beat.get_srcSystem() == 1 for beat in beats)
    client.arm()


def test_overload_is_announced_once_in_a_while(start, flood):
    vehicle = start(links=("udpin:0",))
    quiet = Quiet(vehicle.addresses[0])
    flood(vehicle.addresses[0], redesigns(), seconds=1)
    quiet.watch(2)
    told = [text for text in quiet.texts if re.match(r"Links overloaded: dropped \d+ datagrams?", text)]
    assert len(told) == 1, quiet.texts


def test_lockstep_flies_the_same_under_a_flood(start, connect, flood):
    flights = []
    for attack in (None, "udp", "tcp"):
        vehicle = start("--speed", "max", "--lockstep", "always", links=("udpin:0", "tcpin:0"))
        client = connect(vehicle)
        if attack:
            flood(vehicle.addresses[attack == "tcp"], heartbeats(), attack, seconds=20, connections=3)
        flights.append(steer(client, 150))
        assert vehicle.stop() == 0
    assert flights[1] == flights[0] and flights[2] == flights[0]


def test_a_flight_under_a_flood_is_replayed(start, flood, program, tmp_path):
    record = tmp_path / "flight.lmpc"
    vehicle = start("--record", str(record))
    flood(vehicle.addresses[0], redesigns(), seconds=1)
    Quiet(vehicle.addresses[0]).watch(1.5)
    assert vehicle.stop() == 0
    flown = re.search(r"digest (\w{16})", vehicle.output())[1]
    replayed = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=60)
    assert replayed.returncode == 0 and flown in replayed.stdout, replayed.stdout + replayed.stderr
