"""examples/sweep.py on two local workers: the same flights as one by one, resumed where it stopped, and clear about what is wrong."""

import json
import subprocess
import sys
from pathlib import Path

import documents
import numpy as np
import pyarrow.dataset as dataset
import pytest
from fmpy import simulate_fmu

SWEEP = Path(__file__).parents[2] / "examples" / "sweep.py"


@pytest.fixture
def sweep(fmu, tmp_path):
    """Runs the study in a folder of its own, on two workers."""

    def run(*arguments: str) -> subprocess.CompletedProcess:
        command = [sys.executable, str(SWEEP), str(fmu), "--workers", "2", "--duration", "8", *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=240)

    return run


def rows(folder: Path) -> list[dict]:
    return dataset.dataset(folder, format="parquet").to_table().sort_by("flight").to_pylist()


def test_flights_are_those_that_are_flown_one_by_one(sweep, fmu, tmp_path):
    done = sweep("--flights", "6", "--batch", "2", "--vary", "airframe.mass=0.6:0.8", "--vary", "disturbance.force.x=-1:1")
    assert done.returncode == 0, done.stderr
    assert "6 of 6 flights" in done.stdout and "0 failed" in done.stdout
    assert (tmp_path / "sweep" / "sweep.png").stat().st_size > 10_000
    flown = rows(tmp_path / "sweep" / "flights")
    assert [row["flight"] for row in flown] == list(range(6))
    (block,) = documents.of("python", "sweep/flights")
    read = subprocess.run([sys.executable, "-c", block.text], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    worst = sorted(flown, key=lambda row: -row["overshoot_m"])[:5]
    assert [float(line.split()[1]) for line in read.stdout.splitlines()] == [row["overshoot_m"] for row in worst], read
    for row in flown:
        generator = np.random.default_rng([1, row["flight"]])
        values = {"airframe.mass": generator.uniform(0.6, 0.8), "disturbance.force.x": generator.uniform(-1, 1)}
        assert {name: row[name] for name in values} == values
        output = [f"{kind}.{axis}" for kind in ("position", "velocity") for axis in "xyz"]
        flight = simulate_fmu(str(fmu), stop_time=8.0, start_values=values, output=output)
        speed = np.sqrt(sum(flight[f"velocity.{axis}"] ** 2 for axis in "xyz"))
        error = np.linalg.norm([flight[f"position.{axis}"] - goal for axis, goal in zip("xyz", (5, 5, -10))], axis=0)
        assert row["largest_speed_m_s"] == pytest.approx(speed.max(), rel=1e-12)
        assert row["final_error_m"] == pytest.approx(error[-1], rel=1e-9, abs=1e-12)
        settled = flight["time"][np.flatnonzero(error > 0.05)[-1] + 1]
        assert row["settling_time_s"] == settled


def test_an_interrupted_study_goes_on(sweep, tmp_path):
    asked = ("--flights", "6", "--batch", "2", "--vary", "airframe.mass=0.6:0.8")
    assert sweep(*asked).returncode == 0
    flights = tmp_path / "sweep" / "flights"
    before = rows(flights)
    files = sorted(flights.iterdir())
    times = {path.name: path.stat().st_mtime_ns for path in files}
    files[1].unlink()
    # Left by a process that was ended while it wrote.
    files[1].with_suffix(".part").write_bytes(b"PAR1")
    # What is missing, and more flights of the same study.
    again = sweep("--flights", "7", *asked[2:])
    assert again.returncode == 0, again.stderr
    assert "4 of 7 flights are there already" in again.stdout and "3 of 3 flights" in again.stdout
    assert len(rows(flights)) == 7 and rows(flights)[:6] == before
    kept = [path for path in files if path != files[1]]
    assert all(path.stat().st_mtime_ns == times[path.name] for path in kept)

    other = sweep(*asked, "--seed", "2")
    assert other.returncode != 0 and "holds another study (different: seed)" in other.stderr


def test_a_flight_that_fails_is_a_row_with_its_message(sweep, tmp_path):
    done = sweep("--flights", "2", "--vary", "airframe.mass=3:4")
    assert done.returncode == 0, done.stderr
    messages = [row["message"] for row in rows(tmp_path / "sweep" / "flights")]
    assert all("too heavy" in message for message in messages), messages
    assert json.loads((tmp_path / "sweep" / "study.json").read_text())["seed"] == 1


def test_shares_are_of_the_start_value(sweep, tmp_path, model_description):
    """Also those that are varied without being asked for: a vehicle of another kind would tell nothing about this one."""
    start = {v.name: float(v.start) for v in model_description.modelVariables if v.type == "Real" and v.start is not None}
    assert sweep("--flights", "4", "--duration", "1").returncode == 0
    flown = rows(tmp_path / "sweep" / "flights")
    for name, low, high in (("airframe.mass", 0.85, 1.2), ("airframe.inertia.x", 0.8, 1.3), ("airframe.inertia.y", 0.8, 1.3),
                            ("airframe.rotor.time_constant", 0.5, 1.5)):
        assert all(low * start[name] <= row[name] <= high * start[name] for row in flown), name
    assert [row["message"] for row in flown] == [""] * 4


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--vary", "disturbance.force.x=50%:150%"), "its start value is 0, which has no shares"),
        (("--vary", "airframe.mass=50%:1"), "is not NAME=LOW:HIGH"),
        (("--vary", "airframe.weight=1:2"), "the FMU has no Real parameter or input of this name"),
        (("--vary", "airframe.mass=2"), "is not NAME=LOW:HIGH"),
        (("--vary", "airframe.mass=2:1"), "2.0 is above 1.0"),
        (("--flights", "0"), "'0' is not a positive integer"),
    ],
)
def test_what_is_wrong_is_said_before_anything_flies(sweep, tmp_path, arguments, message):
    done = sweep(*arguments)
    assert done.returncode != 0 and message in done.stderr
    assert not (tmp_path / "sweep").exists()
