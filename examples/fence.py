"""Flies against a fence: a square to stay in, a circle to stay out of. It brakes in front of both, and is refused what lies behind."""

import math
import sys

from flight import POSITION, VELOCITY, Flight, arguments, mavlink

HALF = 25.0  # of the square's side, m
CENTRE, RADIUS = (0.0, 14.0), 5.0  # of the circle, m
SQUARE = [(HALF, HALF), (HALF, -HALF), (-HALF, -HALF), (-HALF, HALF)]
FENCE = [
    *((mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, (len(SQUARE), 0, 0, 0), corner, 0.0) for corner in SQUARE),
    (mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, (RADIUS, 0, 0, 0), CENTRE, 0.0),
]
HOLD = (4, 3)  # PX4's auto mode, loiter


def holds() -> bool:
    heartbeat = flight.latest.get("HEARTBEAT")
    if heartbeat is None:
        return False
    mode = heartbeat.custom_mode
    return (mode >> 16 & 0xFF, mode >> 24) == HOLD


def against(velocity) -> tuple:
    """Flies at a velocity until the fence takes over, and returns where it comes to rest."""
    flight.set_point(VELOCITY, velocity=velocity)
    flight.offboard()
    flight.until(lambda: not holds(), 5, "offboard mode")
    flight.until(holds, 30, "the fence", lambda: flight.set_point(VELOCITY, velocity=velocity))
    flight.idle()
    flight.until(lambda: math.hypot(*flight.velocity) < 0.05, 10, "rest")
    print("at rest at north {:.1f}, east {:.1f} m".format(*flight.position))
    return flight.position


options = arguments(__doc__, "fence.png")
flight = Flight(options.connect)
flight.upload(FENCE, mavlink.MAV_MISSION_TYPE_FENCE)
flight.take_off()

north, _, _ = against((4, 0, 0))
missed = flight.verdict("beyond the square", max(north - HALF, 0), 0, "m")
missed |= flight.verdict("short of it", HALF - north, 5, "m")
flight.go_to((0.0, 0.0, -3.0))
place = against((0, 4, 0))
gap = math.dist(place[:2], CENTRE) - RADIUS
missed |= flight.verdict("into the circle", max(-gap, 0), 0, "m") | flight.verdict("short of it", gap, 5, "m")

# A goal behind the square is refused: the vehicle stays.
flight.latest.pop("STATUSTEXT", None)
flight.set_point(POSITION, (2 * HALF, 0.0, -3.0))
flight.asked.pop()  # not for the plot
flight.idle()
refusal = None


def is_refused() -> bool:
    global refusal
    text = flight.latest.get("STATUSTEXT")
    if text is not None and "rejected" in text.text:
        refusal = text.text
    return refusal is not None


flight.until(is_refused, 5, "the rejection")
print(f"rejected: {refusal}")
flight.land()
flight.clear(mavlink.MAV_MISSION_TYPE_FENCE)

circle = [(CENTRE[0] + RADIUS * math.cos(angle), CENTRE[1] + RADIUS * math.sin(angle))
          for angle in (2 * math.pi * index / 60 for index in range(61))]
flight.plot(options.plot, "flying against a fence", [[*SQUARE, SQUARE[0]], circle])
sys.exit(missed)
