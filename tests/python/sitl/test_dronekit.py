"""DroneKit, as its guide and its examples use it: what they do is what is done here, in their words."""

import collections
import collections.abc
import math
import time

import pytest

# DroneKit 2.9.2 is older than Python 3.10, which has these names in collections.abc only.
for name in ("MutableMapping", "Mapping", "Callable"):
    if not hasattr(collections, name):
        setattr(collections, name, getattr(collections.abc, name))

from dronekit import Command, LocationGlobal, LocationGlobalRelative, VehicleMode, connect  # noqa: E402
from pymavlink import mavutil  # noqa: E402

SPEED = 16


def wait(condition, what: str, timeout: float = 30.0):
    end = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < end, f"not within {timeout} s: {what}"
        time.sleep(0.02)


@pytest.fixture
def vehicle(start):
    """Connected as every example begins."""
    program = start("--autopilot", "ardupilot", "--speed", str(SPEED), links=("tcpin:0",))
    vehicle = connect(f"tcp:{program.addresses[0]}", wait_ready=True, timeout=60)
    yield vehicle
    vehicle.close()


def arm_and_takeoff(vehicle, altitude: float):
    """The function of the guide."""
    wait(lambda: vehicle.is_armable, "is_armable")
    vehicle.mode = VehicleMode("GUIDED")
    wait(lambda: vehicle.mode.name == "GUIDED", "GUIDED")
    vehicle.armed = True
    wait(lambda: vehicle.armed, "armed")
    vehicle.simple_takeoff(altitude)
    wait(lambda: vehicle.location.global_relative_frame.alt >= altitude * 0.95, "altitude")


def get_location_metres(original, north: float, east: float):
    radius = 6378137.0
    lat = original.lat + math.degrees(north / radius)
    lon = original.lon + math.degrees(east / (radius * math.cos(math.radians(original.lat))))
    return type(original)(lat, lon, original.alt)


def get_distance_metres(one, other) -> float:
    return math.hypot(other.lat - one.lat, (other.lon - one.lon) * math.cos(math.radians(one.lat))) * 1.113195e5


def goto(vehicle, north: float, east: float, **options):
    """Of the example guided_set_speed_yaw: until it is as near as the example wants it."""
    target = get_location_metres(vehicle.location.global_relative_frame, north, east)
    vehicle.simple_goto(target, **options)
    wait(lambda: get_distance_metres(vehicle.location.global_relative_frame, target) < 0.5, "the target")


def test_simple_goto(vehicle):
    """Of the example simple_goto: two points, one with a ground speed, then home."""
    arm_and_takeoff(vehicle, 10)
    vehicle.airspeed = 3
    start = vehicle.location.global_relative_frame
    vehicle.simple_goto(get_location_metres(start, 20, 10))
    wait(lambda: get_distance_metres(start, vehicle.location.global_relative_frame) > 22, "the first point")
    fastest = 0.0
    point = get_location_metres(start, -50, -30)
    vehicle.simple_goto(point, groundspeed=7)
    while get_distance_metres(vehicle.location.global_relative_frame, point) > 1:
        fastest = max(fastest, vehicle.groundspeed)
        time.sleep(0.02)
    assert fastest == pytest.approx(7, abs=0.1)
    vehicle.mode = VehicleMode("RTL")
    wait(lambda: not vehicle.armed, "landed at home", 60)
    assert get_distance_metres(start, vehicle.location.global_relative_frame) < 1


def test_a_goto_during_the_takeoff_takes_over(vehicle):
    """The guide: "if another command arrives before that point it will be run instead"."""
    wait(lambda: vehicle.is_armable, "is_armable")
    vehicle.mode = VehicleMode("GUIDED")
    vehicle.armed = True
    wait(lambda: vehicle.armed and vehicle.mode.name == "GUIDED", "armed")
    vehicle.simple_takeoff(60)
    wait(lambda: vehicle.location.global_relative_frame.alt > 1, "off the ground")
    home = vehicle.location.global_frame
    vehicle.simple_goto(LocationGlobalRelative(home.lat + 1e-4, home.lon, 8))
    wait(lambda: get_distance_metres(vehicle.location.global_frame, home) > 10.5, "the target")
    wait(lambda: abs(vehicle.location.global_relative_frame.alt - 8) < 0.3, "its altitude")


def test_guided_set_speed_yaw(vehicle):
    """Of the example of that name: velocities, yaw and region of interest in its own messages."""
    factory = vehicle.message_factory
    frame = mavutil.mavlink.MAV_FRAME_LOCAL_NED

    def send_ned_velocity(x, y, z, until, what):
        """Each second of the vehicle's, as the example does, until something is so: on a busy machine, a second is late."""
        message = factory.set_position_target_local_ned_encode(
            0, 0, 0, frame, 0b0000111111000111, 0, 0, 0, x, y, z, 0, 0, 0, 0, 0)

        def sent():
            vehicle.send_mavlink(message)
            time.sleep(1 / SPEED)
            return until()

        wait(sent, what)

    def flies(component, speed):
        return abs(vehicle.velocity[component] - speed) < 0.2

    def condition_yaw(heading, relative=False):
        vehicle.send_mavlink(factory.command_long_encode(
            0, 0, mavutil.mavlink.MAV_CMD_CONDITION_YAW, 0, heading, 0, 1, int(relative), 0, 0, 0))

    def set_roi(location):
        vehicle.send_mavlink(factory.command_long_encode(
            0, 0, mavutil.mavlink.MAV_CMD_DO_SET_ROI, 0, 0, 0, 0, 0, location.lat, location.lon, location.alt))

    arm_and_takeoff(vehicle, 5)
    home = vehicle.location.local_frame
    condition_yaw(180)
    wait(lambda: abs(vehicle.heading - 180) <= 2, "heading south")
    send_ned_velocity(-2, 0, 0, lambda: flies(0, -2), "south at 2 m/s")
    assert abs(vehicle.heading - 180) <= 3, "the nose points where it flies"
    send_ned_velocity(0, 2, -0.5, lambda: flies(1, 2), "east at 2 m/s")
    send_ned_velocity(0, 2, -0.5, lambda: vehicle.location.local_frame.down < home.down - 1, "a metre higher")
    send_ned_velocity(0, 2, 0, lambda: abs(vehicle.heading - 90) <= 3, "the nose points east")
    send_ned_velocity(0, 0, 0, lambda: flies(1, 0), "a stop")
    condition_yaw(90, relative=True)
    wait(lambda: abs(vehicle.heading - 180) <= 3, "a quarter more")
    set_roi(get_location_metres(vehicle.location.global_relative_frame, 100, 0))
    wait(lambda: min(vehicle.heading, 360 - vehicle.heading) <= 3, "looking north")
    goto(vehicle, 0, -10, groundspeed=5)


def test_mission_basic(vehicle):
    """Of the example of that name: upload, AUTO, next, download."""
    commands = vehicle.commands
    commands.download()
    commands.wait_ready()
    assert commands.count == 0 and vehicle.home_location is not None
    commands.clear()
    here = vehicle.location.global_frame
    waypoint = mavutil.mavlink.MAV_CMD_NAV_WAYPOINT
    relative = mavutil.mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
    commands.add(Command(0, 0, 0, relative, mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 0, 0, 10))
    points = [get_location_metres(here, *offset) for offset in [(15, 0), (15, 15), (0, 15), (0, 15)]]
    for point, height in zip(points, [11, 12, 13, 13]):
        commands.add(Command(0, 0, 0, relative, waypoint, 0, 0, 0, 0, 0, 0, point.lat, point.lon, height))
    commands.upload()
    commands.download()
    commands.wait_ready()
    assert commands.count == 5 and commands[1].command == waypoint

    arm_and_takeoff(vehicle, 10)
    commands.next = 0
    vehicle.mode = VehicleMode("AUTO")
    wait(lambda: vehicle.commands.next == 3, "the third command")
    assert vehicle.mode.name == "AUTO"
    wait(lambda: vehicle.commands.next == 5, "the dummy waypoint at the end")
    vehicle.mode = VehicleMode("RTL")
    wait(lambda: not vehicle.armed, "landed", 60)


def test_vehicle_state(vehicle):
    """Of the example of that name: every attribute, listeners, home and parameters."""
    wait(lambda: vehicle.capabilities.mission_float is not None and vehicle.version.raw_version is not None, "the version")
    for attribute in ("location.global_frame", "location.global_relative_frame", "location.local_frame", "attitude",
                      "velocity", "gps_0", "gimbal", "battery", "ekf_ok", "last_heartbeat", "rangefinder", "heading",
                      "is_armable", "system_status", "groundspeed", "airspeed", "mode", "armed", "version", "channels"):
        value = vehicle
        for part in attribute.split("."):
            value = getattr(value, part)
        assert str(value), attribute
    wait(lambda: vehicle.ekf_ok and vehicle.is_armable, "EKF_STATUS_REPORT")
    assert vehicle.version.vehicle_type == mavutil.mavlink.MAV_TYPE_QUADROTOR and vehicle.gps_0.fix_type >= 3
    assert vehicle.mode.name == "LOITER" and not vehicle.armed

    heard = []

    def listener(_, name, value):
        heard.append((name, value))

    vehicle.add_attribute_listener("location.global_frame", listener)
    wait(lambda: heard, "a location")
    vehicle.remove_attribute_listener("location.global_frame", listener)

    vehicle.commands.download()
    vehicle.commands.wait_ready()
    home = vehicle.home_location
    vehicle.home_location = LocationGlobal(home.lat + 1e-4, home.lon, home.alt)
    vehicle.commands.download()
    vehicle.commands.wait_ready()
    assert vehicle.home_location.lat == pytest.approx(home.lat + 1e-4, abs=2e-5)

    changed = []

    @vehicle.parameters.on_attribute("DISARM_DELAY")
    def on_change(_, name, value):
        changed.append(value)

    assert vehicle.parameters["DISARM_DELAY"] == 10
    vehicle.parameters["DISARM_DELAY"] = 0
    wait(lambda: changed and changed[-1] == 0, "the changed parameter")
    assert vehicle.parameters["DISARM_DELAY"] == 0


def test_channel_overrides(vehicle):
    """Of the example channel_overrides, and the guide: the mode's attribute, overrides that move the vehicle, and their end."""
    arm_and_takeoff(vehicle, 5)
    vehicle.mode = VehicleMode("LOITER")
    wait(lambda: vehicle.mode.name == "LOITER", "LOITER")
    vehicle.channels.overrides = {"1": 1500, "2": 1300, "3": 1500, "4": 1500}
    wait(lambda: vehicle.velocity[0] > 1, "forward")
    vehicle.channels.overrides = {}
    wait(lambda: abs(vehicle.velocity[0]) < 0.2, "standing again")
    vehicle.mode = VehicleMode("LAND")
    wait(lambda: not vehicle.armed, "landed")


def test_what_its_own_tests_expect(vehicle):
    """A parameter of Copter 3.3, channels as numbers, waypoints of far away, and one answer to a calibration, when it is over."""
    assert vehicle.parameters["THR_MIN"] == 130
    vehicle.parameters["THR_MIN"] = 3.0
    assert vehicle.parameters["THR_MIN"] == 3
    wait(lambda: all(isinstance(vehicle.channels[number], int) for number in range(1, 9)), "channels")

    answers = []
    vehicle.add_message_listener("COMMAND_ACK", lambda _, name, message: answers.append((message.command, message.result)))
    calibration = mavutil.mavlink.MAV_CMD_PREFLIGHT_CALIBRATION
    for parameters in ([1, 0, 0, 0, 0], [0, 0, 1, 0, 0], [0, 0, 0, 0, 2]):
        vehicle.send_mavlink(vehicle.message_factory.command_long_encode(0, 0, calibration, 0, *parameters, 0, 0))
        wait(lambda: answers, "an answer")
        time.sleep(3 / SPEED)
        assert answers == [(calibration, mavutil.mavlink.MAV_RESULT_ACCEPTED)], parameters
        answers.clear()
