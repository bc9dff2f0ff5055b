"""How fast vehicles fly on this machine, beside gym-pybullet-drones where that is installed."""

import argparse
import os
import time
from collections.abc import Callable

import numpy as np

from .fleet import Fleet

#: Simulated s of each measurement.
_DURATION = 1.0
_STEP = 0.02


def _rate(count: int, step: Callable[[], object]) -> float:
    """Vehicle-seconds per second of the wall clock: the best of three."""
    steps = round(_DURATION / _STEP)
    best = float("inf")
    for _ in range(3):
        begun = time.perf_counter()
        for _ in range(steps):
            step()
        best = min(best, time.perf_counter() - begun)
    return count * _DURATION / best


def _fleet(count: int, actuation: str) -> float:
    fleet = Fleet(count, actuation=actuation)
    return _rate(count, lambda: fleet.advance(_STEP))


def _vector(count: int, action: str) -> float | None:
    try:
        from .gym.vector import QuadrotorVectorEnv
    except ImportError:
        return None
    environments = QuadrotorVectorEnv(count, "hover", action)
    environments.reset(seed=1)
    actions = np.zeros((count, 4), dtype=np.float32)
    return _rate(count, lambda: environments.step(actions))


def _pybullet(count: int) -> float | None:
    """HoverAviary of gym-pybullet-drones: 240 Hz physics, 48 Hz control of `count` drones in one world."""
    try:
        from gym_pybullet_drones.envs.CtrlAviary import CtrlAviary  # type: ignore[import-not-found, unused-ignore]
    except ImportError:
        return None
    world = CtrlAviary(num_drones=count, pyb_freq=240, ctrl_freq=48, gui=False)
    world.reset(seed=1)
    speeds = np.full((count, 4), world.HOVER_RPM)
    steps = 48
    begun = time.perf_counter()
    for _ in range(steps):
        world.step(speeds)
    return count * 1.0 / (time.perf_counter() - begun)


def main(arguments: list[str] | None = None) -> int:
    """Measures and prints a table."""
    parser = argparse.ArgumentParser(prog="python -m lmpc_quadrotor benchmark", description=__doc__)
    parser.add_argument("--vehicles", type=int, default=1000, help="vehicles at once (default: 1000)")
    count = parser.parse_args(arguments).vehicles
    print(f"{count} vehicles, {os.cpu_count()} cores; vehicle-seconds per second of the wall clock")
    for name, actuation in [("plant, rotor speeds", "rotors"), ("body rates", "rates"), ("position references", "reference")]:
        print(f"  Fleet, {name:<33} {_fleet(count, actuation):10.0f}", flush=True)
    for action in ("rotors", "rates", "position"):
        rate = _vector(count, action)
        shown = "gymnasium is not installed" if rate is None else f"{rate:10.0f}"
        print(f"  Hover-v0, vector, action = {action:<13} {shown}", flush=True)
    drones = min(count, 10)
    rate = _pybullet(drones)
    shown = "not installed, so not measured" if rate is None else f"{rate:10.0f}"
    print(f"  gym-pybullet-drones, {drones} drones, 240 Hz  {shown}")
    return 0
