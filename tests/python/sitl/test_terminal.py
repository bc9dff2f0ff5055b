"""What a person sees: the program in a pseudo-terminal of several widths, and in pipes."""

import fcntl
import os
import pty
import re
import select
import socket
import struct
import subprocess
import termios
import time

import pytest
from pymavlink.dialects.v20 import common

CLEAR = "\r\x1b[K"


def watch(program, *arguments, columns=80, environment=None, until=None, meanwhile=lambda: None,
          timeout=30.0):
    """Runs the program in a terminal of so many columns to its end, or until its output matches; returns the output."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    process = subprocess.Popen([program, *map(str, arguments)], stdin=slave, stdout=slave, stderr=slave,
                               env={"TERM": "xterm", **(environment or {})})
    os.close(slave)
    output, deadline = b"", time.monotonic() + timeout
    try:
        while time.monotonic() < deadline:
            meanwhile()
            if not select.select([master], [], [], 0.1)[0]:
                continue
            try:
                piece = os.read(master, 65536)
            except OSError:  # the other end is closed
                break
            output += piece
            if not piece or (until and re.search(until, output.decode(errors="replace"))):
                break
        else:
            raise AssertionError(f"not within {timeout} s: {output!r}")
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        os.close(master)
    return output.decode()


def status_lines(output):
    """What was written over, without lines of the log and of the summary, which stay."""
    pieces = [piece.split("\r")[0] for piece in output.split(CLEAR)[1:]]
    return [piece for piece in pieces if piece and not re.match(r"(\x1b\[2m)?\d{4}-|system ", piece)]


FLIGHT = ("--link", "udpin:0", "--duration", "2.2", "--speed", "1")


@pytest.mark.parametrize("columns", [20, 40, 80, 120])
def test_the_status_line_never_wraps(program, columns):
    lines = status_lines(watch(program, *FLIGHT, "--vehicles", 3, "--ports", "shared", columns=columns))
    lines += status_lines(watch(program, *FLIGHT, columns=columns))
    assert len(lines) >= 4, lines
    assert all(len(line) < columns for line in lines), lines
    assert any("disarmed Hold" in line for line in lines) and any("0 of 3 armed" in line for line in lines)
    if columns >= 120:  # room for all
        assert all(word in lines[-1] for word in (" s  ", "x  ", "N   0.0 E   0.0 up  0.0 m", "battery 100 %", "0 clients")), lines


def test_one_client_is_one_client(program):
    mav = common.MAVLink(None, srcSystem=255, srcComponent=190)
    heartbeat = mav.heartbeat_encode(common.MAV_TYPE_GCS, common.MAV_AUTOPILOT_INVALID, 0, 0, common.MAV_STATE_ACTIVE).pack(mav)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.bind(("127.0.0.1", 0))
        client.setblocking(False)

        def answer():
            try:
                client.sendto(heartbeat, client.recvfrom(4096)[1])
            except BlockingIOError:
                pass

        link = f"udpout:127.0.0.1:{client.getsockname()[1]}"
        output = watch(program, "--link", link, columns=100, until="1 client", meanwhile=answer)
    assert re.search(r"1 client(?!s)", output), output


def test_the_simulator_of_an_external_autopilot_has_one_too(program):
    output = watch(program, "--hil", 0, columns=40, until="waiting for an autopilot")
    assert all(len(line) < 40 for line in status_lines(output)), output


def test_no_color_and_dumb_terminals(program):
    windy = ("--wind", "30", *FLIGHT)
    coloured = watch(program, *windy)
    assert "\x1b[33m" in coloured and CLEAR in coloured, coloured
    plain = watch(program, *windy, environment={"NO_COLOR": "1"})
    assert "\x1b[" in plain and not re.search(r"\x1b\[[0-9;]*m", plain), "no colour, but a status line"
    dumb = watch(program, *windy, environment={"TERM": "dumb"})
    assert "\x1b" not in dumb and "WARN" in dumb, dumb


def test_pipes_get_no_status_line_and_no_colour(program):
    result = subprocess.run([program, "--wind", "30", *FLIGHT], capture_output=True, text=True, timeout=60, env={"TERM": "xterm"})
    assert result.returncode == 0 and "\x1b" not in result.stdout + result.stderr and "\r" not in result.stdout + result.stderr
    assert "it will be blown away" in result.stderr


def test_the_log_has_simulation_time(program):
    result = subprocess.run([program, "--link", "udpin:0", "--speed", "max", "--duration", "3", "--fault", "1.5:battery=off"],
                            capture_output=True, text=True, timeout=60, env={})
    stamps = {float(match[1]) for match in re.finditer(r"^\d{4}-\S+Z +(\d+\.\d{3})s +[A-Z]+ ", result.stderr, re.MULTILINE)}
    assert any(1.49 <= stamp <= 1.6 for stamp in stamps), result.stderr
    assert len(stamps) > 0 and len(re.findall(r"^\d{4}-", result.stderr, re.MULTILINE)) == len(result.stderr.splitlines()), result.stderr


@pytest.mark.parametrize("columns", [40, 80, 120])
@pytest.mark.parametrize("flag", ["-h", "--help"])
def test_help_fits_the_terminal(program, columns, flag):
    lines = watch(program, flag, columns=columns).splitlines()
    assert all(len(line) <= max(columns, 60) for line in lines), [line for line in lines if len(line) > columns]
    if flag == "-h" and columns >= 80:
        assert len(lines) <= 50, len(lines)
