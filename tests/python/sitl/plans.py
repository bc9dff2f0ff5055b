"""Plans as ground stations write them."""

import math


def waypoints(folder, *places):
    """A plan that takes off and flies to places, north, east and up of home, m."""
    home, earth = (47.397742, 8.545594), 6_371_000.0
    rows = [(16, *home, 488), (22, 0, 0, 6)]
    for north, east, height in places:
        rows.append((16, home[0] + math.degrees(north / earth), home[1] + math.degrees(east / earth / math.cos(math.radians(home[0]))), height))
    lines = [f"{item}\t{int(item == 0)}\t{3 if item else 0}\t{command}\t0\t0\t0\t0\t{latitude}\t{longitude}\t{height}\t1"
             for item, (command, latitude, longitude, height) in enumerate(rows)]
    plan = folder / "survey.waypoints"
    plan.write_text("\n".join(["QGC WPL 110", *lines]) + "\n")
    return str(plan)
