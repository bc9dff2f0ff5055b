"""Flies a square by velocities alone, then climbs while it turns east."""

import math
import time

from flight import VELOCITY, Flight, arguments

LEGS = [((2, 0, 0), 0.0), ((0, 2, 0), 0.0), ((-2, 0, 0), 0.0), ((0, -2, 0), 0.0), ((0, 0, -1), math.pi / 2), ((0, 0, 0), math.pi / 2)]

options = arguments(__doc__, "velocity_flight.png")
flight = Flight(options.connect)
flight.take_off()
flight.set_point(VELOCITY)
flight.offboard()
for velocity, yaw in LEGS:
    end = time.monotonic() + 4
    while time.monotonic() < end:
        flight.set_point(VELOCITY, velocity=velocity, yaw=yaw)
        flight.read(0.05)
    print("asked for {} m/s, flew {:.2f}, {:.2f}, {:.2f} m/s".format(velocity, *flight.flown[-1][2]))
flight.land()
flight.plot(options.plot, "velocity flight")
