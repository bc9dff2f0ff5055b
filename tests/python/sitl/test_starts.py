"""How ground stations and MAVROS begin, message by message as they send it, and what they need of the answers."""

import json
import math
import struct

import pytest
from pymavlink import mavftp
from pymavlink.dialects.v10 import ardupilotmega as first_version
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from test_files import file_client, protocol_crc
from test_ros2 import listening
from test_services import all_parameters

PROTOCOL_VERSION, COMPONENT_METADATA, AVAILABLE_MODES = 300, 397, 435
# Streams that Mission Planner asks for, with the rates of its settings.
STREAMS = {
    mavlink.MAV_DATA_STREAM_EXTENDED_STATUS: 2, mavlink.MAV_DATA_STREAM_POSITION: 2, mavlink.MAV_DATA_STREAM_EXTRA1: 4,
    mavlink.MAV_DATA_STREAM_EXTRA2: 4, mavlink.MAV_DATA_STREAM_EXTRA3: 2, mavlink.MAV_DATA_STREAM_RAW_SENSORS: 2,
    mavlink.MAV_DATA_STREAM_RC_CHANNELS: 2,
}  # fmt: skip
# What its head-up display, its map and its page of values are filled by.
SHOWN = {
    "ATTITUDE", "VFR_HUD", "GLOBAL_POSITION_INT", "GPS_RAW_INT", "SYS_STATUS", "BATTERY_STATUS", "NAV_CONTROLLER_OUTPUT", "MISSION_CURRENT",
    "RC_CHANNELS", "SERVO_OUTPUT_RAW", "EKF_STATUS_REPORT", "VIBRATION", "AHRS2", "RAW_IMU", "SCALED_PRESSURE", "HWSTATUS", "MEMINFO",
    "POWER_STATUS", "SYSTEM_TIME", "TERRAIN_REPORT", "WIND", "LOCAL_POSITION_NED",
}  # fmt: skip
# Parameters that it reads to lay out its pages for a copter.
READ = {
    "FRAME_CLASS", "FLTMODE_CH", "FLTMODE1", "SIMPLE", "SUPER_SIMPLE", "FENCE_TOTAL", "FENCE_ACTION", "RALLY_TOTAL", "RALLY_LIMIT_KM",
    "TERRAIN_ENABLE", "AVD_ENABLE", "CHUTE_ENABLED", "BATT_MONITOR", "BATT_CAPACITY", "FS_THR_ENABLE", "FS_THR_VALUE", "FS_GCS_ENABLE",
    "RC1_MIN", "RC1_MAX", "RC1_TRIM", "RCMAP_ROLL", "RC7_OPTION", "TUNE", "ATC_RAT_RLL_P", "LOIT_SPEED", "WPNAV_SPEED", "RTL_ALT",
    "SERVO1_FUNCTION", "MNT1_TYPE", "CAM1_TYPE", "RNGFND1_TYPE", "COMPASS_USE", "SYSID_THISMAV", "LOG_BITMASK", "STAT_RUNTIME",
}  # fmt: skip


def download(ftp, path):
    """The bytes of a file."""
    held = []
    ftp.cmd_get([path], callback=lambda file: held.append(file.read()))
    ftp.process_ftp_reply("OpenFileRO", timeout=20)
    return held[0]


def packed_parameters(client):
    """The packed file with defaults, read in bursts and decoded by pymavlink."""
    decoded = mavftp.MAVFTP.ftp_param_decode(download(file_client(client), "@PARAM/param.pck?withdefaults=1"))
    named = lambda rows: {name.decode(): value for name, value, _ in rows}  # noqa: E731
    return named(decoded.params), named(decoded.defaults)


def test_mission_planner(start, connect):
    client = connect(start("--autopilot", "ardupilot", "--speed", "4", links=("tcpin:0",)), kind="tcp")
    # It counts two heartbeats, introduces itself in both versions of the protocol, and goes on in the second.
    client.wait("HEARTBEAT")
    hello = first_version.MAVLink(None, srcSystem=255, srcComponent=190)
    client.connection.write(first_version.MAVLink_statustext_message(6, b"Mission Planner").pack(hello))
    client.mav.statustext_send(6, b"Mission Planner")
    client.mav.autopilot_version_request_send(*client.target)
    client.command(mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1)
    version = client.wait("AUTOPILOT_VERSION")
    assert version.capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_FTP and version.flight_sw_version >> 24 >= 4
    client.mav.command_long_send(*client.target, mavlink.MAV_CMD_DO_SEND_BANNER, 0, *[0] * 7)
    texts = []
    client.wait("STATUSTEXT", lambda said: texts.append(said.text) or any("copter" in text.lower() for text in texts))

    client.set_parameter("RTL_ALT", 2500)
    values, defaults = packed_parameters(client)
    every = {name: value.param_value for name, value in all_parameters(client).items()}
    assert values.keys() == every.keys() == defaults.keys()
    assert all(math.isclose(values[name], every[name], rel_tol=1e-6) for name in every if not name.startswith("STAT_"))
    assert (values["RTL_ALT"], defaults["RTL_ALT"]) == (2500, 1500)
    assert {name for name in values if values[name] != defaults[name]} >= {"RTL_ALT", "RTL_ALT_M"}
    assert READ <= values.keys(), READ - values.keys()

    for stream, rate in STREAMS.items():
        client.mav.request_data_stream_send(*client.target, stream, rate, 1)
    missing = set(SHOWN)
    client.wait(None, lambda message: missing.discard(message.get_type()) or not missing)
    # Home is item 0 of the mission.
    client.mav.mission_request_list_send(*client.target, mavlink.MAV_MISSION_TYPE_MISSION)
    assert client.wait("MISSION_COUNT").count <= 1
    client.mav.mission_request_int_send(*client.target, 0, mavlink.MAV_MISSION_TYPE_MISSION)
    home = client.wait("MISSION_ITEM_INT")
    place = client.wait("GLOBAL_POSITION_INT")
    assert (home.seq, home.command) == (0, mavlink.MAV_CMD_NAV_WAYPOINT)
    assert abs(home.x - place.lat) < 100 and abs(home.y - place.lon) < 100
    # Cameras and gimbals are looked for two seconds later: those of anybody.
    client.command(mavlink.MAV_CMD_REQUEST_CAMERA_INFORMATION)
    client.wait("CAMERA_INFORMATION")
    client.command(mavlink.MAV_CMD_REQUEST_CAMERA_SETTINGS)
    client.mav.command_long_send(0, 0, mavlink.MAV_CMD_REQUEST_MESSAGE, 0, mavlink.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION, *[0] * 6)
    assert client.wait("GIMBAL_MANAGER_INFORMATION").gimbal_device_id


def test_qgroundcontrol(start, connect):
    client = connect(start("--speed", "4"))

    def ask(number, index=0):
        client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, number, index)

    ask(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
    capabilities = client.wait("AUTOPILOT_VERSION").capabilities
    needed = ["MISSION_INT", "COMMAND_INT", "MISSION_FENCE", "MISSION_RALLY", "MAVLINK2", "PARAM_FLOAT", "FTP"]
    assert all(capabilities & getattr(mavlink, f"MAV_PROTOCOL_CAPABILITY_{name}") for name in needed)

    # All modes at once. This version of the library does not know them: custom mode, properties, count, index, kind, name.
    ask(AVAILABLE_MODES)
    modes = []
    while not modes or modes[-1][3] < modes[-1][2]:
        payload = bytes(client.wait("UNKNOWN_435").get_msgbuf())[10:-2]
        modes.append((*struct.unpack("<IIBBB", payload[:11]), payload[11:].rstrip(b"\0").decode()))
    assert [mode[3] for mode in modes] == list(range(1, modes[0][2] + 1)) and len({mode[5] for mode in modes}) == len(modes)
    assert {"Hold", "Mission", "Return", "Land", "Position", "Altitude", "Takeoff", "Offboard"} <= {mode[5] for mode in modes}
    # Newer versions ask for one after the other.
    ask(AVAILABLE_MODES, 2)
    again = bytes(client.wait("UNKNOWN_435").get_msgbuf())[10:-2]
    assert (struct.unpack("<I", again[:4])[0], again[9]) == (modes[1][0], 2)

    # Component information: the general file, and those that it names, with their checksums.
    ask(COMPONENT_METADATA)
    payload = bytes(client.wait(["UNKNOWN_397", "COMPONENT_METADATA"]).get_msgbuf())[10:-2]
    checksum, uri = struct.unpack("<I", payload[4:8])[0], payload[8:].split(b"\0")[0].decode()
    ftp, files = file_client(client), {}

    general = download(ftp, uri.removeprefix("mftp://"))
    assert protocol_crc(general) == checksum
    for entry in json.loads(general)["metadataTypes"]:
        content = download(ftp, entry["uri"].removeprefix("mftp://"))
        assert protocol_crc(content) == entry["fileCrc"]
        files[entry["type"]] = json.loads(content)
    described = {parameter["name"] for parameter in files[1]["parameters"]}

    # Parameters: a list that begins with their hash. Who has them already sends it back, and the list ends.
    every = all_parameters(client)
    assert every.keys() <= described
    client.mav.param_request_list_send(*client.target)
    digest = client.wait("PARAM_VALUE")
    assert digest.param_id == "_HASH_CHECK"
    client.mav.param_set_send(*client.target, b"_HASH_CHECK", digest.param_value, digest.param_type)
    told = []
    client.mav.ping_send(0, 77, 0, 0)
    client.wait(["PARAM_VALUE", "PING"], lambda message: told.append(message) or getattr(message, "seq", 0) == 77)
    assert len(told) < len(every)

    for kind in (mavlink.MAV_MISSION_TYPE_MISSION, mavlink.MAV_MISSION_TYPE_FENCE, mavlink.MAV_MISSION_TYPE_RALLY):
        client.mav.mission_request_list_send(*client.target, kind)
        assert client.wait("MISSION_COUNT", lambda count: count.mission_type == kind).count == 0
        client.mav.mission_ack_send(*client.target, mavlink.MAV_MISSION_ACCEPTED, kind)

    # Then its pages.
    ask(mavlink.MAVLINK_MSG_ID_CAMERA_INFORMATION)
    client.wait("CAMERA_INFORMATION")
    ask(mavlink.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION)
    client.wait("GIMBAL_MANAGER_INFORMATION")
    ask(PROTOCOL_VERSION)


@pytest.fixture
def mavros(start):
    """MAVROS with apm.launch: component 191 of the vehicle's own system, which listens."""
    yield from listening(start, "--autopilot", "ardupilot")


def test_mavros_for_ardupilot(mavros):
    first = mavros.wait("HEARTBEAT")
    assert (first.autopilot, first.type) == (mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA, mavlink.MAV_TYPE_QUADROTOR)
    for version in mavros.ask_for_the_version():
        assert version.capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    # The node's own service asks for rates, one message after the other.
    for number in (mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, mavlink.MAVLINK_MSG_ID_ATTITUDE_QUATERNION, mavlink.MAVLINK_MSG_ID_RAW_IMU):
        mavros.mav.command_long_send(1, 1, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 0, number, 50_000, 0, 0, 0, 0, 0)
        assert mavros.wait("COMMAND_ACK", lambda ack: ack.command == mavlink.MAV_CMD_SET_MESSAGE_INTERVAL).result == 0
    mavros.mav.request_data_stream_send(1, 1, mavlink.MAV_DATA_STREAM_ALL, 10, 1)
    missing = {"SYS_STATUS", "BATTERY_STATUS", "MEMINFO", "HWSTATUS", "EKF_STATUS_REPORT", "GLOBAL_POSITION_INT", "GPS_RAW_INT",
               "LOCAL_POSITION_NED", "ATTITUDE", "ATTITUDE_QUATERNION", "RAW_IMU", "SCALED_PRESSURE", "VFR_HUD", "RC_CHANNELS", "SERVO_OUTPUT_RAW",
               "NAV_CONTROLLER_OUTPUT", "SYSTEM_TIME", "VIBRATION", "MISSION_CURRENT", "WIND"}  # fmt: skip
    mavros.wait(None, lambda message: missing.discard(message.get_type()) or not missing)
    mavros.mav.command_long_send(1, 1, mavlink.MAV_CMD_GET_HOME_POSITION, 0, *[0] * 7)
    mavros.wait("HOME_POSITION")
    # Parameters, and all plans; of the mission home alone.
    mavros.mav.param_request_list_send(1, 1)
    numbers, count = set(), None
    while count is None or len(numbers) < count:
        value = mavros.wait("PARAM_VALUE")
        count = value.param_count
        numbers |= {value.param_index} - {65535}
    for kind, most in ((mavlink.MAV_MISSION_TYPE_MISSION, 1), (mavlink.MAV_MISSION_TYPE_FENCE, 0), (mavlink.MAV_MISSION_TYPE_RALLY, 0)):
        mavros.mav.mission_request_list_send(1, 1, kind)
        assert mavros.wait("MISSION_COUNT", lambda answer: answer.mission_type == kind).count <= most
    # A part of the mission is written again, as enable_partial_push does.
    mission, relative = mavlink.MAV_MISSION_TYPE_MISSION, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
    place = mavros.wait("GLOBAL_POSITION_INT")

    def give(begin, answers, height):
        for number in answers:
            asked = mavros.wait(["MISSION_REQUEST", "MISSION_REQUEST_INT"], lambda asked: asked.seq == number)
            assert asked.get_type() == "MISSION_REQUEST", "ArduPilot asks so"
            mavros.mav.mission_item_int_send(
                1, 1, number, relative, mavlink.MAV_CMD_NAV_WAYPOINT, 0, 1, 0, 0, 0, 0, place.lat + 1000 * number, place.lon, height, mission)
        assert mavros.wait("MISSION_ACK", lambda ack: ack.mission_type == mission).type == 0, begin

    mavros.mav.mission_count_send(1, 1, 4, mission)
    give("all", range(4), 20)
    mavros.mav.mission_write_partial_list_send(1, 1, 2, 2, mission)
    give("one", [2], 35)
    heights = []
    for number in range(4):
        mavros.mav.mission_request_int_send(1, 1, number, mission)
        heights.append(mavros.wait("MISSION_ITEM_INT", lambda item: item.seq == number).z)
    assert heights[1:] == [20, 35, 20]
