"""The three controllers, designed here again with scipy, against the FMU's calculated parameters.

Everything follows from the FMU's parameters and from the constants of the design below; continuous models go through the matrix exponential, the
closed attitude loop is flown sample by sample.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.linalg import block_diag, expm, solve_discrete_are, solve_discrete_lyapunov

GRAVITY = 9.80665
INNER_LOOPS, PAPER = 1, 2

#: Bandwidth of the altitude, rad/s.
ALTITUDE_BANDWIDTH = 2.7
#: Bandwidth of the position times the delay of attitude and sampling; the bandwidth on the paper's model, rad/s.
POSITION_SHARE, POSITION_BANDWIDTH_PAPER = 0.62, 1.8
#: Bandwidth of roll and pitch times the delay of rotors and sampling, and the angle, rad, that takes all torque; by model.
ATTITUDE = {INNER_LOOPS: (0.8, 0.06), PAPER: (0.2265, 0.0765)}
#: Bandwidth of the feedback about which plans are made, as a share.
STABILIZING_SHARE = {"altitude": 0.2, "position": 0.45, "attitude": 0.3}


@dataclass(frozen=True)
class Settings:
    """One controller's parameters as the FMU has them, some of its channels."""

    sample_time: float
    terms: int
    scale: float
    horizon: int
    alpha: float
    lam: float
    output_weight: list
    damping_weight: list
    rate_weight: list
    increment_weight: list

    def of(self, channels: slice) -> "Settings":
        names = ("output_weight", "damping_weight", "rate_weight", "increment_weight")
        return replace(self, **{name: getattr(self, name)[channels] for name in names})


@dataclass(frozen=True)
class Figures:
    """What the FMU calculates, and the gain."""

    radius: float
    difference: float
    condition: float
    gain: np.ndarray

    def worse(self, other: "Figures") -> "Figures":
        return Figures(
            max(self.radius, other.radius),
            max(self.difference, other.difference, key=abs),
            max(self.condition, other.condition),
            self.gain,
        )


def held(a, b, time):
    """Zero-order hold."""
    n, p = b.shape
    exponential = expm(np.block([[a, b], [np.zeros((p, n + p))]]) * time)
    return exponential[:n, :n], exponential[:n, n:]


def double_integrator(time):
    return held(np.array([[0.0, 1], [0, 0]]), np.array([[0.0], [1]]), time)


def with_lag(lag, time):
    """Output, rate and acceleration, which follows its command with the rotors' lag."""
    a = np.array([[0, 1, 0], [0, 0, 1], [0, 0, -1 / lag]])
    return held(a, np.array([[0], [0], [1 / lag]]), time)


def without_lag(time):
    """The same at once."""
    a, b = double_integrator(time)
    return block_diag(a, [[0.0]]), np.vstack([b, [[1.0]]])


def augmented(axis, count):
    """(36) of some such axes, of which each has its output first."""
    am, bm = (block_diag(*[block] * count) for block in axis)
    states = len(am)
    cm = np.zeros((count, states))
    cm[range(count), range(0, states, states // count)] = 1
    a = np.block([[am, np.zeros((states, count))], [cm @ am, np.eye(count)]])
    return a, np.vstack([bm, cm @ bm])


def weights(settings: Settings, states: int, bandwidth: float):
    """Q and R: error, rate over ω, acceleration over ω² and jerk over ω³ count alike; increments are derivatives times ΔT."""
    count = len(settings.output_weight)

    def relative(weight, power):
        return np.array(weight) / (bandwidth**power * settings.sample_time) ** 2

    of_states = np.zeros((count, states // count))
    of_states[:, 0] = relative(settings.damping_weight, 1)
    of_states[:, 1] = relative(settings.rate_weight, 2)
    return np.diag([*of_states.ravel(), *settings.output_weight]), np.diag(relative(settings.increment_weight, 3))


def laguerre(terms: int, scale: float):
    """A_l of (42) and L(0) of (41)."""
    beta = 1 - scale**2
    matrix = np.zeros((terms, terms))
    for row in range(terms):
        matrix[row, row] = scale
        for column in range(row):
            matrix[row, column] = (-scale) ** (row - column - 1) * beta
    return matrix, np.sqrt(beta) * (-scale) ** np.arange(terms)


def regulator(a, b, q, r, lam):
    """P, and the gain of degree λ: (54) with λ for α."""
    p = solve_discrete_are(a / lam, b / lam, q, r)
    return p, np.linalg.solve(r + b.T @ p @ b / lam**2, b.T @ p @ a / lam**2)


def figures(a, b, gain, dlqr, hessian) -> Figures:
    def radius(k):
        return np.abs(np.linalg.eigvals(a - b @ k)).max()

    return Figures(radius(gain), radius(gain) - radius(dlqr), np.linalg.cond(hessian), gain)


def stabilized(settings: Settings, axis, bandwidth: float, share: float) -> Figures:
    """Plans Δu = −K_s x + L(m)ᵀη without end, about the regulator of a slower loop."""
    count = len(settings.output_weight)
    a, b = augmented(axis, count)
    states, lam = len(a), settings.lam
    q, r = weights(settings, states - count, bandwidth)
    _, slow = regulator(a, b, *weights(settings, states - count, share * bandwidth), lam)
    matrix, start = laguerre(settings.terms, settings.scale)
    first = np.kron(np.eye(count), start)
    onwards = block_diag(*[matrix.T] * count)
    motion = np.block([[a - b @ slow, b @ first], [np.zeros((len(onwards), states)), onwards]]) / lam
    move = np.hstack([-slow, first])
    stage = block_diag(q, np.zeros_like(onwards)) + move.T @ r @ move
    cost = solve_discrete_lyapunov(motion.T, stage)
    hessian, coupling = cost[states:, states:], cost[states:, :states]
    gain = slow + first @ np.linalg.solve(hessian, coupling)
    return figures(a, b, gain, regulator(a, b, q, r, lam)[1], hessian)


def printed(settings: Settings, axis, bandwidth: float) -> Figures:
    """The paper's Ω and Ψ over the prediction horizon."""
    inputs = len(settings.output_weight)
    a, b = augmented(axis, inputs)
    q, r = weights(settings, len(a) - inputs, bandwidth)
    lam, alpha = settings.lam, settings.alpha
    p, dlqr = regulator(a, b, q, r, lam)

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
    return figures(a, b, gain, dlqr, omega)


class Attitude:
    """The attitude controller: roll and pitch have one bandwidth, yaw another one and times that are longer by some factor. The
    time of the Laguerre functions is longer by its root."""

    def __init__(self, values: dict, model: int):
        self.settings = settings_of(values, "attitude")
        self.lag = values["airframe.rotor.time_constant"]
        time = self.settings.sample_time
        self.axis = with_lag(self.lag, time) if model == INNER_LOOPS else without_lag(time)
        share, angle = ATTITUDE[model]
        lean, turn = accelerations(values)

        def closed(acceleration):
            return min(share / (self.lag + time / 2), np.sqrt(acceleration / angle))

        longer = np.clip(np.sqrt(lean / turn), 1, 8)
        slower = replace(
            self.settings.of(slice(2, 3)),
            scale=self.settings.scale ** (1 / np.sqrt(longer)),
            alpha=self.settings.alpha ** (1 / longer),
            lam=self.settings.lam ** (1 / longer),
            horizon=int(np.ceil(self.settings.horizon * longer)),
        )

        def design(settings, bandwidth):
            if model == PAPER:
                return printed(settings, self.axis, bandwidth)
            return stabilized(settings, self.axis, bandwidth, STABILIZING_SHARE["attitude"])

        self.lean = design(self.settings.of(slice(0, 2)), closed(lean))
        self.figures = self.lean.worse(design(slower, closed(turn)))

    def law(self, state, command, torque):
        """The commanded angular acceleration, going by the motion that the model makes under the last one."""
        a, b = self.axis
        before = np.linalg.solve(a, state - b[:, 0] * torque)
        gain = self.lean.gain[0, [0, 1, 2, 6]]
        return torque - gain @ [*(state - before), state[0] - command]

    def delay(self) -> float:
        """∫ e dt after a unit step of the command."""
        a, b = self.axis
        state, torque, sum_of_errors = np.zeros(3), 0.0, 0.0
        for _ in range(5000):
            sum_of_errors += 1.0 - state[0]
            torque = self.law(state, 1.0, torque)
            state = a @ state + b[:, 0] * torque
        return self.settings.sample_time * (sum_of_errors - 0.5)

    def under_position(self, time):
        """Position, its derivatives up to the snap, and the commanded snap, over a sample of the position controller."""
        samples = round(time / self.settings.sample_time)
        chain = np.diag([1.0] * 4, 1)
        chain[4, 4] = -1 / self.lag
        a, b = held(chain, np.array([[0], [0], [0], [0], [1 / self.lag]]), time / samples)

        def flown(start, command):
            state, torque = start[:5], start[5]
            for _ in range(samples):
                torque = self.law(state[2:], command, torque)
                state = a @ state + b[:, 0] * torque
            return [*state, torque]

        return np.array([flown(unit, 0.0) for unit in np.eye(6)]).T, np.array([flown(np.zeros(6), 1.0)]).T


def accelerations(values: dict) -> tuple[float, float]:
    """Largest angular accelerations in hover about the slower one of roll and pitch, and about yaw, of a plus of four rotors."""
    k1, k2 = values["airframe.rotor.thrust_coefficient"], values["airframe.rotor.torque_coefficient"]
    least, most = (k1 * values[f"airframe.rotor.speed_{end}"] ** 2 for end in ("min", "max"))
    mean = values["airframe.mass"] * GRAVITY / 4
    room = min(mean - least, most - mean)
    x, y, z = (values[f"airframe.inertia.{axis}"] for axis in "xyz")
    return 2 * values["airframe.arm_length"] * room / max(x, y), 4 * room * k2 / k1 / z


CHANNELS = {
    "altitude": ([""], [""]),
    "position": ([".x", ".y"], [".theta", ".phi"]),
    "attitude": ([".phi", ".theta", ".psi"], [".phi", ".theta", ".psi"]),
}


def settings_of(values: dict, controller: str) -> Settings:
    outputs, inputs = CHANNELS[controller]

    def value(name):
        return values[f"controller.{controller}.{name}"]

    return Settings(
        sample_time=value("sample_time"),
        terms=int(value("terms")),
        scale=value("scale"),
        horizon=int(value("prediction_horizon")),
        alpha=value("alpha"),
        lam=value("lambda"),
        output_weight=[value(f"output_weight{output}") for output in outputs],
        damping_weight=[value(f"damping_weight{output}") for output in outputs],
        rate_weight=[value(f"rate_weight{output}") for output in outputs],
        increment_weight=[value(f"increment_weight{i}") for i in inputs],
    )


def design(values: dict, controller: str, model: int) -> Figures:
    settings = settings_of(values, controller)
    time = settings.sample_time
    if controller == "attitude":
        return Attitude(values, model).figures
    if controller == "altitude":
        if model == PAPER:
            return printed(settings, double_integrator(time), ALTITUDE_BANDWIDTH)
        axis = with_lag(values["airframe.rotor.time_constant"], time)
        return stabilized(settings, axis, ALTITUDE_BANDWIDTH, STABILIZING_SHARE[controller])
    if model == PAPER:
        return printed(settings, double_integrator(time), POSITION_BANDWIDTH_PAPER)
    attitude = Attitude(values, model)
    bandwidth = POSITION_SHARE / (attitude.delay() + time / 2)
    return stabilized(settings, attitude.under_position(time), bandwidth, STABILIZING_SHARE[controller])


def assert_calculated(slave, model_description, controller: str, model: int, changes: dict):
    values = {
        v.name: float(v.start)
        for v in model_description.modelVariables
        if v.causality == "parameter" and v.type in ("Real", "Integer")
    }
    values.update(changes)
    instance = slave({"controller.model": model, **changes})

    names = ("spectral_radius", "eigenvalue_difference_to_dlqr", "condition_number")
    radius, difference, condition = instance.get(*(f"controller.{controller}.{name}" for name in names))
    expected = design(values, controller, model)
    assert radius == pytest.approx(expected.radius, rel=1e-6)
    assert difference == pytest.approx(expected.difference, abs=1e-6)
    assert condition == pytest.approx(expected.condition, rel=1e-4)
    assert radius < 1.0


@pytest.mark.parametrize("controller", CHANNELS)
@pytest.mark.parametrize(
    "changes", [{}, {"terms": 9, "scale": 0.75}, {"terms": 1}, {"sample_time": 0.02}, {"lambda": 0.97}], ids=str
)
def test_calculated_parameters(slave, model_description, controller, changes):
    changes = {f"controller.{controller}.{name}": value for name, value in changes.items()}
    assert_calculated(slave, model_description, controller, INNER_LOOPS, changes)


@pytest.mark.parametrize("weight", ["output_weight", "damping_weight", "rate_weight", "increment_weight"])
@pytest.mark.parametrize("controller", CHANNELS)
def test_weights_are_relative_to_the_bandwidth(slave, model_description, controller, weight):
    outputs, inputs = CHANNELS[controller]
    channels = inputs if weight == "increment_weight" else outputs
    changes = {f"controller.{controller}.{weight}{channel}": 2.0 + i for i, channel in enumerate(channels)}
    # The closed attitude loop is that of the slower one of roll and pitch; here they are alike.
    assert_calculated(slave, model_description, controller, INNER_LOOPS, changes)


@pytest.mark.parametrize("controller", CHANNELS)
@pytest.mark.parametrize(
    "changes",
    [
        {"airframe.rotor.time_constant": 0.08},
        {"airframe.mass": 1.0},
        {"airframe.inertia.x": 0.08, "airframe.inertia.y": 0.08, "airframe.inertia.z": 0.15},
        {"controller.attitude.increment_weight.phi": 3.0, "controller.attitude.increment_weight.theta": 3.0},
    ],
    ids=str,
)
def test_the_loops_inside_are_those_of_the_airframe(slave, model_description, controller, changes):
    assert_calculated(slave, model_description, controller, INNER_LOOPS, changes)


@pytest.mark.parametrize("controller", CHANNELS)
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"terms": 9, "scale": 0.75},
        {"prediction_horizon": 300},
        {"alpha": 1.05},
        {"alpha": 1.0, "prediction_horizon": 60},
        {"lambda": 0.998},
    ],
    ids=str,
)
def test_calculated_parameters_of_the_papers_models(slave, model_description, controller, changes):
    changes = {f"controller.{controller}.{name}": value for name, value in changes.items()}
    assert_calculated(slave, model_description, controller, PAPER, changes)
