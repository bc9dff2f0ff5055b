"""Set-points in every frame, and attitudes, through a real client."""

import math

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import PX4_HOLD, PX4_OFFBOARD, PX4_POSITION, near, patiently

POSITION = 0b110111111000
VELOCITY = 0b110111000111


@pytest.fixture
def flying(start, connect):
    client = connect(start(*patiently("--speed", "2", "--home", "-33.9,151.2,20,0"), links=("udpin:0,onboard",)))
    client.take_off()
    return client


def test_position_in_every_frame(flying):
    goal = (4.0, -3.0, -6.0)
    flying.go(lambda: flying.position(goal))
    flying.stream(lambda: flying.position(goal), near(goal))

    # Relative to the vehicle: sent once, then the place that it means.
    flying.position((1.0, 1.0, 0.0), frame=mavlink.MAV_FRAME_LOCAL_OFFSET_NED)
    goal = (5.0, -2.0, -6.0)
    flying.stream(lambda: flying.position(goal), near(goal))
    flying.position((-1.0, 0.0, -1.0), frame=mavlink.MAV_FRAME_BODY_OFFSET_NED)
    goal = (4.0, -2.0, -7.0)
    flying.stream(lambda: flying.position(goal), near(goal))

    # The same place by latitude and longitude, from what the telemetry says of another.
    here = flying.wait("GLOBAL_POSITION_INT")
    north_m = 6.0
    latitude = here.lat + round(north_m / 6_357_000 * 180 / math.pi * 1e7)
    for frame, altitude in ((5, 30.0), (6, 10.0), (11, 10.0)):
        def send(frame=frame, altitude=altitude):
            flying.mav.set_position_target_global_int_send(
                0, *flying.target, frame, POSITION, latitude, here.lon, altitude, 0, 0, 0, 0, 0, 0, 0, 0)
        flying.stream(send, near((10.0, -2.0, -10.0), 0.15))
    there = flying.wait("GLOBAL_POSITION_INT")
    assert abs(there.lat - latitude) <= 15 and abs(there.relative_alt - 10_000) < 100


def test_velocity_in_both_frames(flying):
    send = lambda: flying.position((0, 0, 0), VELOCITY, velocity=(1.0, 2.0, -0.5))  # noqa: E731
    flying.go(send)
    flying.stream(send, lambda p: math.dist((p.vx, p.vy, p.vz), (1, 2, -0.5)) < 0.05)
    # Heading east, forward.
    east = lambda: flying.position((0, 0, 0), 0b100111000111, velocity=(0, 0, 0), yaw=math.pi / 2)  # noqa: E731
    flying.stream(east, lambda p: abs(flying.connection.messages["ATTITUDE"].yaw - math.pi / 2) < 0.02)
    body = lambda: flying.position((0, 0, 0), VELOCITY, mavlink.MAV_FRAME_BODY_NED, velocity=(1.5, 0, 0))  # noqa: E731
    flying.stream(body, lambda p: math.dist((p.vx, p.vy, p.vz), (0, 1.5, 0)) < 0.06)
    # Silence is a failsafe: it holds.
    flying.set_parameter("COM_OF_LOSS_T", 1.0)
    flying.wait("HEARTBEAT", lambda beat: beat.custom_mode == (4 << 16 | 3 << 24), 5)
    flying.wait("LOCAL_POSITION_NED", lambda p: math.hypot(p.vx, p.vy, p.vz) < 0.05)


def test_attitude_and_thrust(flying):
    lean = [math.cos(0.05), math.sin(0.05), 0.0, 0.0]
    send = lambda: flying.mav.set_attitude_target_send(0, *flying.target, 0b111, lean, 0, 0, 0, 0.32)  # noqa: E731
    flying.go(send)
    flying.stream(send, lambda p: p.vy > 1.0 and abs(flying.connection.messages["ATTITUDE"].roll - 0.1) < 0.02)
    flying.set_mode(PX4_HOLD)
    flying.wait("LOCAL_POSITION_NED", lambda p: math.hypot(p.vx, p.vy, p.vz) < 0.05)


def test_sticks(flying):
    flying.set_mode(PX4_POSITION)
    send = lambda: flying.mav.manual_control_send(1, 500, 0, 500, 0, 0)  # noqa: E731
    flying.stream(send, lambda p: p.vx > 2.0)
    override = lambda: flying.mav.rc_channels_override_send(*flying.target, 1500, 1500, 1900, 1500, 0, 0, 0, 0)  # noqa: E731
    flying.stream(override, lambda p: p.vz < -1.0 and abs(p.vx) < 0.2)


def test_refusals(flying):
    flying.set_mode(PX4_OFFBOARD, mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
    flying.position((1, 1, 1), frame=mavlink.MAV_FRAME_BODY_FRD)
    flying.wait("STATUSTEXT", lambda text: "frame 12" in text.text)
    flying.command(31_999, result=mavlink.MAV_RESULT_UNSUPPORTED)


def test_go_to_and_pause_as_a_ground_station_does(flying):
    here = flying.wait("GLOBAL_POSITION_INT")
    flying.command_int(mavlink.MAV_CMD_DO_REPOSITION, mavlink.MAV_FRAME_GLOBAL, (-1, 1, 0, math.nan),
                       here.lat + 2000, here.lon, 30.0)
    flying.wait("LOCAL_POSITION_NED", lambda p: p.vx > 1.0)
    flying.command(mavlink.MAV_CMD_DO_REPOSITION, -1, 1, 0, math.nan, math.nan, math.nan, math.nan)
    flying.wait("LOCAL_POSITION_NED", lambda p: math.hypot(p.vx, p.vy, p.vz) < 0.05)
