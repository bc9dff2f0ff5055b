"""Five vehicles on one connection: they take off from a circle, turn around its centre once, rising and sinking and
further out where they are high, and land where they began. They stand behind one port, on one clock:

    cargo run --release -p sitl -- --vehicles 5 --ports shared --formation circle,6 --speed max --lockstep always
    python examples/five_vehicles.py --plot five_vehicles.png
"""

import itertools
import math
import os
import sys
import time

os.environ.setdefault("MAVLINK20", "1")

from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

from flight import INTERVAL, OFFBOARD, SILENCE, TRAJECTORY, VELOCITY, arguments, beat, connect, receive, remedy, round_trip, verdict  # noqa: E402

COUNT = 5
START = f"--vehicles {COUNT} --ports shared --formation circle,6"
HEIGHT, TURN = 5.0, 20.0  # m, s of one turn
ARMED = mavlink.MAV_MODE_FLAG_SAFETY_ARMED


class Fleet:
    def __init__(self, address: str):
        self.connection = connect(address)
        self.mav = self.connection.mav
        self.flown = {}  # system: time in s and position of each report
        self.armed, self.answers = {}, {}
        self.beaten = -math.inf
        self.longest_lag = 0.0  # between two reports of a vehicle, and until it has answered, s
        # In lock-step no time passes until all have a set-point, so that all begin together.
        end = time.monotonic() + 5
        while len(self.armed) < COUNT and time.monotonic() < end:
            self.read(0.1)
        if len(self.armed) < COUNT:
            raise SystemExit(f"no {COUNT} vehicles at {address}, only {sorted(self.armed)}: start them with {START}")
        self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, 1e6 * INTERVAL)
        for system in sorted(self.armed):
            self.idle(system)
        # The first reports come at once, the others at the interval: from the second ones on, each is answered.
        end = time.monotonic() + 5
        while min(len(self.flown.get(system, ())) for system in self.armed) < 2:
            if time.monotonic() > end:
                raise SystemExit("the vehicles do not tell where they are")
            self.read(0.5)
        for system in sorted(self.armed):
            self.idle(system)
        self.longest_lag = 0.0

    def fail(self, reason: str):
        """Ends the program with one line."""
        raise SystemExit(reason + remedy(self.longest_lag))

    def read(self, timeout: float = SILENCE):
        """Takes a message in; returns the vehicle whose place it tells, if it does."""
        message = receive(self.connection, timeout=timeout)
        if message is None:
            if timeout == SILENCE:
                self.fail("the vehicles have fallen silent")
            return None
        system, kind = message.get_srcSystem(), message.get_type()
        if self.flown:
            self.longest_lag = max(self.longest_lag, round_trip(message, self.now))
        if kind == "HEARTBEAT" and message.autopilot != mavlink.MAV_AUTOPILOT_INVALID:
            self.armed[system] = bool(message.base_mode & ARMED)
        elif kind == "COMMAND_ACK":
            self.answers[system, message.command] = message.result
        elif kind == "LOCAL_POSITION_NED":
            at, reports = message.time_boot_ms / 1e3, self.flown.setdefault(system, [])
            if reports and at <= reports[-1][0]:
                return system  # told again, because nothing has answered it
            if reports:
                self.longest_lag = max(self.longest_lag, at - reports[-1][0])
            reports.append((at, (message.x, message.y, message.z)))
            if self.now - self.beaten >= 1:
                beat(self.connection, self.now)
                self.beaten = self.now
            return system
        return None

    def idle(self, system: int):
        """Asks for nothing but to stay, which modes other than offboard ignore; in lock-step the vehicle waits for a set-point."""
        self.mav.set_position_target_local_ned_send(
            0, system, 1, mavlink.MAV_FRAME_LOCAL_NED, VELOCITY, *[0.0] * 9, 0, 0)

    @property
    def now(self) -> float:
        """Time of the vehicles, s."""
        return max(reports[-1][0] for reports in self.flown.values())

    def place(self, system: int):
        return self.flown[system][-1][1]

    def command(self, number: int, *parameters: float, each_report=None):
        """The same command to each; again to those that have not answered."""
        each_report = each_report or self.idle
        parameters = [*parameters, *([0.0] * (7 - len(parameters)))]
        self.answers = {}
        for attempt in range(5):
            for system in sorted(set(self.armed) - {system for system, _ in self.answers}):
                self.mav.command_long_send(system, 1, number, attempt, *parameters)
            end = time.monotonic() + 1
            while time.monotonic() < end and len(self.answers) < COUNT:
                if system := self.read(1):
                    each_report(system)
            if len(self.answers) == COUNT:
                break
        refused = {system: self.answers.get((system, number)) for system in self.armed}
        if any(result != mavlink.MAV_RESULT_ACCEPTED for result in refused.values()):
            self.fail(f"command {number} was not accepted by all: {refused}")

    def until(self, condition, seconds: float, what: str, each_report=None):
        each_report = each_report or self.idle
        end = self.now + seconds
        while not condition():
            if self.now > end:
                self.fail(f"{what}: not within {seconds} s")
            if system := self.read():
                each_report(system)

    def set_point(self, system: int, position, velocity, acceleration):
        self.mav.set_position_target_local_ned_send(
            0, system, 1, mavlink.MAV_FRAME_LOCAL_NED, TRAJECTORY, *position, *velocity, *acceleration, 0, 0)

    def plot(self, path: str):
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        plt.rcParams.update({"axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True})
        figure, (above, heights) = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
        for (system, reports), colour in zip(sorted(self.flown.items()), ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")):
            north, east, down = zip(*(position for _, position in reports))
            above.plot(east, north, color=colour, linewidth=1, label=f"system {system}")
            above.plot(east[0], north[0], "o", color=colour)
            heights.plot([at for at, _ in reports], [-z for z in down], color=colour, linewidth=1)
        above.set(xlabel="east, m", ylabel="north, m", aspect="equal", adjustable="datalim", title="from above, and the starts")
        heights.set(xlabel="time of the vehicles, s", ylabel="up, m", title="heights")
        figure.legend(*above.get_legend_handles_labels(), ncols=COUNT, loc="outside lower center")
        figure.suptitle("five vehicles on one connection")
        figure.savefig(path, dpi=110)
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
starts = {system: reports[0][1][:2] for system, reports in sorted(fleet.flown.items())}
if min(math.hypot(*start) for start in starts.values()) < 4:
    raise SystemExit(f"the vehicles do not stand in a circle: start them with {START}")
phases = {system: 2 * math.pi * number / COUNT for number, system in enumerate(starts)}
fleet.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
fleet.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, *[math.nan] * 4)
fleet.until(lambda: all(fleet.place(system)[2] < -2.4 for system in starts), 20, "takeoff")

# All wait for one another at the beginning of their ways.
begin = math.inf
late, nearest = 0.0, math.inf


def follow(system: int):
    """Tells a vehicle where to be, whenever it has told where it is."""
    fleet.set_point(system, *motion(starts[system], phases[system], fleet.now - begin))


asked_from = fleet.now
fleet.until(lambda: fleet.now > asked_from + 2 * INTERVAL, 5, "set-points before offboard mode", follow)
fleet.command(mavlink.MAV_CMD_DO_SET_MODE, *OFFBOARD, each_report=follow)
fleet.until(lambda: all(math.dist(fleet.place(system), wheel(starts[system], 0, 0)) < 0.05 for system in starts), 20, "the beginning", follow)
begin = fleet.now


def follow_and_measure(system: int):
    global late, nearest
    follow(system)
    at, place = fleet.flown[system][-1]
    late = max(late, math.dist(place, wheel(starts[system], phases[system], at - begin)))
    nearest = min(nearest, *(math.dist(fleet.place(one), fleet.place(other)) for one, other in itertools.combinations(starts, 2)))


fleet.until(lambda: fleet.now > begin + TURN + 1, TURN + 2, "the turn", follow_and_measure)
missed = verdict("farthest from the moving point", 100 * late, 25, "cm", remedy(fleet.longest_lag))
missed |= verdict("two vehicles came nearer than 4 m by", max(0.0, 4 - nearest), 0.1, "m", remedy(fleet.longest_lag))
fleet.command(mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH)
fleet.until(lambda: not any(fleet.armed.values()), 60, "landing")
away = max(math.dist(fleet.place(system)[:2], starts[system]) for system in starts)
missed |= verdict("landed away from the start", 100 * away, 10, "cm")
fleet.plot(options.plot)
sys.exit(missed)
