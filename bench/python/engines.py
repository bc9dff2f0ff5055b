"""Simulators of others, each on one vehicle: seconds of computation per simulated second, with step and order stated.

    python engines.py NAME --seconds 5        prints a line of JSON
"""

import argparse
import importlib
import json
import os
import sys
import time

# crazyflow wants it before anything loads scipy.
os.environ.setdefault("SCIPY_ARRAY_API", "1")
os.environ.setdefault("JAX_PLATFORMS", "cpu")


def timed(seconds: float, advance) -> float:
    """Seconds per simulated second of `advance(seconds)`: the median of three, after a first one that compiles and warms up."""
    advance(min(seconds, 0.1))
    taken = []
    for _ in range(3):
        begin = time.perf_counter()
        advance(seconds)
        taken.append((time.perf_counter() - begin) / seconds)
    return sorted(taken)[1]


def mujoco(seconds: float) -> dict:
    module = importlib.import_module("mujoco")
    rotors = zip("abcd", ((0.1, 0.1), (-0.1, 0.1), (-0.1, -0.1), (0.1, -0.1)), (0.01, -0.01, 0.01, -0.01))
    sites, motors = "", ""
    for name, (x, y), torque in rotors:
        sites += f'<site name="{name}" pos="{x} {y} 0"/>'
        motors += f'<motor site="{name}" gear="0 0 1 0 0 {torque}" ctrlrange="0 10"/>'
    model = module.MjModel.from_xml_string(
        '<mujoco><option timestep="0.001" integrator="RK4"/><worldbody><body pos="0 0 5"><freejoint/>'
        f'<geom type="box" size=".1 .1 .02" mass="1"/>{sites}</body></worldbody><actuator>{motors}</actuator></mujoco>')
    data = module.MjData(model)
    data.ctrl[:] = 9.81 / 4

    def advance(span):
        module.mj_step(model, data, nstep=int(span * 1000))

    return {"what": "a rigid body under four thrusts, no rotor dynamics, no control", "step_s": 1e-3, "order": "4 (Runge–Kutta)",
            "s_per_s": timed(seconds, advance)}


def rotorpy(seconds: float) -> dict:
    import numpy as np
    parameters = importlib.import_module("rotorpy.vehicles.crazyflie_params").quad_params
    vehicle = importlib.import_module("rotorpy.vehicles.multirotor").Multirotor(parameters)
    control = importlib.import_module("rotorpy.controllers.quadrotor_control").SE3Control(parameters)
    goal = {"x": np.ones(3), "yaw": 0, "yaw_dot": 0, "yaw_ddot": 0}
    goal |= {name: np.zeros(3) for name in ("x_dot", "x_ddot", "x_dddot", "x_ddddot")}
    state = vehicle.initial_state

    def advance(span):
        nonlocal state
        for step in range(int(span * 100)):
            state = vehicle.step(state, control.update(step * 0.01, state, goal), 0.01)

    return {"what": "rotor dynamics and aerodynamics, geometric control, in Python", "step_s": 1e-2, "order": "5(4) (adaptive Runge–Kutta)",
            "s_per_s": timed(seconds, advance)}


def jsbsim(seconds: float) -> dict:
    model = importlib.import_module("jsbsim").FGFDMExec(None)
    model.set_debug_level(0)
    model.load_model("F450")
    model.set_dt(1e-3)
    model["ic/h-sl-ft"] = 1000.0
    if not model.run_ic():
        raise RuntimeError("the F450 does not start")

    def advance(span):
        for _ in range(int(span * 1000)):
            model.run()

    return {"what": "its quadrotor F450 with atmosphere and propulsion, one call from Python per step", "step_s": 1e-3,
            "order": "its default (Adams–Bashforth, trapezoidal)", "s_per_s": timed(seconds, advance)}


def pybullet(seconds: float) -> dict:
    bullet = importlib.import_module("pybullet")
    bullet.connect(bullet.DIRECT)
    bullet.setGravity(0, 0, -9.81)
    bullet.setTimeStep(1e-3)
    shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[0.1, 0.1, 0.02])
    body = bullet.createMultiBody(1.0, shape, basePosition=[0, 0, 5])
    places = [[x, y, 0] for x in (-0.1, 0.1) for y in (-0.1, 0.1)]

    def advance(span):
        for _ in range(int(span * 1000)):
            for place in places:
                bullet.applyExternalForce(body, -1, [0, 0, 9.81 / 4], place, bullet.LINK_FRAME)
            bullet.stepSimulation()

    return {"what": "a rigid body under four forces, which is the plant of gym-pybullet-drones", "step_s": 1e-3,
            "order": "1 (semi-implicit Euler)", "s_per_s": timed(seconds, advance)}


def crazyflow(seconds: float) -> dict:
    import numpy as np
    control = importlib.import_module("crazyflow.control").Control.state
    simulation = importlib.import_module("crazyflow.sim").Sim(n_worlds=1, n_drones=1, control=control)
    jax = importlib.import_module("jax")
    simulation.reset()
    steps = simulation.freq // simulation.control_freq
    # Position, velocity, acceleration, attitude as a quaternion, rates: hovering at 1 m.
    command = np.zeros((1, 1, 16))
    command[..., [2, 12]] = 1.0

    def advance(span):
        for _ in range(int(span * simulation.control_freq)):
            simulation.state_control(command)
            simulation.step(steps)
        jax.block_until_ready(simulation.data.states.pos)

    return {"what": "one drone in one world with its state controller, JAX on the processor", "step_s": 1 / simulation.freq, "order": "its default",
            "s_per_s": timed(min(seconds, 2.0), advance)}


ENGINES = {"MuJoCo": mujoco, "RotorPy": rotorpy, "JSBSim": jsbsim, "PyBullet": pybullet, "crazyflow": crazyflow}
#: What cannot be had from the registry of Python packages.
ABSENT = {
    "gym-pybullet-drones": "is not in the registry of Python packages; PyBullet, its engine, is measured instead",
    "PX4 SIH": "is a firmware, which no package registry has",
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", choices=ENGINES)
    parser.add_argument("--seconds", type=float, default=5.0)
    arguments = parser.parse_args()
    # Some write to standard output as they load.
    figures, out = None, os.dup(1)
    os.dup2(2, 1)
    try:
        figures = ENGINES[arguments.name](arguments.seconds)
    except Exception as failure:  # noqa: BLE001: whatever a peer fails with is reported
        print(f"{type(failure).__name__}: {failure}", file=sys.stderr)
    os.write(out, (json.dumps(figures) + "\n").encode())


if __name__ == "__main__":
    main()
