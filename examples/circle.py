"""Streams a circle with velocity and acceleration fed forward: radius 4 m, one turn in ten seconds, twice."""

import math
import sys

from flight import TRAJECTORY, Flight, arguments

RADIUS, HEIGHT = 4.0, 5.0
RATE = 2 * math.pi / 10  # rad/s
RAMP = 5.0  # s, from rest to that rate
TURNS = 2


def circle(t: float):
    """Position, velocity and acceleration at a time; it begins at rest above the origin, heading north."""
    u = min(t / RAMP, 1.0)
    # The rate grows smoothly, so that the acceleration has no step: 3u² - 2u³.
    angle = RATE * RAMP * (u**3 - u**4 / 2) + RATE * max(t - RAMP, 0.0)
    rate = RATE * (3 * u**2 - 2 * u**3)
    change = RATE * 6 * u * (1 - u) / RAMP
    s, c = math.sin(angle), math.cos(angle)
    position = (RADIUS * s, RADIUS * (1 - c), -HEIGHT)
    velocity = (RADIUS * c * rate, RADIUS * s * rate, 0.0)
    acceleration = (RADIUS * (c * change - s * rate**2), RADIUS * (s * change + c * rate**2), 0.0)
    return position, velocity, acceleration


options = arguments(__doc__, "circle.png")
flight = Flight(options.connect)
flight.take_off()
flight.go_to(circle(0)[0])
begin = flight.now
flight.stream(RAMP / 2 + TURNS * 2 * math.pi / RATE, lambda t: flight.set_point(TRAJECTORY, *circle(t)))
distances = [abs(math.dist(position[:2], (0.0, RADIUS)) - RADIUS) for _, position, _ in flight.since(begin)]
missed = flight.verdict("farthest from the circle", 100 * max(distances), 5, "cm")
late = [math.dist(position, circle(at - begin)[0]) for at, position, _ in flight.since(begin)]
missed |= flight.verdict("farthest from the moving point", 100 * flight.most(late[:-1], "the way"), 20, "cm")
flight.land()
flight.plot(options.plot, "streamed circle with feed-forward")
sys.exit(missed)
