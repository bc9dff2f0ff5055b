"""MAVProxy's own shell: parameters, arm, takeoff, guided, land."""

import re
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

PROGRAM = Path(sys.executable).parent / "mavproxy.py"


class Shell:
    def __init__(self, folder: Path, master: str):
        self.process = subprocess.Popen(
            [sys.executable, PROGRAM, f"--master={master}", "--non-interactive", "--default-modules=param,cmdlong,arm,mode,ftp,misc",
             f"--aircraft={folder / 'mavproxy'}", "--dialect=common", "--retries=5"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=folder, text=True, bufsize=1,
        )
        self.text = ""
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            self.text += line

    def type(self, line: str):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def expect(self, pattern: str, timeout: float = 20.0, since: int = 0) -> int:
        """Waits for text; returns where it ends."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if found := re.search(pattern, self.text[since:]):
                return since + found.end()
            time.sleep(0.05)
        raise AssertionError(f"no {pattern!r} within {timeout} s in:\n{self.text[since:]}")

    def stop(self):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


@pytest.fixture
def shell(tmp_path):
    shells = []

    def make(master: str) -> Shell:
        shells.append(Shell(tmp_path, master))
        return shells[-1]

    yield make
    for one in shells:
        one.stop()


def test_a_flight_by_commands_of_the_shell(start, connect, shell):
    vehicle = start("--autopilot", "ardupilot", "--speed", "2", links=("tcpin:0", "udpin:0"))
    watcher = connect(vehicle, 1)
    console = shell(f"tcp:{vehicle.addresses[0]}")
    console.expect(r"Received \d+ parameters", 20)
    console.type("param show LIM_SPEED_H")
    console.expect(r"LIM_SPEED_H\s+8\.0")
    console.type("param set LIM_SPEED_H 6")
    watcher.wait("PARAM_VALUE", lambda value: value.param_id == "LIM_SPEED_H" and value.param_value == 6.0)

    console.type("mode guided")
    watcher.wait("HEARTBEAT", lambda beat: beat.custom_mode == 4)
    console.type("arm throttle")
    watcher.wait("HEARTBEAT", lambda beat: beat.base_mode & 128)
    console.type("takeoff 7")
    watcher.wait("GLOBAL_POSITION_INT", lambda position: abs(position.relative_alt - 7000) < 200, 30)
    console.type("mode land")
    watcher.wait("HEARTBEAT", lambda beat: not beat.base_mode & 128, 60)
