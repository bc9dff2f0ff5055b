"""Flies to 5 m north, 5 m east, 10 m up: the paper's goal, as a position target that the vehicle shapes itself."""

import math
import sys

from flight import POSITION, Flight, arguments

GOAL = (5.0, 5.0, -10.0)

options = arguments(__doc__, "position_target.png")
flight = Flight(options.connect)
flight.take_off()
begin = flight.now
flight.go_to(GOAL)
print(f"arrived after {flight.now - begin:.1f} s")
flight.stream(3, lambda t: flight.set_point(POSITION, GOAL))
missed = flight.verdict("distance from the goal", 100 * math.dist(flight.position, GOAL), 1, "cm")
flight.land()
flight.plot(options.plot, "position target: 5 m north, 5 m east, 10 m up")
sys.exit(missed)
