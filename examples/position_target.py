"""Flies to 5 m north, 5 m east, 10 m up: the paper's goal, as a position target that the vehicle shapes itself."""

import math

from flight import POSITION, Flight, arguments

options = arguments(__doc__, "position_target.png")
flight = Flight(options.connect)
flight.take_off()

goal = (5.0, 5.0, -10.0)
flight.set_point(POSITION, goal)
flight.offboard()
while math.dist(flight.position, goal) > 0.05 or math.hypot(*flight.flown[-1][2]) > 0.05:
    flight.set_point(POSITION, goal)
    flight.read(0.1)
print("arrived at north {:.3f}, east {:.3f}, down {:.3f} m".format(*flight.position))
flight.land()
flight.plot(options.plot, "position target")
