"""The least that raw steps cost on the nonlinear plant, found offline by a nonlinear solver.

For each step two optimal-control problems are solved with CasADi and IPOPT (direct multiple shooting): the least integral of
the squared distance from the goal, and the least time after which the vehicle stays within 2 cm of it. The plant has the
twelve states of the paper (2)-(3) and four rotors with their lag; speeds are commanded piecewise constantly. The limits on
tilt, speed and thrust and those of the rotors are kept at every node and halfway between them; limits on the rate of commands are not.

Commands are written, not conclusions: the report flies them on its own plant and measures that flight.

    python optimum.py MODEL_DESCRIPTION OUT.json
"""

import argparse
import json
import math
import sys
import time
import xml.etree.ElementTree as tree
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import casadi as ca
import numpy as np

GRAVITY = 9.80665
# Time between nodes, s, which the problems of least time stretch, and steps of the integration between them.
STEP = 0.04
SUBSTEPS = 4
# What counts as settled, m: a millimetre less than in the report, for the difference of the integrations. And how long the
# fastest flight must show that it stays, s.
SETTLED = 0.019
STAY = 1.0
# Name in results.json, goal in NED, m, time of the flight, s, and a first guess of the settling time, s.
STEPS = [
    ("5 m north", (5.0, 0.0, 0.0), 4.0, 2.2),
    ("20 m north", (20.0, 0.0, 0.0), 6.0, 4.0),
    ("5 m north, 5 m east, 5 m up", (5.0, 5.0, -5.0), 4.0, 2.6),
]


def parameters(description):
    """Start values of the FMU's parameters, by name."""
    values = {}
    for variable in tree.parse(description).getroot().iter("ScalarVariable"):
        real = variable.find("Real")
        if real is not None and "start" in real.attrib:
            values[variable.attrib["name"]] = float(real.attrib["start"])
    return values


class Plant:
    """The default airframe in the layout "+", with rotor speeds in multiples of the hover speed."""

    def __init__(self, values):
        self.mass = values["airframe.mass"]
        self.arm = values["airframe.arm_length"]
        self.inertia = [values[f"airframe.inertia.{axis}"] for axis in "xyz"]
        self.k1 = values["airframe.rotor.thrust_coefficient"]
        self.k2 = values["airframe.rotor.torque_coefficient"]
        self.lag = values["airframe.rotor.time_constant"]
        self.drag = [values[f"airframe.drag.{axis}"] for axis in "xyz"]
        self.hover = math.sqrt(self.mass * GRAVITY / (4 * self.k1))
        self.speeds = [values[f"airframe.rotor.speed_{end}"] / self.hover for end in ("min", "max")]
        self.tilt = values["limits.tilt"]
        self.thrust = [values[f"limits.thrust.{end}"] for end in ("min", "max")]
        self.velocity = [values[f"limits.speed.{way}"] for way in ("horizontal", "up", "down")]

    def derivative(self, body, speed):
        """f(x, u) of the rigid body: position, velocity, attitude (roll, pitch, yaw) and body rates, under rotor speeds."""
        velocity, (phi, theta, psi), (p, q, r) = body[3:6], ca.vertsplit(body[6:9]), ca.vertsplit(body[9:12])
        lift = self.k1 * self.hover**2 * speed**2
        torque = ca.vertcat(
            self.arm * (lift[3] - lift[1]),
            self.arm * (lift[0] - lift[2]),
            self.k2 / self.k1 * (lift[1] + lift[3] - lift[0] - lift[2]),
        )
        sp, cp, st, ct, ss, cs = ca.sin(phi), ca.cos(phi), ca.sin(theta), ca.cos(theta), ca.sin(psi), ca.cos(psi)
        down = ca.vertcat(cs * st * cp + ss * sp, ss * st * cp - cs * sp, ct * cp)
        acceleration = ca.vertcat(0, 0, GRAVITY) - (ca.sum1(lift) * down + ca.DM(self.drag) * velocity) / self.mass
        turning = ca.vertcat(p + sp * st / ct * q + cp * st / ct * r, cp * q - sp * r, sp / ct * q + cp / ct * r)
        rate, inertia = ca.vertcat(p, q, r), ca.DM(self.inertia)
        spin = (torque - ca.cross(rate, inertia * rate)) / inertia
        return ca.vertcat(velocity, acceleration, turning, spin)

    def step(self):
        """The states halfway through a time and after it under a constant command: body by the classical Runge-Kutta method, rotor
        speeds, whose lag is linear, exactly."""
        x, u, h = ca.SX.sym("x", 16), ca.SX.sym("u", 4), ca.SX.sym("h")
        body, states, part = x[:12], [], h / SUBSTEPS
        speed = lambda after: u + (x[12:] - u) * ca.exp(-after / self.lag)
        f = self.derivative
        for index in range(SUBSTEPS):
            begin, middle, end = (speed((index + share) * part) for share in (0.0, 0.5, 1.0))
            k1 = f(body, begin)
            k2 = f(body + part / 2 * k1, middle)
            k3 = f(body + part / 2 * k2, middle)
            k4 = f(body + part * k3, end)
            body = body + part / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            states.append(ca.vertcat(body, end))
        return ca.Function("step", [x, u, h], [states[SUBSTEPS // 2 - 1], states[-1]])

    def limits(self, x):
        """Expressions that must not be positive."""
        thrust = ca.sum1(x[12:16] ** 2) / 4
        horizontal, up, down = self.velocity
        return ca.vertcat(
            math.cos(self.tilt) - ca.cos(x[6]) * ca.cos(x[7]),
            ca.sumsqr(x[3:5]) / horizontal**2 - 1,
            -x[5] / up - 1,
            x[5] / down - 1,
            thrust - self.thrust[1],
            self.thrust[0] - thrust,
        )


def solve(plant, goal, duration, first, fastest):
    """Times between nodes and commands of the best flight to a goal: the fastest to stay, or the one with the least squared distance."""
    goal = np.array(goal)
    rest = np.concatenate([np.zeros(12), np.ones(4)])
    step = plant.step()
    moving = round((first if fastest else duration) / STEP)
    staying = round(STAY / STEP) if fastest else 0
    stretch = ca.SX.sym("stretch")
    variables, lower, upper, guess = [stretch], [0.5 if fastest else 1.0], [2.0 if fastest else 1.0], [1.0]
    equal, at_most, cost = [], [], 0
    x, held = ca.DM(rest), ca.DM.ones(4)
    for node in range(moving + staying):
        u = ca.SX.sym(f"u{node}", 4)
        following = ca.SX.sym(f"x{node + 1}", 16)
        h = STEP * stretch if node < moving else STEP
        share = min((node + 1) / moving, 1.0)
        place = goal * (10 * share**3 - 15 * share**4 + 6 * share**5)
        variables += [u, following]
        # Beyond these angles Euler's equations and the limits end; a bound on tilt keeps it far inside.
        angles, rates = [plant.tilt, plant.tilt, 0.5], [20.0] * 3
        lower += [plant.speeds[0]] * 4 + [-200.0] * 3 + [-50.0] * 3 + [-a for a in angles] + [-r for r in rates]
        lower += [0.9 * plant.speeds[0]] * 4
        upper += [plant.speeds[1]] * 4 + [200.0] * 3 + [50.0] * 3 + angles + rates + [1.1 * plant.speeds[1]] * 4
        guess += [1.0] * 4 + list(place) + [0.0] * 9 + [1.0] * 4
        halfway, after = step(x, u, h)
        equal.append(after - following)
        at_most += [plant.limits(halfway), plant.limits(following)]
        error = following[0:3] - goal
        if fastest and node + 1 >= moving:
            at_most.append(ca.sumsqr(error) / SETTLED**2 - 1)
        if not fastest:
            cost += STEP * ca.sumsqr(error)
        # A trace of smoothness where the cost leaves the commands free.
        cost += 1e-5 * ca.sumsqr(u - held)
        x, held = following, u
    if fastest:
        cost += stretch
        equal.append(x[3:12])
    else:
        equal.append(x[0:12] - np.concatenate([goal, np.zeros(9)]))
    equal.append(x[12:16] - 1)
    equal, at_most = ca.vertcat(*equal), ca.vertcat(*at_most)
    problem = {"x": ca.vertcat(*variables), "f": cost, "g": ca.vertcat(equal, at_most)}
    options = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 1000, "tol": 1e-6, "constr_viol_tol": 1e-8}}
    solver = ca.nlpsol("solver", "ipopt", problem, options)
    bounds = {"lbg": [0.0] * equal.numel() + [-math.inf] * at_most.numel(), "ubg": 0.0}
    found = solver(x0=guess, lbx=lower, ubx=upper, **bounds)
    stats = solver.stats()
    if not stats["success"]:
        raise RuntimeError(f"goal {tuple(goal)}: {stats['return_status']}")
    values = np.array(found["x"]).ravel()
    steps = np.where(np.arange(moving + staying) < moving, STEP * values[0], STEP)
    return steps, plant.hover * values[1:].reshape(-1, 20)[:, :4]


def best(task):
    """Solves one of the two problems of a step."""
    values, (name, goal, duration, first), fastest = task
    begin = time.perf_counter()
    steps, commands = solve(Plant(values), goal, duration, first, fastest)
    return {
        "flight": name,
        "objective": "settling time" if fastest else "squared distance",
        "computed_in_s": time.perf_counter() - begin,
        "step_s": steps.tolist(),
        "command_rad_s": commands.tolist(),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("description", type=Path, help="modelDescription.xml, whose start values are the vehicle's")
    parser.add_argument("out", type=Path, help="JSON file for the results")
    arguments = parser.parse_args()
    try:
        values = parameters(arguments.description)
    except (OSError, tree.ParseError) as error:
        sys.exit(f"error: cannot read {arguments.description}: {error}")
    tasks = [(values, step, fastest) for step in STEPS for fastest in (False, True)]
    with ProcessPoolExecutor() as pool:
        results = list(pool.map(best, tasks))
    arguments.out.write_text(json.dumps(results), encoding="utf-8")


if __name__ == "__main__":
    main()
