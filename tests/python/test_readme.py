"""The Python code of README and book that simulates the FMU runs as it is printed."""

import ast
import inspect
import os
import re
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


def test_every_block_is_of_a_kind_that_a_test_takes():
    """A block of Python has a title, by which the package's tests find it, or a word by which others do."""
    languages, words = {"json", "mermaid", "python", "rust", "sh", "text", "toml"}, ("fmpy", "pymavlink", "mavsdk", "sweep/flights", "action.do_orbit")
    for file in [documents.ROOT / "README.md", *(documents.ROOT / "book" / "src").rglob("*.md")]:
        opening = False
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            if line.lstrip().startswith("```"):
                opening = not opening
                assert not opening or re.match(r"\s*```(\w+)( title=.*)?$", line)[1] in languages, f"{file}:{number}: {line}"
    for block in documents.of("python"):
        assert any(word in block.text for word in words), f"no test takes {block}"


def test_the_orbit_names_what_mavsdk_takes():
    action = pytest.importorskip("mavsdk.plugins.action")
    (block,) = documents.of("python", "action.do_orbit")
    call = ast.parse(block.text).body[0].value
    inspect.signature(action.Action.do_orbit).bind(None, **{argument.arg: argument.value for argument in call.keywords})
    (enumeration,) = {node.value.id for node in ast.walk(call) if isinstance(node, ast.Attribute) and node.value.id != "action"}
    (name,) = {node.attr for node in ast.walk(call) if isinstance(node, ast.Attribute) and node.value.id == enumeration}
    assert hasattr(getattr(action, enumeration), name)


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
