"""A ROS 2 program that flies to 5 m east, 3 m north, 4 m up with the nose to the east, and lands. It needs `bridge.py` to run."""

import math
import sys
import time

import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

GOAL = (5.0, 3.0, 4.0)  # ENU, m
PATIENCE = 60.0  # s, for each step of the flight


class Pilot(Node):
    def __init__(self):
        super().__init__("pilot")
        self.at = None
        self.wanted = PoseStamped()
        self.wanted.header.frame_id = "map"
        position = self.wanted.pose.position
        position.x, position.y, position.z = GOAL
        self.wanted.pose.orientation.w = 1.0  # the nose to the east
        self.set_points = self.create_publisher(PoseStamped, "/mavros/setpoint_position/local", 10)
        self.create_subscription(PoseStamped, "/mavros/local_position/pose", self.hear, 10)
        self.create_timer(0.05, lambda: self.set_points.publish(self.wanted))

    def hear(self, pose: PoseStamped):
        self.at = pose.pose

    def until(self, what: str, condition):
        """Runs until a condition holds."""
        end = time.monotonic() + PATIENCE
        while not condition():
            rclpy.spin_once(self, timeout_sec=0.1)
            if time.monotonic() > end:
                raise SystemExit(f"waited {PATIENCE:.0f} s in vain until {what}; check that the bridge and the vehicle run")

    def call(self, kind, name: str, request):
        """Asks for something until it is accepted: Offboard is refused, for example, until the vehicle has set-points."""
        client = self.create_client(kind, name)
        self.until(f"{name} is there", client.service_is_ready)
        end = time.monotonic() + PATIENCE
        while True:
            answer = client.call_async(request)
            self.until(f"{name} answers", answer.done)
            if answer.result().success:
                return
            if time.monotonic() > end:
                raise SystemExit(f"{name}: {answer.result().message}")
            rclpy.spin_once(self, timeout_sec=0.1)

    def is_there(self) -> bool:
        """Whether it is at the goal, to 5 cm, with the nose to the east, to 0.02 rad."""
        place, nose = self.at.position, self.at.orientation
        return math.dist((place.x, place.y, place.z), GOAL) < 0.05 and abs(nose.z) < 0.01


def main():
    rclpy.init()
    pilot = Pilot()
    pilot.until("a pose arrives", lambda: pilot.at is not None and pilot.set_points.get_subscription_count() > 0)
    pilot.call(Trigger, "/vehicle/offboard", Trigger.Request())
    pilot.call(SetBool, "/vehicle/arm", SetBool.Request(data=True))
    pilot.until("the vehicle arrives", pilot.is_there)
    print("arrived")
    pilot.call(Trigger, "/vehicle/land", Trigger.Request())
    pilot.until("the vehicle lands", lambda: pilot.at.position.z < 0.05)
    print("landed")


if __name__ == "__main__":
    sys.exit(main())
