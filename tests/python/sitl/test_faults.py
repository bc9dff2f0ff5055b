"""Units that break in flight: by pymavlink, by MAVSDK's failure plugin, and by the schedule of the command line."""

import math
import subprocess

import pytest
from mavsdk.plugins.failure import Failure
from mavsdk.plugins.failure.failure import FailureError, FailureType, FailureUnit
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import Telemetry
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from mavsdk_vehicle import eventually

ARMED = mavlink.MAV_MODE_FLAG_SAFETY_ARMED


def fly_down(client, texts, timeout: float = 30.0):
    """Follows a vehicle until it is disarmed; the largest tilt, degrees, above half a metre and what it said."""
    largest, height = 0.0, math.inf
    while True:
        message = client.wait(["ATTITUDE", "LOCAL_POSITION_NED", "STATUSTEXT", "HEARTBEAT"], timeout=timeout)
        match message.get_type():
            case "ATTITUDE" if height > 0.5:
                largest = max(largest, math.degrees(math.acos(math.cos(message.roll) * math.cos(message.pitch))))
            case "LOCAL_POSITION_NED":
                height = -message.z
            case "STATUSTEXT":
                texts.append(message.text)
            case "HEARTBEAT" if not message.base_mode & ARMED:
                return largest


def test_rotor_off_lands_without_tumbling(start, connect, program, tmp_path):
    record = tmp_path / "flight.record"
    vehicle = start("--speed", "10", "--record", str(record), "--fault", "0:gps=off", "--fault", "0.5:gps=ok",
                    "--set", "SYS_FAILURE_EN=1")
    client = connect(vehicle)
    client.take_off(altitude=498.0, height=10.0)
    client.drain()
    client.command(mavlink.MAV_CMD_INJECT_FAILURE, mavlink.FAILURE_UNIT_SYSTEM_MOTOR, mavlink.FAILURE_TYPE_OFF, 3)
    texts = []
    tilt = fly_down(client, texts)
    assert 20 < tilt < 40, f"{tilt} degrees"
    assert "Rotor 3 lost: descending without yaw control" in texts, texts
    assert "Disarmed: landed without rotor 3" in texts, texts
    landed = mavlink.MAV_LANDED_STATE_ON_GROUND
    client.wait("EXTENDED_SYS_STATE", lambda state: state.landed_state == landed, 10)
    rest = client.wait("ATTITUDE", lambda attitude: abs(attitude.yawspeed) < 0.05)
    assert abs(rest.roll) < 0.05 and abs(rest.pitch) < 0.05, rest
    # Broken, it does not fly again; what has no meaning is refused.
    client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1, result=mavlink.MAV_RESULT_TEMPORARILY_REJECTED)
    client.command(mavlink.MAV_CMD_INJECT_FAILURE, mavlink.FAILURE_UNIT_SENSOR_VIO, mavlink.FAILURE_TYPE_OFF,
                   result=mavlink.MAV_RESULT_UNSUPPORTED)
    # Flown again, faults and all, it is the same flight bit for bit.
    assert vehicle.stop() == 0
    flown = vehicle.output().split("digest ")[1].split()[0]
    replayed = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=20)
    assert replayed.returncode == 0 and flown in replayed.stdout, replayed


def test_mavsdk_injects(fly):  # noqa: F811
    system = fly("--speed", "10", "--set", "SYS_FAILURE_EN=1")
    failure, telemetry = Failure(system), Telemetry(system)
    eventually("a battery", lambda: telemetry.battery().remaining_percent > 90)
    failure.inject(FailureUnit.SYSTEM_BATTERY, FailureType.OFF, 0)
    eventually("an empty battery", lambda: telemetry.battery().remaining_percent == 0)
    failure.inject(FailureUnit.SYSTEM_BATTERY, FailureType.OK, 0)
    eventually("a battery", lambda: telemetry.battery().remaining_percent > 90)
    with pytest.raises(FailureError, match="UNSUPPORTED"):
        failure.inject(FailureUnit.SENSOR_AIRSPEED, FailureType.OFF, 0)


def test_mavsdk_is_told_that_it_is_disabled_until_it_is_not(fly):  # noqa: F811
    """As with PX4."""
    system = fly("--speed", "10")
    with pytest.raises(FailureError, match="DISABLED|DENIED"):
        Failure(system).inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
    Param(system).set_param_int("SYS_FAILURE_EN", 1)
    Failure(system).inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)


def test_faults_of_the_command_line(start, connect):
    vehicle = start("--speed", "10", "--fault", "3:battery=wrong", "--fault", "5:battery=ok")
    client = connect(vehicle)
    client.wait("SYS_STATUS", lambda status: 0 < status.battery_remaining < 15)
    client.wait("SYS_STATUS", lambda status: status.battery_remaining > 90)


def test_wrong_faults_end_the_program_with_the_reason(program):
    for fault, reason in (("1:rotor9=off", "unknown unit `rotor9`"), ("1:gps=weak", "cannot be `weak`"), ("gps=off", "SECONDS:UNIT=KIND"),
                          ("1:gps=wrong", "needs --sensors realistic")):
        ended = subprocess.run([program, "--fault", fault], capture_output=True, text=True, timeout=10)
        assert ended.returncode == 2 and reason in ended.stderr and "--fault" in ended.stderr, ended
