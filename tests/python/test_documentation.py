"""The commands and programs on the page inside each FMU run as they are printed, with that FMU."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import zipfile
from io import BytesIO
from pathlib import Path

import pytest
from fmpy import read_model_description
from lxml import etree

import plot

#: What the closed loop's page has, in this order: a command, and programs.
COMMAND, PLOTTED, OVER_TIME, BY_NAME = range(4)
#: What the plant's page has.
CO_SIMULATION, MODEL_EXCHANGE = range(2)
#: Blocks of code of each page.
COUNTS = {"LmpcQuadrotor": 4, "LmpcController": 0, "QuadrotorPlant": 2}
#: Titles of the curves of a place.
TITLES = {2: [f"position.{axis} [m]" for axis in "xyz"], 3: [f"position[{axis}] [m]" for axis in range(3)]}

versions = pytest.mark.parametrize("version", [2, 3])


@pytest.fixture
def path(fmu):
    """Where an FMU is."""

    def path(identifier: str, version: int) -> Path:
        folder = fmu.parent if version == 2 else fmu.parent / "fmi3"
        return folder / f"{identifier}.fmu"

    return path


def page(path: Path):
    with zipfile.ZipFile(path) as archive:
        return etree.parse(BytesIO(archive.read("documentation/index.html")))


def blocks(path: Path) -> list[str]:
    """The text of the page's blocks of code."""
    return ["".join(block.itertext()) for block in page(path).iterfind(".//{*}pre")]


@pytest.fixture
def run(path, tmp_path):
    """Runs a command beside one FMU, and returns what it prints; what it shows is saved as plot.html."""

    def run(command: list[str], fmu: Path) -> str:
        shutil.copy(fmu, tmp_path)
        environment = os.environ | plot.environment(tmp_path / "plot.html")
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stdout + done.stderr
        # The page says of which inputs FMPy warns.
        said = re.sub(r'^Warning: missing input for variable "\S+"$', "", done.stdout + done.stderr, flags=re.MULTILINE)
        assert "warning" not in said.lower(), said
        return done.stdout

    return run


def check_plot(page: Path, titles: list[str], up: float) -> None:
    """Three curves in metres, from the origin to the goal."""
    curves = plot.curves(page)
    assert list(curves) == titles
    for curve, goal in zip(curves.values(), (5.0, 5.0, -up)):
        assert len(curve) > 100
        assert curve[0] == 0.0 and abs(curve[-1] - goal) < 5e-3


@versions
def test_the_command_shows_a_plot(path, run, tmp_path, version):
    fmu = path("LmpcQuadrotor", version)
    program, *arguments = shlex.split(blocks(fmu)[COMMAND])
    assert program == "fmpy" and "--show-plot" in arguments
    run([sys.executable, "-m", "fmpy", *arguments], fmu)
    check_plot(tmp_path / "plot.html", TITLES[version], up=10.0)


@versions
def test_the_program_shows_a_plot(path, run, tmp_path, version):
    fmu = path("LmpcQuadrotor", version)
    run([sys.executable, "-c", blocks(fmu)[PLOTTED]], fmu)
    check_plot(tmp_path / "plot.html", TITLES[version], up=20.0)


@versions
def test_inputs_over_time_reach_their_goal(path, run, version):
    fmu = path("LmpcQuadrotor", version)
    said = run([sys.executable, "-c", blocks(fmu)[OVER_TIME]], fmu)
    *warnings, last = said.splitlines()
    assert version == 3 or not warnings, warnings
    for value, goal in zip(map(float, last.split()), (3.0, 0.0, 20.0), strict=True):
        assert abs(value - goal) < 5e-3, last


@versions
def test_a_controller_is_chosen_by_name(path, run, version):
    fmu = path("LmpcQuadrotor", version)
    printed = run([sys.executable, "-c", blocks(fmu)[BY_NAME]], fmu)
    # The regulator solves nothing, so it never iterates.
    assert printed.split("}") == ["{'lmpc': 1, 'ssmpc': 2, 'dlqr': 3", " 0\n"]


@versions
@pytest.mark.parametrize(("program", "altitude"), [(CO_SIMULATION, 3.7), (MODEL_EXCHANGE, 7.7)])
def test_programs_climb_with_the_plant(path, run, version, program, altitude):
    fmu = path("QuadrotorPlant", version)
    printed = run([sys.executable, "-c", blocks(fmu)[program]], fmu)
    assert float(printed) == pytest.approx(altitude, abs=0.1)


@versions
@pytest.mark.parametrize("identifier", COUNTS)
def test_the_import_command_shows_outputs(path, run, tmp_path, version, identifier):
    """The table of tools has a command for each FMU."""
    fmu = path(identifier, version)
    commands = [text for code in page(fmu).iterfind(".//{*}td/{*}code") if (text := code.text or "").startswith("fmpy ")]
    (command,) = commands
    _, *arguments = shlex.split(command)
    run([sys.executable, "-m", "fmpy", *arguments], fmu)
    shown = arguments[arguments.index("--output-variables") + 1 :]
    titles = {re.split(r"[ \[]", title)[0] for title in plot.curves(tmp_path / "plot.html")}
    assert titles == {re.split(r"\[", name)[0] for name in shown}


@versions
@pytest.mark.parametrize("identifier", COUNTS)
def test_all_code_of_the_page_is_tested_and_of_its_version(path, version, identifier):
    fmu = path(identifier, version)
    assert len(blocks(fmu)) == COUNTS[identifier]
    text = "".join(page(fmu).getroot().itertext())
    assert f"fmi{5 - version}" not in text


def test_the_page_names_the_numbers_of_enumerated_parameters(path):
    for identifier in COUNTS:
        description = read_model_description(str(path(identifier, 2)))
        chosen = [v for v in description.modelVariables if v.type == "Enumeration" and v.causality == "parameter"]
        assert chosen
        for variable in chosen:
            for item in variable.declaredType.items:
                assert re.search(rf"\b{item.value} = {item.name}\b", variable.description), variable.name
