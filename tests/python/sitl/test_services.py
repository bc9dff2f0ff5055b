"""Identity, parameters, message rates, time, files: what clients ask for when they connect."""

import struct
import time

from pymavlink import mavparm
from pymavlink.dialects.v20 import ardupilotmega as mavlink


def all_parameters(client):
    client.mav.param_request_list_send(*client.target)
    values = {}
    while True:
        value = client.wait("PARAM_VALUE")
        if value.param_index == 65535:
            continue
        values[value.param_index] = value
        if len(values) == value.param_count:
            return {value.param_id: value for value in values.values()}


def test_parameters(start, connect, tmp_path):
    file = tmp_path / "vehicle.parm"
    vehicle = start("--parameters", str(file))
    client = connect(vehicle)
    every = all_parameters(client)
    assert len(every) > 70
    assert [value.param_index for _, value in sorted(every.items())] == list(range(len(every)))
    before = client.parameter("_HASH_CHECK").param_value

    # A weight of a controller, in flight; the hash follows, the vehicle does not move.
    client.take_off()
    assert client.set_parameter("POS_R_PITCH", 900.0).param_value == 900.0
    assert client.parameter("_HASH_CHECK").param_value != before
    place = client.wait("LOCAL_POSITION_NED")
    assert abs(place.x) < 0.02 and abs(place.z + 2.5) < 0.1

    # A part of the vehicle, and a kind of controllers: it goes on from the thrust that it had.
    assert abs(client.set_parameter("FRAME_MASS", 0.8).param_value - 0.8) < 1e-6
    place = client.wait("LOCAL_POSITION_NED")
    assert abs(place.x) < 0.02 and abs(place.z + 2.5) < 0.1

    # Refused, with the reason: out of range, and fixed from the start.
    assert client.set_parameter("LIM_TILT", 9.0).param_value < 1.0
    client.wait("STATUSTEXT", lambda text: "allowed 0.05 to 1.2 rad" in text.text)
    field = struct.unpack("<f", struct.pack("<i", 9))[0]
    client.set_parameter("MAV_SYS_ID", field, mavlink.MAV_PARAM_TYPE_INT32)
    client.wait("STATUSTEXT", lambda text: "MAV_SYS_ID is read-only" in text.text)
    # Integers travel as bytes.
    field = struct.unpack("<f", struct.pack("<i", 4))[0]
    answer = client.set_parameter("COM_OBL_RC_ACT", field, mavlink.MAV_PARAM_TYPE_INT32)
    assert struct.pack("<f", answer.param_value) == struct.pack("<i", 4)
    client.land()

    # They are kept, and there again after the next start.
    assert "POS_R_PITCH 900" in file.read_text() and "COM_OBL_RC_ACT 4" in file.read_text()
    # MAVProxy's own reader takes the file.
    kept = mavparm.MAVParmDict()
    assert kept.load(str(file)) and kept["POS_R_PITCH"] == 900.0
    assert vehicle.stop() == 0
    again = connect(start("--parameters", str(file)))
    assert again.parameter("POS_R_PITCH").param_value == 900.0
    assert abs(again.parameter("FRAME_MASS").param_value - 0.8) < 1e-6


def test_identity_and_modes(start, connect):
    client = connect(start("--system-id", "7", "--autopilot", "ardupilot"))
    assert client.target == (7, 1)
    client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
    version = client.wait("AUTOPILOT_VERSION")
    assert version.capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    plans = ["MISSION_FLOAT", "MISSION_INT", "MISSION_FENCE", "MISSION_RALLY"]
    assert all(version.capabilities & getattr(mavlink, f"MAV_PROTOCOL_CAPABILITY_{plan}") for plan in plans)
    assert version.vendor_id and not any(version.flight_custom_version)
    client.command(mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1)
    client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 435, 0)
    # This version of the library does not know AVAILABLE_MODES: its name is behind 11 bytes of numbers.
    first = bytes(client.wait("UNKNOWN_435").get_msgbuf())[10:-2]
    bodies = [first] + [bytes(client.wait("UNKNOWN_435").get_msgbuf())[10:-2] for _ in range(first[8] - 1)]
    names = {body[11:].rstrip(b"\0").decode() for body in bodies}
    assert names == {"Stabilize", "Acro", "AltHold", "Loiter", "PosHold", "Brake", "Auto", "Auto RTL", "RTL", "Land", "Guided", "Guided NoGPS",
                     "Circle", "Follow", "Smart RTL", "Throw", "Flip", "ZigZag"}
    client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 395, result=mavlink.MAV_RESULT_UNSUPPORTED)
    # An integer of ArduPilot travels as a number.
    assert client.set_parameter("COM_OBL_RC_ACT", 3.0, mavlink.MAV_PARAM_TYPE_INT32).param_value == 3.0
    # Nobody is kept waiting.
    client.mav.mission_request_list_send(*client.target)
    assert client.wait("MISSION_COUNT").count == 0
    client.mav.mission_count_send(*client.target, 60000)
    assert client.wait("MISSION_ACK").type == mavlink.MAV_MISSION_NO_SPACE
    client.mav.log_request_list_send(*client.target, 0, 0xFFFF)
    assert client.wait("LOG_ENTRY").num_logs == 0


def test_rates_and_time(start, connect):
    client = connect(start())
    client.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ATTITUDE, 10_000)
    client.command(mavlink.MAV_CMD_GET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ATTITUDE)
    assert client.wait("MESSAGE_INTERVAL").interval_us == 10_000
    client.drain()
    times = [client.wait("ATTITUDE").time_boot_ms for _ in range(200)]
    gaps = [after - before for before, after in zip(times, times[1:])]
    assert max(gaps) == min(gaps) == 10, "in simulation time a rate holds exactly"

    client.mav.request_data_stream_send(*client.target, mavlink.MAV_DATA_STREAM_EXTRA1, 50, 1)
    times = [client.wait("ATTITUDE").time_boot_ms for _ in range(120)]
    gaps = [after - before for before, after in zip(times, times[1:])]
    assert set(gaps[-60:]) == {20}, gaps

    client.mav.timesync_send(0, 123_456)
    answer = client.wait("TIMESYNC", lambda sync: sync.ts1 == 123_456)
    assert answer.tc1 > 0
    client.mav.ping_send(42, 7, 0, 0)
    assert client.wait("PING").seq == 7
    assert abs(client.wait("SYSTEM_TIME").time_unix_usec / 1e6 - time.time()) < 2


def test_telemetry_agrees_with_itself(start, connect):
    client = connect(start("--home", "10,20,100,90", links=("udpin:0,onboard",)))
    client.take_off(110.0, 10.0)
    wanted = {"ATTITUDE", "ATTITUDE_QUATERNION", "LOCAL_POSITION_NED", "GLOBAL_POSITION_INT", "ODOMETRY", "HIGHRES_IMU",
              "ATTITUDE_TARGET", "POSITION_TARGET_LOCAL_NED", "SYS_STATUS", "EXTENDED_SYS_STATE", "GPS_RAW_INT", "VFR_HUD",
              "ALTITUDE", "BATTERY_STATUS", "HOME_POSITION", "ESTIMATOR_STATUS", "VIBRATION", "GPS_GLOBAL_ORIGIN",
              "SERVO_OUTPUT_RAW", "SYSTEM_TIME", "TIMESYNC", "HEARTBEAT"}
    messages = {}
    end = time.monotonic() + 4
    while time.monotonic() < end:
        message = client.connection.recv_match(blocking=True, timeout=1)
        messages[message.get_type()] = message
    assert wanted <= messages.keys(), wanted - messages.keys()
    assert abs(messages["LOCAL_POSITION_NED"].z + 10) < 0.05
    assert abs(messages["GLOBAL_POSITION_INT"].alt - 110_000) < 50
    assert abs(messages["GLOBAL_POSITION_INT"].hdg - 9000) < 20 and messages["VFR_HUD"].heading in (89, 90)
    assert abs(messages["ALTITUDE"].altitude_relative - 10) < 0.05
    assert abs(messages["GPS_RAW_INT"].lat - 100_000_000) < 10
    assert abs(messages["HIGHRES_IMU"].zacc + 9.80665) < 0.1
    assert messages["BATTERY_STATUS"].battery_remaining >= 99
    assert messages["HOME_POSITION"].altitude // 100 in (999, 1000)
    assert messages["EXTENDED_SYS_STATE"].landed_state == mavlink.MAV_LANDED_STATE_IN_AIR


def test_file_transfer(start, connect):
    client = connect(start())

    def ask(sequence, opcode, size=0, offset=0, data=b"", session=5):
        payload = struct.pack("<HBBBBBBI", sequence, session, opcode, size, 0, 0, 0, offset) + data
        client.mav.file_transfer_protocol_send(0, *client.target, list(payload.ljust(251, b"\0")))
        answer = bytes(client.wait("FILE_TRANSFER_PROTOCOL").payload)
        number, _, kind, length, _, _, _, _ = struct.unpack("<HBBBBBBI", answer[:12])
        assert number == sequence + 1
        return kind, answer[12:12 + length]

    path = b"@PARAM/param.pck"
    kind, size = ask(1, 4, len(path), data=path)
    assert kind == 128
    size, content = struct.unpack("<I", size)[0], b""
    while len(content) < size:
        kind, piece = ask(2, 5, 200, len(content))
        content += piece
    magic, count, total = struct.unpack("<HHH", content[:6])
    assert magic == 0x671B and count == total == len(all_parameters(client))
    assert ask(3, 5, 200, size) == (129, bytes([6]))
    for other in (b"/etc/passwd", b"../../etc/passwd", b"@PARAM/../param.pck", b""):
        assert ask(4, 4, len(other), data=other) == (129, bytes([10]))
    assert ask(5, 7, 5, data=b"a.txt") == (129, bytes([9]))
    assert ask(6, 77) == (129, bytes([7]))
