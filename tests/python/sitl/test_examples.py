"""The examples fly as they are, and hold their own bounds."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
# The others are what these share.
NAMES = sorted(file.stem for file in EXAMPLES.glob("*.py") if file.stem != "flight")


@pytest.mark.parametrize("name", NAMES)
def test_example(start, tmp_path, name):
    fleet = ("--vehicles", "5", "--ports", "shared", "--formation", "circle,6") if name == "five_vehicles" else ()
    # Set-points that are streamed come late when the machine is busy, and the later the faster the vehicle's time.
    speed = "3" if name == "circle" else "8"
    vehicle = start("--speed", speed, *fleet)
    plot = tmp_path / "flight.png"
    done = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py", "--connect", f"udpout:{vehicle.addresses[0]}", "--plot", plot],
        capture_output=True, text=True, timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "at most" in done.stdout and plot.read_bytes().startswith(b"\x89PNG")


def test_a_missing_vehicle_is_told(tmp_path):
    done = subprocess.run([sys.executable, EXAMPLES / "circle.py", "--connect", "udpout:127.0.0.1:9"], cwd=tmp_path,
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "no vehicle at udpout:127.0.0.1:9" in done.stderr
