"""Measures the program: start to first heartbeat and to armable, memory, share of a core, highest speed, and the latency
from a set-point to the motors; prints each row of the README's table as soon as it is measured. It takes four minutes, most of
them hovering at rest between set-points.

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
from contextlib import contextmanager
from pathlib import Path

os.environ.setdefault("MAVLINK20", "1")

#: A change of a rotor's speed that counts, as a share of the fastest: a hovering rotor changes less by itself.
SEEN = 2e-6

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
                data = listener.recv(65536)
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


@contextmanager
def flying(program, *links):
    """The process and a connection to the last of its links."""
    with tempfile.TemporaryDirectory() as folder:
        ready = Path(folder) / "ready"
        options = [option for link in links for option in ("--link", link)]
        process = subprocess.Popen([program, "--ready-file", ready, *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            while not ready.exists():
                if process.poll() is not None:
                    raise SystemExit(f"{program} did not start")
                time.sleep(0.01)
            yield process, connect(json.loads(ready.read_text())["addresses"][-1])
        finally:
            process.terminate()
            process.wait()


def resident(process) -> float:
    """MB."""
    return int(Path(f"/proc/{process.pid}/status").read_text().split("VmRSS:")[1].split()[0]) / 1024


def at_real_time(program, seconds: float):
    """Share of a core, hovering with the default two links and one more; and resident memory in MB after the start, after the
    flight, and after ten more simulated minutes as fast as it goes."""
    with flying(program, "udpout:127.0.0.1:9", "udpout:127.0.0.1:10,onboard", "udpin:0") as (process, connection):
        memory = [resident(process)]
        take_off(connection)

        def used():
            fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
            return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

        before, begin = used(), time.monotonic()
        while time.monotonic() - begin < seconds:
            connection.recv_match(blocking=True, timeout=1)  # an answer is not to drown in what is unread
        share = (used() - before) / (time.monotonic() - begin)
        command(connection, mavlink.MAV_CMD_NAV_LAND)
        wait(connection, "HEARTBEAT", lambda beat: not beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
        memory.append(resident(process))
        end = wait(connection, "LOCAL_POSITION_NED").time_boot_ms + 600_000
        connection.mav.param_set_send(1, 1, b"SIM_SPEEDUP", 1000, mavlink.MAV_PARAM_TYPE_REAL32)
        wait(connection, "LOCAL_POSITION_NED", lambda place: place.time_boot_ms >= end)
        memory.append(resident(process))
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


def wait(connection, kind: str, condition=lambda message: True, seconds: float = 60):
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        message = connection.recv_match(type=kind, blocking=True, timeout=left)
        if message is not None and condition(message):
            return message
    raise TimeoutError(f"no matching {kind} within {seconds} s")


def take_off(connection):
    command(connection, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    command(connection, mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, *[math.nan] * 4)
    wait(connection, "LOCAL_POSITION_NED", lambda place: abs(place.z + 2.5) < 0.05 and abs(place.vz) < 0.02)


def round_trips(program, count: int):
    """ms of the wall clock from sending a PING to its answer: what transport costs, there and back."""
    found = []
    with flying(program, "udpin:0,onboard") as (_, connection):
        for number in range(count):
            time.sleep(0.0037)
            begin = time.perf_counter()
            connection.mav.ping_send(0, number, 0, 0)
            wait(connection, "PING", lambda ping: ping.seq == number and ping.target_system)
            found.append((time.perf_counter() - begin) * 1e3)
    return found


def thrust_latencies(program, count: int):
    """ms of the wall clock from sending another thrust to changed motors, on the ground."""
    with flying(program, "udpin:0,onboard") as (_, connection):
        connection.mav.param_set_send(1, 1, b"COM_DISARM_PRFLT", -1, mavlink.MAV_PARAM_TYPE_REAL32)  # stays armed though it never takes off
        wait(connection, "PARAM_VALUE", lambda told: told.param_id == "COM_DISARM_PRFLT" and told.param_value == -1)
        send_thrust(connection.mav, 0)
        command(connection, mavlink.MAV_CMD_DO_SET_MODE, 1, 6)
        command(connection, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        return latencies(connection, count, 0.4, 0.0007, send_thrust)


def position_latencies(program, count: int):
    """ms of the wall clock from sending another height to changed motors, hovering."""
    with flying(program, "udpin:0,onboard") as (_, connection):
        take_off(connection)
        send_height(connection.mav, 0)
        command(connection, mavlink.MAV_CMD_DO_SET_MODE, 1, 6)
        return latencies(connection, count, 3, 0.0037, send_height)


def latencies(connection, count: int, rest: float, spread: float, send):
    """ms from sending the other one of two set-points to the first ACTUATOR_OUTPUT_STATUS, sent every millisecond, whose first rotor
    differs from the one at rest. The times of sending are spread over the samples of the controller."""
    told = "ACTUATOR_OUTPUT_STATUS"
    command(connection, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ACTUATOR_OUTPUT_STATUS, 1000)
    found = []
    for number in range(count):
        end = time.monotonic() + rest + spread * (number % 15)
        while (left := end - time.monotonic()) > 0:
            send(connection.mav, number % 2)
            time.sleep(min(0.05, left))
            while connection.recv_match(blocking=False) is not None:
                pass
        settled = wait(connection, told, seconds=1).actuator[0]
        begin = time.perf_counter()
        send(connection.mav, (number + 1) % 2)
        wait(connection, told, lambda rotors: abs(rotors.actuator[0] - settled) >= SEEN, seconds=1)
        found.append((time.perf_counter() - begin) * 1e3)
    return found


def send_thrust(mav, which: int):
    """Level, too weak to lift off: only the motors change."""
    mav.set_attitude_target_send(0, 1, 1, 0b111, [1, 0, 0, 0], 0, 0, 0, (0.1, 0.2)[which])


def send_height(mav, which: int):
    """A place and a heading."""
    mav.set_position_target_local_ned_send(0, 1, 1, mavlink.MAV_FRAME_LOCAL_NED, 0b100111111000, 0, 0, (-2.5, -3.0)[which],
                                           0, 0, 0, 0, 0, 0, 0, 0)


def percentiles(values) -> str:
    values = sorted(values)
    return f"p50 {values[len(values) // 2]:.1f} ms, p99 {values[int(len(values) * 0.99)]:.1f} ms"


def rows(program):
    """One after the other, each as soon as it is measured."""
    beats, armable = starts(program, 20)
    yield "start of the process to the first heartbeat", f"{statistics.median(beats):.1f} ms, worst of 20 {max(beats):.1f} ms"
    yield 'start to "armable" in SYS_STATUS', f"{statistics.median(armable):.1f} ms, worst of 20 {max(armable):.1f} ms"
    yield "size of the program", f"{os.path.getsize(program) / 2**20:.1f} MB"
    share, memory = at_real_time(program, 10)
    yield "resident memory after the start, a flight, ten more minutes", ", ".join(f"{each:.1f}" for each in memory) + " MB"
    yield "share of one core at real time, hovering, three links", f"{100 * share:.1f} %"
    quiet = highest_speed(program, ["--link", "tcpin:0"])
    loud = highest_speed(program, ["--link", "udpout:127.0.0.1:9", "--link", "udpout:127.0.0.1:10,onboard"])
    yield "highest speed, no client; ground-station and onboard link", f"{quiet:.0f}; {loud:.0f} times real time"
    yield "PING to its answer: transport there and back", percentiles(round_trips(program, 200))
    yield "thrust set-point to changed motors, sampled every 10 ms", percentiles(thrust_latencies(program, 60))
    yield "position set-point to changed motors, sampled every 50 ms", percentiles(position_latencies(program, 45))


def main():
    for row in rows(sys.argv[1]):
        print("| {} | {} |".format(*row), flush=True)


if __name__ == "__main__":
    main()
