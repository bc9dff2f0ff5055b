"""Files that are written while vehicles fly: full, read-only and shared disks, too many open files, kill -9. None of them ends a flight;
each is announced, tried again, and named at the end by exit code 4."""

import os
import re
import resource
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

import records
from client import Client
from test_program import run
from test_signing import key_file, signed

UNLIMITED = resource.RLIM_INFINITY


@pytest.fixture
def launch(tmp_path):
    """Starts programs that may end with any code. Their output is a pipe: a limit on files does not concern it."""
    running, clients = [], []

    def make(command, *arguments, **options):
        ready = tmp_path / f"ready{len(running)}.json"
        process = subprocess.Popen(
            [*map(str, command), "--ready-file", str(ready), "--link", "udpin:0", *map(str, arguments)], stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, env={"PATH": os.environ["PATH"]}, **options)
        running.append(process)
        end = time.monotonic() + 20
        while not ready.exists():
            assert process.poll() is None and time.monotonic() < end, process.stdout.read()
            time.sleep(0.01)
        return process, re.search(r'"addresses":\["([^"]+)"', ready.read_text())[1]

    def client(address, **options):
        clients.append(Client(address, **options))
        return clients[-1]

    yield make, client
    for one in clients:
        one.close()
    for process in running:
        if process.poll() is None:
            process.kill()
        process.communicate()


def said(client, *texts, timeout=15.0):
    """Waits for texts, in any order."""
    missing, end = set(texts), time.monotonic() + timeout
    while missing:
        assert time.monotonic() < end, f"not said: {missing}"
        message = client.connection.recv_match(type="STATUSTEXT", blocking=True, timeout=0.5)
        if message is not None:
            missing -= {text for text in missing if message.text.startswith(text)}


def ended(process, code):
    process.terminate()
    output, _ = process.communicate(timeout=20)
    assert process.returncode == code and "panicked" not in output, output
    return output


def paths(folder: Path):
    key = key_file(folder)
    return {"--record": folder / "flight.lmpc", "--tlog": folder / "flight.tlog", "--log-dir": folder / "logs",
            "--parameters": folder / "a.params", "--signing-key": key}


def flags(files):
    return [text for pair in files.items() for text in pair]


def fly(client_of, address):
    client = client_of(address, heartbeat=False)
    signed(client.connection)
    client.beat()
    client.wait("HEARTBEAT")
    client.target = (1, 1)
    client.take_off()
    return client


def still_flies(client):
    client.drain()
    position = client.wait("LOCAL_POSITION_NED")
    assert abs(position.z + 2.5) < 0.2, position


FAILING = [f"{name} not written" for name in ("Record", "Traffic log", "Flight log", "Parameters", "Signing timestamps")]
AGAIN = [f"{name} written again" for name in ("Record", "Traffic log", "Flight log", "Parameters", "Signing timestamps")]


def flies_on_a_full_disk(program, launch, files):
    """The process, and a client that has been told of every file and sees the vehicle fly on."""
    start, client_of = launch
    process, address = start([program], *flags(files))
    client = fly(client_of, address)
    # From now on no file grows: what the system says is the same as with a full disk, but for the reason.
    resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (64, UNLIMITED))
    client.mav.param_set_send(1, 1, b"MIS_TAKEOFF_ALT", 3.5, 9)
    said(client, *FAILING)
    still_flies(client)
    return process, client


def test_a_disk_that_is_full_for_a_while_costs_nothing(program, launch, tmp_path):
    files = paths(tmp_path)
    process, client = flies_on_a_full_disk(program, launch, files)
    assert not files["--parameters"].exists()
    resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (UNLIMITED, UNLIMITED))
    said(client, *AGAIN)
    still_flies(client)
    output = ended(process, 0)
    assert "MIS_TAKEOFF_ALT\t3.5" in files["--parameters"].read_text()
    digest = re.search("digest ([0-9a-f]{16})", output)[1]
    replayed = run(program, "--replay", files["--record"])
    assert replayed.returncode == 0 and f"{digest}: the same flight\n" in replayed.stdout, replayed
    assert records.entries(files["--record"])[-1].startswith("end ")
    # No lock and no half of a file is left.
    left = {path.name for path in tmp_path.iterdir() if not path.name.startswith("ready")}
    assert left == {"flight.lmpc", "flight.tlog", "logs", "a.params", "signing.key", "signing.key.timestamps"}, left


def test_a_disk_that_stays_full_is_named_at_the_end(program, launch, tmp_path):
    files = paths(tmp_path)
    process, _ = flies_on_a_full_disk(program, launch, files)
    output = ended(process, 4)
    last = output.splitlines()[-1]
    assert last.startswith("lmpc-sitl: the flight ended as asked, but files are incomplete: "), output
    assert "flew " in output and "file too large" in last
    for name in ("flight.lmpc ends early", "flight.tlog ends early", ".ulg ends early", "a.params lacks", "signing.key.timestamps lacks"):
        assert name in last, last
    # What is on the disk is of use.
    replayed = run(program, "--replay", files["--record"])
    assert replayed.returncode == 0 and "the record ends early" in replayed.stdout, replayed


@pytest.fixture
def small_disk(program, tmp_path):
    """A command that starts the program with a disk of 16 MB at a folder, and the folder as others see it."""
    tools = ("unshare", "nsenter", "mount")
    folder = tmp_path / "disk"
    folder.mkdir()
    space = ["unshare", "--user", "--map-root-user", "--mount"]
    mount = 'mount -t tmpfs -o size=16m tmpfs "$0" && exec "$@"'
    if not all(map(shutil.which, tools)) or subprocess.run([*space, "sh", "-c", mount, folder, "true"], capture_output=True).returncode:
        pytest.skip("this machine lets nobody mount a disk: full disks are tested by a limit on files only")
    return [*space, "sh", "-c", mount, str(folder), program], folder


def test_a_disk_without_space_and_one_that_becomes_read_only(program, launch, small_disk):
    command, folder = small_disk
    start, client_of = launch
    process, address = start(command, "--record", folder / "flight.lmpc", "--tlog", folder / "flight.tlog", "--log-dir", folder / "logs",
                             "--parameters", folder / "a.params")
    inside = Path(f"/proc/{process.pid}/root{folder}")
    client = client_of(address)
    client.take_off()
    with pytest.raises(OSError), (inside / "filler").open("wb", buffering=0) as filler:
        while True:
            filler.write(bytes(4096))
    client.mav.param_set_send(1, 1, b"MIS_TAKEOFF_ALT", 3.5, 9)
    # The last page of a file may still have room: a record grows with what is received.
    for _ in range(100):
        client.mav.heartbeat_send(6, 8, 0, 0, 0)
    said(client, *(f"{name} not written: no space left on" for name in ("Record", "Traffic log", "Flight log", "Parameters")))
    still_flies(client)
    (inside / "filler").unlink()
    said(client, *AGAIN[:4])
    # Another disk, read-only, in its place: names lead there, open files stay where they are.
    within = ["nsenter", "--target", str(process.pid), "--user", "--mount", "--preserve-credentials"]
    subprocess.run([*within, "mount", "-t", "tmpfs", "-o", "ro", "tmpfs", folder], check=True)
    client.mav.param_set_send(1, 1, b"MIS_TAKEOFF_ALT", 4.5, 9)
    said(client, "Parameters not written: read-only file system")
    still_flies(client)
    # Nothing is said twice, and a socket that nobody reads overflows: it is read while the disk goes.
    unmount = subprocess.Popen([*within, "umount", folder])
    said(client, "Parameters written again")
    assert unmount.wait(timeout=10) == 0
    assert "MIS_TAKEOFF_ALT\t4.5" in (inside / "a.params").read_text()
    kept = folder.parent / "kept.lmpc"
    content = (inside / "flight.lmpc").read_bytes()
    kept.write_bytes(content)
    ended(process, 0)
    # Copied in flight, it is the record of a flight that is not over.
    replayed = run(program, "--replay", kept)
    assert replayed.returncode == 0 and "the record ends early" in replayed.stdout, replayed


def test_too_many_open_files_end_no_flight(program, launch, tmp_path):
    start, client_of = launch
    parameters = tmp_path / "a.params"
    process, address = start([program], "--parameters", parameters)
    client = client_of(address)
    client.take_off()
    limits = resource.prlimit(process.pid, resource.RLIMIT_NOFILE)
    resource.prlimit(process.pid, resource.RLIMIT_NOFILE, (len(os.listdir(f"/proc/{process.pid}/fd")), limits[1]))
    client.mav.param_set_send(1, 1, b"MIS_TAKEOFF_ALT", 3.5, 9)
    said(client, "Parameters not written: too many open files")
    still_flies(client)
    resource.prlimit(process.pid, resource.RLIMIT_NOFILE, limits)
    said(client, "Parameters written again")
    ended(process, 0)
    assert "MIS_TAKEOFF_ALT\t3.5" in parameters.read_text()


def test_a_device_that_takes_nothing(program, tmp_path):
    # Somebody is sent to, so that there is traffic.
    flight = ("--link", "udpout:127.0.0.1:9", "--speed", "max", "--duration", 5)
    result = run(program, *flight, "--tlog", "/dev/full")
    assert result.returncode == 4 and "flew 5.000 s" in result.stdout, result
    assert result.stderr.splitlines()[-1].endswith("incomplete: /dev/full ends early: no space left on device"), result.stderr
    # Without its first line a record is none: that is said before the flight.
    result = run(program, *flight, "--record", "/dev/full")
    assert result.returncode == 4 and "cannot write /dev/full" in result.stderr and not result.stdout, result


def test_after_kill_9_all_but_a_second_replays(program, launch, tmp_path):
    start, client_of = launch
    record = tmp_path / "flight.lmpc"
    process, address = start([program], "--record", record)
    client = client_of(address)
    client.take_off()
    # Until then it was heard; a bit of what it said last is on its way.
    client.drain()
    heard_s = client.wait("ATTITUDE").time_boot_ms / 1000
    process.kill()
    process.wait()
    replayed = run(program, "--replay", record)
    line = re.search(r"replayed ([\d.]+) s, flight digest \w+: the same flight up to ([\d.]+) s; the record ends early", replayed.stdout)
    assert replayed.returncode == 0 and line, replayed
    assert "the record was cut in line" in replayed.stderr
    assert heard_s - 1.5 < float(line[2]) <= float(line[1]) < heard_s + 1.5, (heard_s, line[0])
    # One changed number does not move the end.
    content = record.read_bytes()
    assert content.count(b"\nstate ") >= 2
    record.write_bytes(content.replace(b"\nstate ", b"\nstate 9", 1))
    damaged = run(program, "--replay", record)
    assert damaged.returncode == 4 and re.search(r"line \d+, the entry after [\d.]+ s of simulation time, is damaged", damaged.stderr)
    assert len(damaged.stderr.splitlines()) == 1 and not damaged.stdout, damaged


@pytest.mark.parametrize("flag", ["--parameters", "--signing-key", "--record", "--tlog"])
def test_two_processes_do_not_share_a_file(program, launch, tmp_path, flag):
    start, _ = launch
    path = paths(tmp_path)[flag]
    process, _ = start([program], flag, path)
    short = ("--link", "udpin:0", "--speed", "max", "--duration", 1, flag, path)
    refused = run(program, *short)
    assert refused.returncode == 4 and not refused.stdout, refused
    assert refused.stderr == f"lmpc-sitl: {path}: is in use by process {process.pid}; give each process a file of its own\n"
    # A lock ends with its process, however that ends.
    process.kill()
    process.wait()
    assert run(program, *short).returncode == 0
    assert not list(tmp_path.glob("*.lock"))


@pytest.mark.parametrize(("flag", "value"), [
    ("--set", "AF_MASS=1"), ("--wind", "3"), ("--speed", "5"), ("--mission", "a.plan"), ("--link", "udpin:0"), ("--sensors", "realistic"),
    ("--hil", "0"), ("--record", "b.lmpc"), ("--duration", "1"), ("--log-dir", "logs"),
])
def test_a_replay_refuses_what_it_would_ignore(program, tmp_path, flag, value):
    record = tmp_path / "a.lmpc"
    result = run(program, "--replay", record, flag, value)
    assert result.returncode == 2 and result.stderr.startswith(f"lmpc-sitl: {flag}: cannot be used with --replay"), result.stderr
    name = flag.removeprefix("--")
    file = tmp_path / "sitl.toml"
    file.write_text(f'{name} = "{value}"\n')
    assert run(program, "--replay", record, "--config", file).stderr == result.stderr
    environment = {"LMPC_SITL_" + name.replace("-", "_").upper(): value}
    assert run(program, "--replay", record, environment=environment).stderr == result.stderr
    # What says nothing of the flight goes with it.
    file.write_text('log = "warn"\n')
    assert run(program, "--replay", record, "--config", file, "--log", "debug").stderr.startswith(f"lmpc-sitl: cannot read {record}")


def test_who_asks_for_it_survives_the_terminal(program, launch):
    """As `nohup` does."""
    start, client_of = launch
    process, address = start([program], preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    client = client_of(address)
    process.send_signal(signal.SIGHUP)
    client.wait("HEARTBEAT")
    client.wait("HEARTBEAT")
    assert process.poll() is None
    ended(process, 0)
