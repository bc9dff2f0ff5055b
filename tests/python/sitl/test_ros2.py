"""What MAVROS sends and reads when ROS 2 flies the vehicle, sent and read in its place: see the book's page."""

import math
import time

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink

from mavsdk_vehicle import free_port

#: Read by MAVROS's plugins of state, position, inertial sensors, battery and time, none of which asks for them.
READ = {
    "HEARTBEAT", "SYS_STATUS", "EXTENDED_SYS_STATE", "BATTERY_STATUS", "ESTIMATOR_STATUS", "LOCAL_POSITION_NED", "GLOBAL_POSITION_INT",
    "GPS_RAW_INT", "ATTITUDE", "ATTITUDE_QUATERNION", "HIGHRES_IMU", "ALTITUDE", "VFR_HUD", "SYSTEM_TIME", "SERVO_OUTPUT_RAW",
}  # fmt: skip
#: Velocity, acceleration and yaw rate are ignored.
POSITION_AND_YAW = 1 << 11 | 7 << 6 | 7 << 3
OFFBOARD, AUTO_LAND = 6 << 16, 4 << 16 | 6 << 24


class Mavros:
    """The node: component 191 of the vehicle's own system."""

    def __init__(self, port: int):
        self.connection = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=1, source_component=191)
        self.mav = self.connection.mav
        self.beat_at = 0.0

    def wait(self, kind, condition=lambda message: True, each=lambda: None, timeout: float = 30.0):
        """The next such message of the autopilot; meanwhile there are heartbeats once a second, and what is repeated at 20 Hz."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if time.monotonic() - self.beat_at > 1.0:
                self.mav.heartbeat_send(mavlink.MAV_TYPE_ONBOARD_CONTROLLER, mavlink.MAV_AUTOPILOT_INVALID, 192, 0, mavlink.MAV_STATE_ACTIVE)
                self.beat_at = time.monotonic()
            each()
            message = self.connection.recv_match(type=kind, blocking=True, timeout=0.05)
            if message is not None and message.get_srcComponent() == 1 and condition(message):
                return message
        raise AssertionError(f"no {kind} as wanted within {timeout} s")

    def set_mode(self, number: int, armed: int, each=lambda: None):
        """SET_MODE has no answer: it is seen in the heartbeat."""
        self.mav.set_mode_send(1, armed | mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, number)
        self.wait("HEARTBEAT", lambda beat: beat.custom_mode == number, each)

    def ask_for_the_version(self):
        """At large at first, and of the autopilot then; the answers."""
        for target in ((0, 0), (1, 1)):
            self.mav.command_long_send(*target, mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 0, 1, 0, 0, 0, 0, 0, 0)
            yield self.wait("AUTOPILOT_VERSION")


def listening(start, *options: str):
    """MAVROS, to which a vehicle with these options sends."""
    port = free_port()
    start(*options, "--speed", "2", links=(f"udpout:127.0.0.1:{port},onboard",))
    node = Mavros(port)
    yield node
    node.connection.close()


@pytest.fixture
def mavros(start):
    yield from listening(start)


def test_what_mavros_reads_and_asks_for_at_the_start(mavros):
    first = mavros.wait("HEARTBEAT")
    assert (first.autopilot, first.type) == (mavlink.MAV_AUTOPILOT_PX4, mavlink.MAV_TYPE_QUADROTOR)
    missing = set(READ)
    mavros.wait(None, lambda message: missing.discard(message.get_type()) or not missing)

    for version in mavros.ask_for_the_version():
        capabilities = version.capabilities
        assert capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT and capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    mavros.mav.command_long_send(1, 1, mavlink.MAV_CMD_GET_HOME_POSITION, 0, *[0] * 7)
    assert mavros.wait("HOME_POSITION").altitude == 488_000
    sent = time.time_ns()
    mavros.mav.timesync_send(0, sent)
    assert mavros.wait("TIMESYNC", lambda answer: answer.ts1 == sent).tc1 > 0
    mavros.mav.command_long_send(1, 1, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 0, mavlink.MAVLINK_MSG_ID_SCALED_PRESSURE, 50_000, 0, 0, 0, 0, 0)
    mavros.wait("SCALED_PRESSURE")
    mavros.mav.request_data_stream_send(1, 1, mavlink.MAV_DATA_STREAM_ALL, 10, 1)
    for kind in (mavlink.MAV_MISSION_TYPE_MISSION, mavlink.MAV_MISSION_TYPE_FENCE, mavlink.MAV_MISSION_TYPE_RALLY):
        mavros.mav.mission_request_list_send(1, 1, kind)
        assert mavros.wait("MISSION_COUNT", lambda count: count.mission_type == kind).count == 0
    mavros.mav.param_request_list_send(1, 1)
    assert mavros.wait("PARAM_VALUE").param_count > 100


def test_the_flight_of_the_page(mavros):
    # 5 m east, 3 m north and 4 m up with the nose to the east, which is the quaternion (1, 0, 0, 0) of ROS.
    set_point = lambda: mavros.mav.set_position_target_local_ned_send(  # noqa: E731
        0, 1, 1, mavlink.MAV_FRAME_LOCAL_NED, POSITION_AND_YAW, 3, 5, -4, 0, 0, 0, 0, 0, 0, math.pi / 2, 0)  # fmt: skip
    mavros.wait("HEARTBEAT")
    set_point()
    mavros.set_mode(OFFBOARD, 0, set_point)
    mavros.mav.command_long_send(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
    assert mavros.wait("COMMAND_ACK", each=set_point).result == mavlink.MAV_RESULT_ACCEPTED
    near = lambda place: math.dist((place.x, place.y, place.z), (3, 5, -4)) < 0.1  # noqa: E731
    mavros.wait("LOCAL_POSITION_NED", near, set_point, 60)
    mavros.wait("ATTITUDE", lambda attitude: abs(attitude.yaw - math.pi / 2) < 0.02, set_point)
    mavros.set_mode(AUTO_LAND, mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
    mavros.wait("HEARTBEAT", lambda beat: not beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, timeout=60)
