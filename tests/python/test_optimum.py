"""The optimal flights of the paper's report: the commands that the solver finds, integrated by scipy in another form of the equations."""

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import optimum
import pytest
from scipy.integrate import solve_ivp

ROOT = Path(__file__).resolve().parents[2]
GRAVITY = 9.80665
GOAL = np.array([1.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def values():
    return optimum.parameters(ROOT / "modelDescription.xml")


@pytest.fixture(scope="module")
def fastest(values):
    """Times and commands of the flight that stays within 1.9 cm of 1 m north at the earliest."""
    return optimum.solve(optimum.Plant(values), GOAL, None, 1.2, True)


def derivative(values, command):
    """(1)-(3) with a rotation matrix in place of Euler angles: position, velocity, matrix, body rates, rotor speeds."""
    inertia = np.array([values[f"airframe.inertia.{axis}"] for axis in "xyz"])
    mass, arm = values["airframe.mass"], values["airframe.arm_length"]
    k1, k2 = (values[f"airframe.rotor.{kind}_coefficient"] for kind in ("thrust", "torque"))

    def of(_, x):
        rotation, rate, speed = x[6:15].reshape(3, 3), x[15:18], x[18:22]
        front, right, back, left = speed**2
        torque = np.array([arm * k1 * (left - right), arm * k1 * (front - back), k2 * (right + left - front - back)])
        acceleration = np.array([0, 0, GRAVITY]) - k1 * (speed**2).sum() / mass * rotation[:, 2]
        p, q, r = rate
        turning = rotation @ np.array([[0, -r, q], [r, 0, -p], [-q, p, 0]])
        spin = (torque - np.cross(rate, inertia * rate)) / inertia
        lag = (command - speed) / values["airframe.rotor.time_constant"]
        return np.concatenate([x[3:6], acceleration, turning.ravel(), spin, lag])

    return of


@pytest.fixture(scope="module")
def flown(values, fastest):
    """Times and states of the commands, four a command."""
    hover = math.sqrt(values["airframe.mass"] * GRAVITY / (4 * values["airframe.rotor.thrust_coefficient"]))
    x = np.concatenate([np.zeros(6), np.eye(3).ravel(), np.zeros(3), np.full(4, hover)])
    time, times, states = 0.0, [0.0], [x]
    for step, command in zip(*fastest):
        at = step * np.array([0.25, 0.5, 0.75, 1.0])
        found = solve_ivp(derivative(values, command), (0.0, step), x, t_eval=at, rtol=1e-9, atol=1e-11)
        times += list(time + at)
        states += list(found.y.T)
        time, x = time + step, found.y[:, -1]
    return np.array(times), np.array(states)


def test_the_commands_bring_the_vehicle_to_its_goal_to_stay(fastest, flown):
    steps, _ = fastest
    times, states = flown
    distance = np.linalg.norm(states[:, :3] - GOAL, axis=1)
    arrived = steps.sum() - optimum.STAY
    assert distance[times >= arrived - 1e-9].max() < 0.02
    assert distance[times < arrived - 2 * steps[0]].max() > 0.02
    # At rest at the end.
    assert np.abs(states[-1, 3:6]).max() < 0.01 and np.abs(states[-1, 15:18]).max() < 0.01


def test_the_limits_are_kept(values, fastest, flown):
    _, commands = fastest
    _, states = flown
    slowest, highest = (values[f"airframe.rotor.speed_{end}"] for end in ("min", "max"))
    assert commands.min() > slowest - 1e-3 and commands.max() < highest + 1e-3
    tilt = np.arccos(np.clip(states[:, 14], -1, 1))
    assert tilt.max() < 1.02 * values["limits.tilt"]
    weight = values["airframe.mass"] * GRAVITY
    thrust = values["airframe.rotor.thrust_coefficient"] * (states[:, 18:22] ** 2).sum(axis=1) / weight
    # At nodes and halfway: between them a few per cent more.
    assert thrust[::2].max() < 1.02 * values["limits.thrust.max"] and thrust[::2].min() > 0.98 * values["limits.thrust.min"]


def test_no_vehicle_can_be_faster_than_its_thrust(values, fastest):
    """Bang-bang with the largest horizontal thrust from the first moment on: a bound that no lag and no inertia can beat."""
    steps, _ = fastest
    strongest = GRAVITY * values["limits.thrust.max"] * math.sin(values["limits.tilt"])
    least = 2 * math.sqrt((GOAL[0] - 2 * 0.019) / strongest)
    assert least < steps.sum() - optimum.STAY < 3 * least


def test_a_missing_description_is_an_error(tmp_path):
    command = [sys.executable, ROOT / "xtask" / "python" / "optimum.py", tmp_path / "none.xml", tmp_path / "out.json"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 1 and "none.xml" in run.stderr and "Traceback" not in run.stderr
