"""Links: TCP, serial, several clients at once, forwarding, MAVLink 1."""

import os
import pty
import time
import tty

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import ardupilotmega as mavlink


def test_two_clients_at_once_over_udp_and_tcp(start, connect):
    vehicle = start(links=("udpin:0", "tcpin:0", "udpin:0,onboard"))
    one = connect(vehicle, 0, system=250)
    two = connect(vehicle, 0, system=251)
    three = connect(vehicle, 1, kind="tcp", system=252)
    four = connect(vehicle, 1, kind="tcp", system=253)
    # Each gets the answer to its own question, and only that.
    for client in (one, two, three, four):
        client.drain()
    three.command(mavlink.MAV_CMD_REQUEST_PROTOCOL_VERSION, 1)
    assert three.connection.messages["COMMAND_ACK"].target_system == 252
    for client in (one, two, four):
        assert client.connection.recv_match(type="PROTOCOL_VERSION", blocking=True, timeout=0.3) is None
    # A change is told to everyone.
    one.set_parameter("MIS_TAKEOFF_ALT", 3.0)
    for client in (two, three, four):
        client.wait("PARAM_VALUE", lambda value: value.param_id == "MIS_TAKEOFF_ALT" and value.param_value == 3.0)
    # One arms, all see it.
    two.arm()
    for client in (one, three, four):
        client.wait("HEARTBEAT", lambda beat: beat.get_srcSystem() == 1 and beat.base_mode & 128)
    # Rates are a link's own.
    one.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ATTITUDE, -1)
    one.drain()
    assert one.connection.recv_match(type="ATTITUDE", blocking=True, timeout=0.5) is None
    three.drain()
    three.wait("ATTITUDE", timeout=1)


def test_forwarding_reaches_others_once(start, connect):
    vehicle = start(links=("udpin:0", "tcpin:0"))
    sender = connect(vehicle, 0, system=200)
    receiver = connect(vehicle, 1, kind="tcp", system=201)
    third = connect(vehicle, 0, system=202)
    # For one system only.
    sender.mav.ping_send(1, 77, 201, 0)
    assert receiver.wait("PING", lambda ping: ping.seq == 77).get_srcSystem() == 200
    assert third.connection.recv_match(type="PING", blocking=True, timeout=0.3) is None
    # For all: once each, and not back.
    sender.mav.statustext_send(mavlink.MAV_SEVERITY_INFO, b"hello")
    for client in (receiver, third):
        client.wait("STATUSTEXT", lambda text: text.text == "hello")
    for client in (sender, receiver, third):
        again = client.connection.recv_match(type="STATUSTEXT", condition="STATUSTEXT.text=='hello'", blocking=True, timeout=0.3)
        assert again is None


def test_serial_over_a_pseudo_terminal(start):
    ours, theirs = pty.openpty()
    tty.setraw(ours)
    tty.setraw(theirs)
    start(links=(f"serial:{os.ttyname(theirs)}:115200",))
    mav = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
    mav.robust_parsing = True
    os.set_blocking(ours, False)

    def wait(kind, condition=lambda message: True, timeout=5.0):
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            try:
                messages = mav.parse_buffer(os.read(ours, 4096)) or []
            except BlockingIOError:
                time.sleep(0.01)
                continue
            for message in messages:
                if message.get_type() == kind and condition(message):
                    return message
        raise AssertionError(f"no {kind}")

    wait("HEARTBEAT")
    arm = mavlink.MAVLink_command_long_message(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
    os.write(ours, arm.pack(mav))
    assert wait("COMMAND_ACK").result == mavlink.MAV_RESULT_ACCEPTED
    wait("HEARTBEAT", lambda beat: beat.base_mode & 128)
    os.close(ours)
    os.close(theirs)


def test_mavlink_1(start):
    vehicle = start()
    from pymavlink.dialects.v10 import common as old

    connection = mavutil.mavudp(vehicle.addresses[0], input=False)
    mav = old.MAVLink(None, srcSystem=255, srcComponent=190)
    mav.robust_parsing = True
    for sequence in range(4):
        mav.seq = sequence
        connection.port.sendto(old.MAVLink_heartbeat_message(6, 8, 0, 0, 0, 3).pack(mav), connection.destination_addr)
    end = time.monotonic() + 5
    kinds = set()
    sent = False
    connection.port.setblocking(True)
    connection.port.settimeout(1)
    while time.monotonic() < end and not {"ATTITUDE", "COMMAND_ACK"} <= kinds:
        data, _ = connection.port.recvfrom(65536)
        if data[0] != 0xFE:
            continue
        if not sent:
            sent = True
            take_off = old.MAVLink_command_long_message(1, 1, old.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
            connection.port.sendto(take_off.pack(mav), connection.destination_addr)
        kinds |= {message.get_type() for message in mav.parse_buffer(data) or []}
    assert {"ATTITUDE", "COMMAND_ACK"} <= kinds, kinds
    connection.close()


def test_default_links_are_px4s(start, connect):
    # A number far from what may run on this machine.
    vehicle = start("--instance", "117", links=())
    assert vehicle.addresses == ["127.0.0.1:18687", "127.0.0.1:14697"]
    assert connect(vehicle).target == (118, 1)
    assert vehicle.stop() == 0
    # PX4 has ten ports for programs; the vehicles from the tenth on share the last.
    assert "udpin:127.0.0.1:14549" in vehicle.output()


@pytest.mark.parametrize("noise", [b"\xfd" * 600, bytes(range(256)) * 4, b"\xfe\x21\x00\xff"])
def test_noise_on_a_link(start, connect, noise):
    vehicle = start(links=("udpin:0", "tcpin:0"))
    client = connect(vehicle, 1, kind="tcp")
    other = connect(vehicle, 0)
    for _ in range(50):
        client.connection.port.send(noise)
        other.connection.port.sendto(noise, other.connection.destination_addr)
    client.arm()
    assert vehicle.process.poll() is None
