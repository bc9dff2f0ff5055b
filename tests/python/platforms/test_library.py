"""The FMU's library flies the default experiment in a host in C, the same bits on each platform."""

import struct

import pytest
from fmpy import simulate_fmu

#: Longest time between two looks, s: where the arithmetic of two platforms parted would be seen soon.
STEP = 0.05


def fly(platform, description, hostile: bool = False) -> list[str]:
    names = {variable.name: variable for variable in description.modelVariables}
    outputs = [v.valueReference for v in description.modelVariables if v.causality == "output" and v.type == "Real"]
    steps = round(float(description.defaultExperiment.stopTime) / STEP)
    parameter = names["airframe.mass"].valueReference
    result = platform.run(
        platform.host, platform.library, "flight", description.guid, steps, STEP, parameter, int(hostile), *outputs)
    lines = result.stdout.splitlines()
    assert result.returncode == 0, (lines[-5:], result.stderr)
    assert lines[0] == "FMI 2.0, default" and lines[-1] == "end"
    assert len(lines) > steps
    return lines


@pytest.fixture(scope="module")
def flights(built, model_description) -> dict[str, list[str]]:
    return {name: fly(platform, model_description) for name, platform in built.items()}


def test_the_same_bits_on_every_platform(flights):
    first, *others = flights.values()
    assert any(line.startswith("log ") and "airframe.mass" in line for line in first), first[:5]
    assert any(line.startswith("state of ") for line in first)
    for other in others:
        assert other == first


def test_the_same_bits_in_any_floating_point_environment(platform, flights, model_description):
    assert fly(platform, model_description, hostile=True) == flights[platform.platform]


def test_the_flight_is_the_one_of_fmpy(flights, fmu, model_description):
    """FMPy loads linux64 of the archive: the C host and a second importer see the same."""
    outputs = [v.name for v in model_description.modelVariables if v.causality == "output" and v.type == "Real"]
    stop = float(model_description.defaultExperiment.stopTime)
    result = simulate_fmu(str(fmu), stop_time=stop, output_interval=STEP, output=outputs)
    last = [struct.unpack(">d", bytes.fromhex(word))[0] for word in flights["linux64"][-2].split()]
    assert last == [result[name][-1] for name in outputs]
