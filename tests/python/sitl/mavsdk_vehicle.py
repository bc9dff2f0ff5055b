"""A vehicle as MAVSDK's programs meet it: they listen, on the port that the vehicle sends to."""

import socket
import time
from contextlib import contextmanager

from client import patiently
from mavsdk import ComponentType, Configuration, Mavsdk


def eventually(what, condition, timeout: float = 20.0):
    """Waits until a condition holds."""
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError(f"not within {timeout} s: {what}")


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextmanager
def flown_by_mavsdk(start):
    """A function that starts a vehicle with some options and returns MAVSDK's system."""
    made = []

    def make(*arguments):
        port = free_port()
        vehicle = start(*patiently(*arguments), links=(f"udpout:127.0.0.1:{port},onboard",))
        mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        made.append(mavsdk)
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = mavsdk.first_autopilot(10.0)
        assert system is not None, vehicle.output()
        return system

    yield make
    for mavsdk in made:
        mavsdk.destroy()
