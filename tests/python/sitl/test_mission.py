"""Missions as pymavlink, MAVSDK and MAVProxy upload and fly them."""

import json
import math

import pytest
from client import Client
from mavsdk.plugins.action import Action
from mavsdk.plugins.mission import Mission, MissionItem, MissionPlan
from mavsdk.plugins.telemetry import Telemetry
from pymavlink import mavwp
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from test_mavproxy import shell  # noqa: F401
from mavsdk_vehicle import eventually

HOME = (47.397742, 8.545594)
METRE = 1 / 111_200  # of latitude, degrees
NAN = math.nan


def north(metres: float) -> float:
    return HOME[0] + metres * METRE


def upload(client: Client, items, kind: int = mavlink.MAV_MISSION_TYPE_MISSION, integer: bool = True) -> int:
    """Uploads (command, frame, parameters, latitude, longitude, altitude) by request; returns the result."""
    client.mav.mission_count_send(*client.target, len(items), kind)
    while True:
        message = client.wait(["MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK"])
        if message.get_type() == "MISSION_ACK":
            return message.type
        command, frame, parameters, x, y, z = items[message.seq]
        if integer:
            client.mav.mission_item_int_send(*client.target, message.seq, frame, command, 0, 1, *parameters, round(x * 1e7),
                                             round(y * 1e7), z, kind)
        else:
            client.mav.mission_item_send(*client.target, message.seq, frame, command, 0, 1, *parameters, x, y, z, kind)


def download(client: Client, kind: int = mavlink.MAV_MISSION_TYPE_MISSION):
    client.mav.mission_request_list_send(*client.target, kind)
    items = []
    for number in range(client.wait("MISSION_COUNT", lambda count: count.mission_type == kind).count):
        client.mav.mission_request_int_send(*client.target, number, kind)
        items.append(client.wait("MISSION_ITEM_INT", lambda item: item.seq == number))
    client.mav.mission_ack_send(*client.target, mavlink.MAV_MISSION_ACCEPTED, kind)
    return items


RELATIVE = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
FLIGHT = [
    (mavlink.MAV_CMD_NAV_TAKEOFF, RELATIVE, (0, 0, 0, NAN), *HOME, 6.0),
    (mavlink.MAV_CMD_NAV_WAYPOINT, RELATIVE, (0, 2, 0, NAN), north(20), HOME[1], 6.0),
    (mavlink.MAV_CMD_NAV_WAYPOINT, RELATIVE, (0, 2, 0, NAN), north(20), HOME[1] + 2e-4, 8.0),
    (mavlink.MAV_CMD_NAV_LAND, RELATIVE, (0, 0, 0, NAN), 0, 0, 0.0),
]


@pytest.mark.parametrize("integer", [True, False])
def test_pymavlink_uploads_and_flies(start, connect, integer):
    client = connect(start("--speed", "10"))
    assert upload(client, FLIGHT, integer=integer) == mavlink.MAV_MISSION_ACCEPTED
    back = download(client)
    assert [item.command for item in back] == [item[0] for item in FLIGHT]
    assert abs(back[1].x / 1e7 - north(20)) < (1e-7 if integer else 1e-5) and back[2].z == 8.0
    unknown = [*FLIGHT[:2], (31234, RELATIVE, (0, 0, 0, 0), 0, 0, 0)]
    assert upload(client, unknown, integer=integer) == mavlink.MAV_MISSION_UNSUPPORTED
    assert "item 3: command 31234" in client.wait("STATUSTEXT", lambda text: "rejected" in text.text).text
    client.command(mavlink.MAV_CMD_MISSION_START)
    for number in range(4):
        client.wait("MISSION_ITEM_REACHED", lambda item: item.seq == number, 40)
    client.wait("HEARTBEAT", lambda beat: not beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
    place = client.wait("GLOBAL_POSITION_INT")
    assert abs(place.lat / 1e7 - north(20)) < 5e-6 and abs(place.lon / 1e7 - HOME[1] - 2e-4) < 5e-6
    client.wait("NAV_CONTROLLER_OUTPUT")


def test_fence_and_rally_points_are_kept_apart(start, connect):
    client = connect(start("--speed", "10"))
    circle = [(mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, mavlink.MAV_FRAME_GLOBAL, (200, 0, 0, 0), *HOME, 0)]
    rally = [(mavlink.MAV_CMD_NAV_RALLY_POINT, RELATIVE, (0, 0, 0, 0), north(10), HOME[1], 5)]
    assert upload(client, circle, mavlink.MAV_MISSION_TYPE_FENCE) == 0
    assert upload(client, rally, mavlink.MAV_MISSION_TYPE_RALLY) == 0
    assert download(client) == []
    assert [item.param1 for item in download(client, mavlink.MAV_MISSION_TYPE_FENCE)] == [200]
    assert [item.z for item in download(client, mavlink.MAV_MISSION_TYPE_RALLY)] == [5]
    client.mav.mission_clear_all_send(*client.target, mavlink.MAV_MISSION_TYPE_ALL)
    assert client.wait("MISSION_ACK", lambda ack: ack.mission_type == mavlink.MAV_MISSION_TYPE_ALL).type == 0
    assert download(client, mavlink.MAV_MISSION_TYPE_FENCE) == []


def test_a_plan_file_is_flown(start, connect, tmp_path):
    item = {"type": "SimpleItem", "autoContinue": True, "frame": 3}
    plan = {
        "fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
        "mission": {"version": 2, "items": [
            {**item, "doJumpId": 1, "command": 22, "params": [0, 0, 0, None, *HOME, 5]},
            {**item, "doJumpId": 2, "command": 16, "params": [0, 0, 0, None, north(15), HOME[1], 5]},
            {**item, "doJumpId": 3, "command": 20, "frame": 2, "params": [0, 0, 0, 0, 0, 0, 0]},
        ]},
    }
    file = tmp_path / "flight.plan"
    file.write_text(json.dumps(plan))
    client = connect(start("--speed", "10", "--mission", str(file), "--set", "RTL_RETURN_ALT=6"))
    current = client.wait("MISSION_CURRENT")
    assert (current.total, current.mission_state) == (3, mavlink.MISSION_STATE_NOT_STARTED)
    client.command(mavlink.MAV_CMD_MISSION_START)
    client.wait("MISSION_CURRENT", lambda current: current.mission_state == mavlink.MISSION_STATE_COMPLETE, 40)
    client.wait("HEARTBEAT", lambda beat: not beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 40)
    place = client.wait("LOCAL_POSITION_NED")
    assert math.hypot(place.x, place.y) < 0.3


def mission_item(metres: float, altitude: float, through: bool, speed: float = NAN) -> MissionItem:
    return MissionItem(north(metres), HOME[1], altitude, speed, through, NAN, NAN, MissionItem.CameraAction.NONE, NAN, NAN,
                       NAN, NAN, NAN, MissionItem.VehicleAction.NONE)


def test_mavsdk_uploads_and_watches(fly):  # noqa: F811
    system = fly("--speed", "10")
    telemetry, action, mission = Telemetry(system), Action(system), Mission(system)
    eventually("health", telemetry.health_all_ok)
    items = [mission_item(10, 5, True, 4.0), mission_item(25, 6, True), mission_item(30, 6, False)]
    mission.set_return_to_launch_after_mission(False)
    mission.upload_mission(MissionPlan(items))
    plan = mission.download_mission()
    plan = plan[1] if isinstance(plan, tuple) else plan
    assert [round(item.latitude_deg, 6) for item in plan.mission_items] == [round(item.latitude_deg, 6) for item in items]
    assert plan.mission_items[0].is_fly_through and not plan.mission_items[2].is_fly_through
    progress = []
    mission.subscribe_mission_progress(lambda now, *_: progress.append((now.current, now.total)))
    action.arm()
    mission.start_mission()
    eventually("second leg", lambda: telemetry.position().latitude_deg > north(12), 30)
    mission.pause_mission()
    eventually("hold", lambda: abs(telemetry.velocity_ned().north_m_s) < 0.1)
    mission.start_mission()
    eventually("finished", lambda: progress and progress[-1] == (3, 3), 30)
    finished = mission.is_mission_finished()
    assert finished[1] if isinstance(finished, tuple) else finished
    assert [now for now in dict.fromkeys(current for current, _ in progress)] == [0, 1, 2, 3]
    eventually("at its end", lambda: abs(telemetry.position().latitude_deg - north(30)) < 3e-6)
    mission.clear_mission()


def test_mavproxy_loads_lists_and_sets(start, connect, shell, tmp_path):  # noqa: F811
    vehicle = start("--autopilot", "ardupilot", "--speed", "10", links=("tcpin:0", "udpin:0"))
    watcher = connect(vehicle, 1)
    wp = mavwp.MAVWPLoader()
    for command, frame, altitude, metres in [(16, 0, 488, 0), (22, 3, 5, 0), (16, 3, 6, 12), (20, 3, 0, 0)]:
        wp.add(mavlink.MAVLink_mission_item_message(1, 1, 0, frame, command, 0, 1, 0, 0, 0, 0, north(metres), HOME[1], altitude))
    file = tmp_path / "way.txt"
    wp.save(str(file))
    console = shell(f"tcp:{vehicle.addresses[0]}")
    console.expect("Received .* parameters", timeout=40)
    console.type("module load wp")
    console.ask(f"wp load {file}", "Loaded 4 waypoint|Sent all 4 waypoints|Flight plan received")
    watcher.wait("MISSION_CURRENT", lambda current: current.total == 3, 20)
    console.ask("wp list", "Saved 4 waypoints|22 3 ")
    # As a file, too.
    console.type("wp clear")
    watcher.wait("MISSION_CURRENT", lambda current: current.mission_state == mavlink.MISSION_STATE_NO_MISSION, 20)
    console.ask(f"wp ftpload {file}", "Sent|Sending waypoints with ftp")
    watcher.wait("MISSION_CURRENT", lambda current: current.total == 3, 20)
    console.ask("wp ftp", r"22 3 47\.39\d+ 8\.54\d+ 5\.0")
    console.type("wp set 2")
    watcher.wait("MISSION_CURRENT", lambda current: current.seq == 2, 20)
    console.type("wp set 1")
    watcher.wait("MISSION_CURRENT", lambda current: current.seq == 1, 20)
    console.type("mode guided")
    watcher.wait("HEARTBEAT", lambda beat: beat.custom_mode == 4)
    console.type("arm throttle")
    watcher.wait("HEARTBEAT", lambda beat: beat.base_mode & 128, 20)
    console.type("mode auto")
    watcher.wait("HEARTBEAT", lambda beat: beat.custom_mode == 3)
    # Without a raised throttle it waits on the ground, as ArduCopter does.
    console.type("long MISSION_START 0 0 0 0 0 0 0")
    watcher.wait("MISSION_ITEM_REACHED", lambda item: item.seq == 2, 40)
    watcher.wait("HEARTBEAT", lambda beat: not beat.base_mode & 128, 60)
