"""What is measured on a flight."""

from dataclasses import dataclass

import numpy as np

#: Last part of a flight that counts as steady, s.
STEADY_TIME = 2.0


@dataclass(frozen=True)
class Check:
    """A measured value and its bound."""

    what: str
    value: float
    bound: float
    unit: str

    @property
    def met(self) -> bool:
        # Written so that NaN does not pass.
        return bool(self.value <= self.bound)


@dataclass(frozen=True)
class Errors:
    """Errors of one flight: by axis, in metres and radians; altitude counts upwards."""

    rms: dict
    largest: dict
    #: At the end, to the goal.
    final: dict
    #: Largest in the last two seconds, to the goal.
    steady: dict
    #: Beyond the goal, as a share of the distance to it.
    overshoot: dict
    #: Largest angle between thrust axis and vertical, and its limit, rad.
    tilt: float
    tilt_limit: float

    position_axes = ("north", "east", "altitude")
    axes = (*position_axes, "heading")


def path(result: np.ndarray, prefix: str = "position") -> np.ndarray:
    """North, east and altitude of a recorded position, one row a point."""
    return np.column_stack([result[f"{prefix}.x"], result[f"{prefix}.y"], -result[f"{prefix}.z"]])


def wrapped(angle: np.ndarray) -> np.ndarray:
    """The same direction within ±π."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def reference_of(flight, result: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Path and heading that the flight is compared with, at the recorded times."""
    if flight.reference is None:
        return path(result, "setpoint.position"), result["setpoint.yaw"]
    position, yaw = flight.reference(result["time"])
    return position * [1, 1, -1], yaw


def measure(flight, goal: np.ndarray, result: np.ndarray, tilt_limit: float) -> Errors:
    """Measures a flight to `goal` (NED) against its reference."""
    reference, yaw_reference = reference_of(flight, result)
    flown = path(result)
    error = np.column_stack([flown - reference, wrapped(result["attitude.psi"] - yaw_reference)])

    target = np.append(goal * [1, 1, -1], flight.goal_yaw)
    travelled = np.column_stack([flown, result["attitude.psi"]])
    to_goal = travelled - target
    to_goal[:, 3] = wrapped(to_goal[:, 3])
    distance = target[:3] - flown[0]
    beyond = (to_goal[:, :3] * np.sign(distance)).max(axis=0)
    steady = to_goal[result["time"] >= result["time"][-1] - STEADY_TIME]

    def by_axis(values) -> dict:
        return dict(zip(Errors.axes, values))

    return Errors(
        rms=by_axis(np.sqrt(np.mean(error**2, axis=0))),
        largest=by_axis(np.abs(error).max(axis=0)),
        final=by_axis(to_goal[-1]),
        steady=by_axis(np.abs(steady).max(axis=0)),
        overshoot=by_axis(np.maximum(beyond, 0) / np.abs(distance)),
        tilt=float(tilt(result).max()),
        tilt_limit=tilt_limit,
    )


def tilt(result: np.ndarray) -> np.ndarray:
    """Angle between thrust axis and vertical, rad."""
    cosine = np.cos(result["attitude.phi"]) * np.cos(result["attitude.theta"])
    return np.arccos(np.clip(cosine, -1.0, 1.0))
