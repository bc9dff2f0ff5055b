"""The examples fly as they are, and hold their own bounds."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
# Those that need a vehicle of their own. Set-points that are streamed come late when the machine is busy, and the later the faster
# the vehicle's time.
ALONE = {
    "circle": ("--speed", "2"),
    "five_vehicles": ("--speed", "8", "--vehicles", "5", "--ports", "shared", "--formation", "circle,6"),
}
# "flight" is what they share.
OTHERS = sorted(file.stem for file in EXAMPLES.glob("*.py") if file.stem not in ("flight", *ALONE))


def fly(name, vehicle, tmp_path):
    plot = tmp_path / f"{name}.png"
    done = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py", "--connect", f"udpout:{vehicle.addresses[0]}", "--plot", plot],
        capture_output=True, text=True, timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "at most" in done.stdout and plot.read_bytes().startswith(b"\x89PNG")


@pytest.mark.alone
@pytest.mark.parametrize("name", ALONE)
def test_example(start, tmp_path, name):
    fly(name, start(*ALONE[name]), tmp_path)


def test_examples_fly_one_after_the_other(start, tmp_path):
    """Each from where the one before has left the vehicle."""
    vehicle = start("--speed", "8")
    for name in OTHERS:
        fly(name, vehicle, tmp_path)


def test_vehicles_that_do_not_fit_the_example_are_told_how_to_start(start, tmp_path):
    vehicle = start("--vehicles", "5", "--ports", "shared")
    done = subprocess.run([sys.executable, EXAMPLES / "five_vehicles.py", "--connect", f"udpout:{vehicle.addresses[0]}"], cwd=tmp_path,
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "start them with --vehicles 5 --ports shared --formation circle,6" in done.stderr


def test_a_missing_vehicle_is_told(tmp_path):
    done = subprocess.run([sys.executable, EXAMPLES / "circle.py", "--connect", "udpout:127.0.0.1:9"], cwd=tmp_path,
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "no vehicle at udpout:127.0.0.1:9" in done.stderr
