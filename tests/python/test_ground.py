"""Ground with a height, `ground.z`: plateaus, their edges, and flights over them that are those over flat ground, higher up."""

import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException

from slave import Slave

G, PLATEAU = 9.80665, -5.0
#: How deep feet stand in the ground, m: their contact is an oscillator of 50 rad/s, whatever the mass.
DEPTH = G / 50.0**2
STANDS = {"environment.ground_plane": True, "armed": False}
AXES = ("position.x", "position.y", "position.z")


def signal(model, **changes) -> np.ndarray:
    """Inputs that change at once, as FMPy takes them: by name, the value before, the time, s, and the value after."""
    steps = sorted({time for _, time, _ in changes.values()})
    times = [0.0, *(time for step in steps for time in (step, step)), 1e3]
    names = {name.replace("__", "."): change for name, change in changes.items()}
    rows = np.zeros(len(times), dtype=[("time", float), *((name, float) for name in names)])
    rows["time"] = times
    for name, (before, time, after) in names.items():
        second = [row for row, at in enumerate(times) if at == time][1]
        rows[name] = [before if row < second else after for row in range(len(times))]
    return rows


@pytest.mark.parametrize("archive, kind", [("", "CoSimulation"), ("", "ModelExchange"), ("fmi3", "CoSimulation"), ("fmi3", "ModelExchange")])
def test_a_plant_stands_on_a_plateau_and_falls_over_its_edge(fmu, archive, kind):
    path = fmu.parent / archive / "QuadrotorPlant.fmu"
    rotors = {"rotor.command": [0.0] * 4} if archive else {f"rotor.command[{rotor}]": 0.0 for rotor in (1, 2, 3, 4)}
    place = {"initial.position": [0.0, 0.0, PLATEAU - 0.5]} if archive else {"initial.position.z": PLATEAU - 0.5}
    start = {"environment.ground_plane": True, "initial.hovering": False, "ground.z": PLATEAU, **place, **rotors}
    edge = 3.0
    flown = simulate_fmu(
        str(path), fmi_type=kind, start_values=start, stop_time=edge + 0.8, output_interval=0.01, output=["altitude"],
        input=signal(path, ground__z=(PLATEAU, edge, 0.0)), **({"relative_tolerance": 1e-8} if kind == "ModelExchange" else {}),
    )  # fmt: skip
    time, z = flown["time"], -flown["altitude"]
    free = time < np.sqrt(2 * 0.5 / G) - 0.02
    np.testing.assert_allclose(z[free], PLATEAU - 0.5 + G / 2 * time[free] ** 2, atol=1e-5)
    stands = (time > edge - 0.5) & (time < edge)
    np.testing.assert_allclose(z[stands], PLATEAU + DEPTH, atol=1e-5)
    falls = time > edge
    np.testing.assert_allclose(z[falls], PLATEAU + DEPTH + G / 2 * (time[falls] - edge) ** 2, atol=1e-4)


def test_a_flight_from_flat_ground_lands_on_a_plateau(unzipped, model_description):
    """It passes the edge at 8 s, sinks towards a reference below the plateau's top, and is disarmed on it."""
    start = {"environment.ground_plane": True, "reference.position.x": 5.0, "reference.position.y": 0.0}
    changes = {"ground__z": (0.0, 8.0, PLATEAU), "reference__position__z": (-8.0, 9.0, PLATEAU + 0.3), "armed": (1.0, 16.0, 0.0)}
    flown = simulate_fmu(
        unzipped, stop_time=20.0, output_interval=0.01, start_values=start, model_description=model_description,
        input=signal(unzipped, **changes), output=AXES,
    )  # fmt: skip
    assert flown["position.z"][flown["time"] > 8.0].max() < PLATEAU + 0.02
    assert flown["position.z"][-1] == pytest.approx(PLATEAU + DEPTH, abs=1e-6)
    assert flown["position.x"][-1] == pytest.approx(5.0, abs=0.01)


@pytest.mark.parametrize("version", [2, 3])
def test_a_flight_from_a_plateau_is_the_one_from_flat_ground(fmu, version):
    path = fmu if version == 2 else fmu.parent / "fmi3" / fmu.name

    def flown(z: float) -> np.ndarray:
        vectors = {"initial.position": [0.0, 0.0, z], "reference.position": [2.0, 1.0, z - 3.0]}
        scalars = {f"{name}.{axis}": value for name, values in vectors.items() for axis, value in zip("xyz", values)}
        start = {"environment.ground_plane": True, "ground.z": z, **(scalars if version == 2 else vectors)}
        output = list(AXES) if version == 2 else ["position"]
        result = simulate_fmu(str(path), stop_time=8.0, output_interval=0.02, start_values=start, output=output)
        place = np.column_stack([result[name] for name in AXES]) if version == 2 else result["position"]
        return place - [0.0, 0.0, z]

    np.testing.assert_allclose(flown(PLATEAU), flown(0.0), atol=1e-9)


def test_controllers_learn_nothing_on_a_plateau(fmu, tmp_path):
    """Held down in its stand for two seconds, a vehicle would teach its controllers a wrong mass: they climb as from flat ground."""

    def climb(z: float, told: float) -> np.ndarray:
        known = {"environment.ground_plane": True, "ground.z": told, "controller.learning": True, "measurement.attitude": 1}
        controller, plant = (
            Slave(extract(str(fmu.with_name(f"{name}.fmu")), unzipdir=str(tmp_path / name)), read_model_description(fmu.with_name(f"{name}.fmu")))
            for name in ("LmpcController", "QuadrotorPlant")
        )
        goal = {f"reference.position.{axis}": value for axis, value in zip("xyz", (0.0, 0.0, z - 3.0))}
        controller.initialize({**known, **goal, "measurement.rotor_speeds": 1})
        plant.initialize({"environment.ground_plane": True, "ground.z": z, "initial.position.z": z, "disturbance.force.z": 5.0})
        measured = [name for name in controller.variables if name.startswith("measured.")]
        commands = [name for name in controller.variables if name.startswith("rotor.command")]
        heights = []
        for step in range(6000):
            if step == 2000:
                plant.set({"disturbance.force.z": 0.0})
            controller.set(dict(zip(measured, plant.get(*(name.removeprefix("measured.") for name in measured)))))
            controller.fmu.doStep(step * 1e-3, 1e-3)
            plant.set(dict(zip(commands, controller.get(*commands))))
            plant.fmu.doStep(step * 1e-3, 1e-3)
            heights.append(z - plant.get("position.z")[0])
        for instance in (controller, plant):
            instance.free()
        return np.array(heights)

    flat = climb(0.0, 0.0)
    np.testing.assert_allclose(climb(PLATEAU, PLATEAU), flat, atol=1e-9)
    assert np.abs(climb(PLATEAU, 0.0) - flat).max() > 1e-3, "they learn what they should not if they do not know of the plateau"


@pytest.mark.parametrize("model", ["LmpcQuadrotor", "QuadrotorPlant"])
def test_a_start_below_the_plateau_is_refused(fmu, capsys, model):
    start = {"environment.ground_plane": True, "ground.z": PLATEAU}
    with pytest.raises(FMICallException):
        simulate_fmu(str(fmu.with_name(f"{model}.fmu")), fmi_type="CoSimulation", stop_time=1.0, start_values=start)
    assert "initial.position.z = 0 m is below the ground at ground.z = -5 m" in capsys.readouterr().out


@pytest.mark.parametrize("model", ["LmpcQuadrotor", "LmpcController", "QuadrotorPlant"])
def test_what_was_added_comes_last_so_that_no_value_reference_has_moved(fmu, model):
    variables = read_model_description(str(fmu.with_name(f"{model}.fmu"))).modelVariables
    assert [variable.valueReference for variable in variables] == list(range(len(variables)))
    believed = [f"controller.believed_{name}" for name in ("mass", "drag.x", "drag.y", "drag.z")]
    later = {"LmpcQuadrotor": believed, "LmpcController": [*believed, "airframe.rotor.fall_time_ratio"], "QuadrotorPlant": []}[model]
    names = [variable.name for variable in variables]
    assert names[len(names) - len(later) :] == later
    ground = variables[len(names) - len(later) - 1]
    assert (ground.name, ground.causality, ground.unit, float(ground.start)) == ("ground.z", "input", "m", 0.0)
