"""Several vehicles in one program: on a shared port, on their own ports, by one clock or by their own."""

import math
import re
import socket
import subprocess
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.telemetry import Telemetry
import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

import records
from client import PX4_OFFBOARD


def of(system):
    return lambda message: message.get_srcSystem() == system


def aim(client, system):
    """What is sent from now on is for this vehicle."""
    client.target = (system, 1)
    return client


def latest(client, seconds: float, kind="LOCAL_POSITION_NED"):
    """The last message of a kind from each vehicle within a while."""
    found, end = {}, time.monotonic() + seconds
    while time.monotonic() < end:
        message = client.connection.recv_match(type=kind, blocking=True, timeout=0.1)
        if message is not None:
            found[message.get_srcSystem()] = message
    return found


def test_a_client_sees_five_on_one_port_and_flies_two_at_once(start, connect):
    vehicle = start("--vehicles", "5", "--ports", "shared", "--formation", "line,4", "--speed", "4", links=("tcpin:0",))
    client = connect(vehicle, kind="tcp")

    # Everyone is there, at its place, and numbers its own frames without a gap.
    last, places, homes, end = {}, {}, {}, time.monotonic() + 10
    while (len(places), len(homes)) != (5, 5) or min(len(seen) for seen in last.values()) < 300:
        assert time.monotonic() < end, (places, homes)
        message = client.connection.recv_match(blocking=True, timeout=1)
        # From the frame itself: pymavlink has no header of messages that it does not know, such as PX4's events.
        sequence, system = message.get_msgbuf()[4:6]
        last.setdefault(system, []).append(sequence)
        if message.get_type() == "LOCAL_POSITION_NED":
            places[system] = (message.x, message.y)
        if message.get_type() == "HOME_POSITION":
            homes[system] = (message.x, message.y, message.latitude, message.longitude)
    for system in range(1, 6):
        assert math.dist(places[system], (0, 4 * (system - 1))) < 0.05
        assert math.dist(homes[system][:2], (0, 4 * (system - 1))) < 0.05
        numbers = last[system]
        assert all((one + 1) % 256 == other for one, other in zip(numbers, numbers[1:])), numbers
    assert len({home[2:] for home in homes.values()}) == 5

    # Two fly at once, each to its own goal; the others stay as they are.
    for system in (2, 4):
        aim(client, system).command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        client.command(mavlink.MAV_CMD_NAV_TAKEOFF, *[math.nan] * 7)
    for system in (2, 4):
        client.wait("LOCAL_POSITION_NED", lambda p, system=system: of(system)(p) and p.z < -2.3, 20)
    goals = {2: (6.0, 4.0, -5.0), 4: (-6.0, 12.0, -7.0)}

    def send():
        for system, goal in goals.items():
            aim(client, system).position(goal)

    for system in goals:
        send()
        aim(client, system).set_mode(PX4_OFFBOARD)
    arrived, end = {}, time.monotonic() + 20
    while len(arrived) < 2:
        assert time.monotonic() < end, arrived
        send()
        for system, p in latest(client, 0.1).items():
            if system in goals and math.dist((p.x, p.y, p.z), goals[system]) < 0.2:
                arrived[system] = p
    beats, end = {}, time.monotonic() + 20
    while len(beats) < 5:
        assert time.monotonic() < end, beats
        beats.update(latest(client, 0.6, "HEARTBEAT"))
    assert {system: bool(beat.base_mode & 128) for system, beat in beats.items()} == {
        1: False, 2: True, 3: False, 4: True, 5: False}

    # A command to system 0 is for all, and all answer.
    client.drain()
    client.mav.command_long_send(0, 0, mavlink.MAV_CMD_NAV_LAND, 0, *[0] * 7)
    answered = set()
    while answered != {1, 2, 3, 4, 5}:
        answered.add(client.wait("COMMAND_ACK", lambda ack: ack.command == mavlink.MAV_CMD_NAV_LAND).get_srcSystem())
    for system in goals:
        client.wait("HEARTBEAT", lambda beat, system=system: of(system)(beat) and not beat.base_mode & 128, 30)


def free_ports(count: int) -> int:
    """The first of some free UDP ports in a row."""
    for base in range(20_000 + (time.monotonic_ns() // 1000) % 10_000, 40_000, count):
        probes = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
        try:
            for number, probe in enumerate(probes):
                probe.bind(("127.0.0.1", base + number))
            return base
        except OSError:
            continue
        finally:
            for probe in probes:
                probe.close()
    raise AssertionError("no free ports in a row")


def test_mavsdk_flies_the_second_on_its_own_port(start, connect):
    port = free_ports(3)
    vehicle = start("--vehicles", "3", "--speed", "4", links=(f"udpout:127.0.0.1:{port},onboard", "udpin:0"))
    assert [one["system_id"] for one in vehicle.ready["vehicles"]] == [1, 2, 3]
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    try:
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port + 1}")
        system = mavsdk.first_autopilot(10.0)
        assert system is not None and system.get_system_id() == 2
        telemetry, action = Telemetry(system), Action(system)
        end = time.monotonic() + 20
        while not telemetry.health_all_ok():
            assert time.monotonic() < end
            time.sleep(0.05)
        action.arm()
        action.takeoff()
        while abs(telemetry.position().relative_altitude_m - 2.5) > 0.2:
            assert time.monotonic() < end
            time.sleep(0.05)
    finally:
        mavsdk.destroy()
    # The banner says where a program has to listen for each.
    for number in range(3):
        assert re.search(rf"system +{number + 1} at north .* to 127.0.0.1:{port + number} ", vehicle.output())
    # The others have heard nothing of it.
    for one in vehicle.ready["vehicles"]:
        client = connect(vehicle, vehicle.addresses.index(one["addresses"][1]))
        beat = client.wait("HEARTBEAT")
        assert (beat.get_srcSystem(), bool(beat.base_mode & 128)) == (one["system_id"], one["system_id"] == 2)


def elapsed(client, seconds):
    """Simulated seconds per second of each vehicle."""
    client.drain()
    begin, wall = latest(client, 0.4, "ATTITUDE"), time.monotonic()
    time.sleep(seconds)
    client.drain()
    end = latest(client, 0.4, "ATTITUDE")
    return {system: (end[system].time_boot_ms - begin[system].time_boot_ms) / 1e3 / (time.monotonic() - wall) for system in end}


@pytest.mark.alone
def test_clocks_are_one_or_each_their_own(start, connect):
    for clocks, factors in (("shared", (5, 5)), ("separate", (2, 5))):
        client = connect(start("--vehicles", "2", "--ports", "shared", "--clocks", clocks, "--speed", "2"))
        client.wait("HEARTBEAT", of(1))
        aim(client, 2).set_parameter("SIM_SPEEDUP", 5.0)
        found = elapsed(client, 0.8)
        for system, factor in zip((1, 2), factors):
            assert 0.85 * factor < found[system] < 1.15 * factor, (clocks, found)
            client.mav.param_request_read_send(system, 1, b"SIM_SPEEDUP", -1)
            value = client.wait("PARAM_VALUE", lambda value, system=system: of(system)(value) and value.param_id == "SIM_SPEEDUP")
            assert value.param_value == factor


def digests_of(text: str):
    return re.findall(r"digest ([0-9a-f]{16})", text)


def test_a_record_holds_all_vehicles(start, connect, program, tmp_path):
    record, parameters = tmp_path / "fleet.record", tmp_path / "fleet.params"
    vehicle = start("--vehicles", "3", "--ports", "shared", "--record", str(record), "--parameters", str(parameters),
                    "--gusts", "0.5", "--clocks", "separate", "--speed", "5")
    client = connect(vehicle)
    for system in (1, 3):
        aim(client, system).command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        client.command(mavlink.MAV_CMD_NAV_TAKEOFF, *[math.nan] * 7)
    aim(client, 3).set_parameter("MIS_TAKEOFF_ALT", 3.5)
    for system in (1, 3):
        client.wait("LOCAL_POSITION_NED", lambda p, system=system: of(system)(p) and p.z < -2.2, 20)
    vehicle.stop()
    digests = digests_of(vehicle.output())
    assert len(set(digests)) == 3
    result = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0 and digests_of(result.stdout) == digests, result
    # A parameter is kept by the vehicle that it was set on.
    assert not (tmp_path / "fleet-1.params").exists() and not parameters.exists()
    assert "MIS_TAKEOFF_ALT\t3.5\t" in (tmp_path / "fleet-3.params").read_text()

    # What one vehicle was told is left out: its flight is another, and is named.
    lines = records.entries(record)
    told = next(line for line in lines if line.startswith("frame") and line.split()[2] == "2" and "9001" in line.split()[-1])
    records.write(record, [line for line in lines if line != told])
    result = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=60)
    assert result.returncode == 5 and "system 3 differs" in result.stderr, result
