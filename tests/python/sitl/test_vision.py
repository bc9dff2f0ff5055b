"""A motion capture system in pymavlink: it reads the true motion, sends what it sees thirty times a second, and flies a vehicle that has no
GPS. The oracle is the true motion."""

import math
import struct

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import PX4_OFFBOARD, patiently

# Of a degree of latitude, m.
DEGREE = 111_195.0
GUIDED = (1, 4)


class MotionCapture:
    """Counts from where the vehicle stands."""

    def __init__(self, client, send):
        self.client, self.send, self.origin, self.place = client, send, None, None
        client.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_HIL_STATE_QUATERNION, 1e6 / 30)

    def look(self):
        true = self.client.wait("HIL_STATE_QUATERNION")
        self.origin = self.origin or true
        north = (true.lat - self.origin.lat) * 1e-7 * DEGREE
        east = (true.lon - self.origin.lon) * 1e-7 * DEGREE * math.cos(math.radians(true.lat * 1e-7))
        self.place = (north, east, (self.origin.alt - true.alt) / 1e3)
        self.send(self.client.mav, true, self.place)

    def watch(self, until, looks: int = 30 * 60, meanwhile=lambda: None):
        for _ in range(looks):
            self.look()
            meanwhile()
            if until():
                return
        raise AssertionError(f"not seen; the true place is {self.place}")

    def armed(self) -> bool:
        return bool(self.client.connection.messages["HEARTBEAT"].base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)


def angles(q):
    w, x, y, z = q
    return (math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x)))),
            math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def position_estimate(mav, true, place):
    mav.vision_position_estimate_send(true.time_usec, *place, *angles(true.attitude_quaternion))


def odometry(mav, true, place):
    nothing = [math.nan] * 21
    mav.odometry_send(true.time_usec, mavlink.MAV_FRAME_LOCAL_FRD, mavlink.MAV_FRAME_BODY_FRD, *place, true.attitude_quaternion,
                      math.nan, math.nan, math.nan, 0, 0, 0, nothing, nothing, 0, mavlink.MAV_ESTIMATOR_TYPE_VISION, 100)


def fly(client, camera, goal, mode, take_off):
    """Takes off, flies to a place and lands; the true place is where it was sent."""
    for _ in range(150):
        camera.look()
        client.position(goal)
    client.set_mode(mode)
    take_off()
    camera.watch(lambda: math.dist(camera.place, goal) < 0.3, meanwhile=lambda: client.position(goal))
    client.command(mavlink.MAV_CMD_NAV_LAND)
    camera.watch(lambda: not camera.armed())
    assert abs(camera.place[2]) < 0.1 and math.dist(camera.place[:2], goal[:2]) < 1.0, camera.place


@pytest.mark.parametrize("send", [position_estimate, odometry])
def test_px4_flies_by_motion_capture_alone(start, connect, send):
    client = connect(start(*patiently("--sensors", "realistic", "--speed", "2")))
    for name, value in {"EKF2_GPS_CTRL": 0, "EKF2_EV_CTRL": 11, "EKF2_HGT_REF": 3, "EKF2_MAG_TYPE": 5}.items():
        # PX4's integers travel bytewise.
        client.set_parameter(name, struct.unpack("<f", struct.pack("<i", value))[0], mavlink.MAV_PARAM_TYPE_INT32)
    camera = MotionCapture(client, send)
    fly(client, camera, (2.0, -1.0, -3.0), PX4_OFFBOARD, client.arm)


def test_ardupilot_flies_by_motion_capture_alone(start, connect):
    client = connect(start("--sensors", "realistic", "--autopilot", "ardupilot", "--speed", "2"))
    sources = {f"EK3_SRC1_{source}": 6 for source in ("POSXY", "VELXY", "POSZ", "VELZ", "YAW")}
    for name, value in {"GPS1_TYPE": 0, "VISO_TYPE": 1, **sources}.items():
        client.set_parameter(name, value)
    camera = MotionCapture(client, position_estimate)
    camera.look()
    client.mav.set_gps_global_origin_send(client.target[0], 473977420, 85455940, 488000)

    def take_off():
        client.arm()
        client.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 3)
        camera.watch(lambda: camera.place[2] < -2.5)

    fly(client, camera, (2.0, -1.0, -3.0), GUIDED, take_off)
