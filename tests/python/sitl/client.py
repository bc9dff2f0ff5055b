"""A pymavlink client with the words that the tests use."""

import math
import socket
import time

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import ardupilotmega as mavlink

PX4_OFFBOARD = (1, 6, 0)
PX4_HOLD = (1, 4, 3)
PX4_LAND = (1, 4, 6)
PX4_RETURN = (1, 4, 5)
PX4_POSITION = (1, 3, 0)


class Client:
    def __init__(self, address: str, kind: str = "udpout", system: int = 255, heartbeat: bool = True):
        self.connection = mavutil.mavlink_connection(f"{kind}:{address}", source_system=system, dialect="ardupilotmega")
        self.mav = self.connection.mav
        self.target = (0, 0)
        if heartbeat:
            self.beat()
            message = self.wait("HEARTBEAT")
            self.target = (message.get_srcSystem(), message.get_srcComponent())
            self.connection.target_system, self.connection.target_component = self.target

    def close(self):
        self.connection.close()

    def beat(self):
        self.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)

    def wait(self, kind, condition=lambda message: True, timeout: float = 10.0):
        """The next message of a kind that fulfils a condition."""
        end = time.monotonic() + timeout
        last = None
        while (left := end - time.monotonic()) > 0:
            message = self.connection.recv_match(type=kind, blocking=True, timeout=min(left, 0.5))
            if message is None or message.get_srcSystem() == self.mav.srcSystem:
                continue
            last = message
            if condition(message):
                return message
        raise AssertionError(f"no {kind} as wanted within {timeout} s; the last was {last}")

    def drain(self):
        """Forgets what has come so far."""
        while self.connection.recv_match(blocking=False) is not None:
            pass

    def command(self, number: int, *parameters: float, result=mavlink.MAV_RESULT_ACCEPTED, confirmation: int = 0):
        """Sends COMMAND_LONG, and again as the protocol says; checks the result of the answer."""
        parameters = [*parameters, *([0.0] * (7 - len(parameters)))]
        for attempt in range(3):
            self.mav.command_long_send(*self.target, number, confirmation + attempt, *parameters)
            try:
                ack = self.wait("COMMAND_ACK", lambda ack: ack.command == number, timeout=1.5)
            except AssertionError:
                continue
            assert ack.result == result, f"command {number}: {ack}"
            return ack
        raise AssertionError(f"command {number} was not answered")

    def command_int(self, number: int, frame: int, parameters, x: int, y: int, z: float, result=0):
        self.mav.command_int_send(*self.target, frame, number, 0, 0, *parameters, x, y, z)
        ack = self.wait("COMMAND_ACK", lambda ack: ack.command == number)
        assert ack.result == result, str(ack)

    def set_mode(self, mode, result=mavlink.MAV_RESULT_ACCEPTED):
        self.command(mavlink.MAV_CMD_DO_SET_MODE, *mode, result=result)

    def arm(self):
        self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        self.wait("HEARTBEAT", lambda beat: beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    def take_off(self, altitude: float = math.nan, height: float = 2.5):
        """Arms and takes off; `height` is where it has to get."""
        self.arm()
        self.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, math.nan, math.nan, math.nan, altitude)
        self.wait("LOCAL_POSITION_NED", lambda position: abs(-position.z - height) < 0.15 and abs(position.vz) < 0.1, 20)

    def land(self):
        self.command(mavlink.MAV_CMD_NAV_LAND)
        self.wait("HEARTBEAT", lambda beat: not beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 40)

    def position(self, position, mask=0b110111111000, frame=mavlink.MAV_FRAME_LOCAL_NED, velocity=(0, 0, 0),
                 acceleration=(0, 0, 0), yaw=0.0, yaw_rate=0.0):
        self.mav.set_position_target_local_ned_send(
            0, *self.target, frame, mask, *position, *velocity, *acceleration, yaw, yaw_rate)

    def stream(self, send, until, timeout: float = 30.0, rate: float = 20.0):
        """Calls `send` at a rate until a LOCAL_POSITION_NED fulfils a condition."""
        end = time.monotonic() + timeout
        last = None
        while time.monotonic() < end:
            send()
            message = self.connection.recv_match(type="LOCAL_POSITION_NED", blocking=True, timeout=1 / rate)
            if message is not None:
                last = message
                if until(message):
                    return message
        raise AssertionError(f"not reached within {timeout} s; the last was {last}")

    def go(self, send, mode=PX4_OFFBOARD):
        """Begins the offboard mode with a set-point."""
        send()
        self.set_mode(mode)

    def parameter(self, name: str, timeout: float = 10.0):
        """Reads a parameter. UDP may lose an answer behind telemetry that nobody has read, so it asks again."""
        end = time.monotonic() + timeout
        while True:
            self.mav.param_request_read_send(*self.target, name.encode(), -1)
            try:
                return self.wait("PARAM_VALUE", lambda value: value.param_id == name, timeout=1.0)
            except AssertionError:
                if time.monotonic() >= end:
                    raise

    def set_parameter(self, name: str, value: float, kind: int = mavlink.MAV_PARAM_TYPE_REAL32):
        self.mav.param_set_send(*self.target, name.encode(), value, kind)
        return self.wait("PARAM_VALUE", lambda value: value.param_id == name)


def patiently(*arguments) -> tuple:
    """Arguments of a vehicle that waits for set-points and sticks as long as other work on the machine may keep a client from sending.
    PX4's modes are left after a second, of which a fast vehicle has several in each of the client's; ArduPilot's guided mode stays."""
    return arguments if "ardupilot" in arguments else ("--set", "COM_OF_LOSS_T=30", "--set", "COM_RC_LOSS_T=30", *arguments)


def near(goal, within: float = 0.1, slow: float = 0.1):
    """Whether a LOCAL_POSITION_NED rests at a place."""
    return lambda p: math.dist((p.x, p.y, p.z), goal) < within and math.hypot(p.vx, p.vy, p.vz) < slow


def own_address():
    """An address of this machine that is not loopback. What is sent to it does not leave the machine."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            pytest.skip("no network address")
        return probe.getsockname()[0]
