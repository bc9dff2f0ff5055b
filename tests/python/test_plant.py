"""QuadrotorPlant: under FMPy's CVode and scipy's solvers, in CasADi, and against the paper's Euler form."""

import casadi
import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Model
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp
from test_equations import euler_form

# All that makes flight differ from the paper's, and no ground.
FLIGHT = {
    "airframe.drag.x": 0.1,
    "airframe.battery.sag": True,
    "airframe.rotor.inertia": 1e-4,
    "airframe.rotor.fall_time_ratio": 2.0,
    "airframe.rotor.inflow_coefficient": 1e-4,
    "airframe.centre_of_gravity.x": 0.002,
    "wind.velocity.x": 3.0,
    "rotor.command[1]": 261.0,
}
# Dropped aslant, sliding, with rotors at rest.
LANDING = {
    "environment.ground_plane": True,
    "initial.hovering": False,
    "initial.position.z": -0.3,
    "initial.velocity.x": 0.8,
    "initial.velocity.y": -0.3,
    "initial.attitude.phi": 0.05,
    **{f"rotor.command[{rotor}]": 0.0 for rotor in range(1, 5)},
}


@pytest.fixture(scope="module")
def plant(fmu):
    return str(fmu.with_name("QuadrotorPlant.fmu"))


@pytest.fixture(scope="module")
def description(plant):
    return read_model_description(plant)


@pytest.fixture(scope="module")
def folder(plant, tmp_path_factory):
    return extract(plant, unzipdir=str(tmp_path_factory.mktemp("plant")))


@pytest.fixture
def exchanged(folder, description):
    """An instance for model exchange in continuous-time mode, with its states and derivatives by name."""
    instance = FMU2Model(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.modelExchange.modelIdentifier,
        instanceName="plant",
    )
    instance.instantiate()
    instance.references = {variable.name: variable.valueReference for variable in description.modelVariables}
    yield instance
    instance.terminate()
    instance.freeInstance()


def begin(instance, values):
    instance.setupExperiment()
    for name, value in values.items():
        set_value = instance.setBoolean if isinstance(value, bool) else instance.setReal
        set_value([instance.references[name]], [value])
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    instance.newDiscreteStates()
    instance.enterContinuousTimeMode()


def names_of_states(description):
    return [derivative.variable.derivative.name for derivative in description.derivatives]


def test_description_is_valid(plant):
    assert validate_fmu(plant) == []


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_cvode_agrees_with_co_simulation_in_flight(plant, description, tolerance):
    arguments = {"stop_time": 1.5, "output_interval": 0.01, "start_values": FLIGHT, "relative_tolerance": tolerance}
    stepped = simulate_fmu(plant, fmi_type="CoSimulation", **arguments)
    solved = simulate_fmu(plant, fmi_type="ModelExchange", solver="CVode", **arguments)
    assert len(solved) == len(stepped), "there is no event in flight"
    nominals = {"position": 10, "velocity": 5, "rotor": 250}
    for name in names_of_states(description):
        nominal = nominals.get(name.split(".")[0], 1)
        if name in solved.dtype.names:
            error = np.abs(solved[name] - stepped[name]).max()
            # The tolerance is that of one step. Over the flight errors add up: to 4 to 27 times as much at tolerances from 1e-4 to 1e-8, and
            # to 5 or 20 times at 1e-6 by the last bit of a derivative.
            assert error < 40 * tolerance * nominal, name


def test_cvode_lands_as_co_simulation_does(plant):
    arguments = {"stop_time": 1.5, "output_interval": 0.01, "start_values": LANDING, "relative_tolerance": 1e-6}
    stepped = simulate_fmu(plant, fmi_type="CoSimulation", **arguments)
    solved = simulate_fmu(plant, fmi_type="ModelExchange", solver="CVode", **arguments)
    assert 5 < len(solved) - len(stepped) < 60, "events are few"
    for name in ["position.x", "position.y", "position.z"]:
        error = np.abs(np.interp(stepped["time"], solved["time"], solved[name]) - stepped[name]).max()
        assert error < 3e-4, name
    # Static friction holds it.
    for name in ["velocity.x", "velocity.y", "body_rate.r"]:
        assert solved[name][-1] == 0


def test_directional_derivatives_serve_an_implicit_solver(plant, exchanged, description):
    """scipy's Radau with the FMU's Jacobian."""
    begin(exchanged, FLIGHT)
    names = names_of_states(description)
    states = [exchanged.references[name] for name in names]
    derivatives = [exchanged.references[f"der({name})"] for name in names]

    def slope(_time, x):
        exchanged.setReal(states, x)
        return np.array(exchanged.getReal(derivatives))

    def jacobian(_time, x):
        exchanged.setReal(states, x)
        columns = [exchanged.getDirectionalDerivative(derivatives, [state], [1.0]) for state in states]
        return np.array(columns).T

    start = np.array(exchanged.getReal(states))
    solved = solve_ivp(slope, (0, 1.5), start, method="Radau", jac=jacobian, rtol=1e-8, atol=1e-8)
    stepped = simulate_fmu(plant, fmi_type="CoSimulation", stop_time=1.5, start_values=FLIGHT, output=names)
    assert solved.success
    for name, value in zip(names, solved.y[:, -1], strict=True):
        assert value == pytest.approx(stepped[name][-1], rel=1e-6, abs=1e-6), name


def test_derivatives_are_the_papers_euler_form(exchanged, description):
    begin(exchanged, {})
    random = np.random.default_rng(2015)
    mass, inertia = 0.7, np.array([0.1063, 0.1063, 0.2122])

    def read(names):
        return np.array(exchanged.getReal([exchanged.references[name] for name in names]))

    for _ in range(50):
        quaternion = random.normal(size=4)
        quaternion /= np.linalg.norm(quaternion)
        force = random.normal(size=3)
        values = {
            **dict(zip([f"velocity.{axis}" for axis in "xyz"], random.normal(size=3), strict=True)),
            **{f"attitude.q{i}": value for i, value in enumerate(quaternion)},
            **dict(zip([f"body_rate.{axis}" for axis in "pqr"], random.normal(size=3), strict=True)),
            **{f"rotor.speed[{i}]": random.uniform(50, 450) for i in range(1, 5)},
            **dict(zip([f"disturbance.force.{axis}" for axis in "xyz"], force, strict=True)),
        }
        exchanged.setReal([exchanged.references[name] for name in values], list(values.values()))
        angles = read([f"attitude.{angle}" for angle in ("phi", "theta", "psi")])
        if abs(angles[1]) > 1.4:
            continue
        body = read([f"body_velocity.{axis}" for axis in "uvw"])
        rates = read([f"body_rate.{axis}" for axis in "pqr"])
        state = np.concatenate([np.zeros(3), body, angles, rates])
        torque = read([f"torque.{angle}" for angle in ("phi", "theta", "psi")])
        expected = euler_form(state, read(["thrust"])[0], torque, mass, inertia, force)
        assert read([f"der(position.{axis})" for axis in "xyz"]) == pytest.approx(expected[:3], abs=1e-10)
        assert read([f"der(body_rate.{axis})" for axis in "pqr"]) == pytest.approx(expected[9:], abs=1e-10)
        # The acceleration along the turning axes of the body: v' = R (u' + omega x u).
        turning = read([f"acceleration.{axis}" for axis in "xyz"])
        assert np.linalg.norm(turning) == pytest.approx(np.linalg.norm(expected[3:6] + np.cross(rates, body)), abs=1e-10)


def test_casadi_takes_it_and_its_jacobian_is_that_of_differences(folder):
    builder = casadi.DaeBuilder("plant", str(folder))
    assert (len(builder.x()), len(builder.u())) == (18, 18)
    function = builder.create("f", ["x", "u"], ["ode", "y"])
    jacobian = function.factory("jacobian", ["x", "u"], ["jac:ode:x", "jac:ode:u", "jac:y:x", "jac:y:u"])
    u = np.array([float(value) for value in builder.start(builder.u())])
    x = np.array([0, 0, -5, 1, -2, 0.5, 0.9, 0.2, -0.1, 0.3, 0.4, -0.3, 0.2, 250, 260, 255, 245, 0.0])
    found = [np.array(block) for block in jacobian(x, u)]
    step = 1e-4
    for place, at in enumerate([x, u]):
        for column in range(len(at)):
            moved = [[x, u], [x, u]]
            for side, sign in enumerate([step, -step]):
                moved[side][place] = at + sign * np.eye(len(at))[column]
            ahead, behind = function(*moved[0]), function(*moved[1])
            for block, (one, other) in zip(found[place::2], zip(ahead, behind, strict=True), strict=True):
                difference = (np.array(one) - np.array(other)).ravel() / (2 * step)
                assert block[:, column] == pytest.approx(difference, rel=1e-6, abs=1e-6)
