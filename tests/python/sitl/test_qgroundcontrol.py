"""The clicks of QGroundControl that the tutorial has a table of, by the messages that QGroundControl sends to PX4 for them."""

import math

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import PX4_LAND, PX4_RETURN, near
from test_mission import upload

NAN = math.nan
PX4_MISSION = (1, 4, 4)
HOME = (47.397742, 8.545594, 488.0)


def set_mode(client, mode):
    """As QGroundControl does: SET_MODE, which has no answer, and the mode is read from HEARTBEAT."""
    number = mode[1] << 16 | mode[2] << 24
    armed = client.wait("HEARTBEAT").base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    client.mav.set_mode_send(client.target[0], armed | mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, number)
    client.wait("HEARTBEAT", lambda beat: beat.custom_mode == number)


def take_off(client):
    altitude = client.wait("GLOBAL_POSITION_INT").alt / 1e3
    client.command(mavlink.MAV_CMD_NAV_TAKEOFF, -1, 0, 0, NAN, NAN, NAN, altitude + 2.5)
    client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    client.wait("LOCAL_POSITION_NED", near((0, 0, -2.5)), 20)


def landed(client):
    client.wait("HEARTBEAT", lambda beat: not beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 60)


def test_each_click_of_the_table(start, connect):
    client = connect(start("--speed", "10", "--set", "RTL_RETURN_ALT=4"))
    take_off(client)

    altitude = client.wait("GLOBAL_POSITION_INT").alt / 1e3
    place = round((HOME[0] + 10 / 111_195) * 1e7), round(HOME[1] * 1e7)
    client.command_int(mavlink.MAV_CMD_DO_REPOSITION, mavlink.MAV_FRAME_GLOBAL, (-1, 1, 0, NAN), *place, altitude)
    client.wait("LOCAL_POSITION_NED", near((10, 0, -2.5), 0.2), 30)

    client.command(mavlink.MAV_CMD_DO_REPOSITION, -1, 1, 0, NAN, NAN, NAN, HOME[2] + 5)
    client.wait("LOCAL_POSITION_NED", near((10, 0, -5), 0.2), 30)

    # So far that a pause comes on the way on any machine.
    far = round((HOME[0] + 400 / 111_195) * 1e7)
    client.command_int(mavlink.MAV_CMD_DO_REPOSITION, mavlink.MAV_FRAME_GLOBAL, (-1, 1, 0, NAN), far, place[1], HOME[2] + 5)
    client.wait("LOCAL_POSITION_NED", lambda position: position.x > 15, 20)
    client.command(mavlink.MAV_CMD_DO_REPOSITION, -1, 1, 0, NAN, NAN, NAN, NAN)
    rest = client.wait("LOCAL_POSITION_NED", lambda position: math.hypot(position.vx, position.vy, position.vz) < 0.05, 20)
    assert 15 < rest.x < 390 and abs(rest.z + 5) < 0.2, "it holds on the way"

    set_mode(client, PX4_RETURN)
    landed(client)
    home = client.wait("LOCAL_POSITION_NED")
    assert math.hypot(home.x, home.y) < 0.3

    take_off(client)
    set_mode(client, PX4_LAND)
    landed(client)


def test_a_mission_inside_a_fence_with_a_rotor_that_fails(start, connect, tmp_path):
    vehicle = start("--speed", "10", "--wind", "4,270", "--log-dir", str(tmp_path / "logs"), "--fault", "30:rotor1=off")
    client = connect(vehicle)
    relative, mission = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT, mavlink.MAV_MISSION_TYPE_MISSION
    north = lambda metres: HOME[0] + metres / 111_195  # noqa: E731
    fence = [(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, mavlink.MAV_FRAME_GLOBAL, (120, 0, 0, 0), *HOME[:2], 0)]
    assert upload(client, fence, mavlink.MAV_MISSION_TYPE_FENCE) == 0

    def items(far):
        return [(mavlink.MAV_CMD_NAV_TAKEOFF, relative, (0, 0, 0, NAN), *HOME[:2], 10),
                (mavlink.MAV_CMD_NAV_WAYPOINT, relative, (0, 0, 0, NAN), north(30), HOME[1], 10),
                (mavlink.MAV_CMD_NAV_WAYPOINT, relative, (0, 0, 0, NAN), north(far), HOME[1], 10),
                (mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH, mavlink.MAV_FRAME_MISSION, (0, 0, 0, 0), 0, 0, 0)]

    assert upload(client, items(300), mission) != 0
    client.wait("STATUSTEXT", lambda said: said.text == "Mission rejected: item 3: outside the fence")
    assert upload(client, items(-60), mission) == 0
    set_mode(client, PX4_MISSION)
    client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    client.wait("STATUSTEXT", lambda said: said.text == "Rotor failure: landing", 30)
    landed(client)
