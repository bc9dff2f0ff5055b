"""Uploads a mission around a field and flies it: climb, three corners passed without a stop, a look at its middle, and back to
land."""

import math
import sys

from flight import Flight, arguments, mavlink

RADIUS = 2.0  # within which a corner is passed, m
HEIGHT = 8.0
CORNERS = [(30, 0, HEIGHT), (30, 30, HEIGHT + 4), (0, 30, HEIGHT)]  # north, east, up, m
MIDDLE = (15, 15)


def item(command, parameters=(0, 0, 0, math.nan), place=(0, 0), height=0.0):
    """An item with a place in metres from the origin, which goes as latitude and longitude."""
    return command, parameters, place, height


MISSION = [
    item(mavlink.MAV_CMD_NAV_TAKEOFF, height=HEIGHT),
    item(mavlink.MAV_CMD_DO_CHANGE_SPEED, (1, 5, -1, 0)),
    item(mavlink.MAV_CMD_DO_SET_ROI_LOCATION, place=MIDDLE),
    *(item(mavlink.MAV_CMD_NAV_WAYPOINT, (0, RADIUS, 0, math.nan), (north, east), height) for north, east, height in CORNERS),
    item(mavlink.MAV_CMD_NAV_LAND, place=(0.01, 0)),
]


def beside(position, start, end) -> float:
    """Horizontal distance from the line of a leg."""
    way = (end[0] - start[0], end[1] - start[1])
    off = (position[0] - start[0], position[1] - start[1])
    return abs(way[0] * off[1] - way[1] * off[0]) / math.hypot(*way)


options = arguments(__doc__, "mission.png")
flight = Flight(options.connect)
flight.upload(MISSION)
flight.stand()
flight.command(mavlink.MAV_CMD_MISSION_START)
for kind in ("MISSION_CURRENT", "MISSION_ITEM_REACHED"):
    flight.latest.pop(kind, None)  # of an earlier mission

# The corners with the time at which each was passed.
passed = []


def watch():
    reached = flight.latest.get("MISSION_ITEM_REACHED")
    corner = reached.seq - 3 if reached else -1
    if len(passed) == corner < len(CORNERS):
        north, east, up = CORNERS[corner]
        passed.append(flight.now)
        flight.asked.append((flight.now, (north, east, -up), None))
        print(f"corner {corner + 1} after {flight.now - begin:.1f} s")


def is_complete() -> bool:
    current = flight.latest.get("MISSION_CURRENT")
    return current is not None and current.mission_state == mavlink.MISSION_STATE_COMPLETE


begin = flight.now
flight.until(is_complete, 120, "mission", watch)
flight.until(lambda: not flight.armed, 20, "landing")

nearest = [min(math.dist(position, (north, east, -up)) for _, position, _ in flight.flown) for north, east, up in CORNERS]
missed = flight.verdict("farthest from a corner", max(nearest), RADIUS, "m")
# Between two corners, clear of both.
sides = [(position, start, end)
         for (start, end), (left, right) in zip(zip(CORNERS, CORNERS[1:]), zip(passed, passed[1:]))
         for at, position, _ in flight.flown if left + 3 < at < right - 1.5]
missed |= flight.verdict("beside a leg", 100 * flight.most((beside(*side) for side in sides), "the way between two corners"), 20, "cm")
missed |= flight.verdict("landed from the origin", 100 * math.hypot(*flight.position[:2]), 20, "cm")
flight.plot(options.plot, "mission: around a field", places=True)
sys.exit(missed)
