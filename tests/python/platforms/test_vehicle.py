"""`lmpc-sitl` on each platform: the same flight, and one from pymavlink."""

import math
import re

import pytest

from client import Client

EVENTFUL = ("--link", "udpin:127.0.0.1:0", "--speed", "max", "--sensors", "realistic", "--wind", "5",
            "--autostart", "--duration", "40")


def test_it_says_what_it_is(platform):
    version = platform.run(platform.vehicle, "--version")
    assert version.returncode == 0 and re.fullmatch(r"lmpc-sitl \d+\.\d+\.\d+\s*", version.stdout), version
    assert "--speed" in platform.run(platform.vehicle, "--help").stdout
    mistake = platform.run(platform.vehicle, "--speed", "-3")
    assert mistake.returncode == 2 and mistake.stderr.startswith("lmpc-sitl: --speed: "), mistake


@pytest.fixture(scope="module")
def mission(tmp_path_factory):
    lines = ["QGC WPL 110", "0 1 3 22 0 0 0 0 47.397742 8.545594 10 1", "1 0 3 16 0 0 0 0 47.3979 8.5458 12 1", "2 0 3 20 0 0 0 0 0 0 0 1"]
    path = tmp_path_factory.mktemp("mission") / "hop.plan"
    path.write_text("\n".join(line.replace(" ", "\t") if line[0].isdigit() else line for line in lines) + "\n")
    return path


@pytest.fixture(scope="module")
def digests(built, mission):
    """Hashes of all that was flown."""
    found = {}
    for name, platform in built.items():
        result = platform.run(platform.vehicle, *EVENTFUL, "--mission", mission)
        said = result.stdout + result.stderr
        assert result.returncode == 0 and "Mission complete" in said and "landing" in said, said
        found[name] = re.search(r"digest (\w+)", result.stdout)[1]
    return found


def test_the_same_flight_on_every_platform(digests):
    assert len(set(digests.values())) == 1, digests


def test_pymavlink_flies_it(platform, tmp_path):
    vehicle = platform.start(tmp_path, "--speed", "5", "--duration", "600")
    try:
        client = Client(vehicle.address)
        try:
            client.take_off()
            client.land()
            at_rest = client.wait("LOCAL_POSITION_NED")
            assert math.hypot(at_rest.x, at_rest.y) < 0.3 and abs(at_rest.z) < 0.2
        finally:
            client.close()
    except AssertionError as error:
        raise AssertionError(f"{error}\n{vehicle.said()}") from error
    finally:
        vehicle.stop()
    assert "panicked" not in vehicle.said()
