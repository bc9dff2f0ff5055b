"""Obstacles, traffic and remote identification, as pymavlink and MAVSDK see them."""

import math
import socket
import time

import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.transponder import Transponder

WORLD = """
[[box]]
name = "barn"
center = [20.0, 0.0]
size = [2.0, 10.0]
height = 20.0
"""


def test_ranges_of_a_world_reach_pymavlink(start, connect, tmp_path):
    world = tmp_path / "world.toml"
    world.write_text(WORLD)
    client = connect(start("--world", str(world), "--speed", "10"))
    scan = client.connection.recv_match(type="OBSTACLE_DISTANCE", blocking=True, timeout=10)
    assert scan is not None and abs(scan.distances[0] - 1900) < 10 and scan.distances[36] == 4001
    below = client.connection.recv_match(type="DISTANCE_SENSOR", blocking=True, timeout=10)
    assert below is not None and below.orientation == 25 and below.current_distance <= 25


HILL = """
[terrain]
corner = [-100.0, -100.0]
spacing = 200.0
heights = [[4.0, 4.0], [4.0, 4.0]]

[[hill]]
center = [0.0, 50.0]
radius = 30.0
top = 5.0
height = 6.0
"""


def test_a_world_has_ground_with_heights(start, connect, tmp_path):
    """It stands 4 m above the origin's altitude, and the top of the hill, 50 m east, is 10 m above it."""
    world = tmp_path / "world.toml"
    world.write_text(HILL)
    client = connect(start("--world", str(world), "--autopilot", "ardupilot", "--speed", "10"))
    position = client.connection.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=10)
    assert position is not None and abs(position.relative_alt) < 50
    east_deg = 50 / (111_320 * math.cos(math.radians(position.lat / 1e7)))
    heights = []
    for longitude in (position.lon, position.lon + round(east_deg * 1e7)):
        client.connection.mav.terrain_check_send(position.lat, longitude)
        end = time.monotonic() + 10
        while time.monotonic() < end:
            report = client.connection.recv_match(type="TERRAIN_REPORT", blocking=True, timeout=1)
            if report is not None and report.lon == longitude:
                heights.append(report.terrain_height)
                break
    assert len(heights) == 2 and heights[1] - heights[0] == pytest.approx(6.0, abs=0.01)
    assert heights[0] == pytest.approx(position.alt / 1e3, abs=0.1)


def test_vehicles_of_a_fleet_hear_one_another(start, connect):
    vehicle = start("--vehicles", "2", "--ports", "shared", "--traffic", "fleet", "--speed", "10", links=("tcpin:0",))
    client = connect(vehicle, kind="tcp")
    heard, end = {}, time.monotonic() + 10
    while len(heard) < 2 and time.monotonic() < end:
        message = client.connection.recv_match(type="ADSB_VEHICLE", blocking=True, timeout=1)
        if message is not None:
            heard[message.get_srcSystem()] = message.callsign
    assert heard == {1: "LMPC2", 2: "LMPC1"}


@pytest.fixture
def system(start):
    """A vehicle with an aircraft nearby, and MAVSDK connected to it."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    start("--traffic", "3000,0,100,25,90", "--speed", "5", links=(f"udpout:127.0.0.1:{port},onboard",))
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    found = mavsdk.first_autopilot(10.0)
    assert found is not None
    yield found
    mavsdk.destroy()


def test_mavsdks_transponder_plugin_reads_an_aircraft(system):
    transponder = Transponder(system)
    heard = []
    transponder.subscribe_transponder(lambda aircraft, _: heard.append(aircraft))
    transponder.set_rate_transponder(5.0)
    end = time.monotonic() + 10
    while not heard and time.monotonic() < end:
        time.sleep(0.05)
    assert heard and heard[0].callsign.startswith("SIM1")
    assert abs(heard[0].horizontal_velocity_m_s - 25) < 0.1
    assert abs(heard[0].absolute_altitude_m - 588) < 0.1
