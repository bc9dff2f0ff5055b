"""Fence, rally points and failsafes as pymavlink and MAVSDK know them."""

import math
import subprocess

import pytest
from client import PX4_POSITION, near, patiently
from mavsdk.plugins.action import Action
from mavsdk.plugins.action.action import ActionError
from mavsdk.plugins.geofence import Circle, FenceType, Geofence, GeofenceData, Point, Polygon
from mavsdk.plugins.telemetry import Telemetry
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from mavsdk_vehicle import eventually

HOME = (47.397742, 8.545594)
NORTH, EAST = 1 / 111_180, 1 / 75_470  # degrees per metre there
FENCE, RALLY = mavlink.MAV_MISSION_TYPE_FENCE, mavlink.MAV_MISSION_TYPE_RALLY
INSIDE = mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION
SQUARE = [(-25, -25), (25, -25), (25, 25), (-25, 25)]


def upload(client, kind, items):
    """Uploads (command, parameter 1, north, east); returns the result."""
    client.mav.mission_count_send(*client.target, len(items), kind)
    while True:
        message = client.wait(["MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK"])
        if message.get_type() == "MISSION_ACK":
            return message.type
        command, parameter, north, east = items[message.seq]
        client.mav.mission_item_int_send(
            *client.target, message.seq, mavlink.MAV_FRAME_GLOBAL_INT, command, 0, 1, parameter, 0, 0, 0,
            round((HOME[0] + north * NORTH) * 1e7), round((HOME[1] + east * EAST) * 1e7), 0, kind)


CIRCLE_IN, CIRCLE_OUT = mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION
OUTSIDE = mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION
INVALID, INVALID_RADIUS = mavlink.MAV_MISSION_INVALID, mavlink.MAV_MISSION_INVALID_PARAM1
MEANINGLESS = {
    "two corners": ([(INSIDE, 2, 0, 0), (INSIDE, 2, 9, 0)], INVALID_RADIUS, "item 1: corner count = 2"),
    "crossing sides": ([(INSIDE, 4, *SQUARE[corner]) for corner in (0, 2, 1, 3)], INVALID, "sides 1 and 3 cross; the first is 1"),
    "no area": ([(INSIDE, 3, 5, 5)] * 3, INVALID, "all corners lie on one line"),
    "corners of another kind": ([(INSIDE, 3, 0, 0), (OUTSIDE, 3, 9, 0), (INSIDE, 3, 9, 9)], INVALID, "item 2: this polygon"),
    "a corner missing": ([(INSIDE, 4, *corner) for corner in SQUARE[:3]], INVALID, "needs 4 consecutive corners"),
    "no number of corners": ([(INSIDE, math.nan, 0, 0)], INVALID_RADIUS, "corner count = NaN"),
    "radius 0": ([(CIRCLE_IN, 0, 0, 0)], INVALID_RADIUS, "radius = 0 m; allowed"),
    "radius below 0": ([(CIRCLE_OUT, -1, 0, 0)], INVALID_RADIUS, "radius = -1 m; allowed"),
    "radius NaN": ([(CIRCLE_IN, math.nan, 0, 0)], INVALID_RADIUS, "radius = NaN m; allowed"),
    "radius infinite": ([(CIRCLE_OUT, math.inf, 0, 0)], INVALID_RADIUS, "radius = inf m; allowed"),
    "a waypoint": ([(mavlink.MAV_CMD_NAV_WAYPOINT, 0, 0, 0)], mavlink.MAV_MISSION_UNSUPPORTED, "NAV_WAYPOINT (16): not supported"),
}


def told(client, words):
    """Waits for words in the lines for the pilot, whose pieces are joined."""
    whole = ""
    while words not in whole:
        whole += client.wait("STATUSTEXT", timeout=3).text


def test_zones_without_meaning_are_refused_and_the_fence_stays(start, connect):
    client = connect(start("--speed", "10"))
    assert upload(client, FENCE, [(CIRCLE_IN, 10, 50, 0)]) == mavlink.MAV_MISSION_ACCEPTED
    client.wait("STATUSTEXT", lambda line: line.text.startswith("Fence"))
    for name, (items, result, reason) in MEANINGLESS.items():
        client.drain()
        assert upload(client, FENCE, items) == result, name
        told(client, reason)
    # The one that was there still is: here, outside of it, it is not armed.
    client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1, result=mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
    fence = mavlink.MAV_SYS_STATUS_GEOFENCE
    client.wait("SYS_STATUS", lambda status: status.onboard_control_sensors_present & fence
                and not status.onboard_control_sensors_health & fence)
    client.wait("FENCE_STATUS", lambda status: status.breach_status == 1 and status.breach_count == 1)
    assert upload(client, FENCE, []) == mavlink.MAV_MISSION_ACCEPTED
    client.wait("STATUSTEXT", lambda line: line.text == "Failsafe cleared: inside fence")
    client.arm()


def test_a_terminated_flight_is_told_by_the_heartbeat(start, connect):
    client = connect(start("--speed", "10", "--set", "GF_ACTION=4"))
    client.take_off()
    assert upload(client, FENCE, [(CIRCLE_OUT, 10, 5, 0)]) == mavlink.MAV_MISSION_ACCEPTED
    beat = client.wait("HEARTBEAT", lambda beat: not armed(beat))
    assert beat.system_status == mavlink.MAV_STATE_FLIGHT_TERMINATION, beat


def armed(beat):
    return beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED


def test_pymavlink_flies_against_a_fence_and_the_record_is_the_same_flight(program, start, connect, tmp_path):
    record = tmp_path / "flight.rec"
    vehicle = start(*patiently("--speed", "10", "--record", record))
    client = connect(vehicle)
    assert upload(client, FENCE, [(INSIDE, 2, *SQUARE[0]), (INSIDE, 2, *SQUARE[1])]) == mavlink.MAV_MISSION_INVALID_PARAM1
    assert upload(client, FENCE, [(INSIDE, 4, *corner) for corner in SQUARE]) == mavlink.MAV_MISSION_ACCEPTED
    client.take_off()
    client.command_int(mavlink.MAV_CMD_DO_REPOSITION, mavlink.MAV_FRAME_GLOBAL, (-1, 0, 0, math.nan),
                       round((HOME[0] + 30 * NORTH) * 1e7), round(HOME[1] * 1e7), math.nan, mavlink.MAV_RESULT_DENIED)
    client.set_mode(PX4_POSITION)
    farthest = 0.0

    def held(position):
        nonlocal farthest
        farthest = max(farthest, position.x)
        return position.x > 15 and abs(position.vx) < 0.1

    client.stream(lambda: client.mav.manual_control_send(client.target[0], 1000, 0, 500, 0, 0), held, rate=100)
    assert 20 < farthest < 25
    client.wait("HEARTBEAT", lambda beat: beat.custom_mode == 4 << 16 | 3 << 24)
    vehicle.stop()
    replayed = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=30)
    assert replayed.returncode == 0, replayed.stdout + replayed.stderr


def test_a_small_battery_brings_it_to_the_nearest_rally_point(start, connect):
    client = connect(start("--speed", "10", "--set", "COM_LOW_BAT_ACT=3", "--set", "BAT1_CAPACITY=100",
                           "--set", "RTL_RETURN_ALT=4"))
    assert upload(client, RALLY, [(mavlink.MAV_CMD_NAV_RALLY_POINT, 0, 20, 5)]) == mavlink.MAV_MISSION_ACCEPTED
    client.take_off()
    client.command_int(mavlink.MAV_CMD_DO_REPOSITION, mavlink.MAV_FRAME_GLOBAL, (-1, 0, 0, math.nan),
                       round((HOME[0] + 20 * NORTH) * 1e7), round((HOME[1] + 20 * EAST) * 1e7), math.nan)
    client.wait("LOCAL_POSITION_NED", near((20, 20, -2.5), 0.3, 0.3))
    client.wait("STATUSTEXT", lambda text: text.text.startswith("Battery low"), 30)
    client.wait("STATUSTEXT", lambda text: text.text.startswith("Battery critical"), 30)
    client.wait("HEARTBEAT", lambda beat: beat.system_status >= mavlink.MAV_STATE_CRITICAL)
    client.wait("HEARTBEAT", lambda beat: not armed(beat), 30)
    place = client.wait("LOCAL_POSITION_NED")
    assert abs(place.z) < 0.1


def test_a_silent_ground_station_makes_it_land(program, start, connect, tmp_path):
    record = tmp_path / "flight.rec"
    vehicle = start("--speed", "10", "--record", record, "--set", "NAV_DLL_ACT=3", "--set", "COM_DL_LOSS_T=1")
    client = connect(vehicle)
    client.take_off()
    client.wait("STATUSTEXT", lambda text: text.text == "Ground station lost: landing", 10)
    client.wait("HEARTBEAT", lambda beat: not armed(beat), 30)
    client.beat()
    client.wait("STATUSTEXT", lambda text: text.text == "Failsafe cleared: ground station connected")
    vehicle.stop()
    replayed = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=30)
    assert replayed.returncode == 0, replayed.stdout + replayed.stderr


def test_mavsdk_uploads_a_geofence(fly):  # noqa: F811
    system = fly("--speed", "10")
    corners = [Point(HOME[0] + north * NORTH, HOME[1] + east * EAST) for north, east in SQUARE]
    Geofence(system).upload_geofence(GeofenceData(
        [Polygon(corners, FenceType.INCLUSION)], [Circle(Point(HOME[0] - 15 * NORTH, HOME[1]), 5.0, FenceType.EXCLUSION)]))
    telemetry, action = Telemetry(system), Action(system)
    eventually("health", telemetry.health_all_ok)
    action.arm()
    action.takeoff()
    eventually("in the air", telemetry.in_air)
    eventually("2.5 m", lambda: abs(telemetry.position().relative_altitude_m - 2.5) < 0.2)
    home = telemetry.home()
    for north in (40, -15):
        with pytest.raises(ActionError, match="(?i)denied"):
            action.goto_location(home.latitude_deg + north * NORTH, home.longitude_deg, home.absolute_altitude_m + 5, 0.0)
    action.goto_location(home.latitude_deg + 10 * NORTH, home.longitude_deg, home.absolute_altitude_m + 5, 0.0)
    eventually("inside it goes", lambda: abs(telemetry.position().latitude_deg - home.latitude_deg - 10 * NORTH) < 3e-6)
