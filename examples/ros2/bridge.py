"""Connects ROS 2 and a vehicle that speaks MAVLink, without MAVROS.

    lmpc-sitl                       (or: cargo run --release -p sitl)
    python examples/ros2/bridge.py  (in a terminal with ROS 2)

It needs rclpy, geometry_msgs and std_srvs of ROS 2, and `pip install pymavlink`. Topics have MAVROS's names, and ROS's frames: x east,
y north, z up in the world (ENU), x forward, y left, z up in the vehicle (FLU).

    /mavros/local_position/pose               geometry_msgs/PoseStamped    from the vehicle
    /mavros/local_position/velocity_local     geometry_msgs/TwistStamped   from the vehicle
    /mavros/setpoint_position/local           geometry_msgs/PoseStamped    to the vehicle, at least once a second
    /vehicle/arm                              std_srvs/SetBool
    /vehicle/offboard, /vehicle/land          std_srvs/Trigger
"""

import argparse
import math
import os
import time

os.environ.setdefault("MAVLINK20", "1")

import rclpy  # noqa: E402
from geometry_msgs.msg import PoseStamped, TwistStamped  # noqa: E402
from pymavlink import mavutil  # noqa: E402
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rclpy.signals import SignalHandlerOptions  # noqa: E402
from std_srvs.srv import SetBool, Trigger  # noqa: E402

POSITION_AND_YAW = 0b100111111000  # what a set-point gives; velocity, acceleration and yaw rate are ignored
OFFBOARD, LAND = (6, 0), (4, 6)  # PX4's main and sub mode
PATIENCE = 3.0  # s, for the answer to a command
# Rotations as quaternions, scalar first: from NED to ENU, and from FLU to FRD.
ENU_FROM_NED = (0.0, math.sqrt(0.5), math.sqrt(0.5), 0.0)
FRD_FROM_FLU = (0.0, 1.0, 0.0, 0.0)


def product(a, b):
    """The rotation b followed by a."""
    w, x, y, z = a
    v, i, j, k = b
    return (w * v - x * i - y * j - z * k, w * i + x * v + y * k - z * j, w * j - x * k + y * v + z * i, w * k + x * j - y * i + z * v)


def positive(quaternion):
    """The same rotation with a scalar part that is not negative."""
    return tuple(-part for part in quaternion) if quaternion[0] < 0 else quaternion


def enu(north, east, down):
    """North, east, down as east, north, up."""
    return {"x": east, "y": north, "z": -down}


def heading(quaternion) -> float:
    """The heading from north through east, rad, of an attitude in ENU."""
    w, x, y, z = quaternion.w, quaternion.x, quaternion.y, quaternion.z
    return math.pi / 2 - math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


class Bridge(Node):
    def __init__(self, address: str):
        super().__init__("lmpc_bridge")
        self.link = mavutil.mavlink_connection(address, source_system=1, source_component=mavlink.MAV_COMP_ID_ONBOARD_COMPUTER)
        self.attitude = None
        self.answers = {}
        self.pose = self.create_publisher(PoseStamped, "/mavros/local_position/pose", 10)
        self.velocity = self.create_publisher(TwistStamped, "/mavros/local_position/velocity_local", 10)
        self.create_subscription(PoseStamped, "/mavros/setpoint_position/local", self.set_point, 10)
        self.create_service(SetBool, "/vehicle/arm", self.arm)
        self.create_service(Trigger, "/vehicle/offboard", lambda _, answer: self.change_mode(OFFBOARD, answer))
        self.create_service(Trigger, "/vehicle/land", lambda _, answer: self.change_mode(LAND, answer))
        self.create_timer(0.005, self.read)
        self.create_timer(1.0, self.beat)

    def beat(self):
        self.link.mav.heartbeat_send(mavlink.MAV_TYPE_ONBOARD_CONTROLLER, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, mavlink.MAV_STATE_ACTIVE)

    def read(self):
        """Takes in what has come."""
        while (message := self.link.recv_match()) is not None:
            kind = message.get_type()
            if kind == "ATTITUDE_QUATERNION":
                body = message.q1, message.q2, message.q3, message.q4
                self.attitude = positive(product(ENU_FROM_NED, product(body, FRD_FROM_FLU)))
            elif kind == "LOCAL_POSITION_NED" and self.attitude is not None:
                self.publish(message)
            elif kind == "COMMAND_ACK":
                self.answers[message.command] = message.result

    def publish(self, at):
        pose, twist = PoseStamped(), TwistStamped()
        for stamped in (pose, twist):
            stamped.header.stamp = self.get_clock().now().to_msg()
            stamped.header.frame_id = "map"
        for name, value in enu(at.x, at.y, at.z).items():
            setattr(pose.pose.position, name, value)
        for name, value in zip("wxyz", self.attitude):
            setattr(pose.pose.orientation, name, value)
        for name, value in enu(at.vx, at.vy, at.vz).items():
            setattr(twist.twist.linear, name, value)
        self.pose.publish(pose)
        self.velocity.publish(twist)

    def set_point(self, wanted: PoseStamped):
        place, yaw = wanted.pose.position, heading(wanted.pose.orientation)
        self.link.mav.set_position_target_local_ned_send(
            0, 1, 1, mavlink.MAV_FRAME_LOCAL_NED, POSITION_AND_YAW, place.y, place.x, -place.z, 0, 0, 0, 0, 0, 0, yaw, 0)

    def arm(self, wanted: SetBool.Request, answer):
        return self.command(answer, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, float(wanted.data))

    def change_mode(self, mode, answer):
        return self.command(answer, mavlink.MAV_CMD_DO_SET_MODE, mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, *mode)

    def command(self, answer, number: int, *values):
        """Sends a command and waits for the vehicle's answer."""
        self.answers.pop(number, None)
        self.link.mav.command_long_send(1, 1, number, 0, *values, *[0] * (7 - len(values)))
        end = time.monotonic() + PATIENCE
        while number not in self.answers and (left := end - time.monotonic()) > 0:
            self.link.select(left)
            self.read()
        result = self.answers.get(number)
        answer.success = result == mavlink.MAV_RESULT_ACCEPTED
        answer.message = f"no answer within {PATIENCE:.0f} s: check --connect" if result is None else mavlink.enums["MAV_RESULT"][result].name
        return answer


def main():
    parser = argparse.ArgumentParser(description="Connects ROS 2 and a vehicle that speaks MAVLink.")
    parser.add_argument("--connect", default="udpin:127.0.0.1:14540", help="pymavlink connection string (default: %(default)s)")
    options = parser.parse_args()
    # Ctrl-C is Python's: rclpy's own handler would end the node while it publishes.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        rclpy.spin(Bridge(options.connect))
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
