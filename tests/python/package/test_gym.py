"""Environments: Gymnasium's own checker, seeds, and a thousand vehicles at once."""

import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from lmpc_quadrotor import ArgumentError
from lmpc_quadrotor.gym import QuadrotorEnv, QuadrotorVectorEnv

TASKS, ACTIONS = ["Hover", "Track"], ["rotors", "rates", "position"]


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("action", ACTIONS)
def test_gymnasiums_checker_has_nothing_to_say(task, action):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(f"lmpc_quadrotor/{task}-v0", action=action).unwrapped, skip_render_check=True)


def test_an_import_registers_the_environments():
    program = "import gymnasium, lmpc_quadrotor.gym; print(gymnasium.make('lmpc_quadrotor/Hover-v0').spec.id)"
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert answer.stdout.strip() == "lmpc_quadrotor/Hover-v0", answer


def flown(environment, seed, steps=60):
    random = np.random.default_rng(5)
    seen = [environment.reset(seed=seed)[0]]
    for _ in range(steps):
        observation, reward, *_ = environment.step(random.uniform(-0.2, 0.2, environment.action_space.shape).astype(np.float32))
        seen.append(np.append(observation, reward))
    return np.concatenate([np.ravel(one) for one in seen])


@pytest.mark.parametrize("task", ["hover", "track"])
def test_the_same_seed_is_the_same_flight(task):
    one = flown(QuadrotorEnv(task), 3)
    np.testing.assert_array_equal(one, flown(QuadrotorEnv(task), 3))
    assert not np.array_equal(one, flown(QuadrotorEnv(task), 4))
    vectors = [flown(QuadrotorVectorEnv(5, task, threads=threads), 3) for threads in (1, 2)]
    np.testing.assert_array_equal(*vectors)


def test_again_in_the_same_environment_is_the_same_flight():
    """What an episode leaves behind does not show in the next."""
    environment = QuadrotorEnv(action="position")
    one = flown(environment, 8)
    np.testing.assert_array_equal(one, flown(environment, 8))


def test_positions_are_flown_to():
    environment = QuadrotorEnv(action="position", episode=6.0)
    observation, _ = environment.reset(seed=2)
    # The goal from the middle of the room: the way there, and where the vehicle is.
    reward, truncated = 0.0, False
    goal = environment._flock.episodes[0]
    while not truncated:
        observation, reward, terminated, truncated, information = environment.step(np.append(goal / 5.0, 0.0).astype(np.float32))
        assert not terminated
    assert information["distance"] < 0.05 and reward > 0.9
    assert environment.observation_space.contains(observation)


@pytest.mark.parametrize("action, command", [("rotors", [-1, -1, -1, -1]), ("rates", [-1, 0, 0, 0])])
def test_a_fall_ends_the_episode(action, command):
    environment = QuadrotorEnv(action=action)
    environment.reset(seed=1)
    for step in range(200):
        _, reward, terminated, truncated, _ = environment.step(np.array(command, dtype=np.float32))
        if terminated:
            break
    assert terminated and not truncated and reward == -10.0 and 20 < step < 100


def test_a_thousand_vehicles_fly_at_once_and_begin_anew():
    count = 1000
    environments = gymnasium.make_vec("lmpc_quadrotor/Hover-v0", num_envs=count, action="rotors", episode=0.1)
    assert isinstance(environments.unwrapped, QuadrotorVectorEnv)
    assert environments.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    first, _ = environments.reset(seed=1)
    assert first.shape == (count, 13) and environments.observation_space.contains(first)
    actions = np.zeros((count, 4), dtype=np.float32)
    for step in range(5):
        _, rewards, terminated, truncated, _ = environments.step(actions)
        assert not terminated.any() and truncated.all() == (step == 4)
    begun, rewards, terminated, truncated, _ = environments.step(actions)
    assert not rewards.any() and not terminated.any() and not truncated.any()
    assert not np.array_equal(begun, first) and np.abs(begun[:, :3]).max() < 4.0


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: QuadrotorVectorEnv(2, action="thrust"), "action = 'thrust'; allowed are 'rotors', 'rates', 'position'"),
        (lambda: QuadrotorEnv(task=5), "task = 5; allowed are 'hover', 'track' and a Task"),
        (lambda: QuadrotorEnv(time_step="a"), "time_step = a s; allowed 0.001 to 1 s"),
        (lambda: QuadrotorEnv(episode=float("inf")), "episode = inf s; allowed 0.02 to 1e+06 s"),
        (lambda: QuadrotorEnv(parameters=5), "parameters = 5; expected names with values"),
        (lambda: QuadrotorEnv(render_mode="human"), "render_mode = 'human'; allowed is None"),
        (lambda: QuadrotorVectorEnv(2, render_mode="human"), "render_mode = 'human'; allowed is None"),
        (lambda: QuadrotorVectorEnv(0), "count = 0; expected a whole number from 1"),
        (lambda: QuadrotorEnv().step(np.zeros(3)), r"action has the shape (3,), expected (4,)"),
        (lambda: QuadrotorEnv().step("up"), "action = 'up'; expected (4,) numbers within ±1"),
        (lambda: QuadrotorVectorEnv(2).step(np.zeros(4)), "actions has the shape (4,), expected (2, 4)"),
        (lambda: QuadrotorVectorEnv(2).step(np.full((2, 4), np.nan)), "actions contains a number that is not finite; allowed are -1 to 1"),
    ],
)
def test_errors_name_what_is_wrong_and_what_is_allowed(make, message):
    with pytest.raises(ArgumentError) as error:
        make()
    assert message in str(error.value)


def test_without_gymnasium_an_import_says_what_to_install():
    program = "import sys; sys.modules['gymnasium'] = None; import lmpc_quadrotor.gym"
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert answer.returncode == 1
    assert "lmpc_quadrotor.gym needs Gymnasium: pip install 'lmpc-quadrotor[gym]'" in answer.stderr


def test_a_vector_flies_as_single_environments_do():
    single, vector = QuadrotorEnv("track", "rates"), QuadrotorVectorEnv(1, "track", "rates")
    np.testing.assert_array_equal(flown(single, 9), flown(vector, 9))
