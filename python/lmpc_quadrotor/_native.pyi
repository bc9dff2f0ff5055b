from collections.abc import Iterable
from typing import Any, Literal, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "ArgumentError",
    "Controller",
    "DesignError",
    "Dlqr",
    "Fleet",
    "FlightError",
    "KalmanDesign",
    "KalmanPredictor",
    "LaguerreBasis",
    "Limit",
    "LmpcDesign",
    "ParameterError",
    "SignalLimit",
    "Simulation",
    "StabilizedDesign",
    "StateSpace",
    "StateSpaceMpcDesign",
    "Step",
    "__version__",
    "condition_number",
    "eigenvalues",
    "inputs",
    "outputs",
    "parameters",
    "solve_riccati",
    "solve_stein",
    "spectral_radius",
    "uncontrollable_eigenvalues",
    "unobservable_eigenvalues",
]

__version__: str

_Matrix = npt.NDArray[np.float64]
_Vector = npt.NDArray[np.float64]
_Complex = npt.NDArray[np.complex128]
_Given = npt.ArrayLike

class ArgumentError(ValueError):
    """An argument has a wrong shape, name or value. The message names the argument and what is allowed."""

class DesignError(ValueError):
    """A controller or estimator cannot be designed. The message names the argument or matrix, its value and what is allowed."""

class ParameterError(ValueError):
    """A parameter or input of a flight is unknown or out of range. The message has its name, its value and the allowed range."""

class FlightError(RuntimeError):
    """A flight cannot go on, for instance because its motion has diverged."""

def parameters() -> dict[str, dict[str, Any]]:
    """All parameters by name, each with description, unit, type, start, tunable, and minimum and maximum or items."""

def inputs() -> dict[str, dict[str, Any]]:
    """All inputs by name, each with description, unit, minimum and maximum; a switch has no range."""

def outputs() -> dict[str, dict[str, Any]]:
    """All outputs by name, each with description, unit, whether it is whole, and the items that it counts, if any."""

@final
class StateSpace:
    """A discrete linear plant x(k+1) = A x(k) + B u(k), y(k) = C x(k), with A n×n, B n×p and C q×n.

    Raises `DesignError` when the shapes do not fit or a number is not finite.
    """

    def __new__(cls, a: _Given, b: _Given, c: _Given) -> StateSpace: ...
    @staticmethod
    def from_continuous(
        a: _Given,
        b: _Given,
        c: _Given,
        sample_time: float,
        discretization: Literal["zero_order_hold", "forward_euler"] = "zero_order_hold",
    ) -> StateSpace:
        """From ẋ = A x + B u, y = C x, sampled every `sample_time` s, which must be positive."""

    @staticmethod
    def with_direct_term(a: _Given, b: _Given, c: _Given, d: _Given) -> StateSpace:
        """From A, B, C and D, q×p, of y(k) = C x(k) + D u(k−1). The states are [x(k); u(k−1)]."""

    @property
    def a(self) -> _Matrix:
        """A, n×n."""

    @property
    def b(self) -> _Matrix:
        """B, n×p."""

    @property
    def c(self) -> _Matrix:
        """C, q×n."""

    @property
    def states(self) -> int:
        """n."""

    @property
    def inputs(self) -> int:
        """p."""

    @property
    def outputs(self) -> int:
        """q."""

    def augmented(self) -> tuple[_Matrix, _Matrix, _Matrix]:
        """A, (n+q)×(n+q), B, (n+q)×p, and C, q×(n+q), of the incremental model with the states [Δx; y − r]."""

    def output_weights(self, output: float = 1.0, increment: float = 1.0) -> tuple[_Matrix, _Matrix]:
        """Q = output · CᵀC, (n+q)×(n+q), and R = increment · I, p×p, of the incremental model."""

@final
class LaguerreBasis:
    """N = `terms` discrete Laguerre functions, 1 to 1000, with the scaling factor a = `scale`, 0 ≤ a < 1; a = 0 are unit pulses."""

    def __new__(cls, terms: int, scale: float) -> LaguerreBasis: ...
    @staticmethod
    def for_control_horizon(terms: int, control_horizon: float) -> LaguerreBasis:
        """Functions that reach about `control_horizon` samples far: a = e^(−N/N_c)."""

    @property
    def terms(self) -> int:
        """N."""

    @property
    def scale(self) -> float:
        """a."""

    @property
    def a_l(self) -> _Matrix:
        """A_l, N×N: L(k+1) = A_l L(k)."""

    @property
    def initial(self) -> _Vector:
        """L(0), N."""

    def functions(self, samples: int) -> _Matrix:
        """L(0), L(1), … as rows: samples×N, 10 000 samples at most."""

@final
class Dlqr:
    """The infinite-horizon regulator Δu = −K x of x(k+1) = A x + B Δu.

    It minimizes Σ λ^(−2j) (xᵀQx + ΔuᵀRΔu), so that all eigenvalues of the closed loop are smaller than λ = `degree`, 0 < λ ≤ 1.
    Q must be symmetric and positive semidefinite, R symmetric and positive definite.
    """

    def __new__(cls, a: _Given, b: _Given, q: _Given, r: _Given, degree: float = 1.0) -> Dlqr: ...
    @staticmethod
    def exponentially_weighted(a: _Given, b: _Given, q: _Given, r: _Given, alpha: float) -> Dlqr:
        """The regulator of Σ α^(−2j) (xᵀQx + ΔuᵀRΔu), α ≥ 1: all eigenvalues are smaller than α, so it need not be stable."""

    @property
    def gain(self) -> _Matrix:
        """K, p×n."""

    @property
    def cost(self) -> _Matrix:
        """P, n×n: from the state x on it costs xᵀPx."""

    @property
    def radius(self) -> float:
        """What every eigenvalue of the closed loop is smaller than."""

@final
class LmpcDesign:
    """Laguerre MPC on the incremental model of a plant over N_p = `horizon` samples, 1 to 10 000, with a basis for each input.

    Q is (n+q)×(n+q), R p×p. `weighting` says how the cost depends on the sample:

    * "terminal": the regulator's cost stands at the end of the horizon; the better choice under limits;
    * "exponential": Wang's, with `alpha` ≥ 1; well conditioned for any horizon;
    * "literal": the paper's, which need not give a stable loop, and is refused then.

    `degree` λ, 0 < λ ≤ 1: all eigenvalues of the closed loop are asked to be smaller. "terminal" takes no `alpha`, "literal" no
    `degree`.
    """

    def __new__(
        cls,
        plant: StateSpace,
        q: _Given,
        r: _Given,
        bases: Iterable[LaguerreBasis],
        horizon: int,
        weighting: Literal["terminal", "exponential", "literal"] = "terminal",
        alpha: float = 1.0,
        degree: float = 1.0,
    ) -> LmpcDesign: ...
    @property
    def gain(self) -> _Matrix:
        """K, p×(n+q): without limits Δu = −K [Δx; y − r]."""

    @property
    def dlqr_gain(self) -> _Matrix:
        """The gain of the infinite-horizon regulator of the same weights, p×(n+q)."""

    @property
    def omega(self) -> _Matrix:
        """Ω of the cost ηᵀΩη + 2ηᵀΨx, ΣN×ΣN."""

    @property
    def psi(self) -> _Matrix:
        """Ψ, ΣN×(n+q)."""

    @property
    def closed_loop_eigenvalues(self) -> _Complex:
        """Eigenvalues of A − BK, n+q."""

    @property
    def spectral_radius(self) -> float:
        """Their largest magnitude, below 1."""

    @property
    def condition_number(self) -> float:
        """Of Ω."""

    @property
    def gain_error(self) -> float:
        """Share of the gain that rounding may have changed, at most."""

@final
class StabilizedDesign:
    """Laguerre MPC whose plan is about a slow, stabilizing feedback K_s, p×(n+q), over the infinite horizon.

    Scaling factors of the bases must be below `degree`.
    """

    def __new__(
        cls,
        plant: StateSpace,
        q: _Given,
        r: _Given,
        stabilizing_gain: _Given,
        bases: Iterable[LaguerreBasis],
        degree: float = 1.0,
    ) -> StabilizedDesign: ...
    @property
    def gain(self) -> _Matrix:
        """K, p×(n+q): without limits Δu = −K [Δx; y − r]."""

    @property
    def stabilizing_gain(self) -> _Matrix:
        """K_s, p×(n+q)."""

    @property
    def cost(self) -> _Matrix:
        """S, (n+q+ΣN)²: a plan costs [x; η]ᵀ S [x; η]."""

    @property
    def dlqr_gain(self) -> _Matrix:
        """The gain of the infinite-horizon regulator of the same weights, p×(n+q)."""

    @property
    def spectral_radius(self) -> float:
        """Largest magnitude of the eigenvalues of the closed loop, below 1."""

    @property
    def condition_number(self) -> float:
        """Of the part of S that belongs to η."""

@final
class StateSpaceMpcDesign:
    """State-space MPC: `moves` unknowns for each input, 1 to 1000, within `horizon` samples, 2 to 10 000.

    `output_weight` is q×q, on y − r; `move_weight` p×p, on Δu; `increment_weight` n×n, on Δx; `terminal` (n+q)×(n+q), on
    [Δx; y − r] at the end of the horizon, for instance the cost of a `Dlqr`.
    """

    def __new__(
        cls,
        plant: StateSpace,
        output_weight: _Given,
        move_weight: _Given,
        horizon: int,
        moves: int,
        increment_weight: _Given | None = None,
        terminal: _Given | None = None,
    ) -> StateSpaceMpcDesign: ...
    @property
    def gains(self) -> tuple[_Matrix, _Matrix]:
        """K_x, p×n, and K_u, p×p: without limits Δu = −K_x (x − x_r) − K_u u(k−1), relative to the reference."""

    @property
    def hessian(self) -> _Matrix:
        """H of the quadratic program, p·moves squared."""

    @property
    def spectral_radius(self) -> float:
        """Largest magnitude of the eigenvalues of the closed loop without limits, below 1."""

@final
class KalmanDesign:
    """The stationary predictor of x(k+1) = A x + B u + w, y = C x + v.

    Covariances: `state_noise` of w, n×n; `measurement_noise` of v, q×q, positive definite; `cross` = E[w vᵀ], n×q.
    """

    def __new__(
        cls, plant: StateSpace, state_noise: _Given, measurement_noise: _Given, cross: _Given | None = None
    ) -> KalmanDesign: ...
    @property
    def gain(self) -> _Matrix:
        """K, n×q."""

    @property
    def covariance(self) -> _Matrix:
        """Covariance of the error of the prediction, n×n."""

@final
class KalmanPredictor:
    """The predictor of a design at run time, from an estimate of n numbers on; zero if it is left out."""

    def __new__(cls, design: KalmanDesign, estimate: _Given | None = None) -> KalmanPredictor: ...
    @property
    def estimate(self) -> _Vector:
        """x̂ of the next sample, n."""

    def predict(self, input: _Given, measurement: _Given) -> _Vector:
        """Goes on to the next sample, from u(k), p, and y(k), q; returns x̂(k+1), n. What is not finite is left out."""

@final
class Limit:
    """directions · quantity ≤ upper on some samples of a plan, 0 to 10 000; the values `upper` are given at each step.

    `quantity` is "increment" (Δu), "input" (u) or "state" (x). `directions` has a row for each bound and a column for each input
    or state. A `soft` limit gives way first when not all can be kept.
    """

    def __new__(
        cls,
        quantity: Literal["increment", "input", "state"],
        directions: _Given,
        samples: Iterable[int],
        soft: bool = False,
    ) -> Limit: ...
    @staticmethod
    def range(
        quantity: Literal["increment", "input", "state"], count: int, samples: Iterable[int], soft: bool = False
    ) -> Limit:
        """Upper and lower bounds of `count` inputs or states, 1 to 1000: `upper` is [largest…, −smallest…]."""

    @staticmethod
    def polygon(
        quantity: Literal["increment", "input", "state"], sides: int, samples: Iterable[int], soft: bool = False
    ) -> Limit:
        """A joint bound of two inputs or states: a regular polygon of 3 to 1000 sides; `upper` = r cos(π/sides) lies inside the circle of radius r."""

    @property
    def bounds(self) -> int:
        """How many values of `upper` it takes."""

@final
class SignalLimit:
    """directions · (C x + D u) ≤ upper on some samples, of a signal with at most three components.

    `relaxation` is by how much each bound gives way per unit of the slack that all limits share, in units of the signal.
    """

    def __new__(
        cls, c: _Given, d: _Given, directions: _Given, samples: Iterable[int], relaxation: float
    ) -> SignalLimit: ...
    @staticmethod
    def input_range(states: int, inputs: int, samples: Iterable[int], relaxation: float) -> SignalLimit:
        """Upper and lower bounds of all inputs: `upper` is [largest…, −smallest…]."""

    @staticmethod
    def state_range(
        states: int, inputs: int, limited: Iterable[int], samples: Iterable[int], relaxation: float
    ) -> SignalLimit:
        """Upper and lower bounds of the states with these indices: `upper` is [largest…, −smallest…]."""

    @property
    def bounds(self) -> int:
        """How many values of `upper` it takes."""

@final
class Step:
    """What a controller decided at a sample."""

    @property
    def input(self) -> _Vector:
        """u(k), p: to be applied."""

    @property
    def increment(self) -> _Vector:
        """Δu(k), p."""

    @property
    def integral(self) -> _Vector:
        """The share of the integral action in Δu, p; zero under limits that are active."""

    @property
    def status(self) -> Literal["optimal", "relaxed", "iteration_limit", "held"]:
        """How the input was found: "relaxed" when not all limits can be kept, "held" when a number was not finite."""

    @property
    def iterations(self) -> int:
        """Of the solver; 0 when no limit was near."""

    @property
    def active(self) -> int:
        """Limits that are active."""

@final
class Controller:
    """A control law with its state: the last measurement, the last input, and the limits that were active.

    At most 16 states, 4 inputs, as many outputs as inputs, and 64 Laguerre terms or moves of all inputs together.
    """

    @staticmethod
    def state_feedback(plant: StateSpace, gain: _Given) -> Controller:
        """Δu = −K [Δx; y − r] with K p×(n+q): a regulator, or Laguerre MPC without limits."""

    @staticmethod
    def laguerre_mpc(
        design: LmpcDesign, limits: Iterable[Limit] = ..., model_increment: bool = False
    ) -> Controller:
        """Laguerre MPC under limits. With `model_increment` the increment follows from the model: for actuators that lag."""

    @staticmethod
    def stabilized_mpc(
        design: StabilizedDesign, limits: Iterable[SignalLimit] = ..., slack_cost: float = 10000.0
    ) -> Controller:
        """Laguerre MPC about a stabilizing feedback, under limits whose common slack of 1 costs `slack_cost`."""

    @staticmethod
    def state_space_mpc(design: StateSpaceMpcDesign, limits: Iterable[Limit] = ...) -> Controller:
        """State-space MPC under limits; those of states bound the deviation from the reference."""

    def step(
        self,
        measured: _Given,
        reference: _Given | None = None,
        *,
        reference_increment: _Given | None = None,
        input_reference: _Given | None = None,
        disturbance: _Given | None = None,
        upper: _Given | None = None,
        preview: _Given | None = None,
    ) -> Step:
        """One sample: from the state `measured`, n, to the input, which is taken as applied: see `apply`.

        `reference` is the state to be in, n; `reference_increment` what a plant on a moving reference moves by, n;
        `input_reference` the input that keeps it there, p; `disturbance` an estimate that acts as an input, p; `upper` the
        values of all bounds, one limit after the other, none if left out; `preview` r(k), r(k+1), … as deviations from the
        reference, a row of q numbers each, for `state_space_mpc`. What is left out is zero.
        """

    def take_over(
        self,
        measured: _Given | None = None,
        applied: _Given | None = None,
        input_reference: _Given | None = None,
    ) -> None:
        """Begins anew with a plant whose last state and input these were, n and p, p of it feed-forward; zero if left out."""

    def apply(self, applied: _Given) -> None:
        """Reports the input that was applied in truth, p, so that saturation does not wind up the integral action.

        What is not finite is ignored.
        """

    def save(self) -> bytes:
        """The state, to go on from with `restore`."""

    def restore(self, saved: bytes) -> None:
        """Goes on from a saved state of a controller of the same sizes."""

    @property
    def bounds(self) -> int:
        """How many values of `upper` a step takes."""

def solve_riccati(a: _Given, b: _Given, q: _Given, r: _Given) -> _Matrix:
    """The stabilizing solution P, n×n, of P = AᵀPA − AᵀPB (R + BᵀPB)⁻¹ BᵀPA + Q."""

def solve_stein(a: _Given, b: _Given, c: _Given) -> _Matrix:
    """X of X = A X Bᵀ + C for stable A and B."""

def eigenvalues(a: _Given) -> _Complex:
    """All eigenvalues of a square matrix."""

def spectral_radius(a: _Given) -> float:
    """The largest magnitude of the eigenvalues of a square matrix."""

def condition_number(a: _Given) -> float:
    """The ratio of the largest to the smallest singular value; infinite for a matrix without full rank."""

def uncontrollable_eigenvalues(a: _Given, b: _Given) -> _Complex:
    """Eigenvalues of the part of (A, B) that B cannot reach; none when the pair is controllable."""

def unobservable_eigenvalues(a: _Given, c: _Given) -> _Complex:
    """Eigenvalues of the part of (A, C) that C does not show; none when the pair is observable."""

@final
class Simulation:
    """One flight in whole µs: `lmpc_quadrotor.Simulation` is beside it."""

    def __new__(cls, parameters: dict[str, Any], inputs: dict[str, Any], actuation: str = "reference") -> Simulation: ...
    @staticmethod
    def from_saved(saved: bytes) -> Simulation: ...
    def copy(self) -> Simulation: ...
    @property
    def actuation(self) -> str: ...
    @property
    def time_us(self) -> int: ...
    @property
    def warnings(self) -> list[str]: ...
    def parameters(self) -> dict[str, Any]: ...
    def set_parameters(self, values: dict[str, Any]) -> None: ...
    def inputs(self) -> dict[str, float]: ...
    def set_inputs(self, values: dict[str, Any]) -> None: ...
    def output_names(self) -> list[str]: ...
    def read(self, names: list[str] | None = None) -> _Vector: ...
    def place(self, value: _Given) -> None: ...
    def advance_to(self, time_us: int) -> None: ...
    def record(
        self, end_us: int, step_us: int, names: list[str] | None = None
    ) -> tuple[npt.NDArray[np.uint64], _Matrix]: ...
    def save(self) -> bytes: ...
    def restore(self, saved: bytes) -> None: ...

@final
class Fleet:
    """Many flights in whole µs: `lmpc_quadrotor.Fleet` is beside it."""

    def __new__(
        cls,
        count: int,
        parameters: dict[str, Any],
        inputs: dict[str, Any],
        actuation: str = "reference",
        threads: int | None = None,
    ) -> Fleet: ...
    def __len__(self) -> int: ...
    @property
    def actuation(self) -> str: ...
    @property
    def times_us(self) -> npt.NDArray[np.uint64]: ...
    @property
    def failures(self) -> list[str | None]: ...
    @property
    def failed(self) -> npt.NDArray[np.bool_]: ...
    def output_names(self) -> list[str]: ...
    def set_inputs(self, values: dict[str, Any]) -> None: ...
    def advance(self, duration_us: int) -> None: ...
    def read(self, names: list[str] | None = None) -> _Matrix: ...
    def record(
        self, duration_us: int, step_us: int, names: list[str] | None = None
    ) -> tuple[npt.NDArray[np.uint64], npt.NDArray[np.float64]]: ...
    def restart(self, vehicles: Iterable[int], motions: _Given | None = None) -> None: ...
    def save(self) -> list[bytes]: ...
    def restore(self, saved: list[bytes]) -> None: ...
