"""What the examples share: connecting, arming, taking off, streaming set-points, landing, and a plot of it all.

Each example flies a vehicle that is already running, `lmpc-sitl` or another one that follows PX4's conventions:

    cargo run --release -p sitl
    python examples/position_target.py --plot position.png      (in another terminal)

They need `pip install pymavlink matplotlib`. All times are the vehicle's own. At a high `--speed` a client cannot keep up with the
vehicle; start it with `--lockstep always`, and it waits for the set-points:

    cargo run --release -p sitl -- --speed max --lockstep always

Positions are north, east, down from the origin, in m. Exit code 0: flown as asked; 1: not.
"""

import argparse
import math
import os
import time

os.environ.setdefault("MAVLINK20", "1")

from pymavlink import mavutil  # noqa: E402
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

# What a set-point gives; every other value is ignored.
POSITION = 0b100111111000  # position and yaw
VELOCITY = 0b100111000111  # velocity and yaw
TRAJECTORY = 0b100000000000  # position, velocity, acceleration and yaw

OFFBOARD = (1, 6)  # PX4's custom mode: base mode "custom", main mode
INTERVAL = 0.02  # of telemetry and set-points, s
LATE = 5 * INTERVAL  # between two reports: too long to steer by
SILENCE = 10.0  # s of the wall clock without a report, after which the vehicle is gone
EARTH = 6_378_137.0  # radius, m


def connect(address: str):
    """A pymavlink connection to the vehicle."""
    try:
        connection = mavutil.mavlink_connection(address, dialect="common")
    except (OSError, ValueError, IndexError) as error:
        raise SystemExit(f"cannot connect to {address}: {error}") from None
    if address.startswith(("udpout", "tcp")):
        beat(connection)
    return connection


def beat(connection, now: float = 0.0):
    """A heartbeat; from a time of the vehicle on, s, also the question how far it flies until it is answered."""
    connection.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
    if now > 0:
        connection.mav.timesync_send(0, int(now * 1e9))


def round_trip(message, now: float) -> float:
    """How far the vehicle has flown between the question and this message, s; 0 if that is no answer."""
    answers = message.get_type() == "TIMESYNC" and message.tc1 != 0 and message.ts1 != 0
    return now - message.ts1 / 1e9 if answers else 0.0


def receive(connection, kind=None, timeout: float = SILENCE):
    """The next message, of a kind if one is given; None if there is none within the time."""
    try:
        return connection.recv_match(type=kind, blocking=True, timeout=timeout)
    except OSError as error:
        raise SystemExit(f"the connection to the vehicle has failed: {error}") from None


def remedy(ahead: float) -> str:
    """Why a flight failed, if the vehicle's time ran this many seconds ahead of this program, and what to do."""
    if ahead <= LATE:
        return ""
    return (f" (the vehicle flew up to {ahead:.1f} s ahead: this program cannot keep up with its speed; start the vehicle with "
            "--lockstep always, or with a lower --speed)")


class Flight:
    def __init__(self, address: str):
        self.connection = connect(address)
        self.mav = self.connection.mav
        if self.connection.wait_heartbeat(timeout=5) is None:
            raise SystemExit(f"no vehicle at {address}")
        self.target = (self.connection.target_system, self.connection.target_component)
        self.latest = {}  # the vehicle's last message of each kind
        self.flown = []  # time in s, position, velocity
        self.asked = []  # time in s, position or None, velocity or None
        self.longest_lag = 0.0  # between two reports, and until the vehicle has answered, s
        self.beaten = -math.inf
        self.spoken = False  # whether a set-point has gone since the last report
        self.idle()
        self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, 1e6 * INTERVAL)
        # The first report comes at once, the others at the interval: from the second one on, each is answered.
        self.tick()
        self.receive("LOCAL_POSITION_NED", 0.5)
        self.longest_lag = 0.0

    def fail(self, reason: str):
        """Ends the program with one line."""
        raise SystemExit(reason + remedy(max(self.longest_lag, self.lag())))

    def lag(self) -> float:
        """How far the vehicle's time is ahead of what this program has read, s: it goes on with what has come and was not read yet."""
        if not self.flown:
            return 0.0
        known, begun = self.now, time.monotonic()
        while time.monotonic() - begun < 0.05:
            self.receive("LOCAL_POSITION_NED", 0.01)
        return self.now - known - (time.monotonic() - begun)

    def receive(self, kind, timeout: float):
        """The vehicle's next message of a kind, or of one of several; None if there is none within the time. Every message is taken in."""
        kinds = [kind] if isinstance(kind, str) else kind
        end = time.monotonic() + timeout
        while (left := end - time.monotonic()) > 0:
            message = receive(self.connection, timeout=left)
            if message is None or message.get_srcSystem() != self.target[0]:
                continue
            self.latest[message.get_type()] = message
            if self.flown:
                self.longest_lag = max(self.longest_lag, round_trip(message, self.now))
            if message.get_type() == "LOCAL_POSITION_NED":
                at = message.time_boot_ms / 1e3
                if self.flown and at <= self.now:
                    continue  # the same again
                if self.flown:
                    self.longest_lag = max(self.longest_lag, at - self.now)
                self.flown.append((at, (message.x, message.y, message.z), (message.vx, message.vy, message.vz)))
                self.spoken = False
            if message.get_type() in kinds:
                return message
        return None

    def tick(self):
        """Waits for the vehicle's next report of its place. In lock-step the vehicle waits for a set-point first."""
        end = time.monotonic() + SILENCE
        while True:
            if not self.spoken:
                self.send(self.standing)
            if self.receive("LOCAL_POSITION_NED", 1):
                break
            if time.monotonic() > end:
                self.fail("the vehicle has fallen silent")
            self.spoken = False
        if self.now - self.beaten >= 1:
            beat(self.connection, self.now)
            self.beaten = self.now

    @property
    def now(self) -> float:
        """Time of the vehicle, s."""
        return self.flown[-1][0]

    @property
    def position(self):
        return self.flown[-1][1]

    @property
    def velocity(self):
        return self.flown[-1][2]

    @property
    def armed(self) -> bool:
        """As of the last heartbeat; a vehicle that has not been heard may be armed."""
        heartbeat = self.latest.get("HEARTBEAT")
        return heartbeat is None or bool(heartbeat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    def rests_at(self, goal, within: float = 0.05) -> bool:
        return math.dist(self.position, goal) < within and math.hypot(*self.velocity) < within

    def command(self, number: int, *parameters: float):
        parameters = [*parameters, *([0.0] * (7 - len(parameters)))]
        self.latest.pop("STATUSTEXT", None)
        for attempt in range(5):
            self.mav.command_long_send(*self.target, number, attempt, *parameters)
            end = time.monotonic() + 1
            while (left := end - time.monotonic()) > 0:
                ack = self.receive("COMMAND_ACK", left)
                if ack is not None and ack.command == number:
                    if ack.result != mavlink.MAV_RESULT_ACCEPTED:
                        text = self.latest.get("STATUSTEXT") or self.receive("STATUSTEXT", 0.5)
                        self.fail(f"command {number} was refused: {text.text if text else ack.result}")
                    return
        self.fail(f"command {number} was not answered")

    def set_parameter(self, name: str, value: float):
        """Sets a parameter and waits until the vehicle reports its value."""
        for _ in range(5):
            self.mav.param_set_send(*self.target, name.encode(), value, mavlink.MAV_PARAM_TYPE_REAL32)
            end = time.monotonic() + 1
            while (left := end - time.monotonic()) > 0:
                told = self.receive("PARAM_VALUE", left)
                if told is not None and told.param_id == name:
                    return
        self.fail(f"parameter {name} was not set")

    def until(self, condition, seconds: float, what: str, each_tick=lambda: None):
        """Flies until a condition holds, doing something with each report."""
        end = self.now + seconds
        while not condition():
            if self.now > end:
                self.fail(f"{what}: not within {seconds} s; now at north {self.position[0]:.1f}, east {self.position[1]:.1f}, "
                          f"down {self.position[2]:.1f} m")
            each_tick()
            self.tick()

    def stand(self):
        """Waits until the vehicle is known to stand on the ground, where it can be armed."""
        self.until(lambda: getattr(self.latest.get("EXTENDED_SYS_STATE"), "landed_state", None) == mavlink.MAV_LANDED_STATE_ON_GROUND,
                   20, "standing on the ground")

    def take_off(self):
        self.stand()
        self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        self.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, *[math.nan] * 4)
        self.until(lambda: abs(self.position[2] + 2.5) < 0.1 and abs(self.velocity[2]) < 0.1, 20, "takeoff")

    def set_point(self, mask: int, position=(0, 0, 0), velocity=(0, 0, 0), acceleration=(0, 0, 0), yaw: float = 0.0):
        """Sends SET_POSITION_TARGET_LOCAL_NED; m, m/s, m/s², rad. It is repeated until there is another one."""
        self.standing = (mask, *position, *velocity, *acceleration, yaw, 0)
        self.send(self.standing)
        self.asked.append((self.now, None if mask & 7 else position, None if mask & 56 else velocity))

    def send(self, set_point):
        self.mav.set_position_target_local_ned_send(0, *self.target, mavlink.MAV_FRAME_LOCAL_NED, *set_point)
        self.spoken = True

    def idle(self):
        """From now on nothing is asked for but to stay; modes other than offboard ignore it."""
        self.standing = (VELOCITY, *[0.0] * 11)

    def offboard(self):
        """Enters the mode that follows set-points; one must have been sent just before."""
        self.command(mavlink.MAV_CMD_DO_SET_MODE, *OFFBOARD)

    def stream(self, seconds: float, set_point):
        """Calls `set_point` with the time since now, with each report."""
        start = self.now
        while self.now - start < seconds:
            set_point(self.now - start)
            self.tick()

    def go_to(self, goal, seconds: float = 30):
        """To a place, which the vehicle plans its way to by itself."""
        self.set_point(POSITION, goal)
        self.offboard()
        self.until(lambda: self.rests_at(goal), seconds, f"flying to {goal}", lambda: self.set_point(POSITION, goal))

    def upload(self, items, kind: int = mavlink.MAV_MISSION_TYPE_MISSION):
        """Answers the vehicle's requests until it has a plan; items are command, four parameters, north and east of the origin in m, height
        above home."""
        self.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN)
        origin = self.latest.get("GPS_GLOBAL_ORIGIN") or self.receive("GPS_GLOBAL_ORIGIN", 5)
        if origin is None:
            self.fail("the vehicle does not tell its origin")
        self.mav.mission_count_send(*self.target, len(items), kind)
        while True:
            message = self.receive(["MISSION_REQUEST_INT", "MISSION_ACK"], 5)
            if message is None:
                self.fail("the vehicle does not ask for the plan")
            if message.get_type() == "MISSION_ACK":
                if message.type != mavlink.MAV_MISSION_ACCEPTED:
                    self.fail(f"the plan was refused: {mavlink.enums['MAV_MISSION_RESULT'][message.type].name}")
                return
            command, parameters, (north, east), height = items[message.seq]
            # Both zero mean "here".
            placed = (north, east) != (0, 0)
            latitude = origin.latitude + round(math.degrees(north / EARTH) * 1e7)
            longitude = origin.longitude + round(math.degrees(east / EARTH / math.cos(math.radians(origin.latitude / 1e7))) * 1e7)
            self.mav.mission_item_int_send(
                *self.target, message.seq, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, command, 0, 1, *parameters,
                latitude if placed else 0, longitude if placed else 0, height, kind)

    def clear(self, kind: int = mavlink.MAV_MISSION_TYPE_MISSION):
        self.mav.mission_clear_all_send(*self.target, kind)
        if self.receive("MISSION_ACK", 5) is None:
            self.fail("the vehicle does not clear the plan")

    def land(self):
        self.spoken = False
        self.idle()
        self.command(mavlink.MAV_CMD_NAV_LAND)
        self.until(lambda: not self.armed, 60, "landing")

    def most(self, values, what: str) -> float:
        """The largest of some figures of the flight."""
        values = list(values)
        if not values:
            self.fail(f"{what}: the vehicle has not reported it")
        return max(values)

    def verdict(self, what: str, value: float, bound: float, unit: str) -> int:
        return verdict(what, value, bound, unit, remedy(self.longest_lag))

    def since(self, start: float):
        """What has been flown since a time."""
        return [report for report in self.flown if report[0] >= start]

    def plot(self, path: str, title: str, borders=(), places: bool = False):
        """Draws set-points against the flight, and lines of north and east from above; `places` are single ones, which no line joins."""
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        plt.rcParams.update({"axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True})
        figure, axes = plt.subplot_mosaic([["above", "position"], ["side", "velocity"]], figsize=(11, 8),
                                          width_ratios=(2, 3), layout="constrained")
        colours = {"north": "#0072b2", "east": "#d55e00", "up": "#009e73"}
        dashed = {"color": "#333333", "linestyle": (0, (4, 3)), "linewidth": 1}
        crosses = {"color": "#333333", "linestyle": "none", "marker": "x"}
        flown, asked = [(at, up(p), up(v)) for at, p, v in self.flown], [(at, up(p), up(v)) for at, p, v in self.asked]

        for name, across, along in (("above", 1, 0), ("side", 1, 2)):
            axes[name].plot([p[across] for _, p, _ in flown], [p[along] for _, p, _ in flown], color="#0072b2", label="flown")
            points = [p for _, p, _ in asked if p]
            if points:
                mark = crosses if places or len(set(points)) == 1 else dashed
                axes[name].plot([p[across] for p in points], [p[along] for p in points], label="set-point", **mark)
            axes[name].plot(*[[flown[0][1][axis]] for axis in (across, along)], "o", color="#333333", markersize=4)
            axes[name].set(xlabel="east, m", aspect="equal", adjustable="datalim")
        for border in borders:
            axes["above"].plot([east for _, east in border], [north for north, _ in border], color="#cc3311", linewidth=1.2)
        axes["above"].set(ylabel="north, m", title="from above")
        axes["side"].set(ylabel="up, m", title="from the south")
        axes["above"].legend(loc="best")

        for quantity, name, unit in ((1, "position", "m"), (2, "velocity", "m/s")):
            for axis, (direction, colour) in enumerate(colours.items()):
                # Narrower from one to the next: where two are equal, both are seen.
                axes[name].plot([report[0] for report in flown], [report[quantity][axis] for report in flown], color=colour,
                                linewidth=2.7 - 0.7 * axis, label=direction)
                # A gap in time is a gap in the line.
                given = [(a[0], a[quantity][axis]) if a[quantity] else (a[0], math.nan) for a in asked]
                line = crosses if places else dashed
                axes[name].plot(*zip(*given), **line, label="set-point" if axis == 2 else None) if given else None
            axes[name].set(xlabel="time of the vehicle, s", ylabel=f"{name}, {unit}")
        figure.legend(*axes["velocity"].get_legend_handles_labels(), ncols=4, loc="outside lower right")
        figure.suptitle(title)
        figure.savefig(path, dpi=110)
        print(f"wrote {path}")


def up(vector):
    """North, east, up of north, east, down."""
    return None if vector is None else (vector[0], vector[1], -vector[2])


def arguments(description: str, plot: str):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--connect", default="udpin:127.0.0.1:14540", metavar="ADDRESS",
                        help="where the vehicle is, as pymavlink takes it [%(default)s]")
    parser.add_argument("--plot", default=plot, metavar="FILE", help="picture to write [%(default)s]")
    return parser.parse_args()


def verdict(what: str, value: float, bound: float, unit: str, remedy: str = "") -> int:
    """Prints a figure beside its bound, with a remedy if it is missed, and returns the exit code."""
    print(f"{what}: {value:.2f} {unit}, at most {bound:g} {unit}" + ("" if value <= bound else f": MISSED{remedy}"))
    return 0 if value <= bound else 1
