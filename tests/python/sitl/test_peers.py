"""Who becomes a peer, and keeps its place: strangers cost nobody anything and draw next to nothing, idle connections make room."""

import json
import resource
import socket
import time

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import Client, own_address
from test_disks import ended, launch, said, still_flies  # noqa: F401
from test_signing import key_file, signed

HEARTBEAT = mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3)


def packed(message=HEARTBEAT, system=66):
    return message.pack(mavlink.MAVLink(None, srcSystem=system, srcComponent=190))


def attitudes(client, seconds, meanwhile=lambda: None):
    """Number of ATTITUDE messages per simulated second, while the client sends heartbeats at 1 Hz."""
    times, start, beats = [], time.monotonic(), 0
    while (elapsed := time.monotonic() - start) < seconds:
        meanwhile()
        if elapsed >= beats:
            client.beat()
            beats += 1
        # A client reads everything that is there, so that nothing is lost in its own buffer.
        while (message := client.connection.recv_match(blocking=False)) is not None:
            if message.get_type() == "ATTITUDE":
                times.append(message.time_boot_ms / 1000)
        time.sleep(0.001)
    # By simulated time: on a busy machine that may be less than the wall clock's.
    simulated_s = times[-1] - times[0]
    assert simulated_s > 0.3 * seconds, times
    return (len(times) - 1) / simulated_s


@pytest.mark.parametrize("datagram", [b"\xfd", packed()], ids=["one byte", "unsigned heartbeat"])
def test_strangers_take_nothing_from_a_signed_pilot(start, connect, tmp_path, datagram):
    vehicle = start("--signing-key", str(key_file(tmp_path)))
    pilot = connect(vehicle, heartbeat=False)
    signed(pilot.connection)
    pilot.beat()
    pilot.wait("HEARTBEAT")
    quiet = attitudes(pilot, 2)
    assert quiet > 5, quiet
    host, port = vehicle.addresses[0].split(":")
    strangers = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(200)]
    start_time, sent = time.monotonic(), 0

    def attack():
        nonlocal sent
        # A thousand per second, and no more than catch up a tenth of a second.
        due = min(int((time.monotonic() - start_time) * 1000), sent + 100)
        while sent < due:
            strangers[sent % len(strangers)].sendto(datagram, (host, int(port)))
            sent += 1

    try:
        attacked = attitudes(pilot, 5, attack)
        print(f"ATTITUDE per s: {quiet:.1f} quiet, {attacked:.1f} with {sent} datagrams from {len(strangers)} ports")
        assert sent > 1000 and attacked > 0.9 * quiet
        for stranger in strangers:
            stranger.setblocking(False)
            with pytest.raises(BlockingIOError):
                stranger.recv(2048)
    finally:
        for stranger in strangers:
            stranger.close()


def drawn(sender, seconds):
    """Bytes that reach a socket."""
    count, end = 0, time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        sender.settimeout(left)
        try:
            count += len(sender.recv(65536))
        except TimeoutError:
            break
    return count


def test_a_forged_address_draws_little(start):
    """Beyond loopback: nothing for a byte, ten times its length for a frame, everything for who keeps talking."""
    host = own_address()
    vehicle = start(links=("udpin:0.0.0.0:0",))
    address = (host, int(vehicle.addresses[0].split(":")[1]))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(b"\xfd", address)
        byte = drawn(sender, 3)
        sender.sendto(packed(), address)
        # Longer than the silence that ends a talk, or the next frame would go on with it.
        frame = drawn(sender, 6)
        # A request for 900 parameters, with its answer.
        request = packed(mavlink.MAVLink_param_request_list_message(1, 1))
        sender.sendto(request, address)
        answer = drawn(sender, 3)
        for _ in range(8):
            sender.sendto(packed(), address)
            talking = drawn(sender, 1)
        # Silent again: what is on its way for five seconds, then nothing.
        drawn(sender, 6)
        silent = drawn(sender, 3)
    print(f"bytes drawn: {byte} by a byte, {frame} by a heartbeat, {answer} by a request, {talking} per s of talk, {silent} after it")
    assert byte == 0
    assert 0 < frame <= 10 * len(packed())
    assert 0 < answer <= 10 * len(request + packed())
    assert talking > 1000
    assert silent == 0


def test_loopback_needs_one_frame(start):
    """Scripts that listen after one heartbeat get all telemetry."""
    vehicle = start()
    host, port = vehicle.addresses[0].split(":")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(packed(), (host, int(port)))
        drawn(sender, 7)
        assert drawn(sender, 2) > 2000


def processor_s(process):
    """Processor time that a process has used."""
    with open(f"/proc/{process.pid}/stat") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


@pytest.fixture
def many_files():
    """Lets this process open enough sockets."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = 1400 if hard == resource.RLIM_INFINITY else min(hard, 1400)
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, wanted), hard))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


@pytest.mark.parametrize("descriptors", [40, 1024])
def test_a_thousand_idle_connections(program, launch, many_files, tmp_path, descriptors):  # noqa: F811
    """They take neither the flight nor its files, and whoever speaks gets a place."""
    make, client_of = launch
    key, parameters = key_file(tmp_path), tmp_path / "a.params"
    files = ("--record", tmp_path / "flight.lmpc", "--tlog", tmp_path / "flight.tlog", "--log-dir", tmp_path / "logs",
             "--parameters", parameters, "--signing-key", key)
    process, address = make(
        [program], "--link", "tcpin:0", *files,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (descriptors, descriptors)))
    tcp = json.loads((tmp_path / "ready0.json").read_text())["addresses"][1]
    pilot = client_of(address, heartbeat=False)
    signed(pilot.connection)
    pilot.beat()
    pilot.wait("HEARTBEAT")
    pilot.target = (1, 1)
    pilot.take_off()
    before_s = processor_s(process)
    time.sleep(2)
    quiet_s = processor_s(process) - before_s
    pilot.drain()
    host, port = tcp.split(":")
    idle = []
    try:
        for _ in range(1000):
            idle.append(socket.socket())
            idle[-1].setblocking(False)
            idle[-1].connect_ex((host, int(port)))
        # Files are opened and written meanwhile, in flight.
        pilot.mav.param_set_send(1, 1, b"MIS_TAKEOFF_ALT", 3.5, 9)
        pilot.wait("PARAM_VALUE", lambda value: value.param_id == "MIS_TAKEOFF_ALT" and value.param_value == 3.5)
        before_s, start_time = processor_s(process), time.monotonic()
        time.sleep(2)
        busy_s = processor_s(process) - before_s
        pilot.drain()
        still_flies(pilot)
        speaker = Client(tcp, kind="tcp", system=254, heartbeat=False)
        try:
            signed(speaker.connection)
            # Who connects waits behind those who were there first.
            end = time.monotonic() + 60
            while speaker.connection.recv_match(type="ATTITUDE", blocking=True, timeout=0.5) is None:
                assert time.monotonic() < end, "no place for who speaks"
                speaker.beat()
            waited_s = time.monotonic() - start_time
            speaker.drain()
            # It stays, whoever else is there.
            for _ in range(3):
                speaker.beat()
                speaker.wait("HEARTBEAT", timeout=3)
        finally:
            speaker.close()
        print(f"processor: {quiet_s:.2f} s of 2 s quiet, {busy_s:.2f} s of 2 s attacked; a place after {waited_s:.1f} s")
        assert busy_s < quiet_s + 0.5
    finally:
        for one in idle:
            one.close()
    pilot.drain()
    still_flies(pilot)
    output = ended(process, 0)
    assert "MIS_TAKEOFF_ALT\t3.5" in parameters.read_text()
    assert "not written" not in output and "cannot write" not in output, output


def test_clients_that_speak_keep_their_places(start, connect):
    """Listeners are let in while there is room, and displace one another, but nobody who speaks."""
    vehicle = start(links=("tcpin:0",))
    host, port = vehicle.addresses[0].split(":")
    speaker = connect(vehicle, kind="tcp")
    listeners = []
    try:
        listeners.append(socket.create_connection((host, int(port))))
        assert drawn(listeners[0], 1.5) > 1000, "a listener gets telemetry"
        for _ in range(40):
            listeners.append(socket.create_connection((host, int(port))))
        # The first one makes room.
        end = time.monotonic() + 10
        while True:
            assert time.monotonic() < end, "nobody made room"
            listeners[0].settimeout(1)
            if listeners[0].recv(65536) == b"":
                break
        speaker.drain()
        speaker.wait("HEARTBEAT")
        speaker.arm()
    finally:
        for one in listeners:
            one.close()
