"""What a person sees: the program in a pseudo-terminal of several sizes, and in pipes."""

import fcntl
import os
import pty
import re
import select
import signal
import socket
import struct
import subprocess
import termios
import time

import pytest
from pymavlink.dialects.v20 import common

CLEAR = "\r\x1b[K"


class Screen:
    """What a terminal shows that wraps what is too long for it, and wraps it again when its width changes. It knows what the program
    sends, and no more: lines, returns, cursor up, erase to the end of the line or of the screen, colours."""

    PIECE = re.compile("\x1b\\[(\\d*)([A-Za-z])|\r|\n|[^\x1b\r\n]")

    def __init__(self, columns):
        self.columns, self.lines, self.line, self.column = columns, [""], 0, 0

    def feed(self, text):
        for piece in self.PIECE.finditer(text):
            if piece[0] == "\r":
                self.column -= self.column % self.columns
            elif piece[0] == "\n":
                self.down()
            elif piece[2] == "A":
                for _ in range(int(piece[1])):
                    self.up()
            elif piece[2] in ("K", "J"):
                # To the end of the line: the program does this in the last row of one only.
                self.lines[self.line] = self.lines[self.line][:self.column]
                if piece[2] == "J":
                    del self.lines[self.line + 1:]
            elif piece[2] is None:
                shown = self.lines[self.line].ljust(self.column)
                self.lines[self.line] = shown[:self.column] + piece[0] + shown[self.column + 1:]
                self.column += 1
            else:
                assert piece[2] == "m", f"unknown sequence {piece[0]!r}"

    def up(self):
        if self.column >= self.columns:
            self.column -= self.columns
        elif self.line:
            self.line -= 1
            last_row = max(0, len(self.lines[self.line]) - 1) // self.columns
            self.column += last_row * self.columns

    def down(self):
        if self.column // self.columns < max(0, len(self.lines[self.line]) - 1) // self.columns:
            self.column += self.columns
        else:
            self.line, self.column = self.line + 1, self.column % self.columns
            self.lines += [""] * (self.line + 1 - len(self.lines))


class Terminal:
    """A pseudo-terminal in which the program runs."""

    def __init__(self, program, *arguments, columns=80, rows=24, environment=None):
        self.master, self.slave = pty.openpty()
        self.screen, self.output, self.rows = Screen(columns), "", rows
        self.resize(columns)
        self.settings = termios.tcgetattr(self.slave)
        self.process = subprocess.Popen([program, *map(str, arguments)], stdin=self.slave, stdout=self.slave, stderr=self.slave,
                                        env={"TERM": "xterm", **(environment or {})})

    def resize(self, columns):
        self.screen.columns = columns
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", self.rows, columns, 0, 0))

    def read(self, until=lambda terminal: False, timeout=30.0):
        """Reads until a condition holds, or to the end of the program."""
        deadline = time.monotonic() + timeout
        while not until(self):
            assert time.monotonic() < deadline, f"not within {timeout} s: {self.output!r}"
            # Looked at before reading: what it has written before its end is there by then.
            ended = self.process.poll() is not None
            if select.select([self.master], [], [], 0.0 if ended else 0.05)[0]:
                piece = os.read(self.master, 65536).decode(errors="replace")
                self.output += piece
                self.screen.feed(piece)
            elif ended:
                return

    def shows(self, pattern):
        return any(re.search(pattern, line) for line in self.screen.lines)

    def has_panel(self, last="0 clients"):
        """Whether a panel has been drawn to its last line, and the cursor stands below it: a drawing may arrive in pieces."""
        *_, line, below = ["", *self.screen.lines]
        return last in line and below == "" and self.screen.column == 0

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self.master)
        os.close(self.slave)


@pytest.fixture
def terminal(program):
    """Starts the program in a terminal."""
    opened = []

    def make(*arguments, **options):
        opened.append(Terminal(program, *arguments, **options))
        return opened[-1]

    yield make
    for terminal in opened:
        terminal.close()


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
LINE = (*FLIGHT, "--no-panel")


@pytest.mark.parametrize("columns", [20, 40, 80, 120])
def test_the_status_line_never_wraps(program, columns):
    lines = status_lines(watch(program, *LINE, "--vehicles", 3, "--ports", "shared", columns=columns))
    lines += status_lines(watch(program, *LINE, columns=columns))
    assert len(lines) >= 4, lines
    assert all(len(line) < columns for line in lines), lines
    assert any("disarmed Hold" in line for line in lines) and any("0 of 3 armed" in line for line in lines)
    if columns >= 120:  # room for all
        assert all(word in lines[-1] for word in (" s  ", "x  ", "N   0.0 E   0.0 up  0.0 m", "battery 100 %", "0 clients")), lines


@pytest.mark.parametrize("columns", [40, 80, 120])
def test_the_panel_follows_the_flight_and_goes(terminal, columns):
    """A line each for state, motion, supply and link; the log stands above it, and at the end nothing of it is left."""
    flown = terminal(*FLIGHT, "--wind", 30, columns=columns)
    flown.read(lambda it: it.shows("disarmed Hold") and it.has_panel())
    panel = [line for line in flown.screen.lines if line][-4:]
    words = ["disarmed Hold", "N   0.0 E   0.0 up  0.0 m", "battery 100 %", "0 clients"]
    assert all(word in line for word, line in zip(words, panel, strict=True)), panel
    assert all(len(line) < columns for line in panel), panel
    if columns >= 80:
        assert all(word in " ".join(panel) for word in (" s  ", "x  ", "speed  0.0 m/s", "climb  0.0 m/s", " V ")), panel
    assert flown.screen.column == 0 and flown.screen.lines[-1] == "", "the cursor is below it"
    flown.read()
    assert flown.process.wait(10) == 0
    left = [line for line in flown.screen.lines if line]
    assert not any(word in line for line in left for word in words), left
    assert "flight digest" in left[-1] and any("it will be blown away" in line for line in left), left
    assert flown.shows("^lmpc-sitl ") and termios.tcgetattr(flown.slave) == flown.settings


def test_a_panel_that_is_resized_leaves_nothing_behind(terminal):
    flown = terminal("--link", "udpin:0", columns=100)
    for columns in (100, 45, 120, 30):
        flown.resize(columns)
        shown = len(flown.output)
        # The second one from here on knows the width for certain.
        flown.read(lambda it: it.output[shown:].count("disarmed Hold") >= 2 and it.has_panel())
        counted = sum("disarmed Hold" in line for line in flown.screen.lines)
        assert counted == 1 and flown.shows("^lmpc-sitl "), flown.screen.lines
        assert all(len(line) < columns for line in flown.screen.lines[-5:]), flown.screen.lines
    flown.process.send_signal(signal.SIGINT)
    flown.read()
    assert flown.process.wait(10) == 0 and not flown.shows("disarmed"), flown.screen.lines


def test_a_program_that_is_killed_leaves_the_terminal_as_it_was(terminal):
    flown = terminal("--link", "udpin:0")
    flown.read(lambda it: it.shows("disarmed Hold"))
    flown.process.kill()
    flown.read()
    # A shell's prompt begins in a line of its own, and echoes as before.
    assert flown.screen.column == 0 and flown.screen.lines[-1] == ""
    assert termios.tcgetattr(flown.slave) == flown.settings
    assert not re.search(r"\x1b\[[?\d;]*[rhl]", flown.output), "no mode, no scroll region"


def test_what_was_written_while_it_was_stopped_stays(terminal):
    flown = terminal("--link", "udpin:0")
    flown.read(lambda it: it.shows("disarmed Hold"))
    flown.process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, flown.process.pid, os.WSTOPPED | os.WNOWAIT)
    flown.read(lambda it: not select.select([it.master], [], [], 0.0)[0])
    flown.screen.feed("$ date\r\nMonday\r\n$ fg\r\n")
    shown = len(flown.output)
    flown.process.send_signal(signal.SIGCONT)
    flown.read(lambda it: it.output[shown:].count("disarmed Hold") >= 2 and it.has_panel())
    assert flown.shows("Monday") and flown.shows("fg"), flown.screen.lines
    assert "disarmed Hold" in flown.screen.lines[-5], flown.screen.lines


def test_the_panel_of_a_fleet_has_a_line_for_each_vehicle_that_there_is_room_for(terminal):
    three = terminal(*FLIGHT, "--vehicles", 3)
    three.read(lambda it: it.shows("0 of 3 armed") and it.shows("^id   3 ") and it.has_panel())
    for number in (1, 2, 3):
        assert three.shows(f"^id   {number}  disarmed Hold .*battery 100 %  0 clients"), three.screen.lines
    low = terminal(*FLIGHT, "--vehicles", 9, "--ports", "shared", rows=10)
    low.read(lambda it: it.shows("0 of 9 armed") and it.has_panel("and 7 more vehicles"))
    panel = [line for line in low.screen.lines if line][-5:]
    assert "0 of 9 armed" in panel[0] and "0 clients" in panel[1] and panel[4] == "and 7 more vehicles", panel


def test_a_terminal_without_height_for_a_panel_has_a_line(terminal):
    low = terminal(*FLIGHT, rows=6)
    low.read(lambda it: it.shows("disarmed Hold.*battery"))
    assert "battery 100 %" in low.screen.lines[-1], low.screen.lines


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
        output = watch(program, "--link", link, "--no-panel", columns=100, until="1 client", meanwhile=answer)
        assert re.search(r"1 client(?!s)", output), output
        output = watch(program, "--link", link, columns=100, until="1 client", meanwhile=answer)
    assert re.search(r" 1 client  UDP to 127", output), output


def test_the_simulator_of_an_external_autopilot_has_one_too(program):
    output = watch(program, "--hil", 0, "--no-panel", columns=40, until="waiting for an autopilot")
    assert all(len(line) < 40 for line in status_lines(output)), output


def test_no_color_and_dumb_terminals(program):
    windy = ("--wind", "30", *FLIGHT)
    coloured = watch(program, *windy)
    assert "\x1b[33m" in coloured and "\x1b[J" in coloured, coloured
    plain = watch(program, *windy, environment={"NO_COLOR": "1"})
    assert "\x1b[" in plain and not re.search(r"\x1b\[[0-9;]*m", plain), "no colour, but a panel"
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
@pytest.mark.parametrize("flags", [("-h",), ("--help",), ("--help", "all")])
def test_help_fits_the_terminal(program, columns, flags):
    lines = watch(program, *flags, columns=columns).splitlines()
    assert all(len(line) <= max(columns, 60) for line in lines), [line for line in lines if len(line) > columns]
    if len(flags) == 1 and columns >= 80:
        assert len(lines) <= 50, len(lines)
