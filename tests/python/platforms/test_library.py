"""The library flies the default experiments of its models in hosts in C, the same bits on each platform and in both versions of FMI."""

import struct
from pathlib import Path

import pytest
from fmpy import read_model_description, simulate_fmu

#: Longest time between two looks, s: where the arithmetic of two platforms parted would be seen soon.
STEP = 0.05
#: One library has all of them; an importer names the one that it wants by its GUID.
MODELS = ("LmpcQuadrotor", "LmpcController", "QuadrotorPlant")


@pytest.fixture(scope="module")
def descriptions(fmu) -> dict[str, tuple]:
    """The descriptions of each model in both versions."""

    def of(folder: Path, model: str):
        return read_model_description(str(folder / f"{model}.fmu"))

    return {model: (of(fmu.parent, model), of(fmu.parent / "fmi3", model)) for model in MODELS}


def outputs(description) -> list:
    return [v for v in description.modelVariables if v.causality == "output" and v.type in ("Real", "Float64")]


def steps(description) -> int:
    return round(float(description.defaultExperiment.stopTime) / STEP)


def lines(result, first: str, count: int) -> list[str]:
    found = result.stdout.splitlines()
    assert result.returncode == 0, (found[-5:], result.stderr)
    assert found[0] == first and found[-1] == "end"
    assert len(found) > count
    return found


def fly(platform, description, hostile: bool = False) -> list[str]:
    (parameter,) = (v.valueReference for v in description.modelVariables if v.name == "airframe.mass")
    references = [v.valueReference for v in outputs(description)]
    result = platform.run(platform.host, platform.library, "flight", description.guid, steps(description), STEP, parameter, int(hostile), *references)
    return lines(result, "FMI 2.0, default", steps(description))


def fly3(platform, description) -> list[str]:
    references = [f"{v.valueReference}:{v.shape[0] if v.shape else 1}" for v in outputs(description)]
    result = platform.run(platform.host3, platform.library, description.guid, steps(description), STEP, *references)
    return lines(result, "FMI 3.0", steps(description))


def seen(flight: list[str]) -> list[list[str]]:
    """The doubles of each look, without what is logged."""
    return [line.split() for line in flight[1:-1] if not line.startswith(("log ", "state of "))]


@pytest.fixture(scope="module")
def flights(built, descriptions) -> dict[str, dict[str, list[str]]]:
    """Of each model on each platform."""
    return {model: {name: fly(platform, second) for name, platform in built.items()} for model, (second, _) in descriptions.items()}


@pytest.mark.parametrize("model", MODELS)
def test_the_same_bits_on_every_platform(flights, model):
    first, *others = flights[model].values()
    assert any(line.startswith("log ") and "airframe.mass" in line for line in first), first[:5]
    assert any(line.startswith("state of ") for line in first)
    for other in others:
        assert other == first


@pytest.mark.parametrize("model", MODELS)
def test_the_same_bits_in_both_versions(platform, flights, descriptions, model):
    """An array has the reference of its first component, and the others follow."""
    second, third = descriptions[model]
    places = {variable.valueReference: place for place, variable in enumerate(outputs(second))}
    elements = [v.valueReference + i for v in outputs(third) for i in range(v.shape[0] if v.shape else 1)]
    flown = seen(flights[model][platform.platform])
    assert seen(fly3(platform, third)) == [[look[places[reference]] for reference in elements] for look in flown]


def test_the_same_bits_in_any_floating_point_environment(platform, flights, model_description):
    assert fly(platform, model_description, hostile=True) == flights["LmpcQuadrotor"][platform.platform]


def test_the_flight_is_the_one_of_fmpy(flights, fmu, model_description):
    """FMPy loads linux64 of the archive: the C host and a second importer see the same."""
    names = [v.name for v in outputs(model_description)]
    stop = float(model_description.defaultExperiment.stopTime)
    result = simulate_fmu(str(fmu), stop_time=stop, output_interval=STEP, output=names)
    last = [struct.unpack(">d", bytes.fromhex(word))[0] for word in flights["LmpcQuadrotor"]["linux64"][-2].split()]
    assert last == [result[name][-1] for name in names]
