"""Flies the MAVLink vehicle by an example."""

import json
import os
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import flight_log

#: The examples to fly.
FLIGHTS = ("position_target", "circle")

#: The vehicle's time goes as fast as the example answers, so that the flight is the same on every machine.
PACE = ("--speed", "max", "--lockstep", "always")


@dataclass(frozen=True)
class Flight:
    """A flight that has ended."""

    name: str
    #: What the example printed.
    lines: list[str]
    plot: Path
    log: Path
    #: Whether it met its goals.
    met: bool


def plot_file(name: str, folder: Path) -> Path:
    """Where the example draws its plot."""
    return folder / f"mavlink-{name.replace('_', '-')}.png"


def log_file(name: str, folder: Path) -> Path:
    """Where the vehicle's own log of the flight is kept."""
    return plot_file(name, folder).with_suffix(".ulg")


def fly(name: str, program: Path, examples: Path, folder: Path) -> Flight:
    """Flies an example on a vehicle of its own."""
    plot, log = plot_file(name, folder), log_file(name, folder)
    with TemporaryDirectory(dir=folder) as logs:
        with running(program, Path(logs)) as address:
            done = subprocess.run(
                [sys.executable, examples / f"{name}.py", "--connect", f"udpout:{address}", "--plot", plot],
                stdout=subprocess.PIPE, text=True, timeout=300,
            )
        # One flight, one log.
        (written,) = Path(logs).glob("*.ulg")
        written.replace(log)
    lines = [line for line in done.stdout.splitlines() if not line.startswith("wrote ")]
    return Flight(name, lines, plot, log, done.returncode == 0)


def draw_log(flight: Flight) -> list[Path]:
    """Draws what the log shows, and returns all files of the flight."""
    drawn = flight.plot.with_name(f"{flight.plot.stem}-log.png")
    flight_log.draw(flight.log, drawn, f"{flight.name.replace('_', ' ')}, from the vehicle's log")
    return [flight.plot, flight.log, drawn]


@contextmanager
def running(program: Path, logs: Path):
    """A vehicle on a free port of this machine that logs its flights; gives its address, and ends it afterwards."""
    with TemporaryDirectory() as folder:
        ready = Path(folder) / "ready.json"
        settings = {name: value for name, value in os.environ.items() if not name.startswith("LMPC_SITL_")}
        process = subprocess.Popen(
            [program, "--link", "udpin:0", *PACE, "--log", "warn", "--log-dir", logs, "--ready-file", ready],
            stdout=subprocess.DEVNULL, env=settings,
        )
        try:
            end = time.monotonic() + 20
            while not ready.exists():
                if process.poll() is not None or time.monotonic() > end:
                    raise RuntimeError(f"{program} did not start")
                time.sleep(0.01)
            yield json.loads(ready.read_text())["addresses"][0]
        finally:
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
