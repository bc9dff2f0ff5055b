"""One flight three times: by pymavlink through the program, through the FMU in FMPy, and through the library.

The program's record tells at which simulation time each set-point took effect; the FMU and the library get the same ones at the same
times. FMU and library agree bit for bit; telemetry is theirs in the precision of MAVLink, bit for bit after rounding to 32 bits.
"""

import json
import math
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import records
from client import PX4_OFFBOARD, mavlink

ROOT = Path(__file__).resolve().parents[3]
OUTPUTS = [f"{kind}.{axis}" for kind, axes in (
    ("position", "xyz"), ("velocity", "xyz"), ("attitude", ("phi", "theta", "psi")), ("body_rate", "pqr")) for axis in axes]
#: How each message tells the motion: where in OUTPUTS, and its fields.
TELEMETRY = {
    "LOCAL_POSITION_NED": (slice(0, 6), ("x", "y", "z", "vx", "vy", "vz")),
    "ATTITUDE": (slice(6, 12), ("roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed")),
}
END_S = 14.0
PLACE = 0b1001_1111_1000
TRAJECTORY = 0b1000_0000_0000


def places(time: float) -> dict:
    """Steps from place to place, with turns."""
    goals = ((0, (0, 0, -3), 0.0), (5, (4.3, 2.1, -5.2), 0.7), (9.5, (-1.1, 3.0, -2.4), -0.6))
    _, position, yaw = max(goal for goal in goals if goal[0] <= time)
    return {"mask": PLACE, "position": position, "yaw": yaw}


def helix(time: float) -> dict:
    """A circle that begins slowly and rises, told with velocity and acceleration."""
    t, radius, rate, slow, height = time + 1.0, 2.0, 0.8, 2.0, 6.0
    decay = math.exp(-t / slow)
    angle, speed, change = rate * (t - slow * (1 - decay)), rate * (1 - decay), rate / slow * decay
    c, s = math.cos(angle), math.sin(angle)
    return {
        "mask": TRAJECTORY | 1 << 10,
        "position": (radius * s, radius * (1 - c), -height * (1 - (1 + t / slow) * decay)),
        "velocity": (radius * speed * c, radius * speed * s, -height * t / slow**2 * decay),
        "acceleration": (radius * (change * c - speed**2 * s), radius * (change * s + speed**2 * c),
                         -height / slow**2 * (1 - t / slow) * decay),
    }


def fly_by_pymavlink(start, connect, record: Path, trajectory) -> dict:
    """Telemetry by kind and time, µs."""
    vehicle = start("--speed", "0", "--record", str(record), "--set", "COM_OF_LOSS_T=60", "--duration", str(END_S))
    client = connect(vehicle)

    def send(time: float) -> None:
        target = trajectory(time)
        client.position(target["position"], target["mask"], velocity=target.get("velocity", (0, 0, 0)),
                        acceleration=target.get("acceleration", (0, 0, 0)), yaw=target.get("yaw", 0.0))

    # All of it before simulation time moves.
    send(0.0)
    client.arm()
    client.set_mode(PX4_OFFBOARD)
    client.mav.param_set_send(1, 1, b"SIM_SPEEDUP", 5.0, mavlink.MAV_PARAM_TYPE_REAL32)
    heard = {kind: {} for kind in TELEMETRY}
    sent = 0.0
    while (message := client.connection.recv_match(type=list(TELEMETRY), blocking=True, timeout=1.0)) is not None:
        time_us = message.time_boot_ms * 1000
        heard[message.get_type()][time_us] = [getattr(message, field) for field in TELEMETRY[message.get_type()][1]]
        if time_us / 1e6 - sent > 0.15:
            sent = time_us / 1e6
            send(sent)
    assert vehicle.process.wait(10) == 0
    return heard


def recorded_set_points(record: Path) -> list[dict]:
    parser = mavlink.MAVLink(None)
    set_points = []
    for line in records.entries(record):
        if not line.startswith("frame "):
            continue
        _, time_us, *_, content = line.split(" ")
        for message in parser.parse_buffer(bytearray.fromhex(content)) or []:
            if message.get_type() == "SET_POSITION_TARGET_LOCAL_NED":
                moves = message.type_mask & 0b111000 == 0
                set_points.append({
                    "time_us": int(time_us),
                    "position": [message.x, message.y, message.z],
                    "velocity": [message.vx, message.vy, message.vz] if moves else [0.0] * 3,
                    "acceleration": [message.afx, message.afy, message.afz] if moves else [0.0] * 3,
                    "yaw": message.yaw,
                })
    return set_points


def fly_the_library(shaping: bool, set_points: list[dict], times_us: list[int]) -> np.ndarray:
    folder = Path(os.environ.get("LMPC_QUADROTOR_EXAMPLES", ROOT / "target" / "debug" / "examples"))
    program = folder / "fly_set_points"
    assert program.exists(), f"{program} does not exist: run `cargo test -p quadrotor` first"
    flight = {"shaping": shaping, "set_points": set_points, "samples_us": times_us}
    answer = subprocess.run([program], input=json.dumps(flight), capture_output=True, text=True, check=True, timeout=60)
    return np.array([json.loads(line) for line in answer.stdout.splitlines()])


def fly_the_fmu(slave, shaping: bool, set_points: list[dict], times_us: list[int]) -> np.ndarray:
    instance = slave({"environment.ground_plane": True, "reference.shaping": shaping, "armed": False})
    instance.set({"armed": True})
    samples = set(times_us)
    # Controllers look at their reference every 10 ms.
    stops = sorted(samples | {p["time_us"] for p in set_points} | set(range(0, times_us[-1] + 1, 10_000)))
    motion, latest = [], -1
    for now, then in zip(stops, stops[1:]):
        while latest + 1 < len(set_points) and set_points[latest + 1]["time_us"] <= now:
            latest += 1
        point = set_points[latest]
        t = (now - point["time_us"]) / 1e6
        values = {"reference.yaw": point["yaw"]}
        for axis, p, v, a in zip("xyz", point["position"], point["velocity"], point["acceleration"]):
            values[f"reference.position.{axis}"] = p + (v + a / 2.0 * t) * t
            values[f"reference.velocity.{axis}"] = v + a * t
            values[f"reference.acceleration.{axis}"] = a
        instance.set(values)
        instance.fmu.doStep(currentCommunicationPoint=now / 1e6, communicationStepSize=(then - now) / 1e6)
        if then in samples:
            motion.append(instance.get(*OUTPUTS))
    return np.array(motion)


@pytest.mark.parametrize(("trajectory", "shaping"), [(places, True), (helix, False)], ids=("places", "trajectory"))
def test_the_flight_by_pymavlink_is_that_of_the_fmu_and_of_the_library(start, connect, slave, tmp_path, trajectory, shaping):
    record = tmp_path / "flight.record"
    heard = fly_by_pymavlink(start, connect, record, trajectory)
    set_points = recorded_set_points(record)
    assert set_points[0]["time_us"] == 0 and len(set_points) > 15, set_points
    times_us = sorted(set().union(*heard.values()) - {0})
    assert len(times_us) > 150 and times_us[-1] > (END_S - 0.5) * 1e6, times_us[-3:]

    library = fly_the_library(shaping, set_points, times_us)
    fmu = fly_the_fmu(slave, shaping, set_points, times_us)
    assert np.array_equal(library, fmu), np.abs(library - fmu).max(axis=0)
    # It was a flight.
    assert np.ptp(library[:, :3], axis=0).min() > 2.0
    for kind, (columns, _) in TELEMETRY.items():
        rows = [index for index, time_us in enumerate(times_us) if time_us in heard[kind]]
        told = np.array([heard[kind][times_us[row]] for row in rows])
        assert np.array_equal(library[rows, columns].astype(np.float32), told.astype(np.float32)), (
            kind, np.abs(library[rows, columns] - told).max(axis=0))
