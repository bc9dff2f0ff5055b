"""Streams a circle with velocity and acceleration fed forward: radius 4 m, one turn in ten seconds, twice."""

import math
import time

from flight import TRAJECTORY, Flight, arguments

RADIUS, RATE, PERIOD = 4.0, 2 * math.pi / 10, 0.02


def circle(t: float):
    """Position, velocity and acceleration at a time; the rate grows from nothing within five seconds."""
    ramp = min(t / 5, 1.0)
    angle = RATE * (t * ramp / 2 if ramp < 1 else t - 2.5)
    rate, change = RATE * ramp, RATE / 5 if ramp < 1 else 0.0
    s, c = math.sin(angle), math.cos(angle)
    position = (RADIUS * s, RADIUS * (1 - c), -5.0)
    velocity = (RADIUS * c * rate, RADIUS * s * rate, 0.0)
    acceleration = (RADIUS * (-s * rate**2 + c * change), RADIUS * (c * rate**2 + s * change), 0.0)
    return position, velocity, acceleration


options = arguments(__doc__, "circle.png")
flight = Flight(options.connect)
flight.take_off()
start = time.monotonic()
# To the beginning of the circle, as a place.
while time.monotonic() - start < 6:
    flight.set_point(TRAJECTORY, circle(0)[0])
    if time.monotonic() - start < 0.2:
        flight.offboard()
    flight.read(0.1)

start = begin = time.monotonic()
vehicle_start = flight.now
while (t := time.monotonic() - start) < 22.5:
    flight.set_point(TRAJECTORY, *circle(t))
    flight.read(PERIOD)
steady = [(position[0], position[1] - RADIUS) for when, position, _ in flight.flown if when > vehicle_start + 7]
worst = max(abs(math.hypot(*offset) - RADIUS) for offset in steady)
print(f"the radius was held within {100 * worst:.1f} cm")
flight.land()
flight.plot(options.plot, "streamed circle")
