"""A running vehicle."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import time
from pathlib import Path

from ..files import sitl_path
from .armable import Watch
from .options import Options

#: The line by which a flight ends.
_DIGEST = re.compile(r"flight digest ([0-9a-f]{16})")
#: How long a vehicle may take to end, s.
_PATIENCE = 10.0


class SitlError(RuntimeError):
    """A vehicle did not start, or ended otherwise than asked."""


class Sitl:
    """A simulated vehicle that runs for a test: on ports of its own on 127.0.0.1, with a record and logs in a folder of its own."""

    def __init__(self, options: Options, folder: Path) -> None:
        __tracebackhide__ = True
        self.options = options
        #: Where record, logs and output are.
        self.folder = folder
        #: The record, which `replay_command` flies again.
        self.record: Path = folder / "flight.lmpc"
        #: What the program has said.
        self.log: Path = folder / "output.txt"
        #: How long the start took, until the vehicle could be armed, ms.
        self.start_ms: float = 0.0
        #: By which signal or on which request it has to end is ours: anything else is a failure.
        self._asked = False
        folder.mkdir(parents=True, exist_ok=True)
        begun = time.monotonic()
        ready, self._watch = folder / "ready.json", Watch()
        self.command: list[str] = [
            sitl_path(), "--ready-file", str(ready), "--link", "tcpin:127.0.0.1:0", "--link", self._watch.link,
            "--record", str(self.record), "--log-dir", str(folder / "logs"), *options.flags(),
        ]  # fmt: skip
        environment = {name: value for name, value in os.environ.items() if not name.startswith("LMPC_SITL_")}
        try:
            with self.log.open("wb") as log:
                self._process = subprocess.Popen(
                    self.command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, env=environment
                )
        except OSError as problem:
            self._watch.close()
            raise SitlError(f"cannot start {self.command[0]}: {problem}") from problem
        try:
            self._wait(ready, begun)
        except BaseException:
            self.stop()
            raise
        self.start_ms = (time.monotonic() - begun) * 1e3

    def _wait(self, ready: Path, begun: float) -> None:
        __tracebackhide__ = True
        deadline = begun + self.options.timeout
        while not ready.exists():
            self._check_running()
            if time.monotonic() > deadline:
                raise SitlError(f"lmpc-sitl was not ready after {self.options.timeout} s:\n{self.output()}")
            time.sleep(0.001)
        host, port = json.loads(ready.read_text())["addresses"][0].rsplit(":", 1)
        #: Host and port on which clients are accepted over TCP.
        self.address: tuple[str, int] = (host, int(port))
        while self.options.wait_armable and not self._watch.is_armable(0.2):
            self._check_running()
            if time.monotonic() > deadline:
                raise SitlError(
                    f"the vehicle could not be armed after {self.options.timeout} s ({self._watch.reason}); "
                    "remove the cause, raise timeout, or set wait_armable=False:\n"
                    f"{self.output()}"
                )

    def _check_running(self) -> None:
        __tracebackhide__ = True
        if self._process.poll() is not None:
            self._asked = True
            raise SitlError(f"lmpc-sitl did not start (exit code {self._process.returncode}):\n{self.output()}")

    @property
    def pymavlink(self) -> str:
        """For `mavutil.mavlink_connection`."""
        return f"tcp:{self.address[0]}:{self.address[1]}"

    @property
    def mavsdk(self) -> str:
        """For `System.connect(system_address=…)`."""
        return f"tcpout://{self.address[0]}:{self.address[1]}"

    @property
    def dronekit(self) -> str:
        """For `dronekit.connect`."""
        return f"tcp:{self.address[0]}:{self.address[1]}"

    @property
    def process_id(self) -> int:
        """Of the running program."""
        return self._process.pid

    @property
    def seed(self) -> int:
        """Of everything random."""
        return self.options.seed

    @property
    def is_running(self) -> bool:
        """Whether the program runs."""
        return self._process.poll() is None

    @property
    def flight_logs(self) -> list[Path]:
        """The flight logs (ULog), one for each flight so far."""
        return sorted((self.folder / "logs").rglob("*.ulg"))

    def output(self) -> str:
        """What the program has said so far."""
        return self.log.read_text(errors="replace")

    @property
    def digest(self) -> str | None:
        """The fingerprint of the flight, once it has ended: equal digests mean identical flights."""
        found: list[str] = _DIGEST.findall(self.output())
        return found[-1] if found else None

    @property
    def replay_command(self) -> str:
        """Flies the flight again, bit for bit, in a shell."""
        return shlex.join([self.command[0], "--replay", str(self.record)])

    def stop(self) -> int:
        """Ends the vehicle as Ctrl-C does, and returns the exit code: 0 when all was well."""
        if not self._asked and self._process.poll() is None:
            self._asked = True
            self._process.terminate()
            try:
                self._process.wait(_PATIENCE)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._watch.close()
        return self._process.wait()

    def problem(self) -> str | None:
        """What is wrong with how an ended vehicle ended, if anything is."""
        code = self._process.returncode
        # On Windows a program that is ended has no say in its exit code.
        if code in (0, None) or (os.name == "nt" and self._asked):
            return None
        return f"lmpc-sitl ended with exit code {code}"
