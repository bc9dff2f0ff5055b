"""Flies the MAVLink vehicle by the examples, as a user would."""

import json
import os
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import flight_log

#: The examples to fly, and what their plots show.
FLIGHTS = ("position_target", "circle")

#: Simulated seconds per second.
SPEED = 2


def fly(name: str, program: Path, examples: Path, folder: Path) -> tuple[list[str], list[Path], bool]:
    """Flies an example on a vehicle of its own; returns the lines that it prints, its plot, the vehicle's log and what that shows,
    and whether it met its goals."""
    plot = folder / f"mavlink-{name.replace('_', '-')}.png"
    logs = folder / "logs"
    before = set(logs.glob("*.ulg"))
    with running(program, logs) as address:
        done = subprocess.run(
            [sys.executable, examples / f"{name}.py", "--connect", f"udpout:{address}", "--plot", plot],
            stdout=subprocess.PIPE, text=True, timeout=300,
        )
    lines = [line for line in done.stdout.splitlines() if not line.startswith("wrote ")]
    files = [plot]
    for log in sorted(set(logs.glob("*.ulg")) - before):
        kept = log.replace(plot.with_suffix(".ulg"))
        drawn = plot.with_name(f"{plot.stem}-log.png")
        flight_log.draw(kept, drawn, f"{name.replace('_', ' ')}, from the vehicle's log")
        files += [kept, drawn]
    logs.rmdir()
    return lines, files, done.returncode == 0


@contextmanager
def running(program: Path, logs: Path):
    """A vehicle on a free port of this machine that logs its flights, and its address; it is ended afterwards."""
    with TemporaryDirectory() as folder:
        ready = Path(folder) / "ready.json"
        settings = {name: value for name, value in os.environ.items() if not name.startswith("LMPC_SITL_")}
        process = subprocess.Popen(
            [program, "--link", "udpin:0", "--speed", str(SPEED), "--log", "warn", "--log-dir", logs,
             "--ready-file", ready],
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
