"""The plant as a simulator: an autopilot of a few lines, which connects as PX4 does, takes off and hovers in lock-step;
and autopilots that are broken."""

import math
import re
import socket
import time

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

LOCKSTEP, ARMED = 1, 128
STEP_US = 4000


class Autopilot:
    """A client of the simulator."""

    def __init__(self, address: str):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), timeout=5)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.mav = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
        self.mav.robust_parsing = True
        self.waiting = []
        self.truth = self.fix = self.ack = None
        self.beats = 0

    def send(self, message):
        self.socket.sendall(message.pack(self.mav))

    def sensor(self):
        """The next HIL_SENSOR; what comes before it is kept."""
        while True:
            while not self.waiting:
                data = self.socket.recv(65536)
                assert data, "the simulator has closed the connection"
                self.waiting = self.mav.parse_buffer(data) or []
            message = self.waiting.pop(0)
            kind = message.get_type()
            if kind == "HIL_SENSOR":
                return message
            if kind == "HIL_STATE_QUATERNION":
                self.truth = message
            elif kind == "HIL_GPS":
                self.fix = message
            elif kind == "COMMAND_ACK":
                self.ack = message
            elif kind == "HEARTBEAT":
                self.beats += 1

    def controls(self, time_us: int, motors, armed=True, lockstep=True):
        self.send(mavlink.MAVLink_hil_actuator_controls_message(
            time_us, [*motors, *[0.0] * 12], ARMED if armed else 0, LOCKSTEP if lockstep else 0))

    def begin(self):
        """What PX4 sends at first."""
        self.send(mavlink.MAVLink_heartbeat_message(0, 12, 0, 0, 0, 3))
        self.send(mavlink.MAVLink_command_long_message(0, 0, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 0, 115, STEP_US, 0, 0, 0, 0, 0))
        while self.truth is None or self.ack is None:
            self.sensor()
        assert self.ack.command == mavlink.MAV_CMD_SET_MESSAGE_INTERVAL and self.ack.result == 0
        self.home = (self.truth.lat, self.truth.lon, self.truth.alt)

    def place(self):
        """North, east, up, m."""
        lat, lon, alt = self.home
        north = (self.truth.lat - lat) * 1e-7 * 111_195
        east = (self.truth.lon - lon) * 1e-7 * 111_195 * math.cos(math.radians(lat * 1e-7))
        return north, east, (self.truth.alt - alt) / 1e3


def limited(value, most):
    return max(-most, min(most, value))


def motors_of(autopilot, height, plus):
    """Proportional and derivative control of place, attitude and height; motors in PX4's order."""
    truth = autopilot.truth
    north, east, up = autopilot.place()
    w, x, y, z = truth.attitude_quaternion
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(limited(2 * (w * y - z * x), 1))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    ahead = -0.08 * north - 0.12 * truth.vx / 100
    right = -0.08 * east - 0.12 * truth.vy / 100
    forward, side = ahead * math.cos(yaw) + right * math.sin(yaw), -ahead * math.sin(yaw) + right * math.cos(yaw)
    roll_torque = 0.35 * (limited(side, 0.2) - roll) - 0.18 * truth.rollspeed
    pitch_torque = 0.35 * (-limited(forward, 0.2) - pitch) - 0.18 * truth.pitchspeed
    yaw_torque = limited(-0.3 * yaw - 0.4 * truth.yawspeed, 0.1)
    thrust = 0.505 + limited(0.05 * (height - up) + 0.08 * truth.vz / 100, 0.1)
    if plus:  # right, left, front, back
        return (thrust - roll_torque + yaw_torque, thrust + roll_torque + yaw_torque,
                thrust + pitch_torque - yaw_torque, thrust - pitch_torque - yaw_torque)
    roll_torque, pitch_torque = 0.7 * roll_torque, 0.7 * pitch_torque  # front right, back left, front left, back right
    return (thrust - roll_torque + pitch_torque + yaw_torque, thrust + roll_torque - pitch_torque + yaw_torque,
            thrust + roll_torque + pitch_torque - yaw_torque, thrust - roll_torque - pitch_torque - yaw_torque)


def hover(address, seconds, plus=False, height=5.0):
    """Arms after half a second, takes off and hovers; returns where it was in the last two seconds."""
    autopilot = Autopilot(address)
    autopilot.begin()
    places, last = [], None
    sensor = autopilot.sensor()
    start = sensor.time_usec
    while sensor.time_usec < start + seconds * 1e6:
        armed = sensor.time_usec > start + 5e5
        autopilot.controls(sensor.time_usec, motors_of(autopilot, height, plus) if armed else [0] * 4, armed)
        last, sensor = sensor, autopilot.sensor()
        assert sensor.time_usec == last.time_usec + STEP_US
        if sensor.time_usec > start + (seconds - 2) * 1e6:
            places.append(autopilot.place())
    return autopilot, places


@pytest.mark.parametrize("mount", ["x", "plus"])
def test_an_autopilot_takes_off_and_hovers_in_lockstep(start, mount):
    vehicle = start("--hil", "0", "--hil-mount", mount, "--speed", "max", "--wind", "2,90", "--seed", "4", links=())
    autopilot, places = hover(vehicle.addresses[0], 12, mount == "plus")
    assert all(abs(up - 5) < 0.3 for _, _, up in places), places[-1]
    assert all(math.hypot(north, east) < 1.5 for north, east, _ in places), places[-1]
    # The receiver shows it, too, within its errors.
    assert abs(autopilot.fix.alt / 1e3 - autopilot.home[2] / 1e3 - 5) < 15 and autopilot.beats >= 10
    autopilot.socket.close()
    # Whoever connects next begins on the ground, at the beginning of time.
    autopilot = Autopilot(vehicle.addresses[0])
    assert autopilot.sensor().time_usec == STEP_US
    autopilot.begin()
    assert abs(autopilot.place()[2]) < 0.01


def test_the_same_autopilot_flies_the_same_flight(start):
    """Lock-step begins after a while that depends on the machine: the motors rest until then, and so does the plant."""
    digests = []
    for speed in ("max", "20"):
        vehicle = start("--hil", "0", "--speed", speed, "--duration", "4", links=())
        autopilot = Autopilot(vehicle.addresses[0])
        while (sensor := autopilot.sensor()).time_usec < 4_000_000:
            motor = 0.6 if sensor.time_usec > 2_000_000 else 0.0
            # Steps, not this machine's pace, count from the start.
            autopilot.controls(sensor.time_usec, [motor] * 4, motor > 0)
        assert vehicle.process.wait(10) == 0
        digests.append(re.findall(r"digest ([0-9a-f]{16})", vehicle.output()))
    assert len(digests[0]) == 1 and digests[0] == digests[1]


@pytest.mark.alone
def test_broken_autopilots(start):
    vehicle = start("--hil", "0", "--speed", "max", links=())
    address = vehicle.addresses[0]

    # Silent from the start: time goes on as the wall clock does, and the motors rest.
    silent = Autopilot(address)
    begin = time.monotonic()
    while (sensor := silent.sensor()).time_usec < 400_000:
        pass
    assert 0.3 < time.monotonic() - begin < 2.0
    silent.socket.close()

    # Garbage, values that are none, too many channels of nothing: it flies on without harm.
    noisy = Autopilot(address)
    noisy.begin()
    for _ in range(100):
        sensor = noisy.sensor()
        noisy.socket.sendall(b"\xfd\xff\x00" + bytes(range(256)))
        noisy.controls(sensor.time_usec, [math.nan, math.inf, -5.0, 3e38])
    assert abs(noisy.place()[2]) < 5
    noisy.socket.close()

    # Twice the same controls are one step.
    double = Autopilot(address)
    sensor = double.sensor()
    double.controls(sensor.time_usec, [0.1] * 4)
    while True:  # those that were underway before the first controls came
        double.socket.settimeout(0.3)
        try:
            sensor = double.sensor()
        except TimeoutError:
            break
    for _ in range(50):
        before = sensor.time_usec
        double.controls(before, [0.1] * 4)
        double.controls(before, [0.1] * 4)
        sensor = double.sensor()
        assert sensor.time_usec == before + STEP_US
    double.socket.settimeout(0.2)
    with pytest.raises(TimeoutError):
        double.sensor()

    # Silent after a while: a step per second, in case that one was lost; and the connection breaks in the middle of a frame.
    double.socket.settimeout(3)
    begin = time.monotonic()
    assert double.sensor().time_usec == sensor.time_usec + STEP_US
    assert time.monotonic() - begin > 0.4
    double.socket.sendall(b"\xfd\x51\x00\x00")
    double.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
    double.socket.close()

    # And one that is not broken.
    good, places = hover(address, 6, height=2.0)
    assert abs(places[-1][2] - 2) < 0.5
    assert vehicle.output().count("autopilot disconnected") == 3 and "no HIL_ACTUATOR_CONTROLS for 1s" in vehicle.output()


def test_what_means_nothing_to_a_plant_alone_is_refused(program):
    import subprocess

    for arguments, words in [
        (("--hil", "0", "--vehicles", "2"), "--vehicles: does not go with --hil"),
        (("--hil", "0", "--speed", "0"), "--speed: 0 does not go with --hil"),
        (("--hil", "nowhere:"), "invalid address `nowhere:`; use [HOST:]PORT"),
        (("--hil", "0", "--record", "x"), "--record"),
    ]:
        result = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=20)
        assert result.returncode == 2 and words in result.stderr, result
