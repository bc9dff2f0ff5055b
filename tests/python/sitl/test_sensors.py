"""Realistic sensors and the estimator behind them, as pymavlink and MAVSDK see them."""

import math

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.telemetry import Telemetry
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import near, patiently
from mavsdk_vehicle import eventually, free_port

GPS = mavlink.MAV_SYS_STATUS_SENSOR_GPS
XY_CONTROL = mavlink.MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL
PREARM = mavlink.MAV_SYS_STATUS_PREARM_CHECK
ABSOLUTE = mavlink.ESTIMATOR_POS_HORIZ_ABS


def asked(client, number, name):
    client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, number)
    return client.wait(name)


def test_the_estimate_is_flown_and_told_and_a_lost_gps_with_it(start, connect):
    client = connect(start(*patiently("--sensors", "realistic", "--speed", "10", "--set", "COM_DISARM_PRFLT=-1", "--set", "SYS_FAILURE_EN=1")))
    client.wait("SYS_STATUS", lambda status: status.onboard_control_sensors_health & PREARM)
    client.take_off()
    goal = (6.0, -4.0, -5.0)
    client.go(lambda: client.position(goal))
    client.stream(lambda: client.position(goal), near(goal, 0.3, 0.3))

    # What is told is an estimate: beside the truth, and with a figure for how good it is.
    client.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_SIM_STATE, 100_000)
    truth, told = client.wait("SIM_STATE"), client.wait("GLOBAL_POSITION_INT")
    north_m = (told.lat - truth.lat_int) * 1e-7 * 111_194.9
    east_m = (told.lon - truth.lon_int) * 1e-7 * 111_194.9 * math.cos(math.radians(told.lat * 1e-7))
    assert 0.0 < math.hypot(north_m, east_m) < 1.5
    status = asked(client, mavlink.MAVLINK_MSG_ID_ESTIMATOR_STATUS, "ESTIMATOR_STATUS")
    assert status.flags & ABSOLUTE and 0.0 < status.pos_horiz_accuracy < 2.0, str(status)
    imu = asked(client, mavlink.MAVLINK_MSG_ID_SCALED_IMU, "SCALED_IMU")
    assert abs(imu.zacc + 1000) < 100, str(imu)
    fix = asked(client, mavlink.MAVLINK_MSG_ID_GPS_RAW_INT, "GPS_RAW_INT")
    assert fix.fix_type == mavlink.GPS_FIX_TYPE_3D_FIX and fix.h_acc > 1000, str(fix)

    client.command(mavlink.MAV_CMD_INJECT_FAILURE, mavlink.FAILURE_UNIT_SENSOR_GPS, mavlink.FAILURE_TYPE_OFF)
    client.wait("SYS_STATUS", lambda status: not status.onboard_control_sensors_health & (GPS | XY_CONTROL))
    fix = asked(client, mavlink.MAVLINK_MSG_ID_GPS_RAW_INT, "GPS_RAW_INT")
    assert fix.fix_type == mavlink.GPS_FIX_TYPE_NO_FIX, str(fix)
    status = asked(client, mavlink.MAVLINK_MSG_ID_ESTIMATOR_STATUS, "ESTIMATOR_STATUS")
    assert not status.flags & ABSOLUTE and status.flags & mavlink.ESTIMATOR_ATTITUDE, str(status)
    client.command(mavlink.MAV_CMD_INJECT_FAILURE, mavlink.FAILURE_UNIT_SENSOR_GPS, mavlink.FAILURE_TYPE_OK)
    wanted = GPS | XY_CONTROL
    client.wait("SYS_STATUS", lambda status: status.onboard_control_sensors_health & wanted == wanted)


def test_mavsdk_waits_for_the_estimator_and_flies(start):
    port = free_port()
    vehicle = start(
        "--sensors", "realistic", "--speed", "5", links=(f"udpout:127.0.0.1:{port},onboard",))
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    try:
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = mavsdk.first_autopilot(10.0)
        assert system is not None, vehicle.output()
        telemetry, action = Telemetry(system), Action(system)
        eventually("health", lambda: telemetry.health_all_ok() and telemetry.health().is_armable)
        action.arm()
        action.takeoff()
        eventually("takeoff", lambda: telemetry.position().relative_altitude_m > 2.2)
        action.land()
        eventually("landing", lambda: not telemetry.armed(), 30)
    finally:
        mavsdk.destroy()
