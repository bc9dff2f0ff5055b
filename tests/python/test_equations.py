"""The paper's Euler form (2)–(3), integrated here from the FMU's own thrust and torques."""

import numpy as np
import pytest
from fmpy import simulate_fmu

GRAVITY = 9.80665
STEP = 0.001
# So many steps are integrated from one state of the flight; the errors of a whole flight add up.
PIECE = 100


def euler_form(state, thrust, torque, mass, inertia, force):
    """Derivative of x, y, z, u, v, w, φ, θ, ψ, p, q, r by (2) and (3), with a force in NED."""
    u, v, w, phi, theta, psi, p, q, r = state[3:]
    jx, jy, jz = inertia
    s, c, t = np.sin, np.cos, np.tan
    rotation = np.array(
        [
            [c(theta) * c(psi), s(phi) * s(theta) * c(psi) - c(phi) * s(psi), c(phi) * s(theta) * c(psi) + s(phi) * s(psi)],
            [c(theta) * s(psi), s(phi) * s(theta) * s(psi) + c(phi) * c(psi), c(phi) * s(theta) * s(psi) - s(phi) * c(psi)],
            [-s(theta), s(phi) * c(theta), c(phi) * c(theta)],
        ]
    )
    angles = np.array(
        [
            [1, s(phi) * t(theta), c(phi) * t(theta)],
            [0, c(phi), -s(phi)],
            [0, s(phi) / c(theta), c(phi) / c(theta)],
        ]
    )
    pushed = rotation.T @ force / mass
    # The paper prints r q where r u is meant in the second row.
    velocity = (
        np.array([r * v - q * w, p * w - r * u, q * u - p * v])
        + GRAVITY * np.array([-s(theta), c(theta) * s(phi), c(theta) * c(phi)])
        + np.array([0, 0, -thrust]) / mass
        + pushed
    )
    rates = np.array([(jy - jz) / jx * q * r, (jz - jx) / jy * p * r, (jx - jy) / jz * p * q]) + torque / inertia
    return np.concatenate([rotation @ [u, v, w], velocity, angles @ [p, q, r], rates])


@pytest.mark.parametrize(
    "parameters",
    [
        {},
        {"reference.shaping": False, "reference.yaw": 0.5},
        {
            "airframe.mass": 1.3,
            "airframe.inertia.x": 0.05,
            "airframe.inertia.y": 0.08,
            "airframe.inertia.z": 0.15,
            "initial.attitude.phi": 0.5,
            "initial.attitude.theta": -0.4,
            "initial.attitude.psi": 1.0,
            "initial.body_rate.p": 1.0,
            "initial.body_rate.q": -2.0,
            "initial.body_rate.r": 0.5,
            "initial.velocity.x": 2.0,
            "limits.thrust.max": 2.5,
            "disturbance.force.x": 0.4,
            "disturbance.force.z": -0.7,
        },
    ],
    ids=["default flight", "raw step with yaw", "another vehicle, tumbling and pushed"],
)
def test_trajectory_obeys_the_equations(unzipped, model_description, parameters):
    # Half steps give the thrust and torques that a Runge–Kutta step asks for in its middle.
    recorded = simulate_fmu(
        unzipped,
        stop_time=6.0,
        output_interval=STEP / 2,
        start_values=parameters,
        model_description=model_description,
    )
    mass = parameters.get("airframe.mass", 0.7)
    inertia = np.array([parameters.get(f"airframe.inertia.{a}", d) for a, d in zip("xyz", (0.1063, 0.1063, 0.2122))])
    force = np.array([parameters.get(f"disturbance.force.{a}", 0.0) for a in "xyz"])
    names = [
        *(f"position.{axis}" for axis in "xyz"),
        *(f"body_velocity.{axis}" for axis in "uvw"),
        *(f"attitude.{angle}" for angle in ("phi", "theta", "psi")),
        *(f"body_rate.{axis}" for axis in "pqr"),
    ]
    flown = np.column_stack([recorded[name] for name in names])
    thrust = recorded["thrust"]
    torque = np.column_stack([recorded[f"torque.{angle}"] for angle in ("phi", "theta", "psi")])

    state = piece = flown[0]
    worst = worst_of_pieces = 0.0
    for k in range(0, len(flown) - 2, 2):
        if k % (2 * PIECE) == 0:
            piece = flown[k]

        def f(x, offset):
            return euler_form(x, thrust[k + offset], torque[k + offset], mass, inertia, force)

        def after(x):
            k1 = f(x, 0)
            k2 = f(x + STEP / 2 * k1, 1)
            k3 = f(x + STEP / 2 * k2, 1)
            k4 = f(x + STEP * k3, 2)
            return x + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + k4)

        state, piece = after(state), after(piece)
        worst = max(worst, np.abs(state - flown[k + 2]).max())
        worst_of_pieces = max(worst_of_pieces, np.abs(piece - flown[k + 2]).max())
    # The plant's own steps last up to 5 ms.
    assert worst < 5e-4 and worst_of_pieces < 1e-5


def test_rotor_map_of_the_outputs(unzipped, model_description):
    """(1), from the rotor speeds to thrust and torques."""
    recorded = simulate_fmu(unzipped, stop_time=6.0, output_interval=0.01, model_description=model_description)
    value = {v.name: v.start for v in model_description.modelVariables}
    k1 = float(value["airframe.rotor.thrust_coefficient"])
    k2 = float(value["airframe.rotor.torque_coefficient"])
    arm = float(value["airframe.arm_length"])
    matrix = np.array([[k1] * 4, [0, -arm * k1, 0, arm * k1], [arm * k1, 0, -arm * k1, 0], [-k2, k2, -k2, k2]])
    squares = np.array([recorded[f"rotor.speed[{number}]"] for number in (1, 2, 3, 4)]) ** 2
    wrench = np.array([recorded["thrust"], *(recorded[f"torque.{angle}"] for angle in ("phi", "theta", "psi"))])
    np.testing.assert_allclose(matrix @ squares, wrench, atol=1e-12)
