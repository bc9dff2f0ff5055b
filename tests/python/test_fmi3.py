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
def pairs(fmu3) -> list[tuple[Path, Path]]:
    """Every FMU in version 2.0 and 3.0."""
    third = sorted(fmu3.parent.glob("*.fmu"))
    return [(path.parents[1] / path.name, path) for path in third]


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


def test_fmpy_finds_no_problem(pairs):
    assert {str(third): validate_fmu(str(third)) for _, third in pairs} == {str(third): [] for _, third in pairs}


def test_the_descriptions_obey_the_schema_of_the_standard(pairs):
    schema = etree.XMLSchema(etree.parse(str(files("fmpy") / "schema" / "fmi3" / "fmi3ModelDescription.xsd")))
    for _, third in pairs:
        with zipfile.ZipFile(third) as archive:
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


def outputs(description) -> list:
    return [v for v in description.modelVariables if v.causality == "output"]


def test_default_experiments_are_the_same_bit_for_bit(pairs):
    """All outputs, at all communication points; in model exchange with the simplest solver."""
    for paths in pairs:
        second, third = (read_model_description(str(path)) for path in paths)
        by_reference = {v.valueReference: v.name for v in second.modelVariables}
        kinds = ["CoSimulation"] + (["ModelExchange"] if third.modelExchange else [])
        assert bool(second.modelExchange) == bool(third.modelExchange)
        for kind in kinds:
            results = [
                simulate_fmu(
                    str(path), fmi_type=kind, solver="Euler", output=[v.name for v in outputs(description)]
                )
                for path, description in zip(paths, (second, third))
            ]
            assert len(results[0]) == len(results[1]) > 100
            np.testing.assert_array_equal(results[0]["time"], results[1]["time"])
            compared = 0
            for variable in outputs(third):
                values = results[1][variable.name].reshape(len(results[1]), -1)
                for element in range(values.shape[1]):
                    name = by_reference[variable.valueReference + element]
                    np.testing.assert_array_equal(values[:, element], results[0][name], err_msg=f"{paths[1].name} {name}")
                    compared += 1
            assert compared == len(results[0].dtype.names) - 1


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
