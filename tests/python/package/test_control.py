"""Designs and controllers, with scipy and numpy as oracles."""

import doctest

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are, solve_discrete_lyapunov
from scipy.signal import cont2discrete

from lmpc_quadrotor import control
from lmpc_quadrotor.control import (
    Controller, DesignError, Dlqr, KalmanDesign, KalmanPredictor, LaguerreBasis, Limit, LmpcDesign, SignalLimit, StabilizedDesign,
    StateSpace, StateSpaceMpcDesign, condition_number, unobservable_eigenvalues,
)

DOUBLE_INTEGRATOR = ([[0, 1], [0, 0]], [[0], [1]], [[1, 0]])


def plant(states=2, inputs=1, outputs=1, seed=1):
    """A stable plant at random."""
    random = np.random.default_rng(seed)
    a = random.normal(size=(states, states))
    a *= 0.95 / np.abs(np.linalg.eigvals(a)).max()
    return StateSpace(a, random.normal(size=(states, inputs)), random.normal(size=(outputs, states)))


def identity_weights(model):
    return np.eye(model.states + model.outputs), np.eye(model.inputs)


def test_documentation_examples():
    assert doctest.testmod(control).failed == 0


@pytest.mark.parametrize("method, name", [("zoh", "zero_order_hold"), ("euler", "forward_euler")])
def test_sampling_is_scipys(method, name):
    model = StateSpace.from_continuous(*DOUBLE_INTEGRATOR, 0.05, name)
    a, b, *_ = cont2discrete((*map(np.array, DOUBLE_INTEGRATOR), np.zeros((1, 1))), 0.05, method)
    np.testing.assert_allclose(model.a, a, atol=1e-15)
    np.testing.assert_allclose(model.b, b, atol=1e-15)


@pytest.mark.parametrize("states, inputs", [(2, 1), (5, 2), (12, 4)])
def test_regulator_is_scipys(states, inputs):
    model = plant(states, inputs, 1, seed=states)
    a, b, _ = model.augmented()
    q, r = np.eye(states + 1), 2.0 * np.eye(inputs)
    regulator = Dlqr(a, b, q, r)
    p = solve_discrete_are(a, b, q, r)
    np.testing.assert_allclose(regulator.cost, p, rtol=1e-8, atol=1e-8)
    gain = np.linalg.solve(r + b.T @ p @ b, b.T @ p @ a)
    np.testing.assert_allclose(regulator.gain, gain, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(control.solve_riccati(a, b, q, r), p, rtol=1e-8, atol=1e-8)


def test_degree_of_stability_bounds_the_eigenvalues():
    model = StateSpace.from_continuous(*DOUBLE_INTEGRATOR, 0.05)
    a, b, _ = model.augmented()
    regulator = Dlqr(a, b, np.eye(3), [[1.0]], degree=0.8)
    assert control.spectral_radius(a - b @ regulator.gain) < 0.8
    np.testing.assert_allclose(
        np.sort_complex(control.eigenvalues(a - b @ regulator.gain)), np.sort_complex(np.linalg.eigvals(a - b @ regulator.gain))
    )


def test_stein_equation_is_scipys():
    a = plant(4).a
    np.testing.assert_allclose(control.solve_stein(a, a, np.eye(4)), solve_discrete_lyapunov(a, np.eye(4)), rtol=1e-9)


def test_laguerre_functions_are_orthonormal():
    functions = LaguerreBasis(5, 0.8).functions(400)
    np.testing.assert_allclose(functions.T @ functions, np.eye(5), atol=1e-9)


def test_laguerre_mpc_approaches_the_regulator():
    model = StateSpace.from_continuous(*DOUBLE_INTEGRATOR, 0.05)
    q, r = model.output_weights()
    design, rough = (LmpcDesign(model, q, r, [LaguerreBasis(terms, 0.8)], 200) for terms in (8, 4))
    far = lambda one: np.abs(one.gain - one.dlqr_gain).max()
    assert far(design) < 0.01 * np.abs(design.dlqr_gain).max() and far(design) < 0.5 * far(rough)
    assert design.spectral_radius == pytest.approx(np.abs(design.closed_loop_eigenvalues).max())
    # η = −Ω⁻¹Ψx.
    eta = np.linalg.solve(design.omega, design.psi)
    np.testing.assert_allclose(LaguerreBasis(8, 0.8).initial @ eta, design.gain[0], rtol=1e-9)


def test_kalman_predictor_is_scipys():
    model = plant(4, 2, 2)
    noise, measurement = np.diag([1.0, 2.0, 3.0, 4.0]), np.diag([0.5, 0.25])
    design = KalmanDesign(model, noise, measurement)
    p = solve_discrete_are(model.a.T, model.c.T, noise, measurement)
    gain = model.a @ p @ model.c.T @ np.linalg.inv(model.c @ p @ model.c.T + measurement)
    np.testing.assert_allclose(design.gain, gain, rtol=1e-9)
    predictor = KalmanPredictor(design, np.ones(4))
    u, y = np.array([1.0, -1.0]), np.array([0.3, 0.2])
    expected = model.a @ np.ones(4) + model.b @ u + gain @ (y - model.c @ np.ones(4))
    np.testing.assert_allclose(predictor.predict(u, y), expected, rtol=1e-9)
    # What is not finite is left out.
    predicted = predictor.predict(u, [np.nan, 0.0])
    np.testing.assert_allclose(predicted, model.a @ expected + model.b @ u, rtol=1e-9)


def controllers(states, inputs, outputs):
    """Each law without limits with the gain it must have."""
    model = plant(states, inputs, outputs, seed=states + inputs)
    q, r = identity_weights(model)
    bases = [LaguerreBasis(4, 0.6)] * inputs
    a, b, _ = model.augmented()
    regulator = Dlqr(a, b, q, r)
    yield model, regulator.gain, Controller.state_feedback(model, regulator.gain)
    design = LmpcDesign(model, q, r, bases, 100)
    yield model, design.gain, Controller.laguerre_mpc(design)
    slow = Dlqr(a, b, q, 100.0 * r).gain
    stabilized = StabilizedDesign(model, q, r, slow, bases)
    yield model, stabilized.gain, Controller.stabilized_mpc(stabilized)


@pytest.mark.parametrize("states, inputs, outputs", [(1, 1, 1), (3, 2, 1), (5, 2, 2), (16, 4, 4)])
def test_laws_without_limits_are_their_gains(states, inputs, outputs):
    """Also for plants with fewer states than a law has room for."""
    random = np.random.default_rng(7)
    for model, gain, law in controllers(states, inputs, outputs):
        before, u, x_r = np.zeros(model.states), np.zeros(inputs), random.normal(size=model.states)
        for _ in range(5):
            x = random.normal(size=model.states)
            step = law.step(x, x_r)
            u = u - gain @ np.concatenate([x - before, model.c @ (x - x_r)])
            np.testing.assert_allclose(step.input, u, rtol=1e-6, atol=1e-8)
            assert step.status == "optimal"
            before = x


def test_state_space_mpc_is_its_gains():
    model = plant(3, 2, 2)
    design = StateSpaceMpcDesign(model, np.eye(2), np.eye(2), 30, 8)
    law, (of_state, of_input) = Controller.state_space_mpc(design), design.gains
    x, v = np.array([1.0, -2.0, 0.5]), np.zeros(2)
    for _ in range(4):
        step = law.step(x)
        v = v - of_state @ x - of_input @ v
        np.testing.assert_allclose(step.input, v, rtol=1e-8, atol=1e-10)
        x = model.a @ x + model.b @ step.input


def fly(law, model, upper, samples=150, goal=1.0):
    x, inputs, states = np.zeros(model.states), [], []
    for _ in range(samples):
        step = law.step(x, [goal, *np.zeros(model.states - 1)], upper=upper)
        inputs.append(step.input)
        x = model.a @ x + model.b @ step.input
        states.append(x)
    return np.array(inputs), np.array(states)


def limited():
    model = StateSpace.from_continuous(*DOUBLE_INTEGRATOR, 0.05)
    q, r = model.output_weights()
    bases, samples = [LaguerreBasis(6, 0.7)], list(range(40))
    yield model, Controller.laguerre_mpc(LmpcDesign(model, q, r, bases, 200), [Limit.range("input", 1, samples)])
    a, b, _ = model.augmented()
    stabilized = StabilizedDesign(model, q, r, Dlqr(a, b, q, 100.0 * r).gain, bases)
    yield model, Controller.stabilized_mpc(stabilized, [SignalLimit.input_range(2, 1, samples, 0.01)])
    moves = StateSpaceMpcDesign(model, [[1.0]], [[1.0]], 60, 20)
    yield model, Controller.state_space_mpc(moves, [Limit.range("input", 1, list(range(20)))])


def test_limits_are_kept_and_the_goal_is_reached():
    for model, law in limited():
        assert law.bounds == 2
        inputs, states = fly(law, model, [0.5, 0.5])
        assert 0.45 < np.abs(inputs).max() < 0.5 + 1e-6
        np.testing.assert_allclose(states[-1], [1.0, 0.0], atol=5e-3)


def test_a_limited_step_is_the_minimum_of_its_program():
    """Against scipy's minimizer of the same cost under the same limits."""
    from scipy.optimize import minimize

    model = StateSpace.from_continuous(*DOUBLE_INTEGRATOR, 0.05)
    q, r = model.output_weights()
    basis, samples = LaguerreBasis(3, 0.6), list(range(20))
    design = LmpcDesign(model, q, r, [basis], 100)
    step = Controller.laguerre_mpc(design, [Limit.range("increment", 1, samples)]).step([-1.0, 0.0], upper=[0.2, 0.2])
    # x(−1) = 0: Δx = x.
    x, moves = np.array([-1.0, 0.0, -1.0]), basis.functions(20)
    size = np.linalg.norm(design.omega)
    cost = lambda eta: (eta @ design.omega @ eta + 2.0 * eta @ design.psi @ x) / size
    gradient = lambda eta: 2.0 * (design.omega @ eta + design.psi @ x) / size
    limits = {"type": "ineq", "fun": lambda eta: 0.2 - np.concatenate([moves @ eta, -moves @ eta]), "jac": lambda eta: np.vstack([-moves, moves])}
    best = minimize(cost, np.zeros(3), jac=gradient, constraints=limits, method="SLSQP", options={"ftol": 1e-14, "maxiter": 500})
    assert best.success
    np.testing.assert_allclose(step.increment, moves[0] @ best.x, atol=1e-5)
    assert step.active > 0 and step.iterations > 0


def test_a_saved_controller_goes_on_the_same():
    for model, law in limited():
        fly(law, model, [0.5, 0.5], samples=10)
        saved = law.save()
        one = [law.step([0.1, 0.2], [1.0, 0.0], upper=[0.5, 0.5]).input for _ in range(3)]
        law.restore(saved)
        again = [law.step([0.1, 0.2], [1.0, 0.0], upper=[0.5, 0.5]).input for _ in range(3)]
        np.testing.assert_array_equal(one, again)


def test_what_was_applied_counts():
    model, law = next(limited())
    law.take_over([0.0, 0.0])
    law.step([0.0, 0.0], [1.0, 0.0])
    law.apply([0.0])
    assert law.step([0.0, 0.0], [1.0, 0.0]).increment == pytest.approx(law.step([0.0, 0.0], [1.0, 0.0]).increment, rel=0.5)


A, B, C = DOUBLE_INTEGRATOR
PLANT = StateSpace.from_continuous(A, B, C, 0.05)


def design_of(horizon=100, bases=None, **options):
    return LmpcDesign(PLANT, *PLANT.output_weights(), [LaguerreBasis(3, 0.5)] if bases is None else bases, horizon, **options)



@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: LaguerreBasis(0, 0.5), "terms = 0; expected a whole number from 1 to 1000"),
        (lambda: LaguerreBasis(10**9, 0.5), "terms = 1000000000; expected a whole number from 1 to 1000"),
        (lambda: LaguerreBasis(5, "a"), "scale = 'a'; expected a number"),
        (lambda: LaguerreBasis(5, 0.5).functions(10**12), "samples = 1000000000000; expected a whole number from 0 to 10000"),
        (lambda: LaguerreBasis(5, 1.5), "scale: Laguerre scaling factor a = 1.5 is outside [0, 1)"),
        (lambda: LaguerreBasis.for_control_horizon(5, 0.0), "control_horizon: control horizon N_c = 0 is outside (0, ∞)"),
        (lambda: StateSpace.from_continuous(A, B, C, 0.0), "sample_time: sample time 0 s is outside (0, ∞)"),
        (lambda: StateSpace.from_continuous(A, B, C, 0.1, "tustin"), "discretization = \"tustin\"; allowed are 'zero_order_hold'"),
        (lambda: StateSpace([[1, 2]], [[1]], [[1]]), "A is 1×2, expected 1×1"),
        (lambda: StateSpace([1.0, 2.0], B, C), "a has 1 dimension; expected a matrix"),
        (lambda: StateSpace("plant", B, C), "a is no array of numbers"),
        (lambda: Dlqr(np.eye(2), B, np.eye(2), [[1.0]], degree=1.5), "degree: degree of stability λ = 1.5 is outside (0, 1]"),
        (lambda: Dlqr(np.eye(2), B, np.eye(2), [[-1.0]]), "R is not positive definite: it has the eigenvalue -1"),
        (lambda: Limit.range("output", 1, [0]), "quantity = \"output\"; allowed are 'increment', 'input' and 'state'"),
        (lambda: LaguerreBasis(-1, 0.5), "terms = -1; expected a whole number from 1 to 1000"),
        (lambda: LaguerreBasis(2.5, 0.5), "terms = 2.5; expected a whole number from 1 to 1000"),
        (lambda: Limit.range("input", 1, [-3]), "samples has -3; expected whole numbers from 0 to 10000, one or more"),
        (lambda: Limit.range("input", 1, []), "samples = []; expected whole numbers from 0 to 10000, one or more"),
        (lambda: Limit.range("input", 1, 5), "samples = 5; expected whole numbers"),
        (lambda: Limit.range("input", 10**9, [0]), "count = 1000000000; expected a whole number from 1 to 1000"),
        (lambda: Limit.polygon("state", 2, [0]), "sides = 2; expected a whole number from 3 to 1000"),
        (lambda: Limit("input", [[np.nan]], [0]), "directions contains NaN; expected finite numbers"),
        (lambda: SignalLimit([[1, 0]], [[0]], [[1, 2]], [0], 1.0), "directions has 2 columns, expected 1: one for each row of c"),
        (lambda: SignalLimit([[1, 0]] * 4, [[0]] * 4, np.eye(4), [0], 1.0), "c has 4 rows; allowed are 1 to 3"),
        (lambda: SignalLimit.state_range(2, 1, [2], [0], 1.0), "limited has 2; expected whole numbers from 0 to 1"),
        (lambda: PLANT.output_weights(output=-1.0), "output = -1 is outside [0, ∞)"),
        (lambda: PLANT.output_weights(increment=0.0), "increment = 0 is outside (0, ∞)"),
        (lambda: design_of(alpha=1.2), "alpha = 1.2 has no effect with weighting = 'terminal'"),
        (lambda: design_of(weighting="literal", degree=0.9), "degree = 0.9 has no effect with weighting = 'literal'"),
        (lambda: design_of(horizon=10**10), "horizon = 10000000000; expected a whole number from 1 to 10000"),
        (lambda: design_of(bases=LaguerreBasis(3, 0.5)), "bases = LaguerreBasis(terms=3, scale=0.5); expected a list of LaguerreBasis"),
        (lambda: StateSpaceMpcDesign(PLANT, [[1.0]], [[0.0]], 10, 5), "move_weight (S) is not positive definite"),
        (lambda: StateSpaceMpcDesign(PLANT, [[1.0]], [[1.0]], 10, 5, terminal=[[1.0]]), "terminal (P) is 1×1, expected 3×3"),
        (lambda: KalmanDesign(PLANT, np.full((2, 2), np.nan), [[1.0]]), "state_noise (W) contains a value that is not finite"),
        (lambda: KalmanPredictor(KalmanDesign(PLANT, np.eye(2), [[1.0]]), [np.nan, 0.0]), "estimate contains NaN"),
        (lambda: next(limited())[1].take_over([np.inf, 0.0]), "measured contains inf; expected finite numbers"),
        (lambda: Controller.state_feedback(PLANT, [[np.nan, 1.0, 1.0]]), "gain contains a value that is not finite: element (0, 0) is NaN"),
        (lambda: Controller.laguerre_mpc(design_of(), [SignalLimit.input_range(2, 1, [0], 1.0)]), "expected a list of Limit"),
        (lambda: condition_number(np.zeros((0, 3))), "a is 0×3; expected a row and a column at least"),
        (lambda: Dlqr([[1.0]], [[0.0]], [[1.0]], [[1.0]]), "the mode at 1 is not controllable, so no gain stabilizes it"),
        (lambda: next(limited())[1].restore(next(limited())[1].save() + b"\0"), "saved is no state of this controller"),
        (lambda: condition_number([[np.nan]]), "a contains a value that is not finite: element (0, 0) is NaN"),
        (lambda: unobservable_eigenvalues([[1.0]], [[1.0, 2.0]]), "C is 1×2, expected 1×1"),
        (lambda: SignalLimit.input_range(2, 1, [0], -1.0), "relaxation = -1 is outside (0, ∞)"),
        (lambda: next(limited())[1].step([1.0]), "measured has 1 element, expected 2"),
        (lambda: next(limited())[1].step([1.0, 0.0], upper=[1.0]), "upper has 1 element, expected 2"),
        (lambda: Controller.state_feedback(plant(17), np.zeros((1, 18))), "no controller has this size: 17 states"),
    ],
)
def test_errors_name_the_argument_its_value_and_what_is_allowed(make, message):
    with pytest.raises(ValueError) as error:
        make()
    assert message in str(error.value)


def test_samples_are_any_whole_numbers():
    """A range, an array of NumPy's and a generator are the same limit."""
    laws = [Controller.laguerre_mpc(design_of(), [Limit.range("input", 1, samples)]) for samples in (range(9), np.arange(9), (k for k in range(9)))]
    inputs = [law.step([-1.0, 0.0], upper=[0.2, 0.2]).input for law in laws]
    np.testing.assert_array_equal(inputs[0], inputs[1])
    np.testing.assert_array_equal(inputs[0], inputs[2])


def test_a_matrix_without_full_rank_has_no_finite_condition():
    assert condition_number(np.zeros((2, 2))) == np.inf
    assert condition_number([[2.0, 0.0], [0.0, 0.5]]) == pytest.approx(np.linalg.cond([[2.0, 0.0], [0.0, 0.5]]))


def test_what_was_not_applied_is_left_out():
    one, other = (next(limited())[1] for _ in range(2))
    for law in (one, other):
        law.step([0.0, 0.0], [1.0, 0.0])
    one.apply([np.nan])
    np.testing.assert_array_equal(one.step([0.0, 0.0], [1.0, 0.0]).input, other.step([0.0, 0.0], [1.0, 0.0]).input)


def test_designs_that_fail_say_why():
    model = StateSpace.from_continuous(A, B, C, 0.05)
    q, r = model.output_weights()
    with pytest.raises(DesignError, match="bases: 2 Laguerre bases given; expected 1, one for each input"):
        LmpcDesign(model, q, r, [LaguerreBasis(3, 0.5)] * 2, 50)
    with pytest.raises(DesignError, match="horizon: prediction horizon N_p = 2 is shorter than the 3 terms"):
        LmpcDesign(model, q, r, [LaguerreBasis(3, 0.5)], 2)
    with pytest.raises(DesignError, match="moves: control horizon N_c = 9 must be at least 1 and below"):
        StateSpaceMpcDesign(model, [[1.0]], [[1.0]], 5, 9)
