"""The program: configuration, pace, records, logs, errors, signals."""

import signal
import socket
import struct
import subprocess
import time

import pytest
from pymavlink import mavutil

from client import near


def run(program, *arguments, environment=None, timeout=60):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, env=environment or {})


@pytest.mark.parametrize(("arguments", "code", "words"), [
    (("--speed", "-3"), 2, "--speed: `-3` is not a speed: 0 (paused), 0.01 to 1000"),
    (("--home", "91,0,0"), 2, "place"),
    (("--link", "carrier-pigeon"), 2, "link"),
    (("--set", "AF_MASS=99"), 2, "AF_MASS = 99 is outside"),
    (("--set", "COM_ACT_FAIL_ACT=9"), 2, "COM_ACT_FAIL_ACT = 9 has no meaning here: 2 Land, 4 Terminate"),
    (("--set", "NO_SUCH=1"), 2, "there is no parameter NO_SUCH"),
    (("--gusts", "99"), 2, "--gusts: `99` is no number within 0 to 10"),
    (("--system-id", "x"), 2, "--system-id: `x` is no whole number within 1 to 250"),
    (("--seed", "-1"), 2, "--seed: `-1` is no whole number within 0 to"),
    (("--autopilot", "betaflight"), 2, "--autopilot: `betaflight` is none of px4, ardupilot, generic"),
    (("--sped", "3"), 2, "'--speed' (--help tells more)"),
    (("--speed",), 2, "a value is required for '--speed"),
    (("--log", "debug["), 2, "--log: `debug[` is no filter"),
    (("--config", "/does/not/exist.toml"), 4, "cannot read /does/not/exist.toml"),
    (("--replay", "/does/not/exist"), 4, "cannot read"),
    (("--link", "serial:/dev/no-such-device"), 3, "/dev/no-such-device"),
    (("--noise", "gps"), 2, "is no noise: motion-capture, rtk-gps"),
    (("--kalman=perhaps",), 2, "--kalman: `perhaps` is none of true, false"),
    (("--kalman", "--sensors", "realistic"), 2, "--noise, --kalman: realistic sensors"),
    (("--parameters", "/no/such/folder/x.params", "--link", "udpin:0", "--duration", "0"), 4, "cannot write /no/such/folder/x.params"),
    (("--tlog", "/no/such/folder/x.tlog", "--link", "udpin:0"), 4, "cannot write"),
    (("--link", "serial:/dev/null:fast"), 2, "--link: `serial:/dev/null:fast` is no link: serial:PATH[:BAUD] with a whole number above 0"),
    (("--link", "tcpin:192.0.2.1:5760"), 3, "cannot use TCP port 192.0.2.1:5760"),
])
def test_a_mistake_is_one_clear_line(program, arguments, code, words):
    result = run(program, *arguments)
    assert result.returncode == code, result.stderr
    assert words in result.stderr, result.stderr
    assert result.stderr.startswith("lmpc-sitl: ") and len(result.stderr.splitlines()) == 1 and not result.stdout, result


def test_a_mistake_in_the_environment_names_the_variable(program):
    result = run(program, environment={"LMPC_SITL_SYSTEM_ID": "251"})
    assert result.returncode == 2
    assert result.stderr == "lmpc-sitl: LMPC_SITL_SYSTEM_ID: `251` is no whole number within 1 to 250\n"


def test_a_port_that_is_taken(program):
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        result = run(program, "--link", f"tcpin:{taken.getsockname()[1]}")
    assert result.returncode == 3 and len(result.stderr.splitlines()) == 1, result.stderr
    assert "--instance" in result.stderr


def test_an_old_ready_file_is_not_taken_for_a_new_one(program, tmp_path):
    ready = tmp_path / "ready"
    ready.write_text("of an earlier run")
    assert run(program, "--ready-file", ready, "--link", "serial:/dev/no-such-device").returncode == 3
    assert not ready.exists()
    assert run(program, "--ready-file", ready, "--link", "udpin:0", "--duration", "0").returncode == 0
    assert "process_id" in ready.read_text()
    # One that cannot be written is told before anybody is told how to connect.
    result = run(program, "--ready-file", "/no/such/folder/ready", "--link", "udpin:0")
    assert result.returncode == 4 and "cannot write /no/such/folder/ready" in result.stderr and not result.stdout


def test_flags_go_before_environment_before_file(program, tmp_path):
    file = tmp_path / "sitl.toml"
    file.write_text('link = ["udpin:0"]\nsystem-id = 11\nautopilot = "ardupilot"\nspeed = "max"\nduration = 1.0\n')
    environment = {"LMPC_SITL_SYSTEM_ID": "22", "LMPC_SITL_CONFIG": str(file)}
    assert "system 22, as ArduPilot" in run(program, environment=environment).stdout
    assert "system 33," in run(program, "--system-id", 33, environment=environment).stdout
    file.write_text('noise = "gps"\n')
    result = run(program, "--config", file)
    assert result.returncode == 4 and """line 1, `noise = "gps"`: `gps` is no noise""" in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1, result.stderr
    file.write_text("speeed = 1\n")
    result = run(program, "--config", file)
    assert result.returncode == 4 and "line 1" in result.stderr and "speeed" in result.stderr


def test_noise_is_the_same_by_flag_environment_and_file(program, tmp_path):
    file = tmp_path / "sitl.toml"
    file.write_text('noise = "rtk-gps"\nkalman = true\nseed = 4\n')
    short = ("--link", "udpin:0", "--speed", "max", "--duration", 1)

    def digest(*arguments, environment=None):
        result = run(program, *short, *arguments, environment=environment)
        assert result.returncode == 0, result.stderr
        return result.stdout.split("digest ")[1].split()[0]

    flown = digest("--noise", "rtk-gps", "--kalman", "--seed", 4)
    assert digest("--config", file) == flown
    assert digest(environment={"LMPC_SITL_NOISE": "rtk-gps", "LMPC_SITL_KALMAN": "true", "LMPC_SITL_SEED": "4"}) == flown
    assert len({flown, digest("--config", file, "--seed", 5), digest("--config", file, "--kalman=false"), digest()}) == 4


def test_help_is_worth_reading(program):
    text = run(program, "--help").stdout
    for word in ("udpin", "QGroundControl", "Exit codes", "LMPC_SITL_", "--replay"):
        assert word in text


def test_the_banner_tells_how_to_connect(program):
    links = ("--link", "udpin:0", "--link", "udpout:127.0.0.1:9,onboard", "--link", "udpout:192.0.2.1:14550", "--duration", "0")
    text = run(program, *links).stdout
    assert "mavlink_connection('udpout:127.0.0.1:" in text and "MAVSDK: udpout://127.0.0.1:" in text, text
    assert "MAVSDK: udpin://0.0.0.0:9; pymavlink: mavlink_connection('udpin:127.0.0.1:9')" in text, text
    # Who is on another machine does not hear what is sent there on its own 127.0.0.1.
    assert "MAVProxy: --master=udpin:0.0.0.0:14550" in text, text


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_cleanly(start, number):
    vehicle = start()
    vehicle.process.send_signal(number)
    assert vehicle.process.wait(5) == 0
    assert "digest" in vehicle.output()


@pytest.mark.parametrize(("flags", "code"), [(("--link", "udpin:0"), 0), (("--sensors", "none"), 2)])
def test_who_closes_the_streams_does_not_end_it(program, flags, code):
    process = subprocess.Popen([program, "--duration", "2", "--speed", "max", "--fault", "1:gps=off", *flags],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={})
    process.stdout.close()
    process.stderr.close()
    assert process.wait(20) == code


@pytest.mark.alone
def test_speed_pause_and_time(start, connect):
    client = connect(start("--speed", "4"))

    def factor(seconds=1.0):
        # The latest of what has come.
        client.drain()
        begin, wall = client.wait("ATTITUDE").time_boot_ms, time.monotonic()
        time.sleep(seconds)
        client.drain()
        return (client.wait("ATTITUDE").time_boot_ms - begin) / 1000 / (time.monotonic() - wall)

    assert 3.5 < factor() < 4.5
    client.set_parameter("SIM_SPEEDUP", 0.0)
    client.drain()
    assert client.connection.recv_match(type="ATTITUDE", blocking=True, timeout=0.5) is None
    # Its link is alive all the same, and it answers.
    client.wait("HEARTBEAT", timeout=2.5)
    client.wait("HEARTBEAT", timeout=2.5)
    client.parameter("AF_MASS")
    client.set_parameter("SIM_SPEEDUP", 0.5)
    assert 0.4 < factor(2.0) < 0.6


def test_the_same_flight_at_every_speed(start, connect, tmp_path):
    """Started paused; arming and takeoff fall on the same instant of simulation time, at any pace behind it."""
    digests = []
    for speed in (5.0, 20.0, -1.0):
        vehicle = start("--speed", "0", "--duration", "12", "--gusts", "1", "--seed", "3")
        client = connect(vehicle)
        client.command(400, 1)
        client.command(22, 0, 0, 0, float("nan"), float("nan"), float("nan"), float("nan"))
        client.mav.param_set_send(1, 1, b"SIM_SPEEDUP", speed, 9)
        assert vehicle.process.wait(30) == 0
        digests.append(vehicle.output().split("digest ")[1].split()[0])
    assert len(set(digests)) == 1, digests


def test_record_and_replay(start, connect, program, tmp_path):
    record, log = tmp_path / "flight.record", tmp_path / "flight.tlog"
    vehicle = start("--record", str(record), "--tlog", str(log), "--wind", "3,90", "--gusts", "0.5", "--speed", "3")
    client = connect(vehicle)
    client.take_off()
    client.go(lambda: client.position((3, 2, -4)))
    client.stream(lambda: client.position((3, 2, -4)), near((3, 2, -4), 0.3, 0.3))
    vehicle.stop()
    flown = vehicle.output().split("digest ")[1].split()[0]
    result = run(program, "--replay", record)
    assert result.returncode == 0 and flown in result.stdout, (flown, result.stdout, result.stderr)

    # A frame that is left out is noticed, and so is a broken file.
    lines = record.read_text().splitlines()
    moved = next(number for number, line in enumerate(lines) if number > len(lines) // 2 and line.startswith("frame"))
    record.write_text("\n".join(lines[:moved - 40] + lines[moved:]) + "\n")
    assert run(program, "--replay", record).returncode in (0, 5)
    arm = next(number for number, line in enumerate(lines[1:], 1) if len(line) > 60 and "9001" in line.split()[-1])
    record.write_text("\n".join(lines[:arm] + lines[arm + 1:]) + "\n")
    assert run(program, "--replay", record).returncode == 5
    record.write_text("\n".join(lines[:-1]) + "\n")
    assert run(program, "--replay", record).returncode == 4

    # Ground stations read the log.
    reader = mavutil.mavlink_connection(str(log))
    kinds = set()
    while (message := reader.recv_match()) is not None:
        kinds.add((message.get_srcSystem(), message.get_type()))
    assert {(1, "ATTITUDE"), (255, "COMMAND_LONG"), (255, "SET_POSITION_TARGET_LOCAL_NED"), (1, "COMMAND_ACK")} <= kinds
    stamp = struct.unpack(">Q", log.read_bytes()[:8])[0] / 1e6
    assert abs(stamp - time.time()) < 600
