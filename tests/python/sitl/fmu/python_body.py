"""A quadrotor as somebody writes it in Python: four rotors with a lag over flat ground, as a slave of PythonFMU. Its variables have the
vehicle's names, so that it needs no map but for the interpreter's library."""

import math

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

GRAVITY = 9.81


class PythonBody(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.parameters = {
            "airframe.mass": 0.7, "airframe.arm_length": 0.275, "airframe.inertia.x": 0.1063, "airframe.inertia.y": 0.1063,
            "airframe.inertia.z": 0.2122, "airframe.rotor.thrust_coefficient": 2.7e-5, "airframe.rotor.torque_coefficient": 5e-7,
            "airframe.rotor.time_constant": 0.05, "initial.position.x": 0.0, "initial.position.y": 0.0, "initial.attitude.psi": 0.0,
        }
        self.command = [0.0] * 4
        self.speed = [0.0] * 4
        self.position = [0.0] * 3
        self.velocity = [0.0] * 3
        self.attitude = [1.0, 0.0, 0.0, 0.0]
        self.rate = [0.0] * 3
        self.armed = False
        for name in self.parameters:
            self.add(name, self.parameters, name, Fmi2Causality.parameter, Fmi2Variability.fixed)
        for number in range(4):
            self.add(f"rotor.command[{number + 1}]", self.command, number, Fmi2Causality.input)
            self.add(f"rotor.speed[{number + 1}]", self.speed, number, Fmi2Causality.output)
            self.add(f"attitude.q{number}", self.attitude, number, Fmi2Causality.output)
        for number, axis in enumerate("xyz"):
            self.add(f"position.{axis}", self.position, number, Fmi2Causality.output)
            self.add(f"velocity.{axis}", self.velocity, number, Fmi2Causality.output)
            self.add(f"body_rate.{'pqr'[number]}", self.rate, number, Fmi2Causality.output)
        self.register_variable(Boolean("armed", causality=Fmi2Causality.input))

    def add(self, name, values, key, causality, variability=Fmi2Variability.continuous):
        def put(value):
            values[key] = value

        self.register_variable(Real(name, causality=causality, variability=variability, getter=lambda: values[key], setter=put))

    def exit_initialization_mode(self):
        self.position[:2] = self.parameters["initial.position.x"], self.parameters["initial.position.y"]
        half = self.parameters["initial.attitude.psi"] / 2
        self.attitude[:] = math.cos(half), 0.0, 0.0, math.sin(half)
        print(f"a Python body of {self.parameters['airframe.mass']} kg")

    def do_step(self, current_time, step_size):
        p, h = self.parameters, step_size
        lag = 1 - math.exp(-h / p["airframe.rotor.time_constant"])
        for rotor in range(4):
            self.speed[rotor] += lag * (self.command[rotor] - self.speed[rotor])
        front, right, back, left = (p["airframe.rotor.thrust_coefficient"] * speed * speed for speed in self.speed)
        drag = p["airframe.rotor.torque_coefficient"] / p["airframe.rotor.thrust_coefficient"]
        thrust = front + right + back + left
        arm = p["airframe.arm_length"]
        torque = (arm * (left - right), arm * (front - back), drag * YAW * (front - right + back - left))
        w, x, y, z = self.attitude
        up = (2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z)
        for axis in range(3):
            self.velocity[axis] += h * ((GRAVITY if axis == 2 else 0.0) - thrust / p["airframe.mass"] * up[axis])
        inertia = [p[f"airframe.inertia.{axis}"] for axis in "xyz"]
        a, b, c = self.rate
        gyroscopic = ((inertia[1] - inertia[2]) * b * c, (inertia[2] - inertia[0]) * c * a, (inertia[0] - inertia[1]) * a * b)
        for axis in range(3):
            self.rate[axis] += h * (torque[axis] + gyroscopic[axis]) / inertia[axis]
        if self.position[2] >= 0 and self.velocity[2] >= 0:
            yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
            self.velocity[:], self.rate[:], self.position[2] = [0.0] * 3, [0.0] * 3, 0.0
            self.attitude[:] = math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)
            return True
        for axis in range(3):
            self.position[axis] += h * self.velocity[axis]
        a, b, c = self.rate
        change = (-x * a - y * b - z * c, w * a + y * c - z * b, w * b - x * c + z * a, w * c + x * b - y * a)
        turned = [value + h / 2 * rate for value, rate in zip(self.attitude, change)]
        norm = math.sqrt(sum(value * value for value in turned))
        self.attitude[:] = [value / norm for value in turned]
        return True


# The front rotor turns clockwise as seen from above, and its drag turns the body the other way.
YAW = -1.0
