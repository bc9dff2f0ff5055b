"""The demo's flights: what is set, which inputs are given over time, and what must come out."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np
from fmpy.model_description import ModelDescription

from measures import Check, Errors

#: The paper's flight: 5 m north, 5 m east, 10 m up, in NED.
GOAL = np.array([5.0, 5.0, -10.0])

#: Communication step and distance of the recorded points, s.
INTERVAL = 0.01

#: A set-point is reached with zero steady-state error when nothing larger is left at the end, m.
STEADY = 1e-3


@dataclass(frozen=True)
class Flight:
    """One flight of the FMU."""

    name: str
    title: str
    duration: float
    #: Judges the errors of the flight.
    checks: Callable[[Errors], list[Check]]
    start_values: dict = field(default_factory=dict)
    #: Columns of the input table by variable name, over the times of `time_grid`; None: nothing is set.
    inputs: Callable[[np.ndarray], dict] | None = None
    #: Position and heading that count as the reference, at given times; None: the FMU's own set-point.
    reference: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]] | None = None
    goal_yaw: float = 0.0

    def signals(self, model_description: ModelDescription) -> np.ndarray | None:
        """The input table for FMPy. Inputs that the flight does not give keep their start values."""
        if self.inputs is None:
            return None
        times = time_grid(self.duration)
        columns = self.inputs(times)
        variables = [v for v in model_description.modelVariables if v.causality == "input"]
        table = np.zeros(
            len(times),
            dtype=[("time", float)] + [(v.name, bool if v.type == "Boolean" else float) for v in variables],
        )
        table["time"] = times
        for v in variables:
            start = v.start == "true" if v.type == "Boolean" else float(v.start)
            table[v.name] = columns.pop(v.name, start)
        if columns:
            raise KeyError(f"the FMU has no inputs {sorted(columns)}")
        return table


def time_grid(duration: float) -> np.ndarray:
    """Times of the input table, s."""
    return np.linspace(0.0, duration, round(duration / INTERVAL) + 1)


def quintic(time: np.ndarray, duration: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """From 0 to 1 at rest at both ends: value and its first two derivatives by time."""
    s = np.clip(time / duration, 0.0, 1.0)
    value = s**3 * (10 - 15 * s + 6 * s**2)
    rate = 30 * s**2 * (1 - s) ** 2 / duration
    acceleration = 60 * s * (1 - s) * (1 - 2 * s) / duration**2
    return value, rate, acceleration


def smooth(goal=GOAL, yaw: float = 0.5, duration: float = 10.0, name: str = "smooth") -> Flight:
    """A trajectory with feed-forward of velocity and acceleration, straight to the controllers."""

    def inputs(time: np.ndarray) -> dict:
        value, rate, acceleration = quintic(time, duration)
        columns = {"reference.yaw": yaw * value, "reference.yaw_rate": yaw * rate}
        for axis, distance in zip("xyz", goal):
            columns[f"reference.position.{axis}"] = distance * value
            columns[f"reference.velocity.{axis}"] = distance * rate
            columns[f"reference.acceleration.{axis}"] = distance * acceleration
        return columns

    def reference(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        value, _, _ = quintic(time, duration)
        return np.outer(value, goal), yaw * value

    def checks(errors: Errors) -> list[Check]:
        return [
            *(Check(f"RMS error {axis}", 1e3 * errors.rms[axis], 2.0, "mm") for axis in errors.position_axes),
            *(Check(f"final error {axis}", 1e3 * abs(errors.final[axis]), 0.1, "mm") for axis in errors.position_axes),
            Check("largest heading error", np.rad2deg(errors.largest["heading"]), 0.1, "deg"),
        ]

    return Flight(
        name=name,
        title=f"{duration:g} s trajectory with feed-forward, heading 0 to {yaw:g} rad, shaping off",
        duration=duration,
        checks=checks,
        start_values={"reference.shaping": False},
        inputs=inputs,
        reference=reference,
        goal_yaw=yaw,
    )


def default() -> Flight:
    """Nothing set: the shaper flies to the goal."""
    return Flight(
        name="default",
        title="no settings, the shaper flies to 5 m north, 5 m east, 10 m up",
        duration=12.0,
        checks=lambda errors: [*overshoot_below(errors, 0.5), *arrived(errors), tilt_within_limit(errors)],
    )


def step() -> Flight:
    """The same goal as a raw step."""
    return Flight(
        name="step",
        title="the same goal as a raw step, shaping off",
        duration=20.0,
        checks=lambda errors: [*overshoot_below(errors, 4.0), *arrived(errors), tilt_within_limit(errors)],
        start_values={"reference.shaping": False},
    )


def disturbed(force: float = 1.0, mass_factor: float = 0.8) -> Flight:
    """The default flight, pushed east by a constant force, with controllers that believe in a wrong mass."""
    return Flight(
        name="disturbed",
        title=f"{force:g} N push east from 2 s on, controllers believe in {100 * mass_factor:.0f} % of the mass",
        duration=20.0,
        checks=lambda errors: [*arrived(errors), tilt_within_limit(errors)],
        start_values={"controller.mass_factor": mass_factor},
        inputs=lambda time: {"disturbance.force.y": np.where(time < 2.0, 0.0, force)},
    )


def overshoot_below(errors: Errors, percent: float) -> list[Check]:
    return [Check(f"overshoot {axis}", 100 * errors.overshoot[axis], percent, "%") for axis in errors.position_axes]


def arrived(errors: Errors) -> list[Check]:
    return [
        Check(f"steady-state error {axis}", 1e3 * errors.steady[axis], 1e3 * STEADY, "mm")
        for axis in errors.position_axes
    ]


def tilt_within_limit(errors: Errors) -> Check:
    return Check("largest tilt", np.rad2deg(errors.tilt), np.rad2deg(errors.tilt_limit), "deg")


def all_flights() -> list[Flight]:
    """The flights of the demo."""
    return [default(), smooth(), step(), disturbed()]
