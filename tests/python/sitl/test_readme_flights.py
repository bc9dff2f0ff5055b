"""What README and book print for the MAVLink vehicle works as it is printed, but for ports that are free ones here, and for a vehicle
that waits longer for set-points."""

import re
import socket
import subprocess
import sys

import documents
import pytest

from client import patiently
from mavsdk_vehicle import free_port

FLIGHTS = [block for block in documents.of("python") if re.search(r"^(from|import) (pymavlink|mavsdk)\b", block.text, re.MULTILINE)]


def group_of(flight) -> tuple:
    """Arguments of the command that a reader has typed before."""
    commands = [arguments for block in documents.of("sh") if block.file == flight.file and block.line < flight.line
                for arguments in block.commands]
    assert commands, f"{flight}: no command before it starts a vehicle"
    return tuple(commands[-1])


# A reader who starts the vehicle once may fly what any page has for it.
GROUPS = {}
for flight in FLIGHTS:
    GROUPS.setdefault(group_of(flight), []).append(flight)


class Stand:
    """A vehicle started as it is printed, on free ports that take the place of those printed."""

    def __init__(self, start, arguments):
        self.ports = {}
        links = () if "--link" in arguments else (f"udpout:127.0.0.1:{self.port('14550')}", f"udpout:127.0.0.1:{self.port('14540')},onboard")
        self.vehicle = start(*patiently(*(re.sub(r"(?<=:)\d{4,5}\b", self.port, word) for word in arguments)), links=links)

    def port(self, printed) -> str:
        number = printed if isinstance(printed, str) else printed[0]
        return self.ports.setdefault(number, str(free_port()))

    def fly(self, block, python=sys.executable):
        code = re.sub(r"(?<=:)\d{4,5}\b", self.port, block.text)
        assert code != block.text, f"{block} names no port"
        done = subprocess.run([python, "-c", code], capture_output=True, text=True, timeout=90)
        assert done.returncode == 0, f"{block}: {done.stdout}{done.stderr}"
        documents.check_output(block, done.stdout)


def test_there_are_flights_with_both_libraries():
    for library in ("from pymavlink", "from mavsdk"):
        assert any(library in block.text for block in FLIGHTS), library
    assert any(block.file == "README.md" for block in FLIGHTS)


@pytest.mark.parametrize("block", FLIGHTS, ids=str)
def test_each_block_alone(start, block):
    Stand(start, group_of(block)).fly(block)


@pytest.mark.parametrize("backwards", [False, True], ids=["in order", "backwards"])
@pytest.mark.parametrize("group", GROUPS, ids=lambda group: " ".join(group) or "defaults")
def test_all_blocks_on_one_vehicle(start, group, backwards):
    """Each from where the one before has left the vehicle. At the speed of the wall clock, each flies alone above."""
    stand = Stand(start, group if "--speed" in group else (*group, "--speed", "4"))
    flights = GROUPS[group]
    for block in reversed(flights) if backwards else flights:
        stand.fly(block)


def test_the_mavsdk_block_flies_a_vehicle_that_another_program_has_left_in_the_air(start, connect):
    block = next(block for block in FLIGHTS if "from mavsdk" in block.text and "print(\"landed\")" in block.text)
    port = free_port()
    vehicle = start(*patiently("--speed", "4"), links=("udpin:0", f"udpout:127.0.0.1:{port},onboard"))
    connect(vehicle).take_off()
    code = block.text.replace("14540", str(port))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=90)
    assert done.returncode == 0 and done.stdout.splitlines()[-1] == "landed", done.stdout + done.stderr


def is_free(port: int) -> bool:
    with socket.socket() as tcp, socket.socket(type=socket.SOCK_DGRAM) as udp:
        try:
            tcp.bind(("127.0.0.1", port))
            udp.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


@pytest.mark.parametrize("block", documents.of("toml", "--config"), ids=str)
def test_configuration_file(start, connect, tmp_path, block):
    """As it is printed, but for ports that somebody else has."""
    text = re.sub(r'(?<=in:)\d{4,5}(?=[",])', lambda port: port[0] if is_free(int(port[0])) else str(free_port()), block.text)
    (tmp_path / "vehicle.toml").write_text(text)
    settings = dict(re.findall(r'^([\w-]+) = "?(.*?)"?(?: *#.*)?$', text, re.MULTILINE))
    vehicle = start("--config", "vehicle.toml", links=(), cwd=tmp_path)
    listening = next(link for link in re.findall(r'"([^"]+)"', settings["link"]) if link.startswith(("tcpin", "udpin")))
    number = re.findall(r'"([^"]+)"', settings["link"]).index(listening)
    client = connect(vehicle, link=number, kind="tcp" if listening.startswith("tcpin") else "udpout")
    assert client.wait("HEARTBEAT").autopilot == {"ardupilot": 3, "px4": 12, "generic": 0}[settings.get("autopilot", "px4")]
    if "home" in settings:
        place = client.wait("GLOBAL_POSITION_INT")
        latitude, longitude = (float(number) for number in settings["home"].split(",")[:2])
        assert abs(place.lat / 1e7 - latitude) < 1e-6 and abs(place.lon / 1e7 - longitude) < 1e-6
    if "speed" in settings and settings["speed"] != "max":
        assert client.parameter("SIM_SPEEDUP").param_value == float(settings["speed"])


def test_there_is_a_configuration_file():
    assert documents.of("toml", "--config")


@pytest.mark.parametrize("block, arguments", [(block, arguments) for block in documents.of("sh") for arguments in block.commands],
                         ids=lambda value: str(value) if isinstance(value, documents.Block) else " ".join(value) or "-")
def test_printed_commands_are_accepted(program, tmp_path, block, arguments):
    """All flags are read before the configuration file, which is not there."""
    config = [] if any(word.startswith("--config") for word in arguments) else ["--config", "missing.toml"]
    done = subprocess.run([program, *arguments, *config], cwd=tmp_path, capture_output=True, text=True, timeout=20)
    assert done.returncode == (0 if {"--help", "-h", "--version"} & set(arguments) else 4), f"{block}: {done.stderr}"
