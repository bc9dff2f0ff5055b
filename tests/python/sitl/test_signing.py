"""Signing with pymavlink and MAVProxy, in both directions."""

import hashlib
import os
import sys
import time
from subprocess import PIPE, STDOUT, Popen

from pymavlink import mavutil
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from client import own_address
from test_program import run

KEY = bytes(range(32, 64))


def key_file(folder, content=KEY.hex(), mode=0o600):
    path = folder / "signing.key"
    path.write_text(content)
    path.chmod(mode)
    return path


def signed(connection, key=KEY, **options):
    """A connection that signs, and accepts nothing that is not."""
    connection.setup_signing(key, allow_unsigned_callback=lambda mav, message_id: False, **options)


def hears(client, seconds=1.0):
    return client.connection.recv_match(type="HEARTBEAT", blocking=True, timeout=seconds) is not None


def refused(client, word):
    return client.wait("STATUSTEXT", lambda text: "rejected so far" in text.text and word in text.text, 15)


def test_a_key_file_that_others_can_read_is_refused(program, tmp_path):
    for content, mode, words in ((KEY.hex(), 0o644, "0600"), ("nonsense", 0o600, "64 hexadecimal"), (None, 0, "cannot read")):
        path = key_file(tmp_path, content, mode) if content else tmp_path / "none"
        result = run(program, "--signing-key", path, "--link", "udpin:0", "--duration", 1)
        assert result.returncode == 4 and words in result.stderr, result.stderr
        assert KEY.hex() not in result.stderr + result.stdout


def test_pymavlink_both_ways(start, connect, tmp_path):
    path = key_file(tmp_path)
    log = tmp_path / "flight.tlog"
    record = tmp_path / "flight.record"
    vehicle = start("--signing-key", str(path), "--tlog", str(log), "--record", str(record), "--speed", "5")
    client = connect(vehicle, heartbeat=False)
    signed(client.connection)
    client.beat()
    client.wait("HEARTBEAT")
    client.target = (1, 1)
    # A stranger is heard by nobody, a forger neither.
    stranger, forger = (connect(vehicle, system=system, heartbeat=False) for system in (249, 250))
    signed(forger.connection, bytes(32 * [9]))
    for other in (stranger, forger):
        other.mav.command_long_send(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
    refused(client, "1 ")
    assert not client.wait("HEARTBEAT").base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    client.take_off()
    client.land()
    assert client.mav.signing.goodsig_count > 50 and client.mav.signing.badsig_count == 0
    # The same frame again, and one of an hour ago.
    packed = mavlink.MAVLink_command_long_message(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0).pack(client.mav)
    client.connection.write(packed)
    client.wait("COMMAND_ACK", lambda ack: ack.command == mavlink.MAV_CMD_COMPONENT_ARM_DISARM)
    client.drain()
    client.connection.write(packed)
    late = connect(vehicle, system=251, heartbeat=False)
    signed(late.connection, initial_timestamp=int((time.time() - 3600 - 1420070400) * 1e5))
    late.beat()
    assert client.connection.recv_match(type="COMMAND_ACK", blocking=True, timeout=0.5) is None
    vehicle.stop()
    output = vehicle.output()
    assert all(words in output for words in ("1 unsigned", "1 forged", "1 replayed", "1 late")), output
    assert KEY.hex() not in output
    # The flight of the record is that of the accepted frames alone; neither file holds the key.
    result = run(vehicle.process.args[0], "--replay", record)
    assert result.returncode == 0, result.stderr
    for file in (log, record):
        assert KEY not in file.read_bytes() and KEY.hex().encode() not in file.read_bytes()
    reader = mavutil.mavlink_connection(str(log))
    while (message := reader.recv_match()) is not None:
        frame = message.get_msgbuf()
        assert frame[2] & 1 and frame[5] in (1, 255), message

    # What was accepted before is refused after a restart, too, even after a crash.
    vehicle = start("--signing-key", str(path))
    client = connect(vehicle, heartbeat=False)
    client.connection.write(packed)
    signed(client.connection)
    client.beat()
    assert not client.wait("HEARTBEAT").base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    assert "1 replayed" in vehicle.output()
    packed = mavlink.MAVLink_command_long_message(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0).pack(client.mav)
    client.connection.write(packed)
    client.wait("COMMAND_ACK")
    vehicle.process.kill()
    vehicle.process.wait()
    vehicle.process.returncode = 0
    again = start("--signing-key", str(path))
    other = connect(again, heartbeat=False)
    other.connection.write(packed)
    signed(other.connection, link_id=7)
    other.beat()
    assert not other.wait("HEARTBEAT").base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    assert "1 replayed" in again.output()
    assert oct(os.stat(f"{path}.timestamps").st_mode)[-3:] == "600"


def test_setup_signing_from_pymavlink(start, connect, tmp_path):
    path = key_file(tmp_path, "")
    log = tmp_path / "flight.tlog"
    vehicle = start("--signing-key", str(path), "--accept-signing-setup", "--tlog", str(log), "--record", str(tmp_path / "record"),
                    links=("udpin:0", "tcpin:0"))
    client = connect(vehicle)
    other = connect(vehicle, 1, kind="tcp", system=252)
    client.mav.setup_signing_send(1, 1, list(KEY), 0)
    client.wait("STATUSTEXT", lambda text: "key set by 255" in text.text)
    signed(client.connection)
    client.arm()
    assert path.read_text().strip() == KEY.hex() and oct(path.stat().st_mode)[-3:] == "600"
    # Others are not heard any more, and were never told the key.
    other.mav.command_long_send(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 0, 0, 0, 0, 0, 0, 0)
    assert other.connection.recv_match(type="COMMAND_ACK", blocking=True, timeout=0.5) is None
    other.drain()
    assert "SETUP_SIGNING" not in other.connection.messages
    # The key is removed by a key of zeros, by who knows it.
    other.mav.setup_signing_send(1, 1, [0] * 32, 0)
    assert other.connection.recv_match(type="STATUSTEXT", blocking=True, timeout=0.3) is None
    client.mav.setup_signing_send(1, 1, [0] * 32, 0)
    client.wait("STATUSTEXT", lambda text: "refused: armed" in text.text)
    client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
    client.mav.setup_signing_send(1, 1, [0] * 32, 0)
    client.connection.disable_signing()
    client.wait("STATUSTEXT", lambda text: "key removed by 255" in text.text)
    client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    vehicle.stop()
    assert path.read_text() == ""
    for file in (log, tmp_path / "record", vehicle.folder / "output.txt"):
        assert KEY not in file.read_bytes() and KEY.hex().encode() not in file.read_bytes()


def test_a_key_is_that_of_all_vehicles_each_with_its_own_streams(start, connect, tmp_path):
    path = key_file(tmp_path, "")
    options = ("--signing-key", str(path), "--accept-signing-setup", "--vehicles", "2", "--speed", "5")
    vehicle = start(*options)
    first, second = clients = [connect(vehicle, number) for number in range(2)]
    assert [client.target[0] for client in clients] == [1, 2]
    first.mav.setup_signing_send(1, 1, list(KEY), 0)
    first.wait("STATUSTEXT", lambda text: "key set by 255" in text.text)
    # The other vehicle, behind links of its own, hears nobody unsigned from now on either, and signs.
    second.drain()
    second.mav.command_long_send(2, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
    refused(second, "1 unsigned")
    assert second.wait("HEARTBEAT").get_header().incompat_flags & 1
    packed = []
    for client in clients:
        # Both are link 0 of 255/0 and count from the same instant: streams of one hub are not those of the other.
        signed(client.connection, initial_timestamp=int((time.time() - 1420070400) * 1e5))
        packed.append(mavlink.MAVLink_command_long_message(
            *client.target, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0).pack(client.mav))
        client.connection.write(packed[-1])
        assert client.wait("COMMAND_ACK", lambda ack: ack.command == mavlink.MAV_CMD_COMPONENT_ARM_DISARM).result == 0
        assert client.mav.signing.badsig_count == 0
    assert vehicle.stop() == 0
    assert {file.name for file in tmp_path.glob("signing.key*")} == {
        "signing.key", "signing.key.timestamps", "signing.key.timestamps.1"}
    assert all(file.stat().st_mode & 0o777 == 0o600 for file in tmp_path.glob("signing.key*"))

    # After a restart each remembers its own: neither takes the same frame again.
    vehicle = start(*options)
    clients = [connect(vehicle, number, heartbeat=False) for number in range(2)]
    for client, frame in zip(clients, packed):
        client.connection.write(frame)
        signed(client.connection)
        client.beat()
        # Only now it has a place and hears what is refused.
        client.connection.write(frame)
        refused(client, "2 replayed")
        assert not client.wait("HEARTBEAT").base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    # Removed at one, it is removed at the other.
    clients[1].mav.setup_signing_send(2, 1, [0] * 32, 0)
    for client in clients:
        client.connection.disable_signing()
        client.wait("HEARTBEAT", lambda beat: not beat.get_header().incompat_flags & 1)
    assert path.read_text() == ""


def test_mavproxy_sets_a_key_and_flies_with_it(start, connect, tmp_path):
    vehicle = start("--autopilot", "ardupilot", "--accept-signing-setup", links=("tcpin:0", "udpin:0"))
    proxy = Popen(
        [sys.executable, "-m", "MAVProxy.mavproxy", f"--master=tcp:{vehicle.addresses[0]}", f"--state-basedir={tmp_path}",
         "--default-modules=signing,arm,mode,cmdlong", "--aircraft=signed"],
        stdin=PIPE, stdout=PIPE, stderr=STDOUT, text=True, cwd=tmp_path, env={**os.environ, "HOME": str(tmp_path)},
    )
    witness = connect(vehicle, 1, system=252)
    try:
        proxy.stdin.write("signing setup a-good-passphrase\n")
        proxy.stdin.flush()
        witness.wait("STATUSTEXT", lambda text: "key set by" in text.text, 20)
        signed(witness.connection, hashlib.sha256(b"a-good-passphrase").digest())
        proxy.stdin.write("mode GUIDED\narm throttle force\n")
        proxy.stdin.flush()
        witness.wait("HEARTBEAT", lambda beat: beat.get_srcSystem() == 1 and beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 15)
        assert witness.mav.signing.goodsig_count > 0
    finally:
        proxy.terminate()
        output, _ = proxy.communicate(timeout=10)
    assert "Sent secret_key" in output, output


def far_address(vehicle):
    """An address of the vehicle that is not loopback; what is sent to it does not leave this machine."""
    return f"{own_address()}:{vehicle.addresses[0].split(':')[1]}"


def test_a_key_that_nobody_asked_for_is_refused(start, connect, program, tmp_path):
    """One unsigned message must not lock all pilots out."""
    vehicle = start()
    pilot, attacker = connect(vehicle), connect(vehicle, system=66)
    for _ in range(100):
        attacker.mav.setup_signing_send(1, 1, list(KEY), 0)
    # Two pieces, one cut where it is full.
    first = pilot.wait("STATUSTEXT", lambda text: text.text.startswith("Signing: setup by 66/0 refused: restart with"))
    second = pilot.wait("STATUSTEXT", lambda text: text.id == first.id and text.chunk_seq == 1)
    assert "restart with --accept-signing-setup to allow it" in first.text + second.text
    pilot.arm()
    pilot.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
    assert not pilot.wait("HEARTBEAT").get_header().incompat_flags & 1
    # A hundred of them are one line.
    assert vehicle.output().count("refused: restart") <= 2, vehicle.output()
    # An empty key file is no key, unless a client may bring it.
    path = key_file(tmp_path, "")
    result = run(program, "--signing-key", path, "--link", "udpin:0", "--duration", 1)
    assert result.returncode == 4 and "is empty" in result.stderr and "--accept-signing-setup" in result.stderr, result.stderr


def test_where_and_when_a_key_may_be_set(start, connect):
    vehicle = start("--accept-signing-setup", links=("udpin:0.0.0.0:0",))
    near = connect(type("Loopback", (), {"addresses": [f"127.0.0.1:{vehicle.addresses[0].split(':')[1]}"]}))
    far = connect(type("Network", (), {"addresses": [far_address(vehicle)]}), system=66, heartbeat=False)

    def refused_because(client, words, timestamp=0, key=KEY):
        # Refusals are told every five seconds.
        end = time.monotonic() + 20
        while time.monotonic() < end:
            client.mav.setup_signing_send(1, 1, list(key), timestamp)
            text = near.connection.recv_match(type="STATUSTEXT", blocking=True, timeout=0.5)
            if text is not None and words in text.text:
                return
        raise AssertionError(f"not said: {words}")

    refused_because(far, "refused: not a local")
    day_ahead = int((time.time() + 86400 - 1420070400) * 1e5)
    refused_because(near, "refused: initial_timestamp", day_ahead)
    near.arm()
    refused_because(near, "refused: armed")
    near.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
    near.mav.setup_signing_send(1, 1, list(KEY), int((time.time() - 1420070400) * 1e5))
    near.wait("STATUSTEXT", lambda text: "key set by 255" in text.text)
    signed(near.connection)
    # Another key by who knows the present one, and no longer by anybody else.
    other_key = bytes(32 * [9])
    near.mav.setup_signing_send(1, 1, list(other_key), 0)
    near.connection.disable_signing()
    signed(near.connection, other_key)
    near.arm()


def test_clocks_ahead_lock_out_nobody(start, connect, tmp_path):
    """A day, and 80 years: with the stream of an honest pilot, and with others."""
    vehicle = start("--signing-key", str(key_file(tmp_path)))
    pilot = connect(vehicle, heartbeat=False)
    now = lambda: int((time.time() - 1420070400) * 1e5)  # noqa: E731
    for ahead_s in (86400, 80 * 365 * 86400):
        for system in (255, 250):
            wrong = connect(vehicle, system=system, heartbeat=False)
            signed(wrong.connection, initial_timestamp=min(now() + int(ahead_s * 1e5), (1 << 48) - 100))
            for _ in range(5):
                wrong.beat()
    signed(pilot.connection, initial_timestamp=now())
    pilot.beat()
    pilot.wait("HEARTBEAT")
    pilot.target = (1, 1)
    pilot.arm()
    assert "early; compare the clocks" in vehicle.output()
    # Neither after a restart.
    vehicle.stop()
    vehicle = start("--signing-key", str(tmp_path / "signing.key"))
    pilot = connect(vehicle, heartbeat=False)
    signed(pilot.connection, initial_timestamp=now())
    pilot.beat()
    pilot.wait("HEARTBEAT")
    pilot.target = (1, 1)
    pilot.arm()
