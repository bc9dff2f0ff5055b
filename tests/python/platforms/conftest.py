"""What `cargo xtask platforms` has built for other platforms, and what runs it here."""

import json
import os
import subprocess
import sys
import time
import zipfile
from dataclasses import dataclass, field
from pathlib import Path

os.environ.setdefault("MAVLINK20", "1")

import pytest  # noqa: E402

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "sitl"))

ZIG = [os.environ.get("LMPC_QUADROTOR_ZIG", "python3"), "-m", "ziglang", "cc", "-target"]
#: C compilers: those that link the libraries. zig would first compile the C library of Windows, for minutes.
COMPILERS = {
    "linux64": [*ZIG, "x86_64-linux-gnu.2.17"],
    "aarch64-linux": [*ZIG, "aarch64-linux-gnu.2.17"],
    "win64": ["x86_64-w64-mingw32-gcc"],
}
PLATFORMS = os.environ.get("LMPC_QUADROTOR_PLATFORMS", "").split()


def pytest_configure():
    unknown = set(PLATFORMS) - set(COMPILERS)
    if unknown or not PLATFORMS:
        pytest.exit(f"cannot check {unknown or 'no platform'}: run `cargo xtask platforms`", returncode=2)


def variable(what: str, platform: str) -> str:
    return f"{what}_{platform.replace('-', '_').upper()}"


def of(what: str, platform: str) -> str:
    return os.environ[variable(what, platform)]


def compile_c(platform: str, source: Path, output: Path, *options: str):
    command = [*COMPILERS[platform], "-O1", "-Wall", "-Werror", "-o", output, source, *options]
    subprocess.run(command, check=True, timeout=240)


@dataclass
class Built:
    """What was built for a platform."""

    platform: str
    #: The FMU's library, out of the archive.
    library: Path
    #: Its size in the archive.
    compressed: int
    #: Absent with `--fmu-only`.
    vehicle: Path | None
    #: The programs that load a library: of FMI 2.0 and of FMI 3.0.
    host: Path
    host3: Path
    emulator: list[str] = field(default_factory=list)

    def run(self, program: Path, *arguments, timeout: float = 120) -> subprocess.CompletedProcess:
        command = [*self.emulator, program, *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, timeout=timeout, env=environment())

    def start(self, folder: Path, *arguments: str) -> "Vehicle":
        return Vehicle([*self.emulator, str(self.vehicle)], folder, *arguments)


def environment() -> dict[str, str]:
    """Without the variables that name programs, which the vehicle would take for its own."""
    return {name: value for name, value in os.environ.items() if not name.startswith("LMPC_SITL_")}


class Vehicle:
    """A running vehicle."""

    def __init__(self, command: list[str], folder: Path, *arguments: str):
        ready = folder / "ready.json"
        self.output = folder / "output.txt"
        with self.output.open("wb") as output:
            self.process = subprocess.Popen(
                [*command, "--ready-file", ready.name, "--link", "udpin:127.0.0.1:0", *arguments],
                stdout=output, stderr=subprocess.STDOUT, env=environment(), cwd=folder)
        end = time.monotonic() + 60
        while not ready.exists():
            if self.process.poll() is not None or time.monotonic() > end:
                self.stop()
                raise AssertionError(f"did not start: {self.said()}")
            time.sleep(0.01)
        self.address = json.loads(ready.read_text())["addresses"][0]

    def said(self) -> str:
        return self.output.read_text(errors="replace")

    def stop(self):
        self.process.kill()
        self.process.wait()


@pytest.fixture(scope="session")
def built(fmu, tmp_path_factory) -> dict[str, Built]:
    found = {}
    for platform in PLATFORMS:
        folder = tmp_path_factory.mktemp(platform)
        with zipfile.ZipFile(fmu) as archive:
            (entry,) = [entry for entry in archive.infolist() if entry.filename.startswith(f"binaries/{platform}/")]
            library = Path(archive.extract(entry, folder))
        windows = platform == "win64"
        hosts = [folder / (f"{name}.exe" if windows else name) for name in ("host", "host3")]
        for source, host in zip(("host.c", "host3.c"), hosts):
            compile_c(platform, HERE / source, host, *([] if windows else ["-ldl"]))
        program = os.environ.get(variable("LMPC_SITL", platform))
        vehicle = Path(program) if program else None
        if windows:
            # Wine looks for libraries beside the program. What is shipped stays as it is, so the vehicle gets a folder here.
            compile_c(platform, HERE / "prng.c", folder / "bcryptprimitives.dll", "-shared", "-ladvapi32")
        if windows and vehicle:
            copy = folder / vehicle.name
            copy.write_bytes(vehicle.read_bytes())
            vehicle = copy
        emulator = [word for word in of("LMPC_QUADROTOR_EMULATOR", platform).split("\n") if word]
        found[platform] = Built(platform, library, entry.compress_size, vehicle, *hosts, emulator)
    return found


@pytest.fixture(params=PLATFORMS)
def platform(request, built) -> Built:
    return built[request.param]
