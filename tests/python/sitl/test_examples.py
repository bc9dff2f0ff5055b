"""The examples fly as they are, and hold their own bounds; what they cannot do they say in one line."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
# In lock-step the vehicle waits for the example at any speed. Without it set-points that are streamed come late when the machine is
# busy, and the later the faster the vehicle's time.
LOCKSTEP = ("--speed", "max", "--lockstep", "always")
FIVE = ("--vehicles", "5", "--ports", "shared", "--formation", "circle,6")
# Those that fly one vehicle; "flight" is what they share, and "sweep" flies the FMU.
SINGLE = sorted(file.stem for file in EXAMPLES.glob("*.py") if file.stem not in ("flight", "five_vehicles", "sweep"))


def run(name, vehicle, folder, *arguments):
    return subprocess.run([sys.executable, EXAMPLES / f"{name}.py", "--connect", f"udpout:{vehicle.addresses[0]}", *arguments],
                          cwd=folder, capture_output=True, text=True, timeout=120)


def fly(name, vehicle, tmp_path):
    plot = tmp_path / f"{name}.png"
    done = run(name, vehicle, tmp_path, "--plot", plot)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "at most" in done.stdout and plot.read_bytes().startswith(b"\x89PNG")


def test_examples_fly_one_after_the_other(start, tmp_path):
    """Each from where the one before has left the vehicle."""
    vehicle = start(*LOCKSTEP)
    for name in SINGLE:
        fly(name, vehicle, tmp_path)


@pytest.mark.alone
@pytest.mark.parametrize("options", [("--speed", "2"), ("--speed", "50", "--lockstep")], ids=" ".join)
def test_streamed_circle(start, tmp_path, options):
    fly("circle", start(*options), tmp_path)


def test_five_vehicles(start, tmp_path):
    fly("five_vehicles", start(*LOCKSTEP, *FIVE), tmp_path)


@pytest.mark.parametrize("name, options", [("position_target", ()), ("mission", ()), ("five_vehicles", FIVE)])
def test_too_fast_without_lockstep_is_told_with_its_remedy(start, tmp_path, name, options):
    done = run(name, start("--speed", "1000", *options), tmp_path)
    assert "Traceback" not in done.stderr and done.returncode in (0, 1), done.stderr
    if done.returncode == 1:
        failed = [line for line in (done.stdout + done.stderr).splitlines() if "start the vehicle with --lockstep always" in line]
        assert failed and all(re.search(r"this program cannot keep up with its speed", line) for line in failed), done.stdout + done.stderr
        assert len(done.stderr.splitlines()) <= 1, done.stderr


def test_a_vehicle_that_ends_in_flight_is_told_in_one_line(start, tmp_path):
    vehicle = start(*LOCKSTEP, "--duration", "12")
    done = run("circle", vehicle, tmp_path)
    assert done.returncode == 1 and done.stderr.splitlines() == ["the vehicle has fallen silent"], done.stdout + done.stderr


def test_vehicles_that_do_not_fit_the_example_are_told_how_to_start(start, tmp_path):
    vehicle = start("--vehicles", "5", "--ports", "shared")
    done = subprocess.run([sys.executable, EXAMPLES / "five_vehicles.py", "--connect", f"udpout:{vehicle.addresses[0]}"], cwd=tmp_path,
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "start them with --vehicles 5 --ports shared --formation circle,6" in done.stderr


def test_a_missing_vehicle_is_told(tmp_path):
    done = subprocess.run([sys.executable, EXAMPLES / "circle.py", "--connect", "udpout:127.0.0.1:9"], cwd=tmp_path,
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "no vehicle at udpout:127.0.0.1:9" in done.stderr
