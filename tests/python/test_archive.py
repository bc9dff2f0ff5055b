"""The archive and its description, as importers and their validators see them."""

import subprocess
import sys
import zipfile
from importlib.resources import files
from io import BytesIO

import fmpy
import pytest
from fmpy.validation import validate_fmu
from lxml import etree

PROMISED = {
    "input": [
        *(f"reference.{kind}.{axis}" for kind in ("position", "velocity", "acceleration") for axis in "xyz"),
        "reference.yaw",
        "reference.yaw_rate",
        *(f"disturbance.{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"),
        *(f"wind.velocity.{axis}" for axis in "xyz"),
        "armed",
        "ground.z",
    ],
    "output": [
        *(f"{kind}.{axis}" for kind in ("position", "velocity", "acceleration", "tracking_error") for axis in "xyz"),
        *(f"setpoint.{kind}.{axis}" for kind in ("position", "velocity", "acceleration") for axis in "xyz"),
        "setpoint.yaw",
        "yaw_error",
        *(f"body_velocity.{axis}" for axis in "uvw"),
        *(f"attitude.{angle}" for angle in ("phi", "theta", "psi", "q0", "q1", "q2", "q3")),
        *(f"body_rate.{axis}" for axis in "pqr"),
        "thrust",
        *(f"torque.{angle}" for angle in ("phi", "theta", "psi")),
        *(f"rotor.speed[{number}]" for number in (1, 2, 3, 4)),
        "tilt_reference.phi",
        "tilt_reference.theta",
    ],
    "parameter": [
        "airframe.mass",
        "airframe.arm_length",
        *(f"airframe.inertia.{axis}" for axis in "xyz"),
        *(f"initial.position.{axis}" for axis in "xyz"),
        *(f"initial.attitude.{angle}" for angle in ("phi", "theta", "psi")),
        "reference.shaping",
    ],
    "calculatedParameter": [
        f"controller.{controller}.{figure}"
        for controller in ("altitude", "position", "attitude")
        for figure in ("spectral_radius", "eigenvalue_difference_to_dlqr", "condition_number")
    ],
}


def test_fmpy_finds_no_problem(fmu):
    assert validate_fmu(str(fmu)) == []


def test_the_description_obeys_the_schema_of_the_standard(fmu):
    # FMPy ships the schema files of the standard.
    schema = etree.XMLSchema(etree.parse(str(files("fmpy") / "schema" / "fmi2" / "fmi2ModelDescription.xsd")))
    with zipfile.ZipFile(fmu) as archive:
        schema.assertValid(etree.parse(BytesIO(archive.read("modelDescription.xml"))))


@pytest.mark.parametrize("causality", PROMISED)
def test_promised_names_exist(model_description, causality):
    names = {v.name for v in model_description.modelVariables if v.causality == causality}
    assert sorted(set(PROMISED[causality]) - names) == []


def test_every_variable_is_described_and_starts_within_its_range(model_description):
    for v in model_description.modelVariables:
        assert v.description, v.name
        if v.start is not None and v.type in ("Real", "Integer"):
            start = float(v.start)
            assert v.min is None or float(v.min) <= start, v.name
            assert v.max is None or start <= float(v.max), v.name


def test_the_archive_is_complete_and_small(fmu):
    # A platform has 1.5 MB. It is 1.2 MB, of which the library is 1.13: three models for both versions of FMI, and programs of several
    # fixed sizes for each of the three controllers.
    assert fmu.stat().st_size < 1_500_000
    with zipfile.ZipFile(fmu) as archive:
        names = archive.namelist()
        assert archive.testzip() is None
        assert names[0] == "modelDescription.xml"
        for name in ("model.png", "documentation/index.html", "licenses/license.txt", "licenses/third-party.txt"):
            assert name in names
        # Fixed times: the same sources give the same bytes.
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert archive.read("model.png").startswith(b"\x89PNG")
        page = etree.fromstring(archive.read("documentation/index.html"))
        assert page.findall(".//{*}svg") and page.findall(".//{*}math")
    assert fmpy.platform in fmpy.supported_platforms(str(fmu))


def test_the_library_does_not_tell_where_it_was_built(fmu, unzipped):
    with zipfile.ZipFile(fmu) as archive:
        binaries = [archive.read(name) for name in archive.namelist() if name.startswith("binaries/")]
    home = str(fmu.resolve().parents[2]).encode()
    assert binaries
    for binary in binaries:
        assert home not in binary
        assert b"/.cargo/registry/" not in binary


@pytest.mark.parametrize("command", ["info", "validate", "simulate"])
def test_command_line(fmu, command, tmp_path):
    arguments = [sys.executable, "-m", "fmpy", command, str(fmu)]
    if command == "simulate":
        arguments += ["--output-file", str(tmp_path / "result.csv")]
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    if command == "simulate":
        rows = (tmp_path / "result.csv").read_text().splitlines()
        assert len(rows) > 100
        assert "position.x" in rows[0]
