"""How fast vehicles fly on this machine, compared with other simulators if these are installed."""

import argparse
import os
import time
from collections.abc import Callable

import numpy as np

from .benchmark_peers import PEERS
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


def _shown(what: str, rate: float | str) -> None:
    figure = rate if isinstance(rate, str) else f"{rate:10.0f}"
    print(f"  {what:<54} {figure}", flush=True)


def _measure_ours(count: int) -> None:
    print("this package; the engine's steps of 1 ms, seen every 20 ms")
    for name, actuation in [("plant, rotor speeds", "rotors"), ("body rates", "rates"), ("position references", "reference")]:
        _shown(f"Fleet, {name}", _fleet(count, actuation))
    for action in ("rotors", "rates", "position"):
        rate = _vector(count, action)
        _shown(f"Hover-v0, vector, action = {action}", "gymnasium is not installed" if rate is None else rate)


def _measure_peers(count: int) -> None:
    print("other simulators; what they simulate differs")
    for peer in PEERS:
        try:
            rate: float | str = peer.rate(count)
        except ImportError:
            rate = "not installed, so not measured"
        except Exception as failure:  # noqa: BLE001: whatever a peer fails with is reported, and the rest is measured
            rate = f"failed: {type(failure).__name__}: {failure}"
        _shown(f"{peer.name}: {peer.what}", rate)


def main(arguments: list[str] | None = None) -> int:
    """Measures and prints a table."""
    parser = argparse.ArgumentParser(prog="python -m lmpc_quadrotor benchmark", description=__doc__)
    parser.add_argument("--vehicles", type=int, default=1000, help="vehicles at once (default: 1000)")
    parser.add_argument("--no-peers", action="store_true", help="measure this package only")
    chosen = parser.parse_args(arguments)
    if chosen.vehicles < 1:
        parser.error(f"--vehicles {chosen.vehicles}: allowed is 1 or more")
    print(f"{chosen.vehicles} vehicles, {os.cpu_count()} cores; vehicle-seconds per second of the wall clock")
    _measure_ours(chosen.vehicles)
    if not chosen.no_peers:
        _measure_peers(chosen.vehicles)
    return 0
