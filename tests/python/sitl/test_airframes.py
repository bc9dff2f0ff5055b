"""Airframes of the vehicle: presets and files, in flags, environment and configuration file, in flight and in replays."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
LOCKSTEP = ("--speed", "max", "--lockstep", "always")
PRESETS = ("crazyflie", "hummingbird", "iris", "heavy")

OWN = """
mass = 1.2
arm_length = 0.25
layout = "x reversed"
inertia = { x = 0.02, y = 0.021, z = 0.035 }
rotor = { thrust_coefficient = 1.5e-5, torque_coefficient = 2.5e-7, speed_max = 800, time_constant = 0.03 }
"""


def fly(name, vehicle, folder):
    return subprocess.run([sys.executable, EXAMPLES / f"{name}.py", "--connect", f"udpout:{vehicle.addresses[0]}", "--plot", folder / "plot.png"],
                          cwd=folder, capture_output=True, text=True, timeout=200)


# The circle of 4 m at 2.5 m/s is one for vehicles with little drag: drag is not fed forward.
@pytest.mark.parametrize("preset, example", [*((preset, "position_target") for preset in PRESETS), ("heavy", "circle")])
def test_each_preset_flies_the_demo(start, tmp_path, preset, example):
    done = fly(example, start(*LOCKSTEP, "--airframe", preset), tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_an_own_file_flies_and_is_replayed(program, start, tmp_path):
    own, record = tmp_path / "own.toml", tmp_path / "flight.lmpc"
    own.write_text(OWN)
    vehicle = start(*LOCKSTEP, "--airframe", own, "--record", record)
    done = fly("position_target", vehicle, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert vehicle.stop() == 0 and "airframe own.toml: 1.2 kg" in vehicle.output()
    # The record has the airframe: the file is not needed any more.
    own.unlink()
    replayed = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=120, env={})
    assert replayed.returncode == 0, replayed.stdout + replayed.stderr


def test_flag_environment_and_configuration_file_are_one(program, tmp_path):
    def listed(*arguments, environment=None):
        done = subprocess.run([program, *arguments, "--list-parameters"], capture_output=True, text=True, timeout=60, env=environment or {})
        assert done.returncode == 0, done.stderr
        return done.stdout

    configuration = tmp_path / "vehicle.toml"
    configuration.write_text('airframe = "iris"\n')
    flag = listed("--airframe", "iris")
    assert flag == listed(environment={"LMPC_SITL_AIRFRAME": "iris"}) == listed("--config", configuration)
    (mass,) = (line for line in flag.splitlines() if line.startswith("FRAME_MASS"))
    assert "1.52" in mass and flag != listed()
