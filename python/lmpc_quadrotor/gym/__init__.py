"""Gymnasium environments: single ones and vector ones over a `Fleet`.

| id | task |
| --- | --- |
| `lmpc_quadrotor/Hover-v0` | fly to a point at random, and stay there |
| `lmpc_quadrotor/Track-v0` | follow a point that moves on a figure of eight |

An import of this module registers them:

    import lmpc_quadrotor.gym

    environment = gymnasium.make("lmpc_quadrotor/Hover-v0", action="rates")
    environments = gymnasium.make_vec("lmpc_quadrotor/Hover-v0", num_envs=1000, action="rotors")

`QuadrotorEnv` and `QuadrotorVectorEnv` describe actions, observations and rewards.
"""

try:
    import gymnasium as _  # noqa: F401
except ModuleNotFoundError as _missing:
    raise ModuleNotFoundError(
        "lmpc_quadrotor.gym needs Gymnasium: pip install 'lmpc-quadrotor[gym]'", name=_missing.name
    ) from _missing

from .actions import ActionKind
from .environment import QuadrotorEnv
from .registration import register
from .tasks import Hover, Task, Track
from .vector import QuadrotorVectorEnv

__all__ = ["ActionKind", "Hover", "QuadrotorEnv", "QuadrotorVectorEnv", "Task", "Track", "register"]
