"""Flies a square by velocities alone, then climbs while it turns east."""

import math
import sys

from flight import VELOCITY, Flight, arguments

EAST = math.pi / 2
LEGS = [((2, 0, 0), 0.0), ((0, 2, 0), 0.0), ((-2, 0, 0), 0.0), ((0, -2, 0), 0.0), ((0, 0, -1), EAST), ((0, 0, 0), EAST)]

options = arguments(__doc__, "velocity_flight.png")
flight = Flight(options.connect)
flight.take_off()
flight.set_point(VELOCITY)
flight.offboard()
worst = 0.0
for velocity, yaw in LEGS:
    flight.stream(5, lambda t: flight.set_point(VELOCITY, velocity=velocity, yaw=yaw))
    print("asked for {}, {}, {} m/s, flies {:.2f}, {:.2f}, {:.2f} m/s".format(*velocity, *flight.velocity))
    worst = max(worst, math.dist(flight.velocity, velocity))
missed = flight.verdict("largest error of velocity at the end of a leg", 100 * worst, 5, "cm/s")
flight.land()
flight.plot(options.plot, "velocity flight")
sys.exit(missed)
