"""Linear model predictive control with Laguerre functions, on NumPy arrays: for any linear plant, not only a quadrotor.

A plant has n states, p inputs and q outputs: x(k+1) = A x(k) + B u(k), y(k) = C x(k). Designs are made on its incremental
model, whose state is [Δx; y − r], so that every controller holds its output error at zero. Weights Q of that state are
(n+q)×(n+q), weights R of the moves Δu p×p, gains p×(n+q).

>>> import numpy as np
>>> plant = StateSpace.from_continuous([[0, 1], [0, 0]], [[0], [1]], [[1, 0]], 0.05)
>>> q, r = plant.output_weights(output=1.0, increment=1.0)
>>> design = LmpcDesign(plant, q, r, [LaguerreBasis(5, 0.8)], horizon=100)
>>> controller = Controller.laguerre_mpc(design, [Limit.range("input", 1, range(20))])
>>> x = np.zeros(2)
>>> for k in range(200):
...     step = controller.step(x, reference=[1.0, 0.0], upper=[0.5, 0.5])
...     x = plant.a @ x + plant.b @ step.input
>>> bool(abs(x[0] - 1.0) < 1e-3)
True

What cannot be designed raises `DesignError`, a shape or name that does not fit `ArgumentError`; both are `ValueError`.
Matrices are anything that NumPy takes for an array; a number is a 1×1 matrix.
"""

from ._native import (
    ArgumentError,
    Controller,
    DesignError,
    Dlqr,
    KalmanDesign,
    KalmanPredictor,
    LaguerreBasis,
    Limit,
    LmpcDesign,
    SignalLimit,
    StabilizedDesign,
    StateSpace,
    StateSpaceMpcDesign,
    Step,
    condition_number,
    eigenvalues,
    solve_riccati,
    solve_stein,
    spectral_radius,
    uncontrollable_eigenvalues,
    unobservable_eigenvalues,
)

__all__ = [
    "ArgumentError",
    "Controller",
    "DesignError",
    "Dlqr",
    "KalmanDesign",
    "KalmanPredictor",
    "LaguerreBasis",
    "Limit",
    "LmpcDesign",
    "SignalLimit",
    "StabilizedDesign",
    "StateSpace",
    "StateSpaceMpcDesign",
    "Step",
    "condition_number",
    "eigenvalues",
    "solve_riccati",
    "solve_stein",
    "spectral_radius",
    "uncontrollable_eigenvalues",
    "unobservable_eigenvalues",
]
