"""The vehicle under test: the program that LMPC_SITL names, else target/debug/lmpc-sitl. Each test has its own, on free ports of
127.0.0.1, and stops it."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

os.environ.setdefault("MAVLINK20", "1")

import pytest  # noqa: E402

sys.path.insert(0, str(Path(__file__).parent))

from browser import Page, browser, needs_browser  # noqa: E402
from client import Client  # noqa: E402
from mavsdk_vehicle import flown_by_mavsdk  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def program() -> Path:
    path = Path(os.environ.get("LMPC_SITL", ROOT / "target" / "debug" / "lmpc-sitl"))
    if not path.is_file():
        pytest.exit(f"{path} does not exist: run `cargo build -p sitl` first", returncode=2)
    return path


class Vehicle:
    """A running program."""

    def __init__(self, program: Path, folder: Path, *arguments: str, cwd: Path | None = None):
        folder.mkdir(exist_ok=True)
        ready = folder / "ready.json"
        self.log = (folder / "output.txt").open("wb")
        self.started = time.monotonic()
        self.process = subprocess.Popen(
            [program, "--ready-file", ready, *arguments], stdout=self.log, stderr=subprocess.STDOUT, cwd=cwd,
            env={name: value for name, value in os.environ.items() if not name.startswith("LMPC_SITL_")},
        )
        self.folder = folder
        while not ready.exists():
            if self.process.poll() is not None or time.monotonic() - self.started > 20:
                raise AssertionError(f"did not start: {self.output()}")
            time.sleep(0.002)
        self.ready = json.loads(ready.read_text())
        # The page of a recorded flight has no links.
        self.addresses = self.ready.get("addresses", [])

    def output(self) -> str:
        return (self.folder / "output.txt").read_text(errors="replace")

    def stop(self) -> int:
        """Ends it as Ctrl-C does, and returns its exit code."""
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.log.close()
        return self.process.returncode


@pytest.fixture
def start(program, tmp_path):
    """Starts vehicles; `links` are specifications as --link takes them."""
    running = []

    def make(*arguments: str, links=("udpin:0",), cwd: Path | None = None) -> Vehicle:
        options = [option for link in links for option in ("--link", link)]
        running.append(Vehicle(program, tmp_path / f"vehicle{len(running)}", *options, *arguments, cwd=cwd))
        return running[-1]

    yield make
    codes = [vehicle.stop() for vehicle in running]
    assert all(code == 0 for code in codes), f"exit codes {codes}: {[vehicle.output() for vehicle in running]}"
    assert not any("panicked" in vehicle.output() for vehicle in running)


@pytest.fixture
def connect():
    """Connects pymavlink clients."""
    clients = []

    def make(vehicle: Vehicle, link: int = 0, **options) -> Client:
        clients.append(Client(vehicle.addresses[link], **options))
        return clients[-1]

    yield make
    for client in clients:
        client.close()


@pytest.fixture
def fly(start):
    """Starts vehicles that MAVSDK is connected to."""
    with flown_by_mavsdk(start) as make:
        yield make


@pytest.fixture(scope="module")
def chromium():
    needs_browser()
    with browser() as running:
        yield running


@pytest.fixture
def look(chromium):
    """Opens pages; closes them at the end, and fails for errors in their consoles."""
    pages = []

    def make(url: str, **options) -> Page:
        pages.append(Page(chromium, url, **options))
        return pages[-1]

    yield make
    for page in pages:
        page.close()
