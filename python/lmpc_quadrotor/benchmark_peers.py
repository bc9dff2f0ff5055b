"""Other simulators of many drones, if they are installed, for `python -m lmpc_quadrotor benchmark`."""

import importlib
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

#: Thrust of a rotor of a drone of 1 kg that hovers, N, and where the rotors are, m.
_THRUST = 9.81 / 4
_ROTORS = [(x, y, 0.0) for x in (-0.1, 0.1) for y in (-0.1, 0.1)]


@dataclass(frozen=True)
class Peer:
    """A simulator that can be measured."""

    name: str
    #: What it simulates, and in which steps.
    what: str
    #: Vehicle-seconds per second of so many vehicles. Raises ImportError where it is not installed.
    rate: Callable[[int], float]


def _timed(count: int, duration: float, fly: Callable[[], None]) -> float:
    """Vehicle-seconds per second: the best of two, after what `fly` does first."""
    best = float("inf")
    for _ in range(2):
        begun = time.perf_counter()
        fly()
        best = min(best, time.perf_counter() - begun)
    return count * duration / best


def _gym_pybullet_drones(count: int) -> float:
    """`count` drones in one world."""
    world_of: Any = importlib.import_module("gym_pybullet_drones.envs.CtrlAviary").CtrlAviary
    world = world_of(num_drones=count, pyb_freq=240, ctrl_freq=48, gui=False)
    world.reset(seed=1)
    speeds, steps = np.full((count, 4), world.HOVER_RPM), 12

    def fly() -> None:
        for _ in range(steps):
            world.step(speeds)

    return _timed(count, steps / 48, fly)


def _pybullet(count: int) -> float:
    """As gym-pybullet-drones uses it: bodies in one world, four forces and a torque at 240 Hz, all states read at 48 Hz."""
    bullet: Any = importlib.import_module("pybullet")
    bullet.connect(bullet.DIRECT)
    try:
        bullet.setGravity(0, 0, -9.81)
        bullet.setTimeStep(1 / 240)
        shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[0.1, 0.1, 0.02])
        side = int(np.ceil(np.sqrt(count)))
        places = [[index % side, index // side, 5.0] for index in range(count)]
        bodies = [bullet.createMultiBody(1.0, shape, basePosition=place) for place in places]
        steps = 60

        def fly() -> None:
            for step in range(steps):
                for body in bodies:
                    for rotor in _ROTORS:
                        bullet.applyExternalForce(body, -1, [0, 0, _THRUST], rotor, bullet.LINK_FRAME)
                    bullet.applyExternalTorque(body, -1, [0, 0, 0], bullet.LINK_FRAME)
                bullet.stepSimulation()
                if step % 5 == 4:
                    for body in bodies:
                        bullet.getBasePositionAndOrientation(body)
                        bullet.getBaseVelocity(body)

        return _timed(count, steps / 240, fly)
    finally:
        bullet.disconnect()


def _crazyflow(count: int) -> float:
    """One drone in each of `count` worlds, under the state controller, on the CPU."""
    # It asks for this before anything has loaded scipy.
    os.environ.setdefault("SCIPY_ARRAY_API", "1")
    os.environ.setdefault("JAX_PLATFORMS", "cpu")
    control: Any = importlib.import_module("crazyflow.control").Control
    simulation: Any = importlib.import_module("crazyflow.sim").Sim(n_worlds=count, n_drones=1, control=control.state)
    jax: Any = importlib.import_module("jax")
    simulation.reset()
    steps = simulation.freq // simulation.control_freq
    # Position, velocity, acceleration, attitude as a quaternion, rates: hovering at 1 m.
    command = np.zeros((count, 1, 16))
    command[..., [2, 12]] = 1.0
    periods = simulation.control_freq // 4

    def fly() -> None:
        for _ in range(periods):
            simulation.state_control(command)
            simulation.step(steps)
        jax.block_until_ready(simulation.data.states.pos)

    fly()  # compiles
    return _timed(count, 0.25, fly)


PEERS = [
    Peer("gym-pybullet-drones", "rotor speeds, 240 Hz", _gym_pybullet_drones),
    Peer("PyBullet", "its engine and calls, 240 Hz", _pybullet),
    Peer("crazyflow", "state controller, JAX", _crazyflow),
]
