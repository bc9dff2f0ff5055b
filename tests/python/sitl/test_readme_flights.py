"""The README's code that flies the MAVLink vehicle runs as it is printed, but for the port."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from test_mavsdk import free_port

README = (Path(__file__).resolve().parents[3] / "README.md").read_text(encoding="utf-8")


def block(language: str, word: str) -> str:
    """The block of code in which a word stands."""
    (code,) = (code for code in re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL) if word in code)
    return code


@pytest.mark.parametrize("library, says", [("from pymavlink", "5.0 5.0 10.0"), ("from mavsdk", "landed")])
def test_python_code_of_the_readme(start, library, says):
    code, port = block("python", library), free_port()
    assert "14540" in code
    start("--speed", "4", links=(f"udpout:127.0.0.1:{port},onboard",))
    done = subprocess.run([sys.executable, "-c", code.replace("14540", str(port))], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    last = done.stdout.splitlines()[-1]
    numbers = re.findall(r"-?[\d.]+", last)
    assert (" ".join(str(round(float(number), 1)) for number in numbers) or last) == says


def test_configuration_file_of_the_readme(start, connect, tmp_path):
    text = block("toml", "--config")
    settings = dict(re.findall(r'^(\w+) = "?(.*?)"?(?: *#.*)?$', text, re.MULTILINE))
    # Ports of a test are free ones; files go where they may.
    text = text.replace(settings["link"], '["udpin:0"]')
    for file in (settings["parameters"], settings["record"]):
        text = text.replace(file, str(tmp_path / file))
    file = tmp_path / "vehicle.toml"
    file.write_text(text)
    client = connect(start("--config", str(file), links=()))
    assert client.wait("HEARTBEAT").autopilot == 3
    place = client.wait("GLOBAL_POSITION_INT")
    latitude, longitude = (float(number) for number in settings["home"].split(",")[:2])
    assert abs(place.lat / 1e7 - latitude) < 1e-6 and abs(place.lon / 1e7 - longitude) < 1e-6
    assert client.parameter("SIM_SPEEDUP").param_value == float(settings["speed"])
