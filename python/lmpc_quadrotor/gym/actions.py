"""What an agent commands: four numbers within ±1 each, whatever they stand for."""

from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .._native import ArgumentError
from ..tables import Numbers

#: What an action stands for.
ActionKind: TypeAlias = Literal["rotors", "rates", "position"]

#: What the vehicles of a fleet are asked for then.
ACTUATION: dict[str, str] = {"rotors": "rotors", "rates": "rates", "position": "reference"}

#: Body rates at an action of 1, rad/s.
RATES = np.array([6.0, 6.0, 3.0])
#: Distance of a position reference from the middle of the room at an action of 1, m.
SPAN = 5.0
_G = 9.80665


def commanded(name: str, given: npt.ArrayLike, shape: tuple[int, ...]) -> Numbers:
    """Actions of a shape; refuses what is no number."""
    try:
        actions = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} = {given!r}; expected {shape} numbers within ±1") from None
    if actions.shape != shape:
        raise ArgumentError(f"{name} has the shape {actions.shape}, expected {shape}")
    if not np.isfinite(actions).all():
        raise ArgumentError(f"{name} contains a number that is not finite; allowed are -1 to 1")
    return actions


class Actions:
    """Turns actions into inputs of a fleet.

    * "rotors": the speed of each rotor: 0 is hover, 1 the largest and −1 the smallest speed of the airframe, linear between.
    * "rates": thrust, 0 is the weight, 1 twice that and −1 none; body rates, 6, 6 and 3 rad/s at 1.
    * "position": position reference north, east and down, 5 m from the middle of the room at 1; heading, half a turn at 1.
    """

    def __init__(self, kind: str, parameters: dict[str, Any], centre: Numbers) -> None:
        self._kind = kind
        self._centre = centre
        self._mass = float(parameters["airframe.mass"])
        coefficient = float(parameters["airframe.rotor.thrust_coefficient"])
        self._hover = float(np.sqrt(self._mass * _G / (4.0 * coefficient)))
        self._least = float(parameters["airframe.rotor.speed_min"])
        self._most = float(parameters["airframe.rotor.speed_max"])

    def inputs(self, actions: Numbers) -> dict[str, Numbers]:
        """The inputs of actions, a row for each vehicle."""
        actions = np.clip(actions, -1.0, 1.0)
        if self._kind == "rotors":
            up, down = self._most - self._hover, self._hover - self._least
            speeds = self._hover + np.where(actions > 0.0, up * actions, down * actions)
            return {f"rotor.command[{rotor + 1}]": speeds[:, rotor] for rotor in range(4)}
        if self._kind == "rates":
            rates = actions[:, 1:] * RATES
            thrust = self._mass * _G * (1.0 + actions[:, 0])
            return {
                "command.thrust": thrust,
                **{f"command.body_rate.{axis}": rates[:, index] for index, axis in enumerate("pqr")},
            }
        positions = self._centre + SPAN * actions[:, :3]
        return {
            **{f"reference.position.{axis}": positions[:, index] for index, axis in enumerate("xyz")},
            "reference.yaw": np.pi * actions[:, 3],
        }
