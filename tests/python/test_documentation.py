"""The commands and programs on the page inside the FMU run as they are printed."""

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
from lxml import etree

import plot

#: What the page has, in this order: a command, and programs.
COMMAND, PLOTTED, OVER_TIME, BY_NAME = range(4)


@pytest.fixture(scope="module")
def blocks(fmu) -> list[str]:
    """The text of the page's blocks of code."""
    with zipfile.ZipFile(fmu) as archive:
        page = etree.parse(BytesIO(archive.read("documentation/index.html")))
    return ["".join(block.itertext()) for block in page.iterfind(".//{*}pre")]


@pytest.fixture
def run(fmu, tmp_path):
    """Runs a command beside the FMU, and returns what it prints; what it shows is saved as plot.html."""
    shutil.copy(fmu, tmp_path / "LmpcQuadrotor.fmu")

    def run(command: list[str]) -> str:
        done = subprocess.run(
            command,
            cwd=tmp_path,
            env=os.environ | plot.environment(tmp_path / "plot.html"),
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        assert "warning" not in (done.stdout + done.stderr).lower()
        return done.stdout

    return run


def check_plot(page: Path, up: float) -> None:
    """Three curves in metres, from the origin to the goal."""
    curves = plot.curves(page)
    assert list(curves) == ["position.x [m]", "position.y [m]", "position.z [m]"]
    for curve, goal in zip(curves.values(), (5.0, 5.0, -up)):
        assert len(curve) > 100
        assert curve[0] == 0.0 and abs(curve[-1] - goal) < 5e-3


def test_the_command_shows_a_plot(blocks, run, tmp_path):
    program, *arguments = shlex.split(blocks[COMMAND])
    assert program == "fmpy" and "--show-plot" in arguments
    run([sys.executable, "-m", "fmpy", *arguments])
    check_plot(tmp_path / "plot.html", up=10.0)


def test_the_program_shows_a_plot(blocks, run, tmp_path):
    run([sys.executable, "-c", blocks[PLOTTED]])
    check_plot(tmp_path / "plot.html", up=20.0)


def test_inputs_over_time_reach_their_goal_without_a_warning(blocks, run):
    reached = [float(number) for number in run([sys.executable, "-c", blocks[OVER_TIME]]).split()]
    for value, goal in zip(reached, (3.0, 0.0, 20.0), strict=True):
        assert abs(value - goal) < 5e-3, reached


def test_a_controller_is_chosen_by_name(blocks, run):
    printed = run([sys.executable, "-c", blocks[BY_NAME]])
    # The regulator solves nothing, so it never iterates.
    assert printed.split("}") == ["{'lmpc': 1, 'ssmpc': 2, 'dlqr': 3", " 0\n"]


def test_all_code_of_the_page_is_tested(blocks):
    assert len(blocks) == len((COMMAND, PLOTTED, OVER_TIME, BY_NAME))


def test_the_page_names_the_numbers_of_enumerated_parameters(model_description):
    chosen = [v for v in model_description.modelVariables if v.type == "Enumeration" and v.causality == "parameter"]
    assert chosen
    for variable in chosen:
        for item in variable.declaredType.items:
            assert re.search(rf"\b{item.value} = {item.name}\b", variable.description), variable.name
