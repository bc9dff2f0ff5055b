"""The pytest plugin, in sessions of its own."""

import json
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

import lmpc_quadrotor
from lmpc_quadrotor.pytest_plugin.armable import _CHECKS, failed_checks


def folder_of(pytester, name):
    (found,) = (pytester.path / "kept").rglob(f"*{name}*/vehicle0")
    return found


def test_a_vehicle_is_ready_and_ends_by_its_id(pytester):
    pytester.makepyfile(
        """
        import os
        from pymavlink import mavutil

        def test_flies(sitl):
            assert sitl.is_running and sitl.start_ms < 5000
            link = mavutil.mavlink_connection(sitl.pymavlink)
            beat = link.wait_heartbeat(timeout=10)
            assert beat is not None and beat.autopilot == 12
            link.mav.command_long_send(1, 1, mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
            answer = link.recv_match(type="COMMAND_ACK", blocking=True, timeout=10)
            assert answer.result == mavutil.mavlink.MAV_RESULT_ACCEPTED
            link.close()
            assert sitl.stop() == 0 and sitl.digest
            assert sitl.mavsdk.startswith("tcpout://127.0.0.1:") and sitl.dronekit == sitl.pymavlink

        def test_ends(sitl):
            with open("id.txt", "w") as file:
                file.write(str(sitl.process_id))
        """
    )
    pytester.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=2)
    identity = int((pytester.path / "id.txt").read_text())
    assert not Path(f"/proc/{identity}").exists() or sys.platform != "linux"


def test_options_come_from_the_marker_before_the_command_line(pytester):
    pytester.makepyfile(
        """
        import pytest

        @pytest.mark.sitl(wind=(4, 90), faults="60:rotor1=off", airframe="iris", speed=50, seed=7, args=["--gusts", "1"],
                          parameters={"airframe.mass": 1.6})
        def test_marker(sitl):
            flags = " ".join(sitl.command)
            for flag in ("--wind 4,90", "--fault 60:rotor1=off", "--airframe iris", "--speed 50", "--seed 7", "--gusts 1", "--set airframe.mass=1.6"):
                assert flag in flags, flag

        @pytest.mark.sitl(wind=2)
        class TestClass:
            @pytest.mark.sitl(seed=3)
            def test_both(self, sitl, sitl_factory):
                assert (sitl.options.wind, sitl.seed, sitl.options.airframe) == (2, 3, "crazyflie")
                other = sitl_factory(seed=4)
                assert other.seed == 4 and other.options.wind == 2 and other.address != sitl.address

        @pytest.mark.sitl(sensors="realistic", speed="max")
        def test_waits_until_it_is_armable(sitl):
            assert sitl.is_running
        """
    )
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", "--sitl-airframe", "crazyflie", "--sitl-seed", "9", "-n", "2")
    result.assert_outcomes(passed=3)


FAILING = """
    import pytest
    from pymavlink import mavutil

    @pytest.mark.sitl(wind=3, seed=5)
    def test_fails(sitl):
        link = mavutil.mavlink_connection(sitl.pymavlink)
        link.wait_heartbeat(timeout=10)
        link.mav.command_long_send(1, 1, mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
        assert link.recv_match(type="COMMAND_ACK", blocking=True, timeout=10)
        link.close()
        assert False, "as it should"

    def test_passes(sitl):
        pass
"""


@pytest.mark.parametrize("options", [(), ("-n", "2")], ids=["alone", "xdist"])
def test_a_failed_test_is_replayed_bit_for_bit(pytester, options):
    pytester.makepyfile(FAILING)
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", "--sitl-artifacts", "kept", "--junitxml=report.xml", *options)
    result.assert_outcomes(failed=1, passed=1)
    report = result.stdout.str()
    assert "seed: 5" in report and "flight log: " in report
    digest = re.search(r"flight digest: ([0-9a-f]{16})", report).group(1)
    (command,) = re.findall(r"replay bit for bit: (.+)", report)
    replayed = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60)
    assert replayed.returncode == 0 and f"{digest}: the same flight" in replayed.stdout, replayed
    kept = folder_of(pytester, "test_fails")
    facts = json.loads((kept / "vehicle.json").read_text())
    assert (facts["seed"], facts["digest"], facts["options"]["wind"]) == (5, digest, 3)
    assert (kept / "output.txt").is_file() and (kept / "replay.txt").read_text() == "lmpc-sitl --replay flight.lmpc\n"
    assert list(kept.rglob("*.ulg"))
    assert not list((pytester.path / "kept").rglob("*test_passes*"))
    assert 'name="sitl_seed" value="5"' in (pytester.path / "report.xml").read_text()


@pytest.mark.parametrize(
    "marker, message",
    [
        ("winds=3", "the vehicle has no option winds; did you mean wind?"),
        ("airframe='biplane'", "unknown airframe `biplane`; allowed paper, crazyflie"),
        ("5", "the marker sitl takes keywords only"),
        ("speed=0, timeout=0.5", "could not be armed after 0.5 s (it has sent no status, as while its time stands still)"),
        (
            "faults=['0:gps=off'], sensors='realistic', timeout=2",
            "could not be armed after 2 s (not healthy: GPS, position estimate); remove the cause, raise timeout, or set wait_armable=False",
        ),
        ("timeout='long'", "timeout = 'long'; expected a number of seconds above 0"),
        ("timeout=0", "timeout = 0; expected a number of seconds above 0"),
        ("parameters=5", "parameters = 5; expected names with values"),
        ("faults=5", "faults = 5; expected a list of strings"),
        ("args=5", "args = 5; expected a list of strings"),
        ("wait_armable='no'", "wait_armable = 'no'; expected True or False"),
    ],
)
def test_errors_say_what_is_wrong(pytester, marker, message):
    pytester.makepyfile(f"import pytest\n\n@pytest.mark.sitl({marker})\ndef test_it(sitl): pass\n")
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    result.assert_outcomes(errors=1)
    assert message in result.stdout.str()


def test_a_vehicle_that_ends_by_itself_otherwise_than_well_fails_the_test(pytester):
    pytester.makepyfile(
        """
        import os, signal

        def test_it(sitl):
            os.kill(sitl.process_id, signal.SIGKILL)
            sitl._process.wait()
        """
    )
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    result.assert_outcomes(passed=1, errors=1)
    assert "lmpc-sitl ended with exit code -9" in result.stdout.str()


def test_sys_status_is_read_as_pymavlink_writes_it():
    from pymavlink.dialects.v20 import common

    class Sink:
        data = b""

        def write(self, data):
            self.data = bytes(data)

    every = 0x1FFFFFFF
    for health, expected in [(every, []), (0x10000000, []), (every - 0x10000000 - 0x24, ["magnetometer", "GPS"]), (every - 0x10000000, ["an arming check that its status does not name"])]:
        sink = Sink()
        common.MAVLink(sink, 1, 1).sys_status_send(every, every, health, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0)
        assert failed_checks(sink.data) == expected
        heartbeat = Sink()
        common.MAVLink(heartbeat, 1, 1).heartbeat_send(2, 12, 0, 0, 0)
        assert failed_checks(heartbeat.data + sink.data) == expected
        damaged = bytearray(sink.data)
        damaged[12] ^= 1
        assert failed_checks(bytes(damaged)) is None
    names = {bit: common.enums["MAV_SYS_STATUS_SENSOR"][bit].name for bit in _CHECKS}
    assert names[0x20] == "MAV_SYS_STATUS_SENSOR_GPS" and names[0x2000] == "MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL"
    assert names[0x4000] == "MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL" and names[0x200000] == "MAV_SYS_STATUS_AHRS"


def test_the_plugin_costs_little(pytester):
    """It is loaded in every session of whoever has the package."""
    pytester.makepyfile("def test_it(): pass")
    begun = time.perf_counter()
    pytester.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=1)
    assert time.perf_counter() - begun < 10.0
    assert Path(lmpc_quadrotor.__file__).parts[-3] == "site-packages"
