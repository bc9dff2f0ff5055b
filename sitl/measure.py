"""Measures the program: start to first heartbeat and to armable, memory, share of a core, highest speed, and the latency
from a set-point to the motors.

    cargo build --release -p sitl
    python sitl/measure.py target/release/lmpc-sitl
"""

import json
import math
import os
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("MAVLINK20", "1")

from pymavlink import mavutil  # noqa: E402
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402


def parser():
    mav = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
    mav.robust_parsing = True
    return mav


def listening():
    """A socket that the vehicle sends to, as a ground station has it."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.bind(("127.0.0.1", 0))
    listener.settimeout(10)
    return listener


def starts(program, times: int):
    """ms from the start of the process to the first heartbeat, and to SYS_STATUS that says "armable"."""
    beats, armable = [], []
    for _ in range(times):
        with listening() as listener:
            mav = parser()
            begin = time.perf_counter()
            process = subprocess.Popen([program, "--link", f"udpout:127.0.0.1:{listener.getsockname()[1]}"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            seen = {}
            while len(seen) < 2:
                data = listener.recv(1000)
                now = (time.perf_counter() - begin) * 1e3
                for message in mav.parse_buffer(data) or []:
                    if message.get_type() == "HEARTBEAT":
                        seen.setdefault("beat", now)
                    if (message.get_type() == "SYS_STATUS"
                            and message.onboard_control_sensors_health & mavlink.MAV_SYS_STATUS_PREARM_CHECK):
                        seen.setdefault("armable", now)
            beats.append(seen["beat"])
            armable.append(seen["armable"])
            process.terminate()
            process.wait()
    return beats, armable


def at_real_time(program, seconds: float):
    """Share of a core and resident memory, MB, with the default two links, hovering."""
    with tempfile.TemporaryDirectory() as folder:
        ready = Path(folder) / "ready"
        links = [option for link in ("udpout:127.0.0.1:9", "udpout:127.0.0.1:10,onboard", "udpin:0") for option in ("--link", link)]
        process = subprocess.Popen([program, "--ready-file", ready, *links], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not ready.exists():
            time.sleep(0.01)
        connection = connect(json.loads(ready.read_text())["addresses"][2])
        command(connection, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        command(connection, mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, *[math.nan] * 4)
        time.sleep(3)

        def used():
            fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
            return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

        before = used()
        time.sleep(seconds)
        share = (used() - before) / seconds
        status = Path(f"/proc/{process.pid}/status").read_text()
        memory = int(status.split("VmRSS:")[1].split()[0]) / 1024
        process.terminate()
        process.wait()
    return share, memory


def highest_speed(program, links):
    result = subprocess.run([program, "--speed", "max", "--duration", "300", *links], capture_output=True, text=True)
    return float(result.stdout.split("(")[-1].split()[0])


def connect(address: str):
    connection = mavutil.mavlink_connection(f"udpout:{address}", dialect="common")
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    connection.wait_heartbeat()
    return connection


def command(connection, number, *parameters):
    parameters = [*parameters, *([0.0] * (7 - len(parameters)))]
    connection.mav.command_long_send(1, 1, number, 0, *parameters)
    ack = connection.recv_match(type="COMMAND_ACK", blocking=True, timeout=5)
    assert ack.result == 0, ack


def latencies(program, count: int):
    """ms of the wall clock from sending a thrust to the first SERVO_OUTPUT_RAW that differs."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        ready = Path(folder) / "ready"
        process = subprocess.Popen([program, "--ready-file", ready, "--link", "udpin:0,onboard"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not ready.exists():
            time.sleep(0.01)
        connection = connect(json.loads(ready.read_text())["addresses"][0])
        send = lambda thrust: connection.mav.set_attitude_target_send(0, 1, 1, 0b111, [1, 0, 0, 0], 0, 0, 0, thrust)  # noqa: E731
        command(connection, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_SERVO_OUTPUT_RAW, 1000)
        send(0.05)
        command(connection, mavlink.MAV_CMD_DO_SET_MODE, 1, 6)
        command(connection, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        # On the ground, too weak to lift off: only the motors change.
        for number in range(count):
            for _ in range(8):
                send(0.1 + 0.1 * (number % 2))
                time.sleep(0.05)
            time.sleep(0.0007 * (number % 15))
            while connection.recv_match(blocking=False) is not None:
                pass
            settled = connection.recv_match(type="SERVO_OUTPUT_RAW", blocking=True, timeout=1).servo1_raw
            begin = time.perf_counter()
            send(0.1 + 0.1 * ((number + 1) % 2))
            while abs(connection.recv_match(type="SERVO_OUTPUT_RAW", blocking=True, timeout=1).servo1_raw - settled) < 2:
                pass
            found.append((time.perf_counter() - begin) * 1e3)
        process.terminate()
        process.wait()
    return found


def main():
    program = sys.argv[1]
    beats, armable = starts(program, 20)
    share, memory = at_real_time(program, 20)
    latency = sorted(latencies(program, 100))
    quiet = highest_speed(program, ["--link", "tcpin:0"])
    loud = highest_speed(program, ["--link", "udpout:127.0.0.1:9", "--link", "udpout:127.0.0.1:10,onboard"])
    print(f"start to first heartbeat      median {statistics.median(beats):6.1f} ms   worst {max(beats):6.1f} ms")
    print(f"start to armable (SYS_STATUS) median {statistics.median(armable):6.1f} ms   worst {max(armable):6.1f} ms")
    print(f"resident memory               {memory:.1f} MB")
    print(f"share of a core at real time  {100 * share:.1f} %")
    print(f"highest speed                 {quiet:.0f} times real time without a client, {loud:.0f} with two UDP links")
    print(f"set-point to motor telemetry  p50 {latency[len(latency) // 2]:.1f} ms   p99 {latency[int(len(latency) * 0.99)]:.1f} ms")


if __name__ == "__main__":
    main()
