"""FMUs in place of the vehicle's closed loop or plant: ours, one in C, and one in Python; and those that fail."""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from client import near
from pymavlink.dialects.v20 import ardupilotmega as mavlink

import foreign
import records
import test_hil
import test_lockstep

ROOT = Path(__file__).resolve().parents[3]

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the FMUs are compiled for Linux")


@pytest.fixture(scope="session")
def closed_loop() -> Path:
    return Path(os.environ.get("LMPC_QUADROTOR_FMU", ROOT / "target" / "fmu" / "LmpcQuadrotor.fmu"))


@pytest.fixture(scope="session")
def plant(closed_loop) -> Path:
    return closed_loop.with_name("QuadrotorPlant.fmu")


@pytest.fixture(scope="session")
def body(tmp_path_factory):
    """The body in C, which works."""
    return foreign.in_c(tmp_path_factory.mktemp("body"))


def run(program, *arguments, timeout=120, **environment):
    environment = {"PATH": os.environ["PATH"], **environment}
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, env=environment)


def fly_about(client):
    """Up, to a place with a heading, and down again. Where it was."""
    client.take_off()
    client.go(lambda: client.position((3, -2, -4), mask=0b100111111000, yaw=1.0))
    arrived = near((3, -2, -4), 0.1, 0.1)

    def is_there(position):
        attitude = client.connection.messages.get("ATTITUDE")
        return arrived(position) and attitude is not None and abs(attitude.yaw - 1.0) < 0.05

    there = client.stream(lambda: client.position((3, -2, -4), mask=0b100111111000, yaw=1.0), is_there, 40)
    client.land()
    return there


@pytest.mark.parametrize("model", ["closed loop", "plant", "body"])
def test_a_client_flies_an_fmu_and_the_record_is_the_same_flight(start, connect, program, tmp_path, model, closed_loop, plant, body):
    fmu, map_file = {"closed loop": (closed_loop, None), "plant": (plant, None), "body": body}[model]
    options = ["--fmu", fmu, "--speed", "5", "--record", tmp_path / "record", "--log-dir", tmp_path / "logs", "--home", "47,8,400,30"]
    vehicle = start(*map(str, options), *([] if map_file is None else ["--map", str(map_file)]))
    client = connect(vehicle)
    fly_about(client)
    assert vehicle.stop() == 0, vehicle.output()
    output = vehicle.output()
    role = "closed loop" if model == "closed loop" else "plant"
    assert f"flies as the {role}" in output
    if model == "body":
        # Its arguments are written into its messages; what it prints at its end is seen, too.
        assert "FMU Body: system 1 has a mass of 0.70 kg, 100%" in output
        assert "FMU Body: terminated" in output
    digest = re.search(r"flight digest (\w+)", output)[1]
    replayed = run(program, "--replay", tmp_path / "record")
    assert replayed.returncode == 0 and f"{digest}: the same flight" in replayed.stdout, replayed
    assert list((tmp_path / "logs").glob("**/*.ulg"))


def a_plan(folder):
    """Up, to a place, and down there."""
    plan = folder / "square.waypoints"
    rows = ["0\t1\t0\t16\t0\t0\t0\t0\t47\t8\t400\t1", "1\t0\t3\t22\t0\t0\t0\t0\t47\t8\t5\t1",
            "2\t0\t3\t16\t0\t0\t0\t0\t47.0001\t8.0001\t8\t1", "3\t0\t3\t21\t0\t0\t0\t0\t47.0001\t8.0001\t0\t1"]
    plan.write_text("QGC WPL 110\n" + "\n".join(rows) + "\n")
    return plan


def test_a_rotor_of_a_plant_fails_as_the_vehicle_s_own(program, plant, body, tmp_path):
    """Told to stop, or to turn on: a plant with rotors, and one that is moved by the thrust of ours."""
    plan = a_plan(tmp_path)

    def fly(fault, *options):
        result = run(program, "--mission", plan, "--autostart", "--speed", "max", "--duration", 50, "--home", "47,8,400", "--link", "udpin:0",
                     "--fault", fault, *options)
        assert result.returncode == 0, result.stderr
        found = re.search(r"(\d+\.\d+)s .*Rotor 2 lost: descending.*?(\d+\.\d+)s .*Disarmed: landed without rotor 2", result.stderr, re.DOTALL)
        assert found, result.stderr
        return [float(time_s) for time_s in found.groups()]

    for fault in ("8:rotor2=off", "8:rotor2=stuck"):
        own = fly(fault)
        assert fly(fault, "--fmu", plant) == pytest.approx(own, abs=0.01)
        # It stands on another ground, and has no drag.
        assert fly(fault, "--fmu", body[0], "--map", body[1]) == pytest.approx(own, abs=1.5)


def test_the_body_flies_as_the_vehicle_does(program, body, tmp_path):
    """One mission with the vehicle's own plant, and with the body that somebody else has integrated."""
    plan = a_plan(tmp_path)
    fmu, map_file = body

    def fly(*options):
        speed = [] if "--speed" in options else ["--speed", "max"]
        result = run(program, "--mission", plan, "--autostart", *speed, "--duration", 50, "--home", "47,8,400", "--link", "udpin:0",
                     *options)
        assert result.returncode == 0, result.stderr
        line = next(line for line in result.stderr.splitlines() if "Landing detected" in line)
        return float(re.search(r"(\d+\.\d+)s ", line)[1]), re.search(r"flight digest (\w+)", result.stdout)[1]

    own, (landed_s, digest) = fly(), fly("--fmu", fmu, "--map", map_file)
    assert abs(own[0] - landed_s) < 0.5, (own, landed_s)
    # At another pace it is the same flight.
    assert fly("--fmu", fmu, "--map", map_file, "--speed", "100") == (landed_s, digest)
    # A record that is full replays up to its end.
    fly("--fmu", fmu, "--map", map_file, "--record", tmp_path / "record", "--record-size", "2")
    replayed = run(program, "--replay", tmp_path / "record")
    assert replayed.returncode == 0 and "the record ends at its size limit" in replayed.stdout, replayed


@pytest.mark.parametrize("fault, words", [
    ("segfault", "the FMU Body crashed in fmi2DoStep: segmentation fault (SIGSEGV); it said: .*at 3.000 s: fault 1"),
    ("abort", "the FMU Body crashed in fmi2DoStep: abort (SIGABRT); it said: .*at 3.000 s: fault 6"),
    ("exit", "the FMU Body ended its process in fmi2DoStep, with exit code 7; it said: .*leaving, without a line's end"),
    ("error", "the FMU Body: fmi2DoStep returned fmi2Error; it said: .*at 3.000 s: fault 2"),
    ("hang", "the FMU Body did not return from fmi2DoStep within 0.5 s; its process was ended; it said: .*at 3.000 s: fault 3"),
    ("nan", "the FMU Body shows NaN for position.y .its variable `north`."),
])
def test_an_fmu_that_fails_ends_its_flight_and_nothing_else(program, tmp_path, fault, words):
    fmu, map_file = foreign.in_c(tmp_path, fault)
    map_file.write_text("step_timeout = 0.5\n" + map_file.read_text())
    files = ["--record", tmp_path / "record", "--log-dir", tmp_path / "logs", "--log-start", "boot"]
    result = run(program, "--fmu", fmu, "--map", map_file, "--speed", "max", "--duration", 10, "--link", "udpin:0", *files)
    assert result.returncode == 6, result
    last = result.stderr.splitlines()[-1]
    pattern = "lmpc-sitl: the simulation failed: system 1: " + words.replace("(SIG", r"\(SIG").replace("V);", r"V\);").replace("T);", r"T\);")
    assert re.fullmatch(pattern + r".* \(3 s of simulation time\)", last), last
    assert "flew 3.000 s" in result.stdout and "panicked" not in result.stderr
    # Everything up to there is kept, and flies again.
    assert records.entries(tmp_path / "record")[-1].startswith("failure 3000000 0 ")
    replayed = run(program, "--replay", tmp_path / "record")
    assert replayed.returncode == 0 and "its simulation fails there, as recorded" in replayed.stdout, replayed
    from pyulog import ULog
    log, = (tmp_path / "logs").glob("**/*.ulg")
    times = ULog(str(log)).get_dataset("vehicle_local_position").data["timestamp"]
    assert times[-1] >= 2_900_000


def test_an_fmu_that_crashes_at_the_start_is_told_at_the_start(program, tmp_path):
    fmu, map_file = foreign.in_c(tmp_path, "start")
    result = run(program, "--fmu", fmu, "--map", map_file, "--link", "udpin:0")
    assert result.returncode == 6
    assert "the FMU Body crashed in fmi2Instantiate: segmentation fault (SIGSEGV)" in result.stderr.splitlines()[-1]


@pytest.mark.parametrize("environment", [1, 2])
def test_an_fmu_that_hands_the_logger_another_environment_is_heard(program, tmp_path, environment):
    """A pointer of its own, or none: some exporters do so. It is not followed."""
    fmu, map_file = foreign.in_c(tmp_path, "error", options=(f"-DENVIRONMENT={environment}",))
    result = run(program, "--fmu", fmu, "--map", map_file, "--speed", "max", "--duration", 10, "--link", "udpin:0")
    assert result.returncode == 6, result
    assert "has a mass of 0.70 kg, 100%" in result.stderr, result.stderr
    assert "fmi2DoStep returned fmi2Error; it said: " in result.stderr.splitlines()[-1], result.stderr
    assert "at 3.000 s: fault 2" in result.stderr.splitlines()[-1], result.stderr


def test_libraries_that_an_fmu_brings_along_are_found(program, tmp_path):
    """Without a run path in its own: not every exporter writes one."""
    helper = tmp_path / "libhelper.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-xc", "-", "-o", helper], input="double help(void) { return 1; }", text=True, check=True)
    options = ("-Wl,--no-as-needed", f"-L{tmp_path}", "-lhelper")
    arguments = ["--speed", "max", "--duration", 1, "--link", "udpin:0"]
    fmu, map_file = foreign.in_c(tmp_path / "with", options=options, beside=(helper,))
    result = run(program, "--fmu", fmu, "--map", map_file, *arguments)
    assert result.returncode == 0, result
    fmu, map_file = foreign.in_c(tmp_path / "without", options=options)
    result = run(program, "--fmu", fmu, "--map", map_file, *arguments)
    last = result.stderr.splitlines()[-1]
    assert result.returncode == 6 and "libhelper.so" in last and "in `preload` of a --map" in last, last


def test_a_plant_without_ground_is_told_so(program, tmp_path, body):
    fmu, map_file = foreign.in_c(tmp_path, options=("-DGROUND=0",))
    arguments = ["--speed", "max", "--duration", 3, "--link", "udpin:0"]
    result = run(program, "--fmu", fmu, "--map", map_file, *arguments)
    assert len(re.findall("the FMU Body falls: nothing carries it while its rotors rest", result.stderr)) == 1, result.stderr
    result = run(program, "--fmu", body[0], "--map", body[1], *arguments)
    assert result.returncode == 0 and "falls" not in result.stderr, result.stderr


@pytest.mark.parametrize("model", ["closed loop", "plant"])
def test_ours_land_on_a_plateau(start, connect, closed_loop, plant, tmp_path, model):
    """4 m above home, and g/ω² deep in the ground: feet are oscillators of 50 rad/s."""
    world = tmp_path / "world.toml"
    world.write_text("[[hill]]\ncenter = [12.0, 0.0]\nradius = 10.0\ntop = 5.0\nheight = 4.0\n")
    client = connect(start("--fmu", str(plant if model == "plant" else closed_loop), "--world", str(world)))
    client.take_off()
    client.go(lambda: client.position((12, 0, -8)))
    client.stream(lambda: client.position((12, 0, -8)), near((12, 0, -8), 0.2, 0.2), 40)
    client.land()
    at = client.wait("LOCAL_POSITION_NED")
    assert at.z == pytest.approx(-4 + 9.80665 / 2500, abs=2e-3) and math.hypot(at.x - 12, at.y) < 0.5


def test_a_plant_with_ground_of_its_own_is_told_so(program, body, tmp_path):
    world = tmp_path / "world.toml"
    world.write_text("[[hill]]\ncenter = [12.0, 0.0]\nradius = 10.0\ntop = 5.0\nheight = 4.0\n")
    arguments = ["--fmu", body[0], "--map", body[1], "--speed", "max", "--duration", 1, "--link", "udpin:0"]
    words = "has no input for the height of the ground (ground.z): it stands on ground of its own"
    told = [words in run(program, *arguments, *more).stderr for more in ([], ["--world", world])]
    assert told == [False, True]


def test_a_plant_that_takes_both_is_told_what_drives_it(program, plant, tmp_path):
    """Ours by thrust and torques, without a word about its parameter `actuation`: it takes off."""
    map_file = tmp_path / "wrench.toml"
    map_file.write_text('[variables]\nthrust = "command.thrust"\n')
    listed = run(program, "--fmu", plant, "--map", map_file, "--fmu-check")
    assert "start  actuation = 2" in listed.stdout, listed
    result = run(program, "--fmu", plant, "--map", map_file, "--mission", a_plan(tmp_path), "--autostart", "--speed", "max",
                 "--duration", 50, "--home", "47,8,400", "--link", "udpin:0")
    assert result.returncode == 0 and "Landing detected" in result.stderr, result.stderr


def test_a_wrong_heading_below_an_autopilot_is_explained(program, body, tmp_path):
    own = tmp_path / "map.toml"
    own.write_text(body[1].read_text().replace('"start.yaw"', "false"))
    result = run(program, "--fmu", body[0], "--map", own, "--hil", "0", "--duration", 1)
    last = result.stderr.splitlines()[-1]
    assert result.returncode == 4 and "the autopilot's nose has the heading 0.0° of --home, and --hil-mount turns it by 45.0°" in last, last
    assert "the vehicle at 0.000, 0.000, 0.000 m (north, east, down), heading -45.0°" in last.replace("-0.000", "0.000"), last


def test_one_vehicle_of_several_ends_alone(program, tmp_path):
    """Each has a process of its own; the second one is killed from outside."""
    fmu, map_file = foreign.in_c(tmp_path)
    process = subprocess.Popen([program, "--fmu", fmu, "--map", map_file, "--vehicles", "2", "--link", "udpin:0", "--ports", "shared", "--duration", "4"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={"PATH": os.environ["PATH"]})
    try:
        hosts = []
        while len(hosts) < 2 and process.poll() is None:
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            hosts = [child for child in children if b"fmu-host" in Path(f"/proc/{child}/cmdline").read_bytes()]
        line = ""
        while "disarmed" not in line and "flies as the plant" not in line:
            line = process.stderr.readline()
        os.kill(int(hosts[1]), 9)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 6, err
    assert "system 2: the FMU Body crashed in " in err and "killed (SIGKILL)" in err
    assert re.search(r"system 1: flew 4.000 s", out), out
    assert not Path(f"/proc/{hosts[0]}").exists()


def test_the_program_lists_what_it_would_fly(program, body):
    fmu, map_file = body
    result = run(program, "--fmu", fmu, "--map", map_file, "--fmu-check")
    assert result.returncode == 0, result
    assert result.stdout.startswith("Body: flies as the plant\n")
    assert re.search(r"attitude.psi +rad +yaw +degree +ours = 0.01745", result.stdout)
    assert "start  m = 0.7" in result.stdout


@pytest.mark.parametrize("spoil, words", [
    (lambda map_: map_.replace('"north"', '"nort"'), "position.y: the FMU has no variable `nort`; did you mean `north`?"),
    (lambda map_: map_.replace('"north"', '"F"'), "position.y: the variable `F` is of causality input; it must be an output"),
    (lambda map_: map_.replace('"v.up"', '"up"'), "velocity.z: the variable `up` has the unit `m`; it must be one that converts into m/s"),
    (lambda map_: map_.replace('thrust = "F"', ""), "map.*thrust|thrust.*map"),
    (lambda map_: map_.replace('"start.yaw"', 'false'), "the FMU starts at .* heading 90.0°, the vehicle at .* heading 20.0°"),
    (lambda map_: map_.replace('"t.y"', '"t.x"'), "torque.x and torque.y are both mapped to the variable `t.x`; give each its own input"),
    (lambda map_: map_ + 'preload = ["a.so"]\n', "preload stands below [variables] and belongs to it; move this line above the first"),
    (lambda map_: map_.replace('"plant"', '"plan"'), "role is \"closed-loop\" or \"plant\""),
])
def test_mistakes_of_the_map_are_one_clear_line(program, body, tmp_path, spoil, words):
    fmu, map_file = body
    own = tmp_path / "map.toml"
    own.write_text(spoil(map_file.read_text()))
    result = run(program, "--fmu", fmu, "--map", own, "--link", "udpin:0", "--home", "47,8,400,20")
    assert result.returncode == 4, result
    line, = [line for line in result.stderr.splitlines() if line.startswith("lmpc-sitl: ")]
    assert re.search(words, line) or words in line, line


def test_fmus_that_cannot_be_flown_are_told_so(program, body, tmp_path, closed_loop):
    fmu, map_file = body
    elsewhere, _ = foreign.in_c(tmp_path / "elsewhere", platform="win64")
    third = closed_loop.parent / "fmi3" / closed_loop.name
    nothing = tmp_path / "nothing.fmu"
    nothing.write_bytes(b"nothing")
    for arguments, code, words in [
        (["--fmu", elsewhere, "--map", map_file], 4, "binaries/linux64/Body.so is missing, the archive has win64"),
        (["--fmu", nothing], 4, "is not an FMU"),
        (["--fmu", tmp_path / "none.fmu"], 4, "No such file"),
        (["--fmu", fmu], 4, "no inputs to fly it by"),
        (["--fmu", third], 4, "is an FMU of FMI 3.0; only FMI 2.0 co-simulation is supported"),
        (["--map", map_file], 2, "--map: needs --fmu"),
        (["--fmu", fmu, "--map", map_file, "--wind", "3"], 2, "has no inputs for the wind"),
        (["--fmu", closed_loop, "--fault", "3:rotor1=off"], 2, "LmpcQuadrotor flies as the closed loop, and its rotors take no faults"),
        (["--fmu", closed_loop, "--sensors", "realistic"], 2, "flies by measurements of its own"),
        (["--fmu", closed_loop, "--hil", "0"], 2, "an external autopilot needs a plant"),
    ]:
        result = run(program, *arguments, "--duration", 1)
        assert result.returncode == code, (arguments, result)
        assert words in result.stderr.splitlines()[-1], (words, result.stderr)


def test_what_describes_the_fmu_cannot_change_in_flight(start, connect, body, closed_loop):
    fmu, map_file = body
    client = connect(start("--fmu", str(fmu), "--map", str(map_file)))
    mass = client.parameter("AF_MASS").param_value
    client.mav.param_set_send(*client.target, b"AF_MASS", 2 * mass, mavlink.MAV_PARAM_TYPE_REAL32)
    text = client.wait("STATUSTEXT", lambda text: "Body" in text.text)
    assert "the FMU Body flies as the plant" in text.text
    assert client.parameter("AF_MASS").param_value == mass

    client = connect(start("--fmu", str(closed_loop)))
    client.mav.set_attitude_target_send(0, *client.target, 0, [1, 0, 0, 0], 0, 0, 0, 0.5)
    text = client.wait("STATUSTEXT", lambda text: "Set-point" in text.text)
    assert "LmpcQuadrotor follows" in text.text


def test_lockstep_waits_for_set_points(start, connect, body):
    """The same set-points are the same flight, whatever the pace."""
    fmu, map_file = body
    flights = []
    for speed in ("max", "20"):
        vehicle = start("--fmu", str(fmu), "--map", str(map_file), "--lockstep", "always", "--speed", speed)
        flights.append((test_lockstep.steer(connect(vehicle), 100), test_lockstep.digest(vehicle)))
    assert flights[0] == flights[1] and flights[0][0][-1][3] < -0.3, flights[0][0][-1]


def test_an_autopilot_flies_a_foreign_plant(start, body):
    fmu, map_file = body
    vehicle = start("--hil", "0", "--speed", "max", "--fmu", str(fmu), "--map", str(map_file), links=())
    autopilot, places = test_hil.hover(vehicle.addresses[0], 12)
    assert all(abs(up - 5) < 0.3 for _, _, up in places), places[-1]
    assert all(math.hypot(north, east) < 1.5 for north, east, _ in places), places[-1]
    autopilot.socket.close()


@pytest.mark.skipif(foreign.interpreter_library() is None, reason="this Python was built without its shared library")
def test_a_plant_in_python_is_flown_by_a_client(start, connect, program, tmp_path):
    fmu, map_file = foreign.in_python(tmp_path / "python")
    vehicle = start("--fmu", str(fmu), "--map", str(map_file), "--record", str(tmp_path / "record"), "--home", "47,8,400,-50", "--speed", "2")
    client = connect(vehicle)
    fly_about(client)
    assert vehicle.stop() == 0, vehicle.output()
    assert "the FMU PythonBody flies as the plant" in vehicle.output()
    replayed = run(program, "--replay", tmp_path / "record")
    assert replayed.returncode == 0 and "the same flight" in replayed.stdout, replayed

    # Without the library its symbols are missing, and that is what is said.
    result = run(program, "--fmu", fmu, "--duration", 1, "--link", "udpin:0")
    assert result.returncode == 6 and "in `preload` of a --map" in result.stderr.splitlines()[-1], result
