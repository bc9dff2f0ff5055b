"""The FMU of version 3.0: valid, and the same flight as that of version 2.0, in FMPy and in a master of our own in C."""

import ctypes
import re
import shutil
import subprocess
import zipfile
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from lxml import etree

HEADERS = files("fmpy") / "c-code"


@pytest.fixture(scope="module")
def fmu3(fmu) -> Path:
    path = fmu.parent / "fmi3" / fmu.name
    assert path.is_file(), f"{path} does not exist: run `cargo xtask fmu`"
    return path


@pytest.fixture(scope="module")
def description3(fmu3):
    return read_model_description(str(fmu3))


@pytest.fixture(scope="module")
def unzipped3(fmu3, tmp_path_factory) -> str:
    return extract(str(fmu3), unzipdir=str(tmp_path_factory.mktemp("fmi3")))


@pytest.fixture(scope="module")
def library3(unzipped3) -> Path:
    (library,) = Path(unzipped3).glob("binaries/*/LmpcQuadrotor.*")
    return library


def test_fmpy_finds_no_problem(fmu3):
    assert validate_fmu(str(fmu3)) == []


def test_the_description_obeys_the_schema_of_the_standard(fmu3):
    schema = etree.XMLSchema(etree.parse(str(files("fmpy") / "schema" / "fmi3" / "fmi3ModelDescription.xsd")))
    with zipfile.ZipFile(fmu3) as archive:
        schema.assertValid(etree.fromstring(archive.read("modelDescription.xml")))


def test_it_is_the_library_of_version_2(fmu, fmu3):
    """One library serves both versions; only its place differs."""

    def libraries(path):
        with zipfile.ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist() if name.startswith("binaries/")}

    second, third = libraries(fmu), libraries(fmu3)
    assert set(second.values()) == set(third.values())
    for name, bytes_ in third.items():
        _, platform, file = name.split("/")
        assert re.fullmatch(r"(x86_64|aarch64|x86)-(linux|windows|darwin)", platform), name
        assert Path(file).stem == "LmpcQuadrotor"


def test_all_functions_of_the_header_are_exported(library3):
    header = (HEADERS / "fmi3FunctionTypes.h").read_text()
    names = re.findall(r"\b(fmi3\w+)TYPE\s*\(", header)
    assert len(names) == 75
    library = ctypes.CDLL(str(library3))
    assert [name for name in names if not hasattr(library, name)] == []


def test_the_default_experiment_is_the_same_bit_for_bit(unzipped, model_description, unzipped3, description3):
    """All outputs, at all communication points."""
    outputs = [v for v in description3.modelVariables if v.causality == "output"]
    second = simulate_fmu(
        unzipped,
        model_description=model_description,
        output=[v.name for v in model_description.modelVariables if v.causality == "output"],
    )
    third = simulate_fmu(unzipped3, model_description=description3, output=[v.name for v in outputs])
    assert len(third) == len(second) == 801
    np.testing.assert_array_equal(third["time"], second["time"])
    by_reference = {v.valueReference: v.name for v in model_description.modelVariables}
    compared = 0
    for variable in outputs:
        values = third[variable.name].reshape(len(third), -1)
        for element in range(values.shape[1]):
            name = by_reference[variable.valueReference + element]
            np.testing.assert_array_equal(values[:, element], second[name], err_msg=name)
            compared += 1
    assert compared == len(second.dtype.names) - 1


def test_arrays_and_enumerations_are_set_in_fmpy(unzipped3, description3):
    result = simulate_fmu(
        unzipped3,
        model_description=description3,
        stop_time=12.0,
        start_values={"reference.position": [3.0, -4.0, -5.0], "controller.kind": 2, "initial.position": [1.0, 0.0, 0.0]},
        output=["position", "controller.kind", "airframe.mass"],
    )
    np.testing.assert_array_equal(result["position"][0], [1.0, 0.0, 0.0])
    np.testing.assert_allclose(result["position"][-1], [3.0, -4.0, -5.0], atol=0.02)
    assert set(result["controller.kind"]) == {2}


@pytest.fixture(scope="module")
def master(tmp_path_factory) -> Path:
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no C compiler (cc)")
    program = tmp_path_factory.mktemp("master") / "master"
    source = Path(__file__).parent / "fmi3" / "master.c"
    command = [compiler, "-std=c11", "-Wall", "-Wextra", "-Werror", "-O1", f"-I{HEADERS}", str(source), "-o", str(program)]
    subprocess.run([*command, "-ldl"], check=True, timeout=120)
    return program


@pytest.mark.parametrize("start", [None, ("wind.velocity", [2.0, -1.0, 0.5])])
def test_a_master_in_c_flies_the_same(master, library3, unzipped3, description3, start):
    """It rejects a step half way, and goes on from the bytes of a saved state."""
    names, stop, steps = ["position", "quaternion", "rotor.speed", "thrust", "time"], 5.0, 200
    variables = {v.name: v for v in description3.modelVariables}
    lengths = {"position": 3, "quaternion": 4, "rotor.speed": 4, "thrust": 1, "time": 1}
    arguments = [str(library3), description3.instantiationToken, repr(stop), str(steps)]
    for name in names:
        arguments += [str(variables[name].valueReference), str(lengths[name])]
    if start:
        name, values = start
        arguments += ["--", str(variables[name].valueReference), *map(repr, values)]
    run = subprocess.run([str(master), *arguments], capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stderr
    flown = np.array([[float.fromhex(number) for number in line.split()] for line in run.stdout.splitlines()])

    expected = simulate_fmu(
        unzipped3,
        model_description=description3,
        stop_time=stop,
        output_interval=stop / steps,
        start_values=dict([start]) if start else {},
        output=names[:-1],
    )
    columns = np.hstack([expected[name].reshape(len(expected), -1) for name in names[:-1]])
    np.testing.assert_array_equal(flown[:, 1:-1], columns)
    # What a step tells as the time that it reached is the variable time.
    np.testing.assert_array_equal(flown[:, 0], flown[:, -1])
