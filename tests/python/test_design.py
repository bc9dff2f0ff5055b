"""The three controllers, designed here again with scipy, against the FMU's calculated parameters."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.linalg import block_diag, solve_discrete_are

GRAVITY = 9.80665


@dataclass
class Settings:
    """One controller's parameters as the FMU has them."""

    gains: list
    sample_time: float
    terms: int
    scale: float
    horizon: int
    alpha: float
    lam: float
    output_weight: list
    rate_weight: list
    increment_weight: list


def laguerre(terms: int, scale: float):
    """A_l of (42) and L(0) of (41)."""
    beta = 1 - scale**2
    matrix = np.zeros((terms, terms))
    for row in range(terms):
        matrix[row, row] = scale
        for column in range(row):
            matrix[row, column] = (-scale) ** (row - column - 1) * beta
    return matrix, np.sqrt(beta) * (-scale) ** np.arange(terms)


def augmented(gains, sample_time):
    """(36) of double integrators under a zero-order hold."""
    am = block_diag(*[[[1, sample_time], [0, 1]] for _ in gains])
    bm = block_diag(*[[[gain * sample_time**2 / 2], [gain * sample_time]] for gain in gains])
    cm = block_diag(*[[[1.0, 0.0]] for _ in gains])
    states, outputs = len(am), len(cm)
    a = np.block([[am, np.zeros((states, outputs))], [cm @ am, np.eye(outputs)]])
    return a, np.vstack([bm, cm @ bm])


def design(settings: Settings):
    """Spectral radius, its difference to DLQR's, and the condition number of Ω."""
    inputs = len(settings.gains)
    a, b = augmented(settings.gains, settings.sample_time)
    q = np.diag([*np.column_stack([np.zeros(inputs), settings.rate_weight]).ravel(), *settings.output_weight])
    r = np.diag(settings.increment_weight)
    lam, alpha = settings.lam, settings.alpha
    p = solve_discrete_are(a / lam, b / lam, q, r)
    # (54) with λ for α: the gain of degree λ
    dlqr = np.linalg.solve(r + b.T @ p @ b / lam**2, b.T @ p @ a / lam**2)

    terminal = alpha == 1.0
    scale = lam if terminal else alpha
    gamma = lam / scale
    q_stage = gamma**2 * q + (1 - gamma**2) * p
    r_stage = gamma**2 * r
    a_p, b_p = a / scale, b / scale
    matrix, start = laguerre(settings.terms, settings.scale)
    count = inputs * settings.terms
    omega, psi = np.zeros((count, count)), np.zeros((count, len(a)))
    phi_t, a_m, l = np.zeros((len(a), count)), np.eye(len(a)), start
    for m in range(1, settings.horizon + 1):
        moves = np.kron(np.eye(inputs), l)
        omega += moves.T @ r_stage @ moves if terminal else 0
        phi_t = a_p @ phi_t + b_p @ moves
        a_m = a_p @ a_m
        weight = p if terminal and m == settings.horizon else q_stage
        omega += phi_t.T @ weight @ phi_t
        psi += phi_t.T @ weight @ a_m
        l = matrix @ l
    if not terminal:
        omega += np.kron(r_stage, np.eye(settings.terms))
    gain = np.kron(np.eye(inputs), start) @ np.linalg.solve(omega, psi)

    def radius(k):
        return np.abs(np.linalg.eigvals(a - b @ k)).max()

    return radius(gain), radius(gain) - radius(dlqr), np.linalg.cond(omega)


CHANNELS = {
    "altitude": ([""], [""]),
    "position": ([".x", ".y"], [".theta", ".phi"]),
    "attitude": ([".phi", ".theta", ".psi"], [".phi", ".theta", ".psi"]),
}


def settings_of(values: dict, controller: str) -> Settings:
    outputs, inputs = CHANNELS[controller]
    inertia = [values[f"airframe.inertia.{axis}"] * values["controller.mass_factor"] for axis in "xyz"]
    gains = {"altitude": [1.0], "position": [-GRAVITY, GRAVITY], "attitude": [1 / j for j in inertia]}

    def value(name):
        return values[f"controller.{controller}.{name}"]

    return Settings(
        gains=gains[controller],
        sample_time=value("sample_time"),
        terms=int(value("terms")),
        scale=value("scale"),
        horizon=int(value("prediction_horizon")),
        alpha=value("alpha"),
        lam=value("lambda"),
        output_weight=[value(f"output_weight{output}") for output in outputs],
        rate_weight=[value(f"rate_weight{output}") for output in outputs],
        increment_weight=[value(f"increment_weight{i}") for i in inputs],
    )


@pytest.mark.parametrize("controller", CHANNELS)
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"terms": 9, "scale": 0.75},
        {"prediction_horizon": 1000},
        {"alpha": 1.05},
        {"alpha": 1.0, "prediction_horizon": 60},
        {"lambda": 0.97},
    ],
    ids=str,
)
def test_calculated_parameters(slave, model_description, controller, changes):
    values = {
        v.name: float(v.start)
        for v in model_description.modelVariables
        if v.causality == "parameter" and v.type in ("Real", "Integer")
    }
    start = {f"controller.{controller}.{name}": value for name, value in changes.items()}
    values.update(start)
    instance = slave(start)

    names = ("spectral_radius", "eigenvalue_difference_to_dlqr", "condition_number")
    radius, difference, condition = instance.get(*(f"controller.{controller}.{name}" for name in names))
    expected_radius, expected_difference, expected_condition = design(settings_of(values, controller))
    assert radius == pytest.approx(expected_radius, rel=1e-6)
    assert difference == pytest.approx(expected_difference, abs=1e-6)
    assert condition == pytest.approx(expected_condition, rel=1e-4)
    assert radius < 1.0
