"""Everything at once: two vehicles by realistic sensors in gusts, with a mission, a fence, faults, signing, logs and a record, which
replays both flights bit for bit."""

import json
import re

from pymavlink import mavutil
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from pyulog import ULog

import records
from client import PX4_OFFBOARD, patiently
from test_program import run
from test_safety import EAST, HOME, NORTH, armed
from test_signing import KEY, key_file, signed

READY = mavlink.MAV_SYS_STATUS_PREARM_CHECK
MISSION_COMPLETE = 5
VELOCITY = 0b110111000111


def place(north, east):
    return [HOME[0] + north * NORTH, HOME[1] + east * EAST]


def plan(path):
    """A mission over two corners, within a fence."""
    def item(number, command, north=0.0, east=0.0, height=5.0):
        return {"type": "SimpleItem", "autoContinue": True, "command": command, "doJumpId": number, "frame": 3,
                "params": [0, 0, 0, None, *place(north, east), height]}

    mission = [item(1, 22), item(2, 16, 12, 0), item(3, 16, 12, 12), item(4, 21, 0, 12, 0)]
    circle = {"circle": {"center": HOME, "radius": 40}, "inclusion": True, "version": 1}
    path.write_text(json.dumps({
        "fileType": "Plan", "version": 1, "groundStation": "QGroundControl", "rallyPoints": {"version": 2, "points": [[*place(5, 5), 5]]},
        "geoFence": {"version": 2, "circles": [circle], "polygons": []},
        "mission": {"version": 2, "firmwareType": 12, "vehicleType": 2, "cruiseSpeed": 5, "hoverSpeed": 5,
                    "plannedHomePosition": [*HOME, 488], "items": mission}}))
    return path


def test_two_flights_with_all_of_it_replay_bit_for_bit(program, start, connect, tmp_path):
    logs, traffic, record = tmp_path / "logs", tmp_path / "flight.tlog", tmp_path / "flight.record"
    vehicle = start(*patiently(
        "--vehicles", "2", "--formation", "line,8", "--sensors", "realistic", "--wind", "3,200", "--gusts", "1", "--seed", "11",
        "--mission", plan(tmp_path / "both.plan"), "--signing-key", key_file(tmp_path),
        "--fault", "9:barometer=garbage", "--fault", "12:gps=slow", "--log-dir", logs, "--tlog", traffic, "--record", record,
        "--speed", "10", "--set", "SYS_FAILURE_EN=1"))
    clients = [connect(vehicle, number, heartbeat=False) for number in range(2)]
    for number, client in enumerate(clients):
        signed(client.connection)
        client.beat()
        client.target = (1 + number, 1)
        client.wait("SYS_STATUS", lambda status: status.onboard_control_sensors_health & READY)
    flown, stopped = clients
    flown.arm()
    flown.command(mavlink.MAV_CMD_MISSION_START)

    # The other one is flown at the fence, and turned away by it.
    stopped.take_off()
    stopped.go(lambda: stopped.position((0, 0, 0), VELOCITY, velocity=(0, 4, 0)), PX4_OFFBOARD)
    stopped.stream(lambda: stopped.position((0, 0, 0), VELOCITY, velocity=(0, 4, 0)), lambda position: position.y > 30)
    stopped.command(mavlink.MAV_CMD_INJECT_FAILURE, mavlink.FAILURE_UNIT_SENSOR_MAG, mavlink.FAILURE_TYPE_STUCK)
    for _ in range(200):
        stopped.position((0, 0, 0), VELOCITY, velocity=(0, 4, 0))
        if stopped.connection.recv_match(type="LOCAL_POSITION_NED", blocking=True, timeout=0.05) is None:
            continue
        if stopped.connection.messages["HEARTBEAT"].custom_mode >> 16 & 0xFF != PX4_OFFBOARD[1]:
            break
    stopped.set_parameter("MIS_TAKEOFF_ALT", 3.0)
    stopped.land()
    flown.wait("HEARTBEAT", lambda beat: not armed(beat), 20)
    assert vehicle.stop() == 0

    flights = re.findall(r"system (\d): flew ([\d.]+) s .* digest ([0-9a-f]{16})", vehicle.output())
    assert len(flights) == 2 and flights[0][2] != flights[1][2], vehicle.output()
    replayed = run(program, "--replay", record)
    assert replayed.returncode == 0, replayed.stderr
    assert re.findall(r"system (\d): replayed ([\d.]+) s, flight digest ([0-9a-f]{16})", replayed.stdout) == flights

    # All of it was there.
    said = {}
    for path in sorted(logs.glob("*.ulg")):
        log = ULog(str(path))
        assert not log.file_corruption
        topics = {dataset.name: dataset.data for dataset in log.data_list}
        system = int(topics["vehicle_status"]["system_id"][0])
        said[system] = "\n".join(message.message for message in log.logged_messages)
        off = topics["vehicle_local_position"]["x"][-1] - topics["vehicle_local_position_groundtruth"]["x"][-1]
        assert 0.001 < abs(off) < 5, off
        if system == 1:
            assert topics["mission_result"]["finished"][-1] == 1 and max(topics["vehicle_local_position_groundtruth"]["x"]) > 9
        else:
            assert 25 < max(topics["vehicle_local_position_groundtruth"]["y"]) < 45 and 1 in topics["vehicle_status"]["failsafe"]
    assert all(words in said[1] for words in ("barometer=garbage", "gps=slow")), said
    assert "magnetometer=stuck" in said[2] and "ence" in said[2] and "magnetometer=stuck" not in said[1], said
    reader = mavutil.mavlink_connection(str(traffic))
    systems = set()
    while (message := reader.recv_match()) is not None:
        # Of frames, as the library does not know the newest messages.
        frame = message.get_msgbuf()
        assert frame[2] & 1
        systems.add(frame[5])
    assert systems == {1, 2, 255} and KEY not in record.read_bytes()

    # The proof can fail: without the first half of the set-points, with which the mode began, it is another flight.
    lines = records.entries(record)
    set_points = [number for number, line in enumerate(lines) if line.startswith("frame ") and line.split()[2] == "1" and " fd" in line]
    for number in reversed(set_points[:len(set_points) // 2]):
        del lines[number]
    records.write(record, lines)
    assert run(program, "--replay", record).returncode == 5
