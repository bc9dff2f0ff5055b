"""What the examples share: connecting, arming, taking off, streaming set-points, landing, and a plot of it all.

Each example flies a vehicle that is already running, `lmpc-sitl` or another one that follows PX4's conventions:

    cargo run --release -p sitl &
    python examples/position_target.py --plot position.png
"""

import argparse
import math
import os
import time

os.environ.setdefault("MAVLINK20", "1")

from pymavlink import mavutil  # noqa: E402
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

POSITION = 0b100111111000  # position and yaw
VELOCITY = 0b100111000111  # velocity and yaw
TRAJECTORY = 0b100000000000  # position, velocity, acceleration and yaw


class Flight:
    def __init__(self, address: str):
        self.connection = mavutil.mavlink_connection(address, dialect="common")
        self.mav = self.connection.mav
        if address.startswith(("udpout", "tcp")):
            self.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        if self.connection.wait_heartbeat(timeout=10) is None:
            raise SystemExit(f"no vehicle at {address}")
        self.target = (self.connection.target_system, self.connection.target_component)
        self.flown = []  # time in s, position, velocity
        self.asked = []  # time in s, position or None, velocity or None

    def read(self, seconds: float = 0.0):
        """Takes in what has come, and what comes within a while."""
        end = time.monotonic() + seconds
        while True:
            left = end - time.monotonic()
            message = self.connection.recv_match(blocking=left > 0, timeout=max(left, 0))
            if message is None and left <= 0:
                return
            if message is not None and message.get_type() == "LOCAL_POSITION_NED":
                self.flown.append((message.time_boot_ms / 1e3, (message.x, message.y, message.z),
                                   (message.vx, message.vy, message.vz)))

    @property
    def now(self) -> float:
        """Time of the vehicle, s."""
        return self.flown[-1][0] if self.flown else 0.0

    @property
    def position(self):
        return self.flown[-1][1]

    def command(self, number: int, *parameters: float):
        parameters = [*parameters, *([0.0] * (7 - len(parameters)))]
        for attempt in range(5):
            self.mav.command_long_send(*self.target, number, attempt, *parameters)
            end = time.monotonic() + 1
            while time.monotonic() < end:
                ack = self.connection.recv_match(type="COMMAND_ACK", blocking=True, timeout=0.2)
                if ack is not None and ack.command == number:
                    if ack.result != mavlink.MAV_RESULT_ACCEPTED:
                        text = self.connection.messages.get("STATUSTEXT")
                        raise SystemExit(f"command {number} was refused: {text.text if text else ack.result}")
                    return
        raise SystemExit(f"command {number} was not answered")

    def take_off(self):
        self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, 20_000)
        self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        self.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, *[math.nan] * 4)
        self.until(lambda: abs(self.position[2] + 2.5) < 0.1, 20, "takeoff")

    def until(self, condition, seconds: float, what: str):
        end = time.monotonic() + seconds
        while not (self.flown and condition()):
            if time.monotonic() > end:
                raise SystemExit(f"{what}: not within {seconds} s")
            self.read(0.02)

    def set_point(self, mask: int, position=(0, 0, 0), velocity=(0, 0, 0), acceleration=(0, 0, 0), yaw: float = 0.0):
        """Sends SET_POSITION_TARGET_LOCAL_NED; NED, m, m/s, m/s², rad."""
        self.mav.set_position_target_local_ned_send(
            0, *self.target, mavlink.MAV_FRAME_LOCAL_NED, mask, *position, *velocity, *acceleration, yaw, 0)
        self.asked.append((self.now, None if mask & 7 else position, None if mask & 56 else velocity))

    def offboard(self):
        """Enters the offboard mode; a set-point must have been sent just before."""
        self.command(mavlink.MAV_CMD_DO_SET_MODE, 1, 6)

    def land(self):
        self.command(mavlink.MAV_CMD_NAV_LAND)
        armed = lambda: self.connection.messages["HEARTBEAT"].base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED  # noqa: E731
        self.until(lambda: not armed(), 60, "landing")

    def plot(self, path: str, title: str):
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(1, 3, figsize=(14, 4.2), layout="constrained")
        times = [time for time, _, _ in self.flown]
        for index, name in enumerate(("north", "east", "down")):
            line, = axes[0].plot(times, [position[index] for _, position, _ in self.flown], label=name)
            axes[0].plot([time for time, position, _ in self.asked if position],
                         [position[index] for _, position, _ in self.asked if position],
                         "--", color=line.get_color(), linewidth=1)
            line, = axes[1].plot(times, [velocity[index] for _, _, velocity in self.flown], label=name)
            axes[1].plot([time for time, _, velocity in self.asked if velocity],
                         [velocity[index] for _, _, velocity in self.asked if velocity],
                         "--", color=line.get_color(), linewidth=1)
        axes[0].set(xlabel="time, s", ylabel="position, m", title="flown, and asked (dashed)")
        axes[1].set(xlabel="time, s", ylabel="velocity, m/s", title="flown, and asked (dashed)")
        axes[0].legend()
        axes[1].legend()
        axes[2].plot([position[1] for _, position, _ in self.flown], [position[0] for _, position, _ in self.flown])
        axes[2].plot([position[1] for _, position, _ in self.asked if position],
                     [position[0] for _, position, _ in self.asked if position], "--", linewidth=1)
        axes[2].set(xlabel="east, m", ylabel="north, m", aspect="equal", title="from above")
        figure.suptitle(title)
        figure.savefig(path, dpi=120)
        print(f"wrote {path}")


def arguments(description: str, plot: str):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--connect", default="udpin:127.0.0.1:14540", help="as mavutil takes it [%(default)s]")
    parser.add_argument("--plot", default=plot, help="picture to write [%(default)s]")
    return parser.parse_args()
