"""Orbits, a target that is followed, and the ways of ArduPilot's CIRCLE and SMART_RTL, flown by MAVSDK and pymavlink as they are."""

import math
import time

from mavsdk.plugins.action import Action, OrbitYawBehavior
from mavsdk.plugins.follow_me import Config, FollowMe, TargetLocation
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from pymavlink import mavutil

from mavsdk_vehicle import eventually

METRES_PER_DEGREE = 6371000 * math.pi / 180


def from_centre(telemetry, latitude, longitude):
    """North and east of a place, m, on the sphere."""
    here = telemetry.position()
    return ((here.latitude_deg - latitude) * METRES_PER_DEGREE,
            (here.longitude_deg - longitude) * METRES_PER_DEGREE * math.cos(math.radians(latitude)))


def off_radius(telemetry, latitude, longitude, radius, seconds):
    """The farthest from a radius, m, in a time of the wall clock, s."""
    worst, end = 0.0, time.monotonic() + seconds
    while time.monotonic() < end:
        worst = max(worst, abs(math.hypot(*from_centre(telemetry, latitude, longitude)) - radius))
        time.sleep(0.02)
    return worst


def test_mavsdk_orbits_and_follows(fly):  # noqa: F811
    system = fly("--speed", "4")
    telemetry, action, follow = Telemetry(system), Action(system), FollowMe(system)
    eventually("health", telemetry.health_all_ok)
    action.set_takeoff_altitude(9.0)
    action.arm()
    action.takeoff()
    eventually("9 m", lambda: abs(telemetry.position().relative_altitude_m - 9) < 0.2)
    home = telemetry.home()
    altitude = home.absolute_altitude_m + 10

    centre = (home.latitude_deg + 15 / METRES_PER_DEGREE, home.longitude_deg)
    action.do_orbit(12.0, 3.0, OrbitYawBehavior.HOLD_FRONT_TO_CIRCLE_CENTER, *centre, altitude)
    eventually("on the circle", lambda: math.hypot(*from_centre(telemetry, *centre)) < 12.2 and
               abs(telemetry.position().relative_altitude_m - 10) < 0.2 and
               math.hypot(telemetry.velocity_ned().north_m_s, telemetry.velocity_ned().east_m_s) > 2.9)
    assert off_radius(telemetry, *centre, 12.0, 2.0) < 0.4
    north, east = from_centre(telemetry, *centre)
    turn = telemetry.heading().heading_deg - math.degrees(math.atan2(-east, -north))
    assert abs((turn + 180) % 360 - 180) < 15

    # A target that goes north at 3 m/s from below the vehicle; it tells itself ten times a second.
    follow.set_config(Config(8.0, 9.0, 0.1, Config.FollowAltitudeMode.CONSTANT, 5.0, 180.0))
    follow.start()
    eventually("follow-me", lambda: telemetry.flight_mode() == FlightMode.FOLLOW_ME and follow.is_active())
    began, behind, end = time.monotonic(), [], time.monotonic() + 7.0
    while time.monotonic() < end:
        travelled = 3.0 * 4 * (time.monotonic() - began)
        latitude = centre[0] + travelled / METRES_PER_DEGREE
        follow.set_target_location(TargetLocation(latitude, centre[1], home.absolute_altitude_m, 3.0, 0.0, 0.0))
        behind.append(from_centre(telemetry, latitude, centre[1]))
        time.sleep(0.1)
    # The clocks of the two do not run quite evenly.
    north, east = behind[-1]
    assert -12 < north < -6 and abs(east) < 1.5, behind[-5:]
    assert abs(telemetry.position().relative_altitude_m - 8) < 0.4
    follow.stop()
    eventually("hold", lambda: telemetry.flight_mode() == FlightMode.HOLD)


def test_ardupilot_circle_and_smart_rtl(start):
    vehicle = start("--autopilot", "ardupilot", "--speed", "10", "--set", "CIRCLE_RADIUS=800")
    link = mavutil.mavlink_connection(f"udpout:{vehicle.addresses[0]}", source_system=255)
    try:
        link.mav.heartbeat_send(6, 8, 0, 0, 0)
        link.wait_heartbeat(timeout=10)
        modes = link.mode_mapping()

        def wait(kind, condition, seconds=20.0):
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                message = link.recv_match(type=kind, blocking=True, timeout=1)
                if message is not None and condition(message):
                    return message
            raise AssertionError(f"no {kind} as wanted")

        def enter(name):
            link.set_mode(name)
            wait("HEARTBEAT", lambda beat: beat.custom_mode == modes[name])

        def at(north, east, within=1.5):
            return wait("LOCAL_POSITION_NED", lambda p: math.hypot(p.x - north, p.y - east) < within)

        def go(north, east):
            link.mav.set_position_target_local_ned_send(0, 1, 1, 1, 0xDF8, north, east, -10, *[0] * 8)
            at(north, east)

        enter("GUIDED")
        link.arducopter_arm()
        link.motors_armed_wait()
        link.mav.command_long_send(1, 1, 22, 0, 0, 0, 0, 0, 0, 0, 10)
        wait("LOCAL_POSITION_NED", lambda p: p.z < -9.7)
        go(30, 0)
        enter("CIRCLE")
        # The nose points north: the centre is 8 m ahead.
        places = []
        end = time.monotonic() + 3.0
        while time.monotonic() < end:
            place = wait("LOCAL_POSITION_NED", lambda p: True)
            places.append((place.x - 38, place.y))
        assert max(abs(math.hypot(*place) - 8) for place in places) < 1.5, places[-3:]
        assert {round(math.atan2(y, x)) for x, y in places} >= {-3, -2, -1, 0, 1, 2, 3}
        enter("GUIDED")
        go(30, 25)
        enter("SMART_RTL")
        # Back around the corner, not straight home.
        at(30, 3, within=6)
        wait("HEARTBEAT", lambda beat: not beat.base_mode & mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 30)
        place = wait("LOCAL_POSITION_NED", lambda p: True)
        assert math.hypot(place.x, place.y) < 0.7
    finally:
        link.close()
