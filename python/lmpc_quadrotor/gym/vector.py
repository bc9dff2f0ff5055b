"""Many vehicles as one environment."""

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from .actions import commanded
from .flock import Flock, refuse_pictures
from .tasks import Task

Observations = npt.NDArray[np.float32]
Flags = npt.NDArray[np.bool_]


class QuadrotorVectorEnv(VectorEnv[Observations, Observations, npt.NDArray[Any]]):
    """Many vehicles that learn side by side, over one `Fleet`: the environments of `QuadrotorEnv`, on all cores.

    Vehicles whose episode has ended begin the next one at the following step, whose action they ignore and whose reward is
    0 (Gymnasium's `AutoresetMode.NEXT_STEP`). `threads` is how many vehicles fly at once; None is one on each core. The same
    seed gives the same episodes, bit for bit, whatever the number of threads.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        num_envs: int = 1,
        task: str | Task = "hover",
        action: str = "rates",
        *,
        parameters: Mapping[str, Any] | None = None,
        time_step: float = 0.02,
        episode: float = 10.0,
        threads: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        refuse_pictures(render_mode)
        self.num_envs, self.render_mode = num_envs, render_mode
        self._flock = Flock(num_envs, task, action, parameters, time_step, episode, threads)
        self.single_observation_space, self.single_action_space = self._flock.spaces()
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._ended = np.zeros(num_envs, dtype=bool)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Begins an episode of each vehicle, or of those that `options["reset_mask"]` marks.

        A list of seeds stands for one seed that is made of all of them.
        """
        if isinstance(seed, list):
            known = [one for one in seed if one is not None]
            self._np_random, self._np_random_seed = gymnasium.utils.seeding.np_random(
                int(np.random.SeedSequence(known).generate_state(1)[0]) if known else None
            )
        elif seed is not None:
            self._np_random, self._np_random_seed = gymnasium.utils.seeding.np_random(seed)
        mask = (options or {}).get("reset_mask")
        vehicles = np.arange(self.num_envs) if mask is None else np.flatnonzero(mask)
        self._flock.begin(vehicles, self.np_random)
        self._ended[vehicles] = False
        observations, _, _, distances = self._flock.look(None)
        return observations, self._information(distances)

    def step(self, actions: Observations) -> tuple[Observations, npt.NDArray[Any], Flags, Flags, dict[str, Any]]:
        """All vehicles fly on by a step; those whose episode has ended begin the next one."""
        given = commanded("actions", actions, (self.num_envs, 4))
        began = self._ended.copy()
        self._flock.step(given)
        if began.any():
            self._flock.begin(np.flatnonzero(began), self.np_random)
        observations, rewards, lost, distances = self._flock.look(given)
        rewards[began] = 0.0
        lost = lost & ~began
        late = (self._flock.elapsed >= self._flock.steps) & ~began
        self._ended = lost | late
        return observations, rewards, lost, late, self._information(distances)

    def _information(self, distances: npt.NDArray[np.float64]) -> dict[str, Any]:
        return {"distance": distances, "_distance": np.ones(self.num_envs, dtype=bool)}
