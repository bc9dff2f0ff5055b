"""MAVSDK from PyPI: connect, health, parameters, takeoff, go-to, offboard, return, land."""

import math

import pytest
from mavsdk.plugins.action import Action
from mavsdk.plugins.action.action import ActionError, ActionResult
from mavsdk.plugins.events import Events
from mavsdk.plugins.events.events import EventsError
from mavsdk.plugins.info import Info
from mavsdk.plugins.offboard import Offboard, PositionNedYaw, VelocityBodyYawspeed, VelocityNedYaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.param.param import ParamError, ParamResult
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from mavsdk.plugins.winch import Winch
from mavsdk.plugins.winch.winch import WinchError, WinchResult

from mavsdk_vehicle import eventually


def test_takeoff_goto_return(fly):
    system = fly("--speed", "2", "--set", "RTL_RETURN_ALT=6")
    telemetry, action, info = Telemetry(system), Action(system), Info(system)
    eventually("health", telemetry.health_all_ok)
    assert telemetry.health().is_armable
    version = info.get_version()
    version = version[1] if isinstance(version, tuple) else version
    # The conventions that are kept.
    assert (version.flight_sw_major, version.flight_sw_minor) == (1, 16)

    action.set_takeoff_altitude(4.0)
    action.arm()
    action.takeoff()
    eventually("in the air", telemetry.in_air)
    eventually("4 m", lambda: abs(telemetry.position().relative_altitude_m - 4) < 0.2)

    home = telemetry.home()
    action.goto_location(home.latitude_deg + 1e-4, home.longitude_deg, home.absolute_altitude_m + 5, 90.0)
    eventually("go-to", lambda: abs(telemetry.position().latitude_deg - home.latitude_deg - 1e-4) < 3e-6
               and abs(telemetry.heading().heading_deg - 90) < 3, 30)
    action.hold()
    action.return_to_launch()
    eventually("home and disarmed", lambda: not telemetry.armed(), 60)
    assert not telemetry.in_air()
    assert math.dist((telemetry.position().latitude_deg, telemetry.position().longitude_deg),
                     (home.latitude_deg, home.longitude_deg)) < 3e-6


def test_offboard(fly):
    system = fly()
    telemetry, action, offboard = Telemetry(system), Action(system), Offboard(system)
    eventually("health", telemetry.health_all_ok)
    action.arm()
    action.takeoff()
    eventually("2.5 m", lambda: abs(telemetry.position().relative_altitude_m - 2.5) < 0.2)

    offboard.set_position_ned(PositionNedYaw(3.0, 1.0, -5.0, 0.0))
    offboard.start()
    place = lambda: telemetry.position_velocity_ned().position  # noqa: E731
    eventually("place", lambda: math.dist((place().north_m, place().east_m, place().down_m), (3, 1, -5)) < 0.2)
    offboard.set_velocity_ned(VelocityNedYaw(0.0, 2.0, 0.0, 0.0))
    eventually("2 m/s east", lambda: abs(telemetry.velocity_ned().east_m_s - 2) < 0.1)
    offboard.set_velocity_body(VelocityBodyYawspeed(0.0, 0.0, -0.5, 20.0))
    eventually("climbs", lambda: abs(telemetry.velocity_ned().down_m_s + 0.5) < 0.1)
    eventually("turns", lambda: abs(telemetry.attitude_angular_velocity_body().yaw_rad_s - math.radians(20)) < 0.05)
    offboard.stop()
    eventually("holds", lambda: abs(telemetry.velocity_ned().down_m_s) < 0.05)
    action.land()
    eventually("disarmed", lambda: not telemetry.armed(), 60)


def test_parameters(fly):
    param = Param(fly())
    every = param.get_all_params()
    every = every[1] if isinstance(every, tuple) else every
    names = {one.name for one in [*every.int_params, *every.float_params]}
    assert {"MIS_TAKEOFF_ALT", "COM_OBL_RC_ACT", "LIM_SPEED_HORIZ", "POS_R_PITCH", "FRAME_MASS"} <= names
    param.set_param_float("LIM_SPEED_HORIZ", 5.0)
    value = param.get_param_float("LIM_SPEED_HORIZ")
    assert (value[1] if isinstance(value, tuple) else value) == pytest.approx(5.0)
    # Former names are still answered.
    param.set_param_float("LIM_SPEED_H", 6.0)
    value = param.get_param_float("LIM_SPEED_H")
    assert (value[1] if isinstance(value, tuple) else value) == pytest.approx(6.0)
    param.set_param_int("COM_OBL_RC_ACT", 4)
    value = param.get_param_int("COM_OBL_RC_ACT")
    assert (value[1] if isinstance(value, tuple) else value) == 4


def test_a_refused_parameter_leaves_no_answer_for_the_next(fly):
    system = fly()
    action, param = Action(system), Param(system)
    for height in (15.0, 16.0, 17.0):
        with pytest.raises(ActionError) as refused:
            action.set_takeoff_altitude(-3.0)
        assert refused.value.result == ActionResult.PARAMETER_ERROR
        action.set_takeoff_altitude(height)
        value = action.get_takeoff_altitude()
        assert (value[1] if isinstance(value, tuple) else value) == height
    with pytest.raises(ParamError) as refused:
        param.set_param_int("FRAME_MASS", 1)
    assert refused.value.result == ParamResult.TYPE_MISMATCH


def test_what_is_not_there_is_refused(fly):
    system = fly()
    with pytest.raises(WinchError) as refused:
        Winch(system).relax(0)
    # Not TIMEOUT, which silence would be.
    assert refused.value.result == WinchResult.UNSUPPORTED


def test_health_and_arming_checks_are_told_to_who_asks(fly):
    system = fly("--speed", "2")
    events, telemetry = Events(system), Telemetry(system)
    eventually("health", telemetry.health_all_ok)

    def report():
        try:
            return events.get_health_and_arming_checks_report()
        except EventsError:
            return None

    eventually("a report", lambda: report() is not None)
    told = report()
    told = told[1] if isinstance(told, tuple) else told
    assert told.current_mode_intention.can_arm_or_run, told
    assert {"gps", "battery"} <= {component.name for component in told.health_components}


def test_hold_stops_on_the_way(fly):
    system = fly("--speed", "2")
    telemetry, action = Telemetry(system), Action(system)
    eventually("health", telemetry.health_all_ok)
    action.arm()
    action.takeoff()
    eventually("2.5 m", lambda: abs(telemetry.position().relative_altitude_m - 2.5) < 0.2)
    home = telemetry.home()
    action.goto_location(home.latitude_deg + 1e-3, home.longitude_deg, home.absolute_altitude_m + 5, 0.0)
    eventually("on its way", lambda: telemetry.velocity_ned().north_m_s > 5)
    action.hold()
    eventually("at rest", lambda: abs(telemetry.velocity_ned().north_m_s) < 0.1)
    # The place that it was to go to is 111 m away.
    assert telemetry.position().latitude_deg - home.latitude_deg < 4e-4
    assert telemetry.flight_mode() == FlightMode.HOLD
    action.land()
    eventually("disarmed", lambda: not telemetry.armed(), 60)


def test_the_origin_of_the_local_frame_moves_and_the_vehicle_does_not(fly):
    system = fly("--speed", "2", "--home", "47.0,8.0,400")
    telemetry, action, offboard = Telemetry(system), Action(system), Offboard(system)
    eventually("health", telemetry.health_all_ok)
    # 1e-4 of a degree of latitude is 11.1 m there.
    action.set_gps_global_origin(46.9999, 8.0, 390.0)
    origin = telemetry.get_gps_global_origin()
    assert (origin.latitude_deg, origin.longitude_deg) == pytest.approx((46.9999, 8.0), abs=1e-7)
    assert origin.altitude_m == pytest.approx(390.0, abs=1e-3)
    place = lambda: telemetry.position_velocity_ned().position  # noqa: E731
    north_m, down_m = 11.117, -10.0
    eventually("it is north of the origin and above it", lambda: math.dist((place().north_m, place().east_m, place().down_m), (north_m, 0, down_m)) < 0.1)
    assert telemetry.position().latitude_deg == pytest.approx(47.0, abs=1e-6)
    action.arm()
    offboard.set_position_ned(PositionNedYaw(north_m, 2.0, down_m - 5.0, 0.0))
    offboard.start()
    # 2 m east of its place, 5 m up.
    degree_m = 111_320 * math.cos(math.radians(47))
    eventually("there", lambda: abs((telemetry.position().longitude_deg - 8.0) * degree_m - 2.0) < 0.1
               and abs(telemetry.position().latitude_deg - 47.0) < 2e-6 and abs(telemetry.position().relative_altitude_m - 5.0) < 0.1, 30)
