"""A pilot's radio: pulses by UDP as ArduPilot's test suite sends them, MAVProxy's mode names, and MAVSDK's manual control."""

import json
import re
import socket
import struct
import time

from mavsdk.plugins.action import Action
from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from pymavlink import mavutil

from mavsdk_vehicle import eventually


class Radio:
    """Sixteen channels as `rc_thread_main` of ArduPilot's suite sends them."""

    def __init__(self, address: str):
        host, port = address.rsplit(":", 1)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.to = (host, int(port))
        self.pulses = [1500, 1500, 1000, 1500, 1800, 1000, 1000, 1800] + [1000] * 8
        self.set({})

    def set(self, pulses: dict[int, int]) -> None:
        for channel, pulse in pulses.items():
            self.pulses[channel - 1] = pulse
        self.socket.sendto(struct.pack("<16H", *self.pulses), self.to)


def wait(connection, what: str, condition, seconds: float = 30.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        message = connection.recv_match(blocking=True, timeout=1.0)
        if message is not None and condition(message):
            return message
    raise AssertionError(f"not within {seconds} s: {what}")


def in_mode(name: str):
    number = mavutil.mode_mapping_acm
    return lambda message: message.get_type() == "HEARTBEAT" and number[message.custom_mode] == name


def test_ardupilot_takes_off_with_the_throttle(start, tmp_path):
    ready = tmp_path / "radio.json"
    vehicle = start("--autopilot", "ardupilot", "--rc-port", "0", "--speed", "8", "--record", str(tmp_path / "record"))
    # The vehicle is ready before its banner is printed.
    radio_line = re.compile(r"radio of system \d+: UDP (\S+)\n")
    eventually("the address of the radio", lambda: radio_line.search(vehicle.output()))
    address = radio_line.search(vehicle.output())[1]
    connection = mavutil.mavlink_connection(f"udpout:{vehicle.addresses[0]}", source_system=255)
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    radio = Radio(address)
    connection.wait_heartbeat(timeout=10)
    wait(connection, "STABILIZE by the mode switch", in_mode("STABILIZE"))
    for name in ("ACRO", "ALT_HOLD", "POSHOLD", "BRAKE", "LOITER"):
        connection.set_mode(connection.mode_mapping()[name])
        wait(connection, name, in_mode(name))
    connection.arducopter_arm()
    wait(connection, "armed", lambda message: message.get_type() == "HEARTBEAT" and message.base_mode & 128)
    radio.set({3: 1700})
    height = lambda m: m.get_type() == "GLOBAL_POSITION_INT" and m.relative_alt > 8000  # noqa: E731
    wait(connection, "8 m", height)
    radio.set({3: 1500})
    told = wait(connection, "RC_CHANNELS", lambda m: m.get_type() == "RC_CHANNELS" and m.chan3_raw == 1500)
    assert told.chancount == 16 and told.chan5_raw == 1800
    # FLTMODE3 of ArduPilot's simulation.
    radio.set({5: 1425})
    wait(connection, "RTL", in_mode("RTL"))
    radio.set({3: 1000})
    wait(connection, "disarmed", lambda message: message.get_type() == "HEARTBEAT" and not message.base_mode & 128)
    connection.close()
    assert not ready.exists() or json.loads(ready.read_text())


def test_mavsdk_flies_by_hand(fly):  # noqa: F811
    system = fly("--speed", "2", "--set", "NAV_RCL_ACT=1")
    telemetry, action, manual = Telemetry(system), Action(system), ManualControl(system)
    eventually("health", telemetry.health_all_ok)

    def centred_and(condition) -> bool:
        manual.set_manual_control_input(0.0, 0.0, 0.5, 0.0)
        return condition()

    manual.set_manual_control_input(0.0, 0.0, 0.5, 0.0)
    action.arm()
    action.takeoff()
    eventually("airborne", lambda: centred_and(lambda: telemetry.position().relative_altitude_m > 2.0))
    manual.set_manual_control_input(0.0, 0.0, 0.5, 0.0)
    manual.start_altitude_control()
    eventually("altitude mode", lambda: telemetry.flight_mode() == FlightMode.ALTCTL)
    for _ in range(40):
        manual.set_manual_control_input(0.0, 0.0, 1.0, 0.0)
        time.sleep(0.05)
    eventually("climbed", lambda: telemetry.position().relative_altitude_m > 4.0)
    # Nobody moves the sticks any more.
    eventually("hold", lambda: telemetry.flight_mode() == FlightMode.HOLD)
