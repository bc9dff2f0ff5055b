"""What the wheel holds, and its programs."""

import ast
import base64
import inspect
import json
import os
import re
import signal
import subprocess
import sys
import urllib.request
import zipfile
from importlib import metadata
from pathlib import Path

import numpy as np
import pandas
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu

import lmpc_quadrotor
from lmpc_quadrotor import Fleet, Simulation, fmu_path, sitl_path
from lmpc_quadrotor.view import flight_page

PACKAGE = Path(lmpc_quadrotor.__file__).parent


def run(*arguments, **options):
    command = [sys.executable, "-m", "lmpc_quadrotor", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, **options)


def test_it_is_the_installed_package():
    assert PACKAGE.parent.name == "site-packages"
    assert metadata.version("lmpc-quadrotor") == lmpc_quadrotor.__version__


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("model", ["quadrotor", "controller", "plant"])
def test_fmus_are_valid_and_fly(model, version):
    path = fmu_path(model, version)
    assert validate_fmu(path) == []
    result = simulate_fmu(path, fmi_type="CoSimulation", stop_time=0.2)
    assert len(result) > 1
    printed = run("fmu", model, "--version", version)
    assert printed.stdout.strip() == path and printed.returncode == 0


def test_the_system_is_there():
    assert zipfile.is_zipfile(fmu_path("system"))
    with pytest.raises(ValueError, match="model = 'copter'; allowed are 'quadrotor', 'controller', 'plant' and 'system'"):
        fmu_path("copter")
    with pytest.raises(ValueError, match="version = '1.0'; allowed are '2.0' and '3.0'"):
        fmu_path(version="1.0")


def test_the_vehicle_is_a_program_of_the_environment():
    program = Path(sitl_path())
    assert program.parent == Path(sys.executable).parent
    for command in ([str(program)], [sys.executable, "-m", "lmpc_quadrotor", "sitl"]):
        answer = subprocess.run([*command, "--version"], capture_output=True, text=True, timeout=60)
        assert answer.stdout.startswith("lmpc-sitl "), answer
    assert run("sitl", "--no-such-flag").returncode == 2


def test_licences_are_inside():
    texts = {file.name: file.locate().read_text() for file in metadata.files("lmpc-quadrotor") if "licenses" in file.parts}
    assert {"LICENSE-MIT", "LICENSE-APACHE", "THIRD-PARTY.txt"} <= set(texts)
    for library in ("nalgebra", "pyo3", "numpy", "mavlink", "rsruckig", "rayon"):
        assert f"\n{library} " in texts["THIRD-PARTY.txt"], library


def test_commands_say_how_they_are_used():
    assert "sitl" in run("--help").stdout
    wrong = run("fly")
    assert wrong.returncode == 2 and "unknown command 'fly'" in wrong.stderr
    missing = run("fmu", "system", "--version", "3.0")
    assert missing.returncode == 2 and "Traceback" not in missing.stderr
    assert missing.stderr.splitlines()[-1].endswith("the SSP has FMUs of FMI 2.0: use version='2.0'")


def test_types_are_those_of_the_module(tmp_path):
    """mypy finds no error in the package and in a program that uses it, and the stubs say what the module has."""
    program = tmp_path / "program.py"
    program.write_text(
        "import lmpc_quadrotor as quadrotor\n"
        "import numpy as np\n"
        "flight = quadrotor.Simulation({'airframe.mass': 0.9})\n"
        "height: float = flight['altitude']\n"
        "basis = quadrotor.control.LaguerreBasis(5, 0.8)\n"
        "terms: int = basis.terms\n"
        "limit = quadrotor.control.Limit.range('input', 1, np.arange(20))\n"
        "fleet = quadrotor.Fleet(2)\n"
        "fleet.restart(np.array([0]))\n"
        "from lmpc_quadrotor.pytest_plugin import Sitl, SitlFactory\n"
        "def test_flies(sitl: Sitl, sitl_factory: SitlFactory) -> None:\n"
        "    address: str = sitl_factory(seed=sitl.seed).pymavlink\n"
    )
    for module, arguments in [
        ("mypy", ["--strict", "--cache-dir", str(tmp_path / "cache"), "-p", "lmpc_quadrotor"]),
        ("mypy", ["--strict", "--cache-dir", str(tmp_path / "cache"), str(program)]),
        ("mypy.stubtest", ["lmpc_quadrotor._native"]),
    ]:
        checked = subprocess.run([sys.executable, "-m", module, *arguments], capture_output=True, text=True, cwd=tmp_path, timeout=240)
        assert checked.returncode == 0, checked.stdout + checked.stderr


def documented(body, owner):
    """The names of a stub with what the module says of them, and what the stub says."""
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and (text := ast.get_docstring(node)):
            yield f"{owner.__name__}.{node.name}", inspect.getdoc(getattr(owner, node.name)), text
        if isinstance(node, ast.ClassDef):
            yield from documented(node.body, getattr(owner, node.name))


def test_help_says_what_the_stubs_say():
    """`help` shows shapes and units, as an editor does."""
    from lmpc_quadrotor import _native, control

    texts = list(documented(ast.parse((PACKAGE / "_native.pyi").read_text()).body, _native))
    assert len(texts) > 90
    assert [(name, said) for name, said, text in texts if said != text] == []
    # What users reach has a text, whether it is written in Python or in Rust.
    public = [control, *(getattr(control, name) for name in control.__all__), Simulation, Fleet]
    members = [getattr(thing, name) for thing in public if inspect.isclass(thing) for name in vars(thing) if not name.startswith("_")]
    assert [thing for thing in [*public, *members] if not inspect.getdoc(thing)] == []


def test_a_csv_file_of_fmpy_is_shown(tmp_path):
    from fmpy.util import write_csv

    result = simulate_fmu(fmu_path(), stop_time=2.0, output=["position.x", "position.y", "position.z", "setpoint.position.x", "setpoint.position.y", "setpoint.position.z"])
    write_csv(tmp_path / "flight.csv", result)
    shown = run("view", str(tmp_path / "flight.csv"))
    assert shown.returncode == 0, shown
    page = (tmp_path / "flight.html").read_text()
    name, enclosed = re.search(r'data-name="([^"]*)">([^<]*)</script>', page).groups()
    assert name == "flight.csv" and base64.b64decode(enclosed) == (tmp_path / "flight.csv").read_bytes()
    assert "http://" not in page and "https://" not in page
    of_array = flight_page(Simulation().fly(0.1), "A & B")
    for wrong, message in [(5, "it has no named columns"), (Simulation().fly(0.1)[:0], "the flight has no rows")]:
        with pytest.raises(ValueError, match=message):
            flight_page(wrong)
    assert of_array.startswith("<!doctype html>") and "<title>A &amp; B</title>" in of_array
    command = [sys.executable, "-m", "lmpc_quadrotor", "view", str(tmp_path / "flight.csv"), "--serve"]
    served = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True, env={**os.environ, "LMPC_SITL_VIEW": "127.0.0.1:0"})
    try:
        url = served.stdout.readline().split()[-1].split("#")[0]
        with urllib.request.urlopen(url + "session.json", timeout=10) as answer:
            assert json.load(answer) == {"recording": "flight.csv"}
    finally:
        os.killpg(served.pid, signal.SIGINT)  # as Ctrl-C does: the program below gets it, too
        served.wait(10)
    missing = str(tmp_path / "missing.csv")
    assert run("view", missing, "--serve").returncode == 4
    assert run("view", missing).stderr.count("missing.csv") == 1
    (tmp_path / "other.csv").write_text("time,height\n0,1\n")
    wrong = run("view", str(tmp_path / "other.csv"))
    assert wrong.returncode == 1 and "the flight has no column position.x, position.y, position.z; it has time,height" in wrong.stderr
    assert run("view", str(tmp_path)).stderr == f"error: {tmp_path}: there is no such file\n"
    # As pandas writes it, with its index.
    pandas.DataFrame(Simulation().fly(0.1)).to_csv(tmp_path / "table.csv")
    assert run("view", str(tmp_path / "table.csv")).returncode == 0


def test_benchmark_prints_its_table():
    answer = run("benchmark", "--vehicles", "2")
    assert answer.returncode == 0, answer
    assert np.isfinite(float(answer.stdout.split("Fleet, plant, rotor speeds")[1].split()[0]))
    for peer in ("gym-pybullet-drones", "PyBullet", "crazyflow"):
        (line,) = [line for line in answer.stdout.splitlines() if line.startswith(f"  {peer}: ")]
        assert line.endswith("not installed, so not measured") or float(line.split()[-1]) > 0, line
    assert "crazyflow" not in run("benchmark", "--vehicles", "1", "--no-peers").stdout
    wrong = run("benchmark", "--vehicles", "0")
    assert wrong.returncode == 2 and "--vehicles 0: allowed is 1 or more" in wrong.stderr
