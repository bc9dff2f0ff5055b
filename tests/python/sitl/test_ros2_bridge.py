"""A ROS 2 program flies the vehicle through the bridge of the examples. The oracle is telemetry of another client."""

import math
import os
import subprocess
from pathlib import Path

import pytest
from mavsdk_vehicle import free_port
from pymavlink.dialects.v20 import common as mavlink

EXAMPLES = Path(__file__).resolve().parents[3] / "examples" / "ros2"

pytestmark = pytest.mark.ros2


@pytest.fixture
def ros():
    """Starts programs of ROS 2 that see nothing of other machines; ends them."""
    python = os.environ.get("LMPC_ROS2_PYTHON")
    if python is None:
        pytest.skip("LMPC_ROS2_PYTHON names no Python with ROS 2: run `cargo xtask ros2`")
    settings = os.environ | {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_DOMAIN_ID": str(free_port() % 100)}
    running = []

    def make(name: str, *arguments: str) -> subprocess.Popen:
        command = [python, EXAMPLES / f"{name}.py", *arguments]
        running.append(subprocess.Popen(command, env=settings, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True))
        return running[-1]

    yield make
    for process in running:
        process.kill()
        # Shown if the test has failed.
        print(process.args[1].name, process.communicate()[0])


def test_a_ros_2_program_flies_the_vehicle(start, connect, ros):
    port = free_port()
    client = connect(start("--speed", "2", links=("udpin:0", f"udpout:127.0.0.1:{port},onboard")))
    bridge = ros("bridge", "--connect", f"udpin:127.0.0.1:{port}")
    pilot = ros("fly")
    places, headings, armed = [], [], []

    def has_flown(message) -> bool:
        if message.get_type() == "LOCAL_POSITION_NED":
            places.append((message.x, message.y, message.z))
        elif message.get_type() == "HEARTBEAT" and message.get_srcComponent() == mavlink.MAV_COMP_ID_AUTOPILOT1:
            armed.append(bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED))
        elif message.get_type() == "ATTITUDE" and armed[-1:] == [True]:
            headings.append(message.yaw)
        return True in armed and not armed[-1]

    client.wait(["LOCAL_POSITION_NED", "ATTITUDE", "HEARTBEAT"], has_flown, timeout=120)
    # 5 m east, 3 m north and 4 m up of ROS, with the nose to the east.
    assert min(math.dist(place, (3, 5, -4)) for place in places) < 0.1
    assert headings[-1] == pytest.approx(math.pi / 2, abs=0.03)
    assert pilot.communicate(timeout=60)[0] == "arrived\nlanded\n" and pilot.returncode == 0
    assert bridge.poll() is None
