"""A drone program: flies a square with a mission, and comes back. `python survey.py udpin:127.0.0.1:14540` flies a real vehicle, or a
simulated one."""

import math
import os
import sys
import time

os.environ.setdefault("MAVLINK20", "1")

from pymavlink import mavutil  # noqa: E402

mavlink = mavutil.mavlink
#: Degrees of latitude in a metre.
METRE = 1.0 / 111_195.0
#: Patience with an answer, s of the wall clock.
PATIENCE = 10.0


class SurveyError(RuntimeError):
    """The vehicle does not do what it is asked for."""


class Survey:
    """A square of `side` metres at `height` metres above the start."""

    def __init__(self, connection: str, side: float = 20.0, height: float = 10.0):
        self.link = mavutil.mavlink_connection(connection, source_system=245)
        self.side, self.height = side, height
        #: Where the vehicle was, NED from its start, m.
        self.track: list[tuple[float, float, float]] = []
        if self.link.wait_heartbeat(timeout=PATIENCE) is None:
            raise SurveyError(f"no vehicle answers on {connection}")

    def receive(self, *kinds: str):
        """The next message of some kinds."""
        message = self.link.recv_match(type=list(kinds), blocking=True, timeout=PATIENCE)
        if message is None:
            raise SurveyError(f"no {' or '.join(kinds)} within {PATIENCE} s")
        return message

    def command(self, number: int, *parameters: float) -> None:
        """Sends a command, which the vehicle has to accept."""
        values = (*parameters, *[0.0] * (7 - len(parameters)))
        self.link.mav.command_long_send(self.link.target_system, 1, number, 0, *values)
        while (answer := self.receive("COMMAND_ACK")).command != number:
            pass
        if answer.result != mavlink.MAV_RESULT_ACCEPTED:
            raise SurveyError(f"command {number} is refused: {mavlink.enums['MAV_RESULT'][answer.result].name}")

    def items(self):
        """Command, latitude, longitude (degrees times 10⁷) and height of each item."""
        start = self.receive("GLOBAL_POSITION_INT")
        east = METRE / math.cos(math.radians(start.lat / 1e7))
        place = lambda n, e: (round(start.lat + n * METRE * 1e7), round(start.lon + e * east * 1e7))  # noqa: E731
        yield mavlink.MAV_CMD_NAV_TAKEOFF, *place(0, 0), self.height
        for n, e in ((self.side, 0), (self.side, self.side), (0, self.side), (0, 0)):
            yield mavlink.MAV_CMD_NAV_WAYPOINT, *place(n, e), self.height
        yield mavlink.MAV_CMD_NAV_LAND, *place(0, 0), 0.0

    def upload(self) -> None:
        """Gives the mission to the vehicle."""
        items, frame = list(self.items()), mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
        self.link.mav.mission_count_send(self.link.target_system, 1, len(items))
        while (message := self.receive("MISSION_REQUEST_INT", "MISSION_ACK")).get_type() != "MISSION_ACK":
            number, latitude, longitude, height = items[message.seq]
            self.link.mav.mission_item_int_send(
                self.link.target_system, 1, message.seq, frame, number, 0, 1, 0, 1.0, 0, math.nan, latitude, longitude, height
            )  # fmt: skip
        if message.type != mavlink.MAV_MISSION_ACCEPTED:
            raise SurveyError(f"the mission is refused: {mavlink.enums['MAV_MISSION_RESULT'][message.type].name}")

    def fly(self, patience: float = 60.0) -> None:
        """Flies the mission to its end. `patience` is in s of the wall clock."""
        self.upload()
        self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        self.command(mavlink.MAV_CMD_MISSION_START)
        flying, deadline = False, time.monotonic() + patience
        while time.monotonic() < deadline:
            message = self.receive("HEARTBEAT", "LOCAL_POSITION_NED", "STATUSTEXT")
            if message.get_type() == "LOCAL_POSITION_NED":
                self.track.append((message.x, message.y, message.z))
            elif message.get_type() == "STATUSTEXT":
                print(message.text)
            elif message.get_srcComponent() == 1:
                armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
                if flying and not armed:
                    return
                flying = flying or armed
        raise SurveyError(f"the mission has not ended within {patience} s")

    def close(self) -> None:
        """Gives the connection back."""
        self.link.close()


if __name__ == "__main__":
    survey = Survey(sys.argv[1] if len(sys.argv) > 1 else "udpin:127.0.0.1:14540")
    survey.fly()
    north, east, down = survey.track[-1]
    print(f"landed {math.hypot(north, east):.2f} m from the start")
