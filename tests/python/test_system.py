"""Controllers and plant as FMUs of their own: wired by masters of this file, by FMPy and by libcosim, against the closed loop; and the
terminals that say how they are wired."""

import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssd
from lxml import etree

from slave import Slave

#: m: how far the default flight may be from the closed loop's per second of the delay, and what is added by a first step without commands.
#: `fmu/tests/controller/delayed.rs` derives both.
DELAYED, IDLE = 2.0, 4.0
STEP, DURATION = 0.001, 10.0
POSITION = ("position.x", "position.y", "position.z")
MODELS = ("LmpcQuadrotor", "LmpcController", "QuadrotorPlant")


@pytest.fixture(scope="module")
def folder(fmu) -> Path:
    """Where all FMUs and the system lie."""
    return fmu.parent


@pytest.fixture(scope="module")
def closed_loop(unzipped, model_description) -> np.ndarray:
    """The default flight, each millisecond."""
    return simulate_fmu(
        unzipped, stop_time=DURATION, output_interval=STEP, output=POSITION, model_description=model_description
    )


@pytest.fixture
def pair(folder, tmp_path):
    """Controllers and plant, ready to step, made with the start values of the controllers."""
    made = []

    def make(start_values: dict) -> list[Slave]:
        for name, values in (("LmpcController", start_values), ("QuadrotorPlant", {})):
            path = str(folder / f"{name}.fmu")
            unzipped = extract(path, unzipdir=str(tmp_path / name))
            made.append(Slave(unzipped, read_model_description(path)).initialize(values))
        return made

    yield make
    for instance in made:
        instance.free()


def connections(terminals: dict, terminal: str, start: str, end: str) -> list[tuple[str, str]]:
    """Variables of two models that belong together by the members of a terminal."""
    start, end = terminals[start][terminal], terminals[end][terminal]
    return [(start[member], end[member]) for member in start.keys() & end.keys()]


@pytest.fixture(scope="module")
def terminals(folder) -> dict:
    """By model, terminal and member: the variable."""
    found = {}
    for name in MODELS:
        with zipfile.ZipFile(folder / f"{name}.fmu") as archive:
            root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
        found[name] = {
            terminal.get("name"): {member.get("memberName"): member.get("variableName") for member in terminal}
            for terminal in root.iter("Terminal")
        }
    return found


def test_controllers_first_are_the_closed_loop(pair, terminals, closed_loop):
    """A master that steps the controllers first, wired by the terminals, flies the closed loop's doubles."""
    controller, plant = pair({"measurement.attitude": 1, "measurement.rotor_speeds": 1})
    measured = connections(terminals, "motion", "QuadrotorPlant", "LmpcController")
    commanded = connections(terminals, "actuation", "LmpcController", "QuadrotorPlant")
    assert len(measured) == 20 and len(commanded) == 8
    for i, expected in enumerate(closed_loop[1:3001]):
        for source, target, wires in ((plant, controller, measured), (controller, plant, commanded)):
            values = source.get(*(start for start, _ in wires))
            target.set(dict(zip((end for _, end in wires), values)))
            target.fmu.doStep(i * STEP, STEP)
        np.testing.assert_array_equal(plant.get(*POSITION), [expected[name] for name in POSITION])


def test_fmpy_runs_the_system(folder, closed_loop):
    """FMPy steps both at once, and begins with zeros: commands, measurements and all."""
    path = str(folder / "LmpcQuadrotor.ssp")
    for parameter_set in (None, read_ssd(path).system.parameterBindings[0].parameterValues[0]):
        flown = simulate_ssp(path, stop_time=DURATION, step_size=STEP, parameter_set=parameter_set)
        # A row has the time before its step, and the outputs after it.
        rows = min(len(flown), len(closed_loop) - 1)
        assert rows >= DURATION / STEP - 1
        for name in POSITION:
            apart = np.abs(flown[f"plant.{name}"][:rows] - closed_loop[name][1 : rows + 1]).max()
            assert 0.0 < apart < (DELAYED + IDLE) * STEP, f"{name}: {apart} m"


def test_the_systems_parameters_reach_both(folder):
    """A lighter vehicle under controllers that know of it flies to another place."""
    path = str(folder / "LmpcQuadrotor.ssp")
    parameters = read_ssd(path).system.parameterBindings[0].parameterValues[0]
    changes = {"controller.reference.position.x": 1.0, "controller.airframe.mass": 0.6, "plant.airframe.mass": 0.6}
    for parameter in parameters.parameters:
        parameter.value = changes.pop(parameter.name, parameter.value)
    assert not changes
    flown = simulate_ssp(path, stop_time=DURATION, step_size=0.01, parameter_set=parameters)
    assert abs(flown["plant.position.x"][-1] - 1.0) < 0.02
    assert abs(flown["plant.thrust"][-1] - 0.6 * 9.81) < 0.05


def test_libcosim_runs_the_system(folder, closed_loop):
    """libcosim steps both at once, and passes values on before the first step."""
    pytest.importorskip("libcosimpy", reason="libcosimpy has no wheel for this platform and Python")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver

    path = str(folder / "LmpcQuadrotor.ssp")
    execution = CosimExecution.from_ssp_file(ssp_path=path, step_size=round(STEP * 1e9))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    plant = execution.slave_index_from_instance_name("plant")
    references = {v.name.decode(): v.reference for v in execution.slave_variables(slave_index=plant)}
    for time_ms in range(100, round(DURATION / STEP) + 1, 100):
        assert execution.simulate_until(target_time=round(time_ms * 1e6))
        flown = observer.last_real_values(plant, [references[name] for name in POSITION])
        expected = [closed_loop[name][time_ms] for name in POSITION]
        np.testing.assert_allclose(flown, expected, rtol=0.0, atol=DELAYED * STEP, err_msg=f"{time_ms} ms")


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("model", MODELS)
def test_terminals_follow_the_standard(folder, model, version):
    """The schema of FMI 3.0, which FMI 2.0.4 refers to; and each member is a variable of the FMU."""
    path = folder / f"{model}.fmu" if version == "2.0" else folder / "fmi3" / f"{model}.fmu"
    schema = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"
    with zipfile.ZipFile(path) as archive:
        root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    etree.XMLSchema(file=str(schema)).assertValid(root)
    variables = {v.name: v.causality for v in read_model_description(str(path)).modelVariables}
    members = [member.get("variableName") for member in root.iter("TerminalMemberVariable")]
    assert members and all(variables[name] in ("input", "output") for name in members)
