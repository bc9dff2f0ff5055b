"""The Python code of README and book that simulates the FMU runs as it is printed."""

import os
import shutil
import subprocess
import sys

import documents
import pytest


@pytest.mark.parametrize("block", documents.of("python", "fmpy"), ids=str)
def test_python_code_with_the_fmu(fmu, tmp_path, block):
    # The blocks that fly the MAVLink vehicle: sitl/test_readme_flights.py.
    for file in [*fmu.parent.glob("*.fmu"), *fmu.parent.glob("*.ssp")]:
        shutil.copy(file, tmp_path)
    shutil.copy(fmu, tmp_path / "LmpcQuadrotor.fmu")
    shutil.copytree(fmu.parent / "fmi3", tmp_path / "fmi3")
    done = subprocess.run([sys.executable, "-c", block.text], cwd=tmp_path, capture_output=True, text=True, timeout=120,
                          env=os.environ | {"MPLBACKEND": "Agg"})
    assert done.returncode == 0, done.stderr
    assert "warn" not in (done.stdout + done.stderr).lower(), done
    documents.check_output(block, done.stdout)


def test_the_readme_has_such_a_block():
    assert any(block.file == "README.md" for block in documents.of("python", "fmpy"))


@pytest.mark.parametrize("line, arguments", [
    ("cargo run --release -p sitl", []),
    ("cargo run --release -p sitl -- --speed max   # as fast as possible", ["--speed", "max"]),
    ("LMPC_SITL_SPEED=max target/release/lmpc-sitl --wind '4,270'", ["--wind", "4,270"]),
    ("cargo run --release -p sitl --example soak -- --hours 1", None),
    ("cargo xtask demo", None),
    ("mavproxy.py --master=udpin:127.0.0.1:14550", None),
])
def test_commands_that_start_the_vehicle_are_told_from_others(line, arguments):
    assert documents.sitl_arguments(line) == arguments
