"""Flights: the same doubles as the FMU in FMPy, saved states, parameters by name."""

import doctest
import os
import pickle
import subprocess
import sys
import threading

import numpy as np
import pandas
import pytest
from fmpy import read_model_description, simulate_fmu

import lmpc_quadrotor
from lmpc_quadrotor import ArgumentError, Fleet, FlightError, ParameterError, Simulation, fleet, fmu_path, simulation

#: What is flown: parameters and inputs.
FLIGHTS = [
    ({}, {}),
    ({"airframe.preset": "iris", "sensor.position_noise": 0.01, "sensor.seed": 3}, {"wind.velocity.x": 3.0}),
    ({"controller.kind": "dlqr", "airframe.mass": 0.8, "reference.shaping": False}, {"reference.yaw": 1.0, "disturbance.force.y": 0.5}),
    ({"environment.ground_plane": True, "airframe.rotor.ground_effect": True, "initial.position.z": -5.2}, {"ground.z": -5.0}),
]


@pytest.mark.parametrize("module", [simulation, fleet])
def test_documentation_examples(module):
    assert doctest.testmod(module).failed == 0


@pytest.mark.parametrize("parameters, inputs", FLIGHTS)
def test_a_flight_is_that_of_the_fmu_to_the_last_bit(parameters, inputs):
    table = Simulation(parameters, inputs).fly(4.0, step=0.01)
    names = [name for name in table.dtype.names if name != "time"]
    known = lmpc_quadrotor.parameters()
    # FMPy takes the number of an item.
    start = {name: known[name]["items"].index(value) + 1 if isinstance(value, str) else value for name, value in parameters.items()}
    result = simulate_fmu(fmu_path(), stop_time=4.0, output_interval=0.01, start_values={**start, **inputs}, output=names)
    np.testing.assert_allclose(table["time"], result["time"], atol=1e-12)
    for name in names:
        np.testing.assert_array_equal(table[name], result[name], err_msg=name)


def test_names_are_those_of_the_fmu():
    variables = read_model_description(fmu_path()).modelVariables
    of = lambda causality: {variable.name for variable in variables if variable.causality == causality}
    assert set(lmpc_quadrotor.outputs()) == of("output")
    assert of("input") <= set(lmpc_quadrotor.inputs())
    assert set(lmpc_quadrotor.parameters()) <= of("parameter")
    units = {variable.name: variable.unit or "" for variable in variables}
    for name, facts in lmpc_quadrotor.outputs().items():
        assert facts["unit"] == units[name], name
    parameter = lmpc_quadrotor.parameters()["limits.tilt"]
    assert parameter["unit"] == "rad" and (parameter["minimum"], parameter["maximum"]) == (0.05, 1.2)


def test_a_saved_flight_goes_on_the_same():
    flight = Simulation({"sensor.position_noise": 0.02}, {"wind.velocity.y": 1.0})
    flight.advance(1.2345)
    saved = flight.save()
    expected = flight.fly(1.0)
    for other in (Simulation.from_saved(saved), pickle.loads(pickle.dumps(Simulation.from_saved(saved)))):
        assert other.time == 1.2345
        np.testing.assert_array_equal(other.fly(1.0), expected)
    flight.restore(saved)
    copy = flight.copy()
    np.testing.assert_array_equal(flight.fly(1.0), expected)
    np.testing.assert_array_equal(copy.fly(1.0), expected)
    for damaged in (b"", saved[:50], b"x" + saved):
        with pytest.raises(ArgumentError, match="saved is"):
            flight.restore(damaged)


def test_inputs_that_change_and_parameters_in_flight():
    flight = Simulation()
    table = flight.fly(3.0, 0.05, outputs=["position.z"], inputs=lambda time: {"reference.position.z": -1.0 if time < 1.0 else -3.0})
    assert len(table) == 61 and table["time"][-1] == pytest.approx(3.0)
    flight.advance(6.0)
    assert flight["altitude"] == pytest.approx(3.0, abs=0.01)
    assert flight.inputs["reference.position.z"] == -3.0
    flight.set_parameters({"airframe.mass": 0.9})
    assert flight.parameters["airframe.mass"] == 0.9
    before = flight["altitude"]
    flight.advance(0.2)
    assert flight["altitude"] < before
    with pytest.raises(ParameterError, match="initial.position.x"):
        flight.set_parameters({"initial.position.x": 1.0})


def test_pandas_takes_a_flight():
    frame = pandas.DataFrame(Simulation().fly(0.1))
    assert list(frame.columns)[:2] == ["time", "position.x"] and frame["controller.altitude.status"].dtype == np.int32


def test_rotor_speeds_drive_the_plant():
    flight = Simulation(inputs={"rotor.failed[1]": True}, actuation="rotors")
    flight.advance(0.3)
    # Without the front rotor the nose drops.
    assert flight["attitude.theta"] < -0.05 and flight["rotor.speed[1]"] < 1.0
    assert "setpoint.yaw" not in flight.outputs
    with pytest.raises(ParameterError, match="output of the controllers"):
        flight["setpoint.yaw"]
    other = Simulation(actuation="rotors")
    other.advance(1.0)
    assert abs(other["velocity.z"]) < 1e-6


def test_the_plant_flies_as_its_fmu():
    speeds = {f"rotor.command[{rotor}]": 262.0 + rotor for rotor in (1, 2, 3, 4)}
    names = ["position.z", "attitude.phi", "attitude.psi", "rotor.speed[2]"]
    table = Simulation(inputs=speeds, actuation="rotors").fly(1.0, outputs=names)
    result = simulate_fmu(
        fmu_path("plant"), fmi_type="CoSimulation", stop_time=1.0, output_interval=0.01, start_values=speeds, output=names
    )  # fmt: skip
    for name in names:
        np.testing.assert_array_equal(table[name], result[name], err_msg=name)


@pytest.mark.parametrize("actuation", ["reference", "rates", "rotors"])
def test_each_vehicle_of_a_fleet_lands_on_ground_of_its_own(actuation):
    """It falls freely, and stands g/ω² deep in the ground: feet are oscillators of 50 rad/s."""
    ground = np.array([0.0, -2.0, -5.0])
    fleet = Fleet(3, {"environment.ground_plane": True, "initial.position.z": -6.0}, {"ground.z": ground, "armed": False}, actuation=actuation)
    table = fleet.fly(8.0, step=0.1, outputs=["altitude"])
    np.testing.assert_allclose(table["altitude"][4], 6.0 - 9.80665 / 2 * 0.4**2, atol=1e-9)
    np.testing.assert_allclose(table["altitude"][-1], -ground - 9.80665 / 2500, atol=1e-4)


def test_a_start_below_the_ground_is_refused():
    with pytest.raises(ParameterError, match="initial.position.z = 0 m is below the ground at ground.z = -5 m"):
        Simulation({"environment.ground_plane": True}, {"ground.z": -5.0})


def test_body_rates_are_followed():
    flight = Simulation(actuation="rates")
    flight.set({"command.body_rate.r": 1.0})
    for _ in range(100):
        flight.advance(0.02)
    assert flight["body_rate.r"] == pytest.approx(1.0, abs=0.05)
    assert abs(flight["attitude.phi"]) < 0.05


def test_another_motion():
    flight = Simulation()
    flight.place([1, 2, -3, 0.5, 0, 0, 1, 0, 0, 0, 0, 0, 0.1])
    np.testing.assert_array_equal(flight.read(["position.x", "position.y", "position.z", "velocity.x", "body_rate.r"]), [1, 2, -3, 0.5, 0.1])
    with pytest.raises(ArgumentError, match="motion has 3 elements, expected 13"):
        flight.place([1, 2, 3])


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: Simulation({"airframe.masss": 1}), "there is no parameter airframe.masss; did you mean airframe.mass?"),
        (lambda: Simulation({"airframe.layout": "x"}), "there is no parameter airframe.layout; `lmpc_quadrotor.parameters()` lists all"),
        (lambda: Simulation({"airframe.mass": -1}), "airframe.mass = -1 kg; allowed 0.005–50 kg"),
        (lambda: Simulation({"airframe.preset": "iriss"}), "airframe.preset = 'iriss'; expected one of paper, crazyflie"),
        (lambda: Simulation(0.9), "parameters = 0.9; expected names with values"),
        (lambda: Simulation({"reference.shaping": "no"}), "reference.shaping = 'no'; expected True or False"),
        (lambda: Simulation({"sensor.seed": 1.5}), "sensor.seed = 1.5; expected a whole number from 0 to 2147483647"),
        (lambda: Simulation({"sensor.seed": -1}), "sensor.seed = -1; expected a whole number from 0 to 2147483647"),
        (lambda: Simulation({"sensor.seed": 2**40}), "sensor.seed = 1099511627776; expected a whole number from 0"),
        (lambda: Simulation({"reference.position.x": 1.0}), "there is no parameter reference.position.x; it is an input: set it among the inputs"),
        (lambda: Simulation(inputs={"airframe.mass": 1.0}), "there is no input airframe.mass; it is a parameter: set it among the parameters"),
        (lambda: Simulation(inputs={"altitude": 1.0}), "there is no input altitude; it is an output, and only read"),
        (lambda: Simulation({1: 2.0}), "parameters has the name 1; expected text"),
        (lambda: Simulation().fly(1.0, outputs=[1]), "outputs has 1; expected names"),
        (lambda: Simulation({"airframe.mass": 5.0}), "airframe.mass = 5 kg is too heavy; allowed up to 1.78 kg"),
        (lambda: Simulation().set_parameters({"airframe.preset": "iris"}), "airframe.preset is fixed for the whole flight"),
        (lambda: Simulation(inputs={"armed": 2}), "armed = 2; expected True or False"),
        (lambda: Simulation(inputs={"armed": float("nan")}), "armed = NaN; expected True or False"),
        (lambda: Fleet(2, inputs={"rotor.failed[2]": [0, 0.5]}), "vehicle 1: rotor.failed[2] = 0.5; expected True or False"),
        (lambda: Fleet(2, {"airframe.mass": [0.7, 200]}), "vehicle 1: airframe.mass = 200 kg; allowed 0.005–50 kg"),
        (lambda: Simulation().place([0] * 13), "motion[6:10] = [0, 0, 0, 0]; expected a quaternion of length"),
        (lambda: Simulation().place([0, float("inf"), *[0] * 11]), "motion[1] = inf; expected a finite number"),
        (lambda: Simulation().read(3), "names = 3; expected a list of names"),
        (lambda: Fleet(3, {"airframe.mass": [0.6, 0.7, 5.0]}), "vehicle 2: airframe.mass = 5 kg is too heavy"),
        (lambda: Simulation(inputs={"reference.position.x": 1e9}), "reference.position.x = 1e9 m; allowed -1e6 to 1e6 m"),
        (lambda: Simulation(inputs={"reference.yaw": "north"}), "reference.yaw = 'north'; expected a number"),
        (lambda: Simulation(actuation="thrust"), "actuation = \"thrust\"; allowed are 'reference', 'rates' and 'rotors'"),
        (lambda: Simulation().advance(-1.0), "duration = -1.0 s; allowed is 0 s or more"),
        (lambda: Simulation().advance("1"), "duration = '1'; expected a number, in s"),
        (lambda: Simulation().advance(1e30), "duration = 1e+30 s; allowed is 0 s or more, up to 9.2e+12 s"),
        (lambda: Simulation().fly(1.0, outputs="altitude"), "outputs = 'altitude'; expected a list of names: ['altitude']"),
        (lambda: Simulation().fly(1.0, step=0.0), "step = 0.0 s; allowed is 1e-06 s or more"),
        (lambda: Simulation()["positon.x"], "there is no output positon.x; did you mean position.x?"),
        (lambda: Fleet(0), "count = 0; expected a whole number from 1 to 1000000"),
        (lambda: Fleet(-1), "count = -1; expected a whole number from 1 to 1000000"),
        (lambda: Fleet(2, threads=0), "threads = 0; expected a whole number from 1 to 1024"),
        (lambda: Fleet(2).restart([-1]), "there is no vehicle -1; allowed are 0 to 1"),
        (lambda: Fleet(2).restart(0), "vehicles = 0; expected a list of whole numbers from 0 to 1"),
        (lambda: Fleet(3, {"airframe.mass": [0.6, 0.7]}), "airframe.mass has 2 values; expected one, or 3"),
        (lambda: Fleet(2).set({"reference.yaw": [1, 2, 3]}), "reference.yaw has 3 values; expected one, or 2"),
        (lambda: Fleet(2).restart([2]), "there is no vehicle 2; allowed are 0 to 1"),
    ],
)
def test_errors_name_what_is_wrong_and_what_is_allowed(make, message):
    with pytest.raises(ValueError) as error:
        make()
    assert message in str(error.value)


@pytest.mark.parametrize("flight", [Simulation, lambda: Fleet(2)])
def test_what_memory_does_not_hold_is_refused(flight):
    """Before a step of it is flown."""
    with pytest.raises(MemoryError, match="no memory for .* rows of 1 numbers; choose a longer step"):
        flight().fly(1e12, step=1e-6, outputs=["altitude"])


def test_time_does_not_run_back():
    flight = Simulation()
    flight.advance(1.0)
    with pytest.raises(FlightError, match="already at 1 s"):
        flight.advance_to(0.5)


@pytest.mark.parametrize(
    ("actuation", "name", "least"),
    [("reference", "reference.position.x", 1.0), ("rates", "command.body_rate.p", 0.1), ("rotors", "rotor.command[1]", 250.0)],
)
def test_a_fleet_flies_as_its_members_alone_on_any_number_of_threads(actuation, name, least):
    # The plants of three of them step together.
    masses, seeds, values = [0.7, 0.6, 0.7, 0.7], [1, 2, 3, 4], [least, least + 0.1, least + 0.2, least + 0.3]
    parameters = {"sensor.position_noise": 0.02}
    several = {**parameters, "airframe.mass": masses, "sensor.seed": seeds}
    tables = [Fleet(4, several, {name: values}, actuation=actuation, threads=threads).fly(2.0, 0.1) for threads in (1, 3)]
    np.testing.assert_array_equal(tables[0], tables[1])
    for vehicle in range(4):
        single = {**parameters, "airframe.mass": masses[vehicle], "sensor.seed": seeds[vehicle]}
        flight = Simulation(single, {name: values[vehicle]}, actuation=actuation)
        np.testing.assert_array_equal(tables[0][:, vehicle], flight.fly(2.0, 0.1))


def test_a_fleet_saves_restarts_and_survives_a_lost_vehicle():
    fleet = Fleet(3, inputs={"reference.position.z": -2.0})
    fleet.advance(1.0)
    saved, expected = fleet.save(), Simulation.from_saved(fleet.save()[1])
    expected.advance(1.0)
    fleet.advance(1.0)
    assert fleet["position.z"][1] == expected["position.z"]
    fleet.restore(saved)
    np.testing.assert_array_equal(fleet.times, [1.0, 1.0, 1.0])
    fleet.restart([0], [[5, 0, -5, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]])
    assert fleet.times.tolist() == [0.0, 1.0, 1.0] and fleet["position.x"][0] == 5.0
    fleet.set({"disturbance.torque.x": [0.0, 1e3, 0.0]})
    fleet.advance(2.0)
    assert fleet.failed.tolist() == [False, True, False]
    assert "the motion has diverged" in fleet.failures[1] and fleet.failures[0] is None


def test_a_fleet_restarts_and_restores_all_or_none():
    """A vehicle that is refused comes last, so that those before it would have been changed."""
    fleet = Fleet(3)
    fleet.set({"disturbance.torque.x": [1e3, 0.0, 0.0]})
    fleet.advance(2.0)
    before = fleet.save()
    assert fleet.failed.tolist() == [True, False, False]
    here = [1, 2, -3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    with pytest.raises(ArgumentError, match=r"vehicle 2: motion\[6:10\]"):
        fleet.restart([0, 1, 2], [here, here, [0] * 13])
    with pytest.raises(ArgumentError, match="saved is damaged"):
        fleet.restore([before[1], before[1], before[2][:-1]])
    assert fleet.save() == before and fleet.failed.tolist() == [True, False, False]
    fleet.restart([0, 1], [here, here])
    assert not fleet.failed.any() and fleet["position.x"].tolist()[:2] == [1.0, 1.0]


INTERRUPTED = """
import signal, sys
from lmpc_quadrotor import Fleet, Simulation

flight = {flight}
signal.signal(signal.SIGALRM, signal.default_int_handler)  # as Ctrl-C, a moment after the flight has begun
signal.setitimer(signal.ITIMER_REAL, 0.2)
try:
    flight.{call}
except KeyboardInterrupt:
    flight.advance(0.1)
    print("interrupted")
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows has no alarm to interrupt with")
@pytest.mark.parametrize("flight, call", [("Simulation()", "advance(1e9)"), ("Simulation()", "fly(1e6, 1.0, outputs=['altitude'])"), ("Fleet(2)", "fly(1e6, 1.0, outputs=['altitude'])")])
def test_a_long_flight_is_interrupted_and_can_go_on(flight, call):
    """It would take minutes."""
    answer = subprocess.run([sys.executable, "-c", INTERRUPTED.format(flight=flight, call=call)], capture_output=True, text=True, timeout=30)
    assert answer.stdout == "interrupted\n", answer


def test_flights_do_not_hold_pythons_lock():
    fleet, counted, flying = Fleet(8), 0, threading.Event()

    def fly():
        flying.set()
        fleet.advance(4.0)

    thread = threading.Thread(target=fly)
    thread.start()
    flying.wait()
    while thread.is_alive():
        counted += 1
    # With the lock held, this thread would run once or twice.
    assert counted > 100
