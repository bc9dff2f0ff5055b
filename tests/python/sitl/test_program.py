"""The program: configuration, pace, records, logs, errors, signals."""

import os
import re
import signal
import socket
import struct
import subprocess
import time

import pytest
from pymavlink import mavutil

import records
from client import near, patiently


def run(program, *arguments, environment=None, timeout=60):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, env=environment or {})


@pytest.mark.parametrize(("arguments", "code", "words"), [
    (("--speed", "-3"), 2, "--speed: `-3` is not a speed: 0 (paused), 0.01 to 1000"),
    (("--home", "91,0,0"), 2, "--home: invalid place `91,0,0`; use LAT,LON,ALT[,HEADING]: latitude -85 to 85"),
    (("--link", "carrier-pigeon"), 2, "--link: invalid link `carrier-pigeon`; use udpout:HOST:PORT"),
    (("--link", "udp:14550"), 2, "--link: invalid link `udp:14550`; did you mean `udpin:14550`?"),
    (("--link", "udpout:no-such-host.invalid:1"), 3, "cannot resolve host no-such-host.invalid"),
    (("--gusts", "99"), 2, "--gusts: `99` is not a number from 0 to 10"),
    (("--system-id", "x"), 2, "--system-id: `x` is not a whole number from 1 to 250"),
    (("--seed", "-1"), 2, "--seed: must be a non-negative integer, not `-1`"),
    (("--rc-port", "x"), 2, "--rc-port: `x` is not a whole number from 0 to 65535"),
    (("--rc-port", "99999"), 2, "--rc-port: `99999` is not a whole number from 0 to 65535"),
    (("--rc-port", "-1"), 2, "--rc-port: `-1` is not a whole number from 0 to 65535"),
    (("--view", "-1"), 2, "--view: invalid address `-1`; use [HOST:]PORT"),
    (("--hil", "-1"), 2, "--hil: invalid address `-1`; use [HOST:]PORT"),
    (("--autopilot", "betaflight"), 2, "--autopilot: must be px4, ardupilot or generic, not `betaflight`"),
    (("--airframe", "crazyfly"), 2, "--airframe: unknown airframe `crazyfly`; allowed paper, crazyflie, hummingbird, iris, heavy or a FILE.toml; did you mean crazyflie?"),
    (("--airframe", "/does/not/exist.toml"), 4, "cannot read /does/not/exist.toml"),
    (("--sped", "3"), 2, "'--speed' (see --help)"),
    (("--set", "FRAME_MASS=99"), 2, "--set: FRAME_MASS = 99 kg; allowed 0.005–50 kg"),
    (("--set", "COM_ACT_FAIL_ACT=9"), 2, "COM_ACT_FAIL_ACT = 9; allowed 0 (Warn), 1 (Hold), 2 (Land), 3 (Return), 4 (Terminate)"),
    (("--set", "NO_SUCH=1"), 2, "--set: unknown parameter NO_SUCH; --list-parameters shows them all"),
    (("--set", "airframe.mas=1"), 2, "--set: unknown parameter airframe.mas; did you mean airframe.mass?"),
    (("--set", "airframe.mass=3"), 2, "airframe.mass = 3 kg is too heavy; allowed up to 1.78 kg, which these rotors carry; lower it, or raise airframe.rotor.speed_max"),
    (("--set", "LIM_TILT=45"), 2, "LIM_TILT = 45 rad; allowed 0.05–1.2 rad (3°–69°)"),
    (("--set", "controller.kind=pid"), 2, "controller.kind = pid; allowed 1 (lmpc), 2 (ssmpc), 3 (dlqr)"),
    (("--set", "SIM_SPEEDUP=5"), 2, "--set: SIM_SPEEDUP has a flag of its own: --speed"),
    (("--set", "FRAME_MASS"), 2, "--set: expected NAME=VALUE, got `FRAME_MASS`"),
    (("--list-parameters=xml",), 2, "--list-parameters: must be table or json, not `xml`"),
    (("--speed",), 2, "a value is required for '--speed"),
    (("--log", "verbose"), 2, "--log: `verbose` is not a log level; use off, error, warn, info, debug, trace"),
    (("--wind", "31"), 2, "--wind: invalid wind `31`; use SPEED[,FROM]: 0 to 30 m/s"),
    (("--formation", "row"), 2, "--formation: invalid formation `row`; use line, grid or circle"),
    (("--ftp-write",), 2, "--ftp-write: needs --ftp-root"),
    (("--traffic", "fleet"), 2, "--traffic fleet: needs --vehicles 2 or more"),
    (("--fault", "5:gps=slow"), 2, "ideal sensors can only be `off`, `stuck` or `intermittent`"),
    (("--system-id", "249", "--vehicles", "3"), 2, "need system ids up to 251; the largest is 250"),
    (("--hil", "4560", "--speed", "0"), 2, "--speed: 0 does not go with --hil"),
    (("--log-start", "later"), 2, "--log-start: must be `arm` or `boot`, not `later`"),
    (("--config", "/does/not/exist.toml"), 4, "cannot read /does/not/exist.toml"),
    (("--replay", "/does/not/exist"), 4, "cannot read"),
    (("--link", "serial:/dev/no-such-device"), 3, "/dev/no-such-device"),
    (("--noise", "gps"), 2, "invalid noise `gps`; use motion-capture, rtk-gps or"),
    (("--kalman=perhaps",), 2, "--kalman: must be true or false, not `perhaps`"),
    (("--kalman", "--sensors", "realistic"), 2, "--noise, --kalman: not with --sensors realistic"),
    (("--parameters", "/no/such/folder/x.params", "--link", "udpin:0", "--duration", "0"), 4, "cannot write /no/such/folder/x.params"),
    (("--tlog", "/no/such/folder/x.tlog", "--link", "udpin:0"), 4, "cannot write"),
    (("--link", "serial:/dev/null:fast"), 2, "--link: invalid link `serial:/dev/null:fast`; use serial:PATH[:BAUD] with a positive integer as BAUD"),
    (("--link", "tcpin:192.0.2.1:5760"), 3, "cannot use TCP port 192.0.2.1:5760"),
])
def test_a_mistake_is_one_clear_line(program, arguments, code, words):
    result = run(program, *arguments)
    assert result.returncode == code, result.stderr
    assert words in result.stderr, result.stderr
    assert result.stderr.startswith("lmpc-sitl: ") and len(result.stderr.splitlines()) == 1 and not result.stdout, result


@pytest.mark.parametrize("conventions", ["px4", "ardupilot"])
def test_an_empty_plan_is_not_started(program, tmp_path, conventions):
    plan = tmp_path / "empty.txt"
    plan.write_text("QGC WPL 110\n")
    arguments = ("--link", "udpin:0", "--duration", "0", "--autopilot", conventions, "--mission", plan)
    assert run(program, *arguments).returncode == 0
    result = run(program, *arguments, "--autostart")
    assert result.returncode == 2
    assert result.stderr == f"lmpc-sitl: --autostart: `{plan}` has no mission items to start; add one, or leave the flag out\n"


@pytest.mark.parametrize("fault", ["off", "stuck", "intermittent"])
def test_ideal_sensors_fall_silent(program, fault):
    result = run(program, "--link", "udpin:0", "--speed", "max", "--duration", "1", "--fault", f"0.5:gps={fault}")
    assert result.returncode == 0 and f"Failure injected: gps={fault}" in result.stderr, result.stderr


def test_a_record_holds_the_state_of_each_simulated_second(program, tmp_path):
    record = tmp_path / "flight.lmpc"
    result = run(program, "--link", "udpin:0", "--speed", "max", "--duration", "12.5", "--vehicles", "2", "--record", record)
    assert result.returncode == 0, result.stderr
    for vehicle in ("0", "1"):
        states = [line.split() for line in records.entries(record) if line.startswith("state ")]
        seconds = [int(time) // 1_000_000 for _, time, number, _ in states if number == vehicle]
        assert seconds == list(range(1, 13)), states
    assert run(program, "--replay", record).returncode == 0


def test_a_mistake_in_the_environment_names_the_variable(program):
    result = run(program, environment={"LMPC_SITL_SYSTEM_ID": "251"})
    assert result.returncode == 2
    assert result.stderr == "lmpc-sitl: LMPC_SITL_SYSTEM_ID: `251` is not a whole number from 1 to 250\n"


def test_an_unknown_variable_is_refused(program):
    result = run(program, environment={"LMPC_SITL_SPED": "max"})
    assert result.returncode == 2
    assert result.stderr == "lmpc-sitl: LMPC_SITL_SPED: unknown environment variable; did you mean LMPC_SITL_SPEED?\n"
    # Help is given in any case.
    assert run(program, "--help", environment={"LMPC_SITL_SPED": "max"}).returncode == 0


def test_a_byte_order_mark_and_names_that_are_not_text(program, tmp_path):
    folder = os.fsencode(tmp_path) + b"/h\xf6he"
    os.mkdir(folder)
    plan, configuration = folder + b"/hop.plan", folder + b"/sitl.toml"
    with open(plan, "wb") as file:
        file.write(b"\xef\xbb\xbfQGC WPL 110\n0\t1\t3\t22\t0\t0\t0\t0\t47.4\t8.5\t10\t1\n")
    with open(configuration, "wb") as file:
        file.write(b"\xef\xbb\xbfspeed = 'max'\nduration = 0.1\n")
    arguments = [b"--config", configuration, b"--link", b"udpin:0", b"--parameters", folder + b"/p.params", b"--set", b"AF_MASS=0.8",
                 b"--record", folder + b"/flight", b"--tlog", folder + b"/flight.tlog", b"--log-dir", folder + b"/logs",
                 b"--log-start", b"boot", b"--ready-file", folder + b"/ready"]
    for own in (b"", b"1:"):
        result = subprocess.run([program, *arguments, b"--mission", own + plan], capture_output=True, timeout=60, env={})
        assert result.returncode == 0 and b"flew 0.100 s" in result.stdout, result.stderr
    assert {b"flight", b"flight.tlog", b"logs", b"ready"} <= set(os.listdir(folder)), os.listdir(folder)
    result = subprocess.run([program, b"--replay", folder + b"/flight"], capture_output=True, timeout=60, env={})
    assert result.returncode == 0, result.stderr
    # What is not text is named; a mistake beside it is still one clear line.
    result = subprocess.run([program, *arguments, b"--speed", b"-1"], capture_output=True, timeout=60, env={})
    assert result.returncode == 2 and result.stderr.startswith(b"lmpc-sitl: --speed: ") and result.stderr.count(b"\n") == 1
    with open(configuration, "wb") as file:
        file.write("speed = 1\n".encode("utf-16"))
    result = subprocess.run([program, *arguments], capture_output=True, timeout=60, env={})
    assert result.returncode == 4 and b"save it as UTF-8" in result.stderr, result.stderr


def test_a_port_that_is_taken(program):
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        result = run(program, "--link", f"tcpin:{taken.getsockname()[1]}")
    assert result.returncode == 3 and len(result.stderr.splitlines()) == 1, result.stderr
    assert "--instance" in result.stderr


def test_a_file_that_cannot_be_written_is_named_as_its_user_knows_it(program):
    result = run(program, "--ready-file", "/no/such/folder/ready", "--link", "udpin:0")
    assert result.returncode == 4
    assert result.stderr.endswith("lmpc-sitl: cannot write /no/such/folder/ready: No such file or directory (os error 2)\n"), result.stderr


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
    assert result.returncode == 4 and """line 1, `noise = "gps"`: invalid noise `gps`""" in result.stderr
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
    text = run(program, "--help", "all").stdout
    for word in ("udpin", "QGroundControl", "Exit codes", "LMPC_SITL_", "--replay", "Link formats:", "Faults, as", "Example:"):
        assert word in text
    short = run(program, "--help").stdout
    assert short == run(program, "-h").stdout
    assert len(short.splitlines()) <= 50 and "--help TOPIC" in short and len(short) < len(text) / 4, short


def test_a_topic_is_found_by_its_name_or_a_flag(program):
    wind = run(program, "--help", "wind")
    assert wind.returncode == 0 and "--gusts" in wind.stdout and "--speed" not in wind.stdout, wind
    assert run(program, "-h", "gusts").stdout == wind.stdout
    unknown = run(program, "--help", "wnid")
    assert unknown.returncode == 2 and len(unknown.stderr.splitlines()) == 1, unknown
    assert "did you mean `wind`? (topics: links, radio, " in unknown.stderr


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish", "powershell"])
def test_completions_have_every_flag(program, shell):
    text = run(program, "--generate", f"complete-{shell}").stdout
    flags = set(re.findall(r"^ +(?:-\w, )?--([a-z-]+)", run(program, "--help", "all").stdout, re.MULTILINE))
    assert len(flags) > 50
    for flag in flags:
        assert re.search(rf"(--|-l ){flag}\b", text), flag


def test_bash_completes_flags_topics_and_choices(program):
    """As bash does it: by the function that the completion registers."""
    script = run(program, "--generate", "complete-bash").stdout

    function = re.search(r"complete -F (\S+)", script)[1]

    def offered(*words):
        # The program, the word to be completed and the one before it are also the function's arguments.
        words = ("lmpc-sitl", *words)
        call = f"COMP_WORDS=({' '.join(map(repr, words))}); COMP_CWORD={len(words) - 1}; {function} lmpc-sitl {words[-1]!r} {words[-2]!r}"
        show = "printf '%s\\n' \"${COMPREPLY[@]}\""
        return subprocess.run(["bash", "-c", f"{script}\n{call}\n{show}"], capture_output=True, text=True, timeout=20, env={}).stdout.split()

    assert {"--vehicles", "--version"} <= set(offered("--ve")), offered("--ve")
    assert set(offered("--autopilot", "")) == {"px4", "ardupilot", "generic"}


def test_the_manual_page_has_flags_and_topics(program):
    page = run(program, "--generate", "man").stdout
    assert "\n.TH lmpc-sitl 1 " in page, page[:200]
    for heading in ("NAME", "SYNOPSIS", "LINKS", "EXIT-CODES"):
        assert f"\n.SH {heading}\n" in page, heading


def test_the_banner_tells_how_to_connect(program):
    links = ("--link", "udpin:0", "--link", "udpout:127.0.0.1:9,onboard", "--link", "udpout:192.0.2.1:14550", "--duration", "0")
    text = run(program, *links).stdout
    assert "mavlink_connection('udpout:127.0.0.1:" in text and "MAVSDK: udpout://127.0.0.1:" in text, text
    assert "MAVSDK: udpin://0.0.0.0:9; pymavlink: mavlink_connection('udpin:127.0.0.1:9')" in text, text
    # Who is on another machine does not hear what is sent there on its own 127.0.0.1.
    assert "MAVProxy: --master=udpin:0.0.0.0:14550" in text, text


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_it_cleanly(start, number):
    # Whoever runs the tests may ignore SIGHUP, as nohup does; a process inherits that.
    before = signal.signal(number, signal.SIG_DFL) if number == signal.SIGHUP else None
    vehicle = start()
    if before is not None:
        signal.signal(number, before)
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
    client.parameter("FRAME_MASS")
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
    vehicle = start(*patiently("--record", str(record), "--tlog", str(log), "--wind", "3,90", "--gusts", "0.5", "--speed", "3"))
    client = connect(vehicle)
    client.take_off()
    client.go(lambda: client.position((3, 2, -4)))
    client.stream(lambda: client.position((3, 2, -4)), near((3, 2, -4), 0.3, 0.3))
    vehicle.stop()
    flown = vehicle.output().split("digest ")[1].split()[0]
    result = run(program, "--replay", record)
    assert result.returncode == 0 and flown in result.stdout, (flown, result.stdout, result.stderr)

    # A frame that is left out is noticed: by the checksums, and if they are made again by the flight.
    lines = record.read_text().splitlines(keepends=True)
    entries = records.entries(record)
    arm = next(number for number, line in enumerate(entries[1:], 1) if len(line) > 60 and "9001" in line.split()[-1])
    record.write_text("".join(lines[:arm] + lines[arm + 1:]))
    result = run(program, "--replay", record)
    assert result.returncode == 4 and f"line {arm + 1}, " in result.stderr and "damaged" in result.stderr, result.stderr
    records.write(record, entries[:arm] + entries[arm + 1:])
    result = run(program, "--replay", record)
    assert result.returncode == 5 and "system 1 differs" in result.stderr, result.stderr

    # Ground stations read the log.
    reader = mavutil.mavlink_connection(str(log))
    kinds = set()
    while (message := reader.recv_match()) is not None:
        kinds.add((message.get_srcSystem(), message.get_type()))
    assert {(1, "ATTITUDE"), (255, "COMMAND_LONG"), (255, "SET_POSITION_TARGET_LOCAL_NED"), (1, "COMMAND_ACK")} <= kinds
    stamp = struct.unpack(">Q", log.read_bytes()[:8])[0] / 1e6
    assert abs(stamp - time.time()) < 600
