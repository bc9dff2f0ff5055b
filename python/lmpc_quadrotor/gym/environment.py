"""One vehicle as an environment."""

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

from .actions import commanded
from .flock import Flock, refuse_pictures
from .tasks import Task

Observation = npt.NDArray[np.float32]


class QuadrotorEnv(gymnasium.Env[Observation, Observation]):
    """One vehicle that learns.

    **Action**: four numbers within ±1: rotor speeds, thrust and body rates, or a position reference; see `Actions`.

    **Observation**: 13 numbers: the way to the goal in NED, m; velocity in NED, m/s; quaternion from body to NED, scalar first
    and not negative; body rates, rad/s. `Track-v0` adds the ways to the next four points of the path, 0.1 s apart.

    **Reward** of a step: e^(−d²) − 0.1 tanh d − 0.01 tanh ω − 0.001 |a|², with the distance d from the goal, m, the body rate ω
    and the action a; −10 when the vehicle is lost.

    **Episode**: ends when the vehicle is lost: more than 5 m from the middle on an axis, upside down, or diverged. It is
    cut off after `episode` s. The same seed gives the same episodes, bit for bit.

    `parameters` are those of `Simulation`: {"airframe.preset": "crazyflie"}, say.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        task: str | Task = "hover",
        action: str = "rates",
        *,
        parameters: Mapping[str, Any] | None = None,
        time_step: float = 0.02,
        episode: float = 10.0,
        render_mode: str | None = None,
    ) -> None:
        refuse_pictures(render_mode)
        self.render_mode = render_mode
        self._flock = Flock(1, task, action, parameters, time_step, episode, 1)
        self.observation_space, self.action_space = self._flock.spaces()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        self._flock.begin(np.array([0]), self.np_random)
        observations, _, _, distances = self._flock.look(None)
        return observations[0], {"distance": float(distances[0])}

    def step(self, action: Observation) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Flies on by a step. Numbers beyond ±1 count as ±1. Raises `ArgumentError` for others than four finite numbers."""
        actions = commanded("action", action, (4,)).reshape(1, 4)
        self._flock.step(actions)
        observations, rewards, lost, distances = self._flock.look(actions)
        late = bool(self._flock.elapsed[0] >= self._flock.steps)
        return observations[0], float(rewards[0]), bool(lost[0]), late, {"distance": float(distances[0])}
