"""In lock-step the vehicle waits for its client, and the same program flies the same flight at every speed."""

import re
import subprocess
import time

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import PX4_OFFBOARD

PERIOD = 0.02
GOAL = (1.0, 2.0, -3.0)


def step(client):
    """One set-point, and the report that answers it."""
    client.position(GOAL)
    return client.wait("LOCAL_POSITION_NED", timeout=5)


def now(client) -> float:
    """Simulation time, s."""
    client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_SYSTEM_TIME)
    return client.wait("SYSTEM_TIME").time_boot_ms / 1000


def steer(client, periods: int, think=lambda number: None) -> list:
    """Arms and flies offboard for some periods, from the first one on; returns the reports."""
    reports = []
    for number in range(periods):
        think(number)
        reports.append(step(client))
        if number == 5:
            client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
            client.set_mode(PX4_OFFBOARD)
    return [(report.time_boot_ms, report.x, report.y, report.z, report.vx, report.vy, report.vz) for report in reports]


def digest(vehicle) -> str:
    assert vehicle.stop() == 0
    return re.search(r"digest (\w{16})", vehicle.output())[1]


def test_a_program_flies_the_same_at_every_speed_bit_for_bit(start, connect):
    flights = {}
    for name, speed, think in (
        ("real time", "1", lambda number: None),
        ("fast", "20", lambda number: None),
        ("as fast as possible", "max", lambda number: None),
        # A client that pauses for 0 to 9 ms before each set-point.
        ("slow client", "max", lambda number: time.sleep(number * 7 % 10 / 1000)),
    ):
        vehicle = start("--speed", speed, "--lockstep", "always", "--wind", "4,270", "--gusts", "1.5")
        flown = steer(connect(vehicle), 200, think)
        flights[name] = (flown, digest(vehicle))
    reports, _ = flights["real time"]
    # One report for each set-point, although telemetry of this link has 10 Hz only; the vehicle has flown.
    # The first comes at once.
    assert [later[0] - earlier[0] for earlier, later in zip(reports[1:], reports[2:])] == [1000 * PERIOD] * 198
    assert reports[-1][3] < -1.5
    for name, flight in flights.items():
        assert flight == flights["real time"], name


def test_a_flight_in_lockstep_is_replayed(start, connect, program, tmp_path):
    record = tmp_path / "flight.lmpc"
    vehicle = start("--speed", "max", "--lockstep", "always", "--record", str(record))
    steer(connect(vehicle), 100)
    flown = digest(vehicle)
    replayed = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=60)
    assert replayed.returncode == 0 and flown in replayed.stdout, replayed.stdout + replayed.stderr


def test_nothing_moves_before_the_first_set_point_and_commands_are_answered(start, connect):
    client = connect(start("--speed", "max", "--lockstep", "always"))
    assert client.parameter("SIM_SPEEDUP").param_value == -1  # max
    assert now(client) == 0
    # Links look alive though time stands still.
    assert client.wait("HEARTBEAT", timeout=3) and client.wait("HEARTBEAT", timeout=3)
    assert now(client) == 0


def test_the_period_is_an_option(start, connect):
    client = connect(start("--speed", "max", "--lockstep", "always", "--lockstep-period", "0.05"))
    times = [step(client).time_boot_ms for _ in range(40)]
    # Telemetry at 10 Hz comes at multiples of the period, too.
    assert [later - earlier for earlier, later in zip(times[5:], times[6:])] == [50] * 34


@pytest.mark.parametrize("phase", ["streaming", "always"])
def test_a_client_that_dies_is_not_waited_for_without_end(start, connect, phase):
    """The vehicle says so, flies on, and its failsafe for lost set-points acts; the next set-point resumes lock-step."""
    vehicle = start("--speed", "20", "--lockstep", phase, "--lockstep-timeout", "2", links=("udpin:0", "udpin:0"))
    observer = connect(vehicle, link=1)
    client = connect(vehicle, system=200)
    steer(client, 50)
    client.close()
    assert observer.wait("STATUSTEXT", lambda text: text.text.startswith("Lock-step suspended: no set-point"))
    hold = lambda beat: beat.custom_mode >> 16 & 0xFF == 4
    observer.wait("HEARTBEAT", hold)
    first = observer.wait("LOCAL_POSITION_NED").time_boot_ms
    observer.wait("LOCAL_POSITION_NED", lambda report: report.time_boot_ms > first + 1000)
    assert "next set-point resumes it" in vehicle.output()
    again = connect(vehicle, system=201)
    for _ in range(10):
        step(again)
    # Simulation time stands still while this client is silent: at this speed it would else be seconds ahead.
    before = now(again)
    time.sleep(0.2)
    assert now(again) - before <= 2 * PERIOD


def test_a_lost_connection_is_noticed_at_once(start, connect):
    vehicle = start("--speed", "20", "--lockstep", "--lockstep-timeout", "1000", links=("tcpin:0", "udpin:0"))
    observer = connect(vehicle, link=1)
    client = connect(vehicle, kind="tcp", system=200)
    steer(client, 50)
    client.close()
    assert observer.wait("STATUSTEXT", lambda text: "client disconnected" in text.text)


def test_streaming_lets_other_flights_run_freely(start, connect):
    """Commands alone need no set-points: nothing is waited for, before or after a stream."""
    client = connect(start("--speed", "50", "--lockstep"))
    client.take_off()
    for _ in range(10):
        step(client)
    client.go(lambda: client.position(GOAL))
    for _ in range(400):
        position = step(client)
    assert abs(position.x - GOAL[0]) < 0.1 and abs(position.y - GOAL[1]) < 0.1 and abs(position.z - GOAL[2]) < 0.1
    client.land()


def test_a_waiting_vehicle_ends_when_it_is_told_to(start):
    vehicle = start("--lockstep", "always")
    begin = time.monotonic()
    assert vehicle.stop() == 0 and time.monotonic() - begin < 5
    assert "flew 0.000 s" in vehicle.output() and "simulation time starts with the first set-point" in vehicle.output()


@pytest.mark.parametrize("arguments, reason", [
    (("--lockstep-period", "0.02"), "--lockstep-period: needs --lockstep"),
    (("--lockstep", "sometimes"), "streaming or always"),
    (("--lockstep", "--lockstep-period", "0"), "0.001 to 1"),
    (("--lockstep", "--hil", "4560"), "--lockstep: does not go with --hil"),
])
def test_wrong_values_are_refused(program, arguments, reason):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=20)
    assert done.returncode == 2 and reason in done.stderr, done.stderr
