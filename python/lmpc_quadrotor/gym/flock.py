"""Vehicles that learn: a fleet, the episodes of its vehicles, and what they observe."""

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

from .._native import ArgumentError
from ..fleet import Fleet
from ..simulation import Simulation
from ..tables import Numbers, by_name
from .actions import ACTUATION, Actions
from .tasks import TASKS, Task

#: Middle of the room, NED, m: high enough for no vehicle to touch the ground.
CENTRE = np.array([0.0, 0.0, -10.0])
#: How far a vehicle may go from the middle on each axis, m.
ROOM = 5.0
#: Longest episode, s.
_LONGEST = 1e6
_STATE = [
    "position.x", "position.y", "position.z", "velocity.x", "velocity.y", "velocity.z",
    "attitude.q0", "attitude.q1", "attitude.q2", "attitude.q3", "body_rate.p", "body_rate.q", "body_rate.r",
]  # fmt: skip


class Flock:
    """Some vehicles, each in an episode of its own."""

    def __init__(
        self,
        count: int,
        task: str | Task,
        action: str,
        parameters: Mapping[str, Any] | None,
        time_step: float,
        episode: float,
        threads: int | None,
    ) -> None:
        if isinstance(task, str):
            if task not in TASKS:
                raise ArgumentError(f"task = {task!r}; allowed are {', '.join(map(repr, TASKS))} and a Task")
            task = TASKS[task]()
        if not all(callable(getattr(task, name, None)) for name in ("begin", "goals")):
            raise ArgumentError(f"task = {task!r}; allowed are {', '.join(map(repr, TASKS))} and a Task")
        if action not in ACTUATION:
            raise ArgumentError(f"action = {action!r}; allowed are {', '.join(map(repr, ACTUATION))}")
        _check_seconds("time_step", time_step, 0.001, 1.0)
        _check_seconds("episode", episode, time_step, _LONGEST)
        self.count, self.task = count, task
        self.time_step, self.steps = time_step, round(episode / time_step)
        start = {"initial.position.x": CENTRE[0], "initial.position.y": CENTRE[1], "initial.position.z": CENTRE[2]}
        flown = {**start, **by_name("parameters", parameters)}
        reference = {f"reference.position.{axis}": CENTRE[index] for index, axis in enumerate("xyz")}
        self.fleet = Fleet(count, flown, reference, actuation=ACTUATION[action], threads=threads)
        self.actions = Actions(action, Simulation(flown, actuation="rotors").parameters, CENTRE)
        self.neutral = self.actions.inputs(np.zeros((count, 4)))
        self.episodes = task.begin(np.random.default_rng(0), count)
        self.elapsed = np.zeros(count, dtype=np.int64)

        #: Largest magnitudes of what an agent observes; a vehicle is lost before it gets there.
        self.bounds = np.array([20.0] * 3 + [50.0] * 3 + [1.0] * 4 + [100.0] * 3 + [20.0] * 3 * task.preview)

    def spaces(self) -> tuple[Any, Any]:
        """Of the observation and the action of one vehicle."""
        bounds = self.bounds.astype(np.float32)
        observation = gymnasium.spaces.Box(-bounds, bounds, dtype=np.float32)
        return observation, gymnasium.spaces.Box(-1.0, 1.0, (4,), np.float32)

    def begin(self, vehicles: npt.NDArray[np.intp], generator: np.random.Generator) -> None:
        """New episodes of some vehicles, each in a motion at random."""
        count = len(vehicles)
        self.episodes[vehicles] = self.task.begin(generator, count)
        self.elapsed[vehicles] = 0
        tilt, heading = generator.uniform(-0.2, 0.2, (count, 2)), generator.uniform(-np.pi, np.pi, count)
        motions = np.column_stack(
            [
                CENTRE + generator.uniform(-1.0, 1.0, (count, 3)),
                generator.uniform(-0.5, 0.5, (count, 3)),
                _quaternions(tilt[:, 0], tilt[:, 1], heading),
                generator.uniform(-0.5, 0.5, (count, 3)),
            ]
        )
        self.fleet.set(self.neutral)
        self.fleet.restart(vehicles.tolist(), motions)

    def step(self, actions: Numbers) -> None:
        """All vehicles fly on by a step."""
        self.fleet.set(self.actions.inputs(actions))
        self.fleet.advance(self.time_step)
        self.elapsed += 1

    def look(self, actions: Numbers | None) -> tuple[npt.NDArray[np.float32], Numbers, npt.NDArray[np.bool_], Numbers]:
        """Observations, rewards, who is lost, and distances from the goals, m."""
        state = self.fleet.read(_STATE)
        position = state[:, :3] - CENTRE
        times = np.asarray(self.elapsed * self.time_step, dtype=np.float64)
        ahead = [self.task.goals(self.episodes, times + point * self.task.interval) for point in range(self.task.preview + 1)]
        # One attitude has two quaternions.
        quaternion = state[:, 6:10] * np.where(state[:, 6:7] < 0.0, -1.0, 1.0)
        parts = [ahead[0] - position, state[:, 3:6], quaternion, state[:, 10:13], *(goal - position for goal in ahead[1:])]
        observations = np.clip(np.concatenate(parts, axis=1), -self.bounds, self.bounds).astype(np.float32)
        distance = np.linalg.norm(ahead[0] - position, axis=1)
        upright = 1.0 - 2.0 * (quaternion[:, 1] ** 2 + quaternion[:, 2] ** 2)
        lost = self.fleet.failed | (np.abs(position).max(axis=1) > ROOM) | (upright < 0.0)
        effort = np.zeros(self.count) if actions is None else np.square(np.clip(actions, -1.0, 1.0)).sum(axis=1)
        spin = np.linalg.norm(state[:, 10:13], axis=1)
        rewards = np.exp(-np.square(distance)) - 0.1 * np.tanh(distance) - 0.01 * np.tanh(spin) - 0.001 * effort
        return observations, np.where(lost, -10.0, rewards), lost, distance


def refuse_pictures(render_mode: str | None) -> None:
    """Refuses to draw: flights of a `Simulation` are shown by `lmpc_quadrotor.view`."""
    if render_mode is not None:
        raise ArgumentError(f"render_mode = {render_mode!r}; allowed is None: lmpc_quadrotor.view.flight_page shows flights of a Simulation")


def _check_seconds(name: str, value: float, least: float, most: float) -> None:
    try:
        allowed = least <= value <= most
    except (TypeError, ValueError):
        allowed = False
    if not allowed:
        raise ArgumentError(f"{name} = {value} s; allowed {least:g} to {most:g} s")


def _quaternions(phi: Numbers, theta: Numbers, psi: Numbers) -> Numbers:
    """From roll, pitch and heading, scalar first."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(angle / 2.0), np.sin(angle / 2.0)) for angle in (phi, theta, psi))
    return np.column_stack(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )
