"""MAVProxy, run as its users run it: its own shell connects, reads and changes parameters, arms, takes off, goes somewhere and lands."""

import math
import re
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

PROGRAM = Path(sys.executable).parent / "mavproxy.py"
# Those that a flight by hand needs; others are for maps, cameras and joysticks.
MODULES = "param,ftp,cmdlong,arm,mode,fence"


class Shell:
    def __init__(self, folder: Path, master: str):
        self.process = subprocess.Popen(
            [sys.executable, PROGRAM, f"--master={master}", f"--default-modules={MODULES}", f"--aircraft={folder / 'mavproxy'}",
             "--retries=5"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=folder, text=True, bufsize=1,
        )
        self.text = ""
        self.reader = threading.Thread(target=self.read)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            self.text += line

    def type(self, line: str) -> int:
        """Types a line; returns where its answer begins."""
        place = len(self.text)
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return place

    def expect(self, pattern: str, since: int = 0, timeout: float = 20.0) -> re.Match:
        """Waits for text."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if found := re.search(pattern, self.text[since:]):
                return found
            time.sleep(0.05)
        raise AssertionError(f"no {pattern!r} within {timeout} s in:\n{self.text[since:]}")

    def ask(self, line: str, pattern: str) -> re.Match:
        return self.expect(pattern, self.type(line))

    def stop(self):
        # Asked politely it takes ten seconds to leave.
        self.process.kill()
        self.process.wait()
        self.reader.join()


@pytest.fixture
def shell(tmp_path):
    shells = []

    def make(master: str) -> Shell:
        shells.append(Shell(tmp_path, master))
        return shells[-1]

    yield make
    for one in shells:
        one.stop()


def armed(beat) -> bool:
    return bool(beat.base_mode & 128)


def test_a_flight_in_guided_mode(start, connect, shell):
    vehicle = start("--autopilot", "ardupilot", "--speed", "4", links=("tcpin:0", "udpin:0"))
    watcher = connect(vehicle, 1)
    console = shell(f"tcp:{vehicle.addresses[0]}")
    # As a file, at once: not one by one after a timeout.
    assert int(console.expect(r"Received (\d+) parameters \(ftp\)", timeout=60)[1]) > 70
    assert float(console.ask("param show LIM_SPEED_HORIZ", r"LIM_SPEED_HORIZ\s+(\S+)")[1]) == 8.0
    end, typed = time.monotonic() + 20, None
    while watcher.parameter("LIM_SPEED_HORIZ").param_value != 6.0:
        assert time.monotonic() < end, f"the parameter was not set:\n{console.text}"
        if typed is None or time.monotonic() - typed > 5:
            console.type("param set LIM_SPEED_HORIZ 6")
            typed = time.monotonic()
    # The vehicle has told it; MAVProxy, a program of its own, may still have to read that.
    end = time.monotonic() + 20
    while float(console.ask("param show LIM_SPEED_HORIZ", r"LIM_SPEED_HORIZ\s+(\S+)")[1]) != 6.0:
        assert time.monotonic() < end, f"MAVProxy shows the former value:\n{console.text}"
        time.sleep(0.2)
    # Refused, and it says why.
    console.ask("param set LIM_TILT 9", "LIM_TILT = 9 rad; allowed 0.05 to 1.2 rad")

    console.ask("mode guided", "GUIDED> |Mode GUIDED")
    watcher.wait("HEARTBEAT", lambda beat: beat.custom_mode == 4)
    console.ask("arm throttle", "Got COMMAND_ACK: COMPONENT_ARM_DISARM: ACCEPTED")
    watcher.wait("HEARTBEAT", armed)
    console.ask("takeoff 7", "Got COMMAND_ACK: NAV_TAKEOFF: ACCEPTED")
    start_place = watcher.wait("GLOBAL_POSITION_INT", lambda place: abs(place.relative_alt - 7000) < 200, 30)
    # 20 m to the north, 3 m up.
    north_deg = start_place.lat / 1e7 + math.degrees(20 / 6_378_137)
    console.type(f"guided {north_deg:.7f} {start_place.lon / 1e7:.7f} 10")
    watcher.wait("LOCAL_POSITION_NED", lambda p: math.dist((p.x, p.y, p.z), (20, 0, -10)) < 0.2, 30)
    # In the air it is not disarmed.
    console.ask("disarm", "Disarming denied: not landed")
    console.ask("mode land", "LAND> |Mode LAND")
    watcher.wait("HEARTBEAT", lambda beat: not armed(beat), 60)


def test_a_flight_with_px4s_modes(start, connect, shell):
    vehicle = start("--speed", "4", links=("udpin:0", "udpin:0"))
    watcher = connect(vehicle, 1)
    console = shell(f"udpout:{vehicle.addresses[0]}")
    console.expect(r"Received (\d+) parameters \(ftp\)", timeout=60)
    console.ask("arm throttle", "Got COMMAND_ACK: COMPONENT_ARM_DISARM: ACCEPTED")
    # MAVProxy means a height above home; PX4 takes an altitude that is below the ground for "as the parameter says".
    console.ask("takeoff 7", "Got COMMAND_ACK: NAV_TAKEOFF: ACCEPTED")
    watcher.wait("LOCAL_POSITION_NED", lambda p: abs(p.z + 2.5) < 0.1 and abs(p.vz) < 0.1, 30)
    # Its `mode` fails with PX4's numbers before it sends anything; commands do not.
    console.ask("long NAV_RETURN_TO_LAUNCH 0 0 0 0 0 0 0", "Got COMMAND_ACK: NAV_RETURN_TO_LAUNCH: ACCEPTED")
    watcher.wait("HEARTBEAT", lambda beat: beat.custom_mode == (4 << 16 | 5 << 24))
    watcher.wait("HEARTBEAT", lambda beat: not armed(beat), 60)
    console.ask("arm throttle", "Got COMMAND_ACK: COMPONENT_ARM_DISARM: ACCEPTED")
    watcher.wait("HEARTBEAT", armed)
    console.ask("disarm", "Got COMMAND_ACK: COMPONENT_ARM_DISARM: ACCEPTED")
    watcher.wait("HEARTBEAT", lambda beat: not armed(beat))


def test_a_fence_is_loaded_and_kept(start, connect, shell, tmp_path):
    vehicle = start("--autopilot", "ardupilot", "--speed", "4", links=("tcpin:0", "udpin:0"))
    watcher = connect(vehicle, 1)
    console = shell(f"tcp:{vehicle.addresses[0]}")
    console.expect(r"Received (\d+) parameters \(ftp\)", timeout=60)
    home = watcher.wait("GLOBAL_POSITION_INT")
    latitude, longitude = home.lat / 1e7, home.lon / 1e7
    north, east = math.degrees(15 / 6_378_137), math.degrees(15 / 6_378_137 / math.cos(math.radians(latitude)))
    corners = [(-north, -east), (-north, east), (north, east), (north, -east)]
    rows = [f"{index}\t0\t3\t5001\t4\t0\t0\t0\t{latitude + x:.7f}\t{longitude + y:.7f}\t0\t1" for index, (x, y) in enumerate(corners)]
    (tmp_path / "fence.txt").write_text("\n".join(["QGC WPL 110", *rows, ""]))
    console.ask("fence load fence.txt", "Loaded 4 fence|fence present|[Ss]ent all|Fence sent")
    console.ask("fence enable", "[Ff]ence enabled")
    watcher.wait("SYS_STATUS", lambda status: status.onboard_control_sensors_enabled & 1 << 20)
    console.ask("mode guided", "GUIDED> |Mode GUIDED")
    console.ask("arm throttle", "Got COMMAND_ACK: COMPONENT_ARM_DISARM: ACCEPTED")
    console.ask("takeoff 5", "Got COMMAND_ACK: NAV_TAKEOFF: ACCEPTED")
    watcher.wait("GLOBAL_POSITION_INT", lambda place: abs(place.relative_alt - 5000) < 200, 30)
    console.ask(f"guided {latitude + 2 * north:.7f} {longitude:.7f} 5", "rejected: outside the fence")
    console.ask("fence disable", "fence disabled|Fence disabled")
    console.type(f"guided {latitude + 2 * north:.7f} {longitude:.7f} 5")
    watcher.wait("LOCAL_POSITION_NED", lambda place: place.x > 20, 30)
    console.ask("fence enable", "Fence")
