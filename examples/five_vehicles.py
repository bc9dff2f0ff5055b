"""Five vehicles on one connection: they take off from a circle, turn around its centre once, rising and sinking and
further out where they are high, and land where they began. Start them behind one port, on one clock:

    cargo run --release -p sitl -- --vehicles 5 --ports shared --formation circle,6 &
    python examples/five_vehicles.py --plot five_vehicles.png
"""

import itertools
import math
import os
import time

os.environ.setdefault("MAVLINK20", "1")

from pymavlink import mavutil  # noqa: E402
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

from flight import TRAJECTORY, arguments  # noqa: E402

COUNT, HEIGHT, TURN = 5, 5.0, 20.0  # vehicles, m, s of one turn of the wheel


class Fleet:
    def __init__(self, address: str):
        self.connection = mavutil.mavlink_connection(address, dialect="common")
        self.mav = self.connection.mav
        if address.startswith(("udpout", "tcp")):
            self.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        self.flown = {}  # system: time in s and position of each sample
        self.armed = {}
        self.acknowledged = {}  # (system, command): result
        self.until(lambda: len(self.flown) >= COUNT, f"{COUNT} vehicles at {address}", 20)

    def read(self, seconds: float = 0.0):
        """Takes in what comes within a while."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            message = self.connection.recv_match(blocking=True, timeout=left)
            if message is None:
                return
            system, kind = message.get_srcSystem(), message.get_type()
            if kind == "LOCAL_POSITION_NED":
                self.flown.setdefault(system, []).append((message.time_boot_ms / 1e3, (message.x, message.y, message.z)))
            elif kind == "HEARTBEAT":
                self.armed[system] = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
            elif kind == "COMMAND_ACK":
                self.acknowledged[system, message.command] = message.result

    def until(self, condition, what: str, seconds: float):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise SystemExit(f"{what}: not within {seconds} s")
            self.read(0.05)

    def command(self, number: int, *parameters: float):
        """A command for all, and again for those that have not answered."""
        parameters = [*parameters, *([0.0] * (7 - len(parameters)))]
        waiting = set(self.flown)
        for attempt in range(5):
            for system in waiting:
                self.acknowledged.pop((system, number), None)
                self.mav.command_long_send(system, 1, number, attempt, *parameters)
            self.read(0.3)
            waiting = {system for system in waiting if self.acknowledged.get((system, number)) != mavlink.MAV_RESULT_ACCEPTED}
            if not waiting:
                return
        raise SystemExit(f"command {number}: not accepted by {sorted(waiting)}")

    @property
    def now(self) -> float:
        """Time of the vehicles, s."""
        return max(samples[-1][0] for samples in self.flown.values())

    def place(self, system: int):
        return self.flown[system][-1][1]

    def set_point(self, system: int, position, velocity=(0, 0, 0), acceleration=(0, 0, 0)):
        self.mav.set_position_target_local_ned_send(
            0, system, 1, mavlink.MAV_FRAME_LOCAL_NED, TRAJECTORY, *position, *velocity, *acceleration, 0, 0)

    def plot(self, path: str):
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        figure, (above, heights) = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
        for system, samples in sorted(self.flown.items()):
            north, east, down = zip(*(position for _, position in samples))
            line, = above.plot(east, north, linewidth=1, label=f"system {system}")
            above.plot(east[0], north[0], "o", color=line.get_color())
            heights.plot([when for when, _ in samples], [-z for z in down], linewidth=1)
        above.set(xlabel="east, m", ylabel="north, m", aspect="equal", title="from above, and the starts")
        above.legend(fontsize="small")
        heights.set(xlabel="time, s", ylabel="height, m", title="heights")
        figure.suptitle("five vehicles on one connection")
        figure.savefig(path, dpi=120)
        print(f"wrote {path}")


def wheel(start, phase: float, t: float):
    """A place on the way around the centre: from rest to rest within a turn, further out where it is high."""
    s = min(max(t / TURN, 0.0), 1.0)
    turned = 2 * math.pi * s**3 * (10 - 15 * s + 6 * s * s)
    wave = math.sin(turned + phase) - math.sin(phase)
    radius, angle = math.hypot(*start) * (1 + 0.2 * wave), math.atan2(start[1], start[0]) + turned
    return radius * math.cos(angle), radius * math.sin(angle), -HEIGHT - 1.5 * wave


def motion(start, phase: float, t: float, h: float = 0.02):
    """Position, velocity and acceleration there."""
    before, now, after = (wheel(start, phase, t + step) for step in (-h, 0.0, h))
    return (now, [(b - a) / (2 * h) for a, b in zip(before, after)],
            [(a - 2 * here + b) / h**2 for a, here, b in zip(before, now, after)])


options = arguments(__doc__, "five_vehicles.png")
fleet = Fleet(options.connect)
starts = {system: samples[-1][1][:2] for system, samples in sorted(fleet.flown.items())}
print("vehicles:", ", ".join(f"{system} at {north:.1f} m north, {east:.1f} m east" for system, (north, east) in starts.items()))
fleet.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
fleet.command(mavlink.MAV_CMD_NAV_TAKEOFF, *[math.nan] * 7)
fleet.until(lambda: all(fleet.place(system)[2] < -2.3 for system in starts), "takeoff", 30)

phases = {system: 2 * math.pi * number / COUNT for number, system in enumerate(starts)}
climb = fleet.now
for system in starts:
    fleet.set_point(system, wheel(starts[system], phases[system], 0))
fleet.command(mavlink.MAV_CMD_DO_SET_MODE, 1, 6)
begin, worst, nearest = climb + 6, 0.0, math.inf
while (t := fleet.now - begin) < TURN + 1:
    for system in starts:
        fleet.set_point(system, *motion(starts[system], phases[system], t))
    fleet.read(0.02)
    if t > 0:
        nearest = min(nearest, *(math.dist(fleet.place(one), fleet.place(other)) for one, other in itertools.combinations(starts, 2)))
        for system in starts:
            when, place = fleet.flown[system][-1]
            worst = max(worst, math.dist(place, wheel(starts[system], phases[system], when - begin)))
print(f"nobody was further than {100 * worst:.0f} cm from its place, nor nearer than {nearest:.1f} m to another")
fleet.command(mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH)
fleet.until(lambda: not any(fleet.armed.get(system, True) for system in starts), "landing", 60)
fleet.plot(options.plot)
