"""Logs of flights: written as ULog, read by pyulog, downloaded by MAVSDK and pymavlink; and the traffic log."""

import base64
import math
import time

import numpy as np
import pytest
from mavsdk.plugins.log_files import LogFiles, LogFilesResult
from mavsdk.plugins.log_streaming import LogStreaming
from pymavlink import mavutil
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from pyulog import ULog
from pyulog.px4 import PX4ULog

from client import near, patiently
from mavsdk_vehicle import eventually
from test_program import run


FLIGHT_REVIEW = {
    "vehicle_local_position": "x y z vx vy vz xy_valid z_valid v_xy_valid v_z_valid",
    "vehicle_local_position_setpoint": "x y z vx vy vz",
    "vehicle_local_position_groundtruth": "x y z",
    "vehicle_global_position": "lat lon alt",
    "vehicle_gps_position": "time_utc_usec latitude_deg longitude_deg altitude_msl_m eph epv satellites_used fix_type",
    "vehicle_attitude": "q[0] q[3]", "vehicle_attitude_setpoint": "q_d[0] q_d[3] yaw_sp_move_rate", "vehicle_attitude_groundtruth": "q[0] q[3]",
    "vehicle_angular_velocity": "xyz[0] xyz[2]", "vehicle_angular_velocity_groundtruth": "xyz[0] xyz[2]",
    "vehicle_air_data": "baro_alt_meter", "vehicle_magnetometer": "magnetometer_ga[0] magnetometer_ga[2]",
    "sensor_combined": "accelerometer_m_s2[0] gyro_rad[2]", "vehicle_imu_status": "accel_vibration_metric",
    "estimator_status": "health_flags timeout_flags innovation_check_flags time_slip",
    "actuator_motors": "control[0] control[3]", "actuator_outputs": "noutputs output[0] output[3]",
    "battery_status": "voltage_v voltage_filtered_v current_a discharged_mah remaining",
    "vehicle_status": "nav_state arming_state vehicle_type failsafe", "vehicle_land_detected": "landed",
}


def topics(log: ULog) -> dict:
    return {dataset.name: dataset.data for dataset in log.data_list}


def logs(folder):
    return sorted(folder.glob("*.ulg"))


def test_flights_read_by_pyulog(start, connect, program, tmp_path):
    folder, record = tmp_path / "logs", tmp_path / "record"
    vehicle = start(*patiently("--log-dir", str(folder), "--record", str(record), "--speed", "5", "--wind", "3,90"))
    client = connect(vehicle)
    client.take_off()
    client.go(lambda: client.position((3, 2, -4)))
    client.stream(lambda: client.position((3, 2, -4)), near((3, 2, -4), 0.3, 0.3))
    client.set_parameter("LIM_SPEED_HORIZ", 4.5)
    client.land()
    client.arm()
    client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
    vehicle.stop()
    assert len(logs(folder)) == 2, "one for each time that it was armed"

    log = ULog(str(logs(folder)[0]))
    assert not log.file_corruption and not log.dropouts
    assert log.msg_info_dict["sys_name"] == "lmpc-sitl" and log.get_version_info()[:3] == (0, 1, 0)
    # Without it Flight Review looks for the receiver's places under the names of before.
    assert log.msg_info_dict["ver_data_format"] >= 2
    assert log.initial_parameters["MIS_TAKEOFF_ALT"] == 2.5 and isinstance(log.initial_parameters["COM_OBL_RC_ACT"], int)
    assert ("LIM_SPEED_HORIZ", pytest.approx(4.5)) in [(name, value) for _, name, value in log.changed_parameters]
    said = [message.message for message in log.logged_messages]
    assert {"Armed", "Takeoff height reached", "Disarmed after landing"} <= set(said), said
    data = topics(log)
    assert {
        "vehicle_local_position", "vehicle_local_position_setpoint", "vehicle_attitude", "vehicle_attitude_setpoint",
        "vehicle_angular_velocity", "actuator_outputs", "actuator_motors", "vehicle_status", "battery_status",
        "vehicle_gps_position", "sensor_combined", "vehicle_land_detected", "lmpc_status", "vehicle_global_position",
    } <= data.keys()

    # What the plots of Flight Review take without a default (its public plot_app/configured_plots.py): one that is missing is a plot less.
    for topic, fields in FLIGHT_REVIEW.items():
        assert set(fields.split()) <= data[topic].keys(), topic

    # It went where it was sent, as it was told to, and the topics agree with one another.
    position, setpoint = data["vehicle_local_position"], data["vehicle_local_position_setpoint"]
    goal = np.argmin(np.abs(position["x"] - 3) + np.abs(position["y"] - 2) + np.abs(position["z"] + 4))
    assert math.dist((position["x"][goal], position["y"][goal], position["z"][goal]), (3, 2, -4)) < 0.3
    flown = np.interp(position["timestamp"], setpoint["timestamp"], np.nan_to_num(setpoint["z"]))
    climbing = (position["z"] < -0.5) & ~np.isnan(np.interp(position["timestamp"], setpoint["timestamp"], setpoint["z"]))
    assert np.sqrt(np.mean((flown - position["z"])[climbing] ** 2)) < 0.2
    speed = np.gradient(position["x"], position["timestamp"] / 1e6)
    assert np.max(np.abs(speed - position["vx"])) < 0.2
    px4 = PX4ULog(log)
    px4.add_roll_pitch_yaw()
    attitude = topics(log)["vehicle_attitude"]
    assert np.max(np.abs(attitude["pitch"])) > 0.02 and np.max(np.abs(attitude["roll"])) < 0.6
    norms = sum(attitude[f"q[{index}]"] ** 2 for index in range(4))
    assert np.allclose(norms, 1, atol=1e-4)
    status = data["vehicle_status"]
    assert list(np.unique(status["arming_state"])) == [1, 2] and status["arming_state"][-1] == 1
    assert {17, 4, 14, 18} <= set(status["nav_state"]), "takeoff, hold, offboard, land"
    landed = data["vehicle_land_detected"]["landed"]
    assert landed[0] == landed[-1] == 1 and 0 in landed
    gps = data["vehicle_gps_position"]
    assert abs(gps["latitude_deg"][0] - 47.397742) < 1e-3 and abs(gps["time_utc_usec"][0] / 1e6 - time.time()) < 600
    motors = data["actuator_motors"]
    assert all(0 < np.max(motors[f"control[{index}]"]) <= 1 for index in range(4)) and np.isnan(motors["control[4]"]).all()
    hover = np.median(-data["sensor_combined"]["accelerometer_m_s2[2]"])
    assert abs(hover - 9.81) < 0.5
    assert np.all(np.diff(data["battery_status"]["remaining"]) <= 0)
    control = data["lmpc_status"]
    assert np.max(control["position_active_constraints"]) >= 0 and set(control["attitude_status"]) <= {0, 1, 2, 3}
    assert np.median(control["thrust_n"][control["steering"] == 1]) == pytest.approx(0.7 * 9.80665, rel=0.1)
    assert control["believed_mass_kg"][-1] == pytest.approx(0.7, rel=0.05)

    # With the log the flight is that of the record.
    flight = vehicle.output().split("digest ")[1].split()[0]
    assert flight in run(program, "--replay", record).stdout


def test_a_crash_loses_less_than_a_second(start, connect, tmp_path):
    folder, traffic = tmp_path / "logs", tmp_path / "flight.tlog"
    vehicle = start("--log-dir", str(folder), "--tlog", str(traffic), "--speed", "3")
    client = connect(vehicle)
    client.take_off()
    last = client.wait("LOCAL_POSITION_NED").time_boot_ms
    vehicle.process.kill()
    vehicle.process.wait()
    vehicle.process.returncode = 0
    log = ULog(str(logs(folder)[0]))
    end = max(int(dataset.data["timestamp"][-1]) for dataset in log.data_list)
    assert end / 1000 > last - 1050
    reader = mavutil.mavlink_connection(str(traffic))
    stamps = [message.time_boot_ms for message in iter(lambda: reader.recv_match(type="LOCAL_POSITION_NED"), None)]
    assert stamps[-1] > last - 1050


def test_rotation(program, tmp_path):
    folder = tmp_path / "logs"
    result = run(program, "--link", "udpin:0", "--log-dir", folder, "--log-start", "boot", "--log-size", "0.3", "--log-count", "3",
                 "--speed", "max", "--duration", "60", "--vehicles", "2", "--formation", "line")
    assert result.returncode == 0, result.stderr
    assert len(logs(folder)) == 3
    assert all(file.stat().st_size < 400_000 for file in logs(folder))
    assert all(not ULog(str(file)).file_corruption for file in logs(folder))


def test_download_by_pymavlink(start, connect, tmp_path):
    folder = tmp_path / "logs"
    vehicle = start("--log-dir", str(folder), "--speed", "5")
    client = connect(vehicle)
    client.mav.log_request_list_send(*client.target, 0, 0xFFFF)
    assert client.wait("LOG_ENTRY").num_logs == 0
    for _ in range(2):
        client.arm()
        client.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
        # A log ends a second after the flight.
        over = client.wait("ATTITUDE").time_boot_ms + 1200
        client.wait("ATTITUDE", lambda attitude: attitude.time_boot_ms > over)
    client.mav.log_request_list_send(*client.target, 0, 0xFFFF)
    entries = [client.wait("LOG_ENTRY", lambda entry, number=number: entry.id == number) for number in range(2)]
    assert all(entry.num_logs == 2 and entry.last_log_num == 1 for entry in entries)
    assert abs(entries[0].time_utc - time.time()) < 60
    content = bytearray(entries[0].size)
    missing = set(range(0, entries[0].size, 90))
    end = time.monotonic() + 20
    client.mav.log_request_data_send(*client.target, 0, 0, 0xFFFFFFFF)
    while missing and time.monotonic() < end:
        piece = client.connection.recv_match(type="LOG_DATA", blocking=True, timeout=0.3)
        if piece is None:
            client.mav.log_request_data_send(*client.target, 0, min(missing), 90)
            continue
        content[piece.ofs:piece.ofs + piece.count] = bytes(piece.data[:piece.count])
        missing.discard(piece.ofs)
    assert not missing and bytes(content) == logs(folder)[0].read_bytes()
    client.mav.log_erase_send(*client.target)
    client.wait("STATUSTEXT", lambda text: "Logs erased" in text.text)
    assert logs(folder) == []


def test_download_by_mavsdk(fly, tmp_path):  # noqa: F811
    folder = tmp_path / "logs"
    system = fly("--log-dir", str(folder), "--log-start", "boot", "--speed", "5")
    files = LogFiles(system)
    entries = []

    def listed():
        entries[:] = files.get_entries()
        return entries and entries[0].size_bytes > 50_000

    eventually("a log", listed)
    results = []
    files.download_log_file_async(entries[0], str(tmp_path / "got.ulg"), lambda result, progress, _: results.append(result))
    eventually("the log", lambda: results and results[-1] != LogFilesResult.NEXT)
    assert results[-1] == LogFilesResult.SUCCESS
    got = (tmp_path / "got.ulg").read_bytes()
    assert len(got) == entries[0].size_bytes and logs(folder)[0].read_bytes().startswith(got)
    # It was being written when it was listed: what is there can be read.
    assert "vehicle_attitude" in topics(ULog(str(tmp_path / "got.ulg")))


def streamed(client, lost, fly) -> tuple[bytes, int]:
    """A log that is streamed until `fly`, which sees each position from the first data on, says that it is enough. The first copy of some reliable
    chunks is lost. Returns the log, and how many were lost."""
    client.command(mavlink.MAV_CMD_LOGGING_START, 0)
    chunks, dropped, reliable = {}, set(), set()
    end = time.monotonic() + 60
    while time.monotonic() < end:
        message = client.connection.recv_match(type=["LOGGING_DATA", "LOGGING_DATA_ACKED", "LOCAL_POSITION_NED"], blocking=True, timeout=1)
        if message is None:
            continue
        if message.get_type() == "LOCAL_POSITION_NED":
            if len(chunks) > len(reliable) and fly(message):
                client.command(mavlink.MAV_CMD_LOGGING_STOP)
                assert sorted(chunks) == list(range(len(chunks))), "nothing is missing"
                assert reliable == set(range(len(reliable))), "the definitions come first"
                return b"".join(data for _, data in sorted(chunks.items())), len(dropped)
            continue
        assert (message.target_system, message.target_component) == (client.mav.srcSystem, client.mav.srcComponent)
        if message.get_type() == "LOGGING_DATA_ACKED":
            if lost(message.sequence) and message.sequence not in dropped:
                dropped.add(message.sequence)
                continue
            reliable.add(message.sequence)
            client.mav.logging_ack_send(*client.target, message.sequence)
        chunks[message.sequence] = bytes(message.data[:message.length])
        # A whole entry of the log: its length, and its letter.
        if message.first_message_offset < message.length - 3 and message.sequence:
            assert chr(message.data[message.first_message_offset + 2]) in "BIFMPADOS", message
    raise AssertionError(f"{len(chunks)} chunks in 60 s")


def test_a_log_is_streamed_while_it_is_written(start, connect, tmp_path):
    client = connect(start("--speed", "2", "--set", "RTL_RETURN_ALT=12.5"))
    heights, landed_ms = [], []

    def fly(message):
        """Takes off to 2.5 m, lands, and stays for a second: the stream is behind the flight."""
        ask = lambda number, *values: client.mav.command_long_send(*client.target, number, 0, *values, *[math.nan] * (7 - len(values)))  # noqa: E731
        if not heights:
            ask(mavlink.MAV_CMD_NAV_TAKEOFF)
            ask(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        elif max(heights) < 2.4 <= -message.z:
            ask(mavlink.MAV_CMD_NAV_LAND)
        heights.append(-message.z)
        if max(heights) > 2.4 and heights[-1] < 0.02:
            landed_ms.append(message.time_boot_ms)
        return bool(landed_ms) and landed_ms[-1] - landed_ms[0] >= 1000

    log, lost = streamed(client, lambda sequence: sequence % 7 == 3, fly)
    assert lost >= 5
    path = tmp_path / "streamed.ulg"
    path.write_bytes(log)
    read = ULog(str(path))
    assert not read.file_corruption and not read.dropouts
    assert read.initial_parameters["RTL_RETURN_ALT"] == 12.5
    times, downs = (topics(read)["vehicle_local_position"][name] for name in ("timestamp", "z"))
    # In simulation time, each sample is there: the first one when the stream begins, the others at the multiples of 20 ms.
    steps = np.diff(times.astype(int))
    assert 0 < steps[0] <= 20_000 and (steps[1:] == 20_000).all() and not (times[1:] % 20_000).any()
    assert -downs.min() == pytest.approx(max(heights), abs=0.1) and abs(downs[-1]) < 0.2


def test_mavsdk_gets_a_streamed_log(fly, tmp_path):
    system = fly()
    streaming, pieces = LogStreaming(system), []
    streaming.subscribe_log_streaming_raw(lambda raw, _: pieces.append(base64.b64decode(raw.data_base64)))
    streaming.start_log_streaming()
    eventually("a second of data", lambda: sum(map(len, pieces)) > 200_000)
    streaming.stop_log_streaming()
    path = tmp_path / "streamed.ulg"
    path.write_bytes(b"".join(pieces))
    assert "vehicle_attitude" in topics(ULog(str(path)))
