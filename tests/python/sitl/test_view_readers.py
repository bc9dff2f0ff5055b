"""Clients of the live page that read nothing: the flight is the same, and takes no more memory."""

import re
import socket
import subprocess

READERS = 20
FLIGHT = ("--vehicles", "10", "--speed", "max", "--duration", "60")


def digests(vehicle):
    """Those of all vehicles, once the flight has ended."""
    assert vehicle.process.wait(120) == 0, vehicle.output()
    found = re.findall(r"flight digest ([0-9a-f]{16})", vehicle.output())
    assert len(found) == 10, vehicle.output()
    return found


def subscribed(address):
    """A client that has asked for the stream of states and never reads it."""
    client = socket.socket()
    # The least room that the system gives.
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
    client.settimeout(20)
    client.connect(address)
    host = f"{address[0]}:{address[1]}"
    client.sendall((
        f"GET /stream HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
    ).encode())
    answer = client.recv(12)
    assert answer == b"HTTP/1.1 101", answer
    return client


def peaks_kb(process):
    """The most memory that a process has had so far, again and again until it ends."""
    while process.poll() is None:
        with open(f"/proc/{process.pid}/status") as status:
            # Not there in the instant in which it ends.
            if peak := re.search(r"VmHWM:\s+(\d+)", status.read()):
                yield int(peak[1])
        try:
            process.wait(0.05)
        except subprocess.TimeoutExpired:
            pass


def test_clients_that_read_nothing_change_no_flight_and_take_no_memory(start):
    expected = digests(start(*FLIGHT))
    vehicle = start("--view", "127.0.0.1:0", *FLIGHT)
    port = int(re.search(r"http://127\.0\.0\.1:(\d+)/", vehicle.output())[1])
    readers = [subscribed(("127.0.0.1", port)) for _ in range(READERS)]
    try:
        begun, *_, last = peaks_kb(vehicle.process)
        assert digests(vehicle) == expected
    finally:
        for reader in readers:
            reader.close()
    assert last < begun + 10_000, f"{begun} kB when all had asked, {last} kB at the end"
