"""Loses the front rotor in flight, and watches the vehicle come down without yaw control."""

import math
import sys

from flight import Flight, arguments
from pymavlink.dialects.v20 import common as mavlink

START = (0.0, 0.0, -20.0)
ROTOR = 1

options = arguments(__doc__, "failure.png")
flight = Flight(options.connect)
flight.set_parameter("SYS_FAILURE_EN", 1)
flight.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ATTITUDE, 20_000)
flight.take_off()
flight.go_to(START)

broken_at = flight.now
flight.command(mavlink.MAV_CMD_INJECT_FAILURE, mavlink.FAILURE_UNIT_SYSTEM_MOTOR, mavlink.FAILURE_TYPE_OFF, ROTOR)
tilts, spins, sinks, drifts = [], [], [], []


def watch():
    attitude = flight.latest.get("ATTITUDE")
    if attitude is not None and flight.position[2] < -0.3:
        tilts.append(math.degrees(math.acos(math.cos(attitude.roll) * math.cos(attitude.pitch))))
        spins.append(abs(attitude.yawspeed))
        sinks.append(flight.velocity[2])
        drifts.append(math.dist(flight.position[:2], START[:2]))


flight.idle()
flight.until(lambda: not flight.armed, 60, "coming down", watch)
largest_tilt = flight.most(tilts, "coming down")
print(f"down in {flight.now - broken_at:.1f} s, {drifts[-1]:.1f} m away, spinning with {spins[-1]:.1f} rad/s")
missed = flight.verdict("largest tilt", largest_tilt, 40, "degrees")
missed |= flight.verdict("sink rate at touch-down", sinks[-1], 1, "m/s")
missed |= flight.verdict("largest drift", max(drifts), 30, "m")
flight.command(mavlink.MAV_CMD_INJECT_FAILURE, mavlink.FAILURE_UNIT_SYSTEM_MOTOR, mavlink.FAILURE_TYPE_OK, ROTOR)
flight.plot(options.plot, f"without rotor {ROTOR}")
sys.exit(missed)
