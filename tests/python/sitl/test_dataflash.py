"""Logs in ArduPilot's format, read by pymavlink's DFReader, and a reboot as ArduPilot's own tests ask for it."""

import subprocess
import time

from pymavlink import DFReader
from pymavlink.dialects.v20 import ardupilotmega as mavlink

GUIDED, LAND = 4, 9


def fly(client):
    client.set_mode((1, GUIDED))
    client.arm()
    client.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 4)
    client.wait("GLOBAL_POSITION_INT", lambda message: message.relative_alt > 3800)
    client.set_mode((1, LAND))
    client.wait("HEARTBEAT", lambda message: not message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 30)


def test_dfreader_reads_a_flight_without_a_warning(start, connect, tmp_path, capfd):
    folder = tmp_path / "logs"
    vehicle = start("--autopilot", "ardupilot", "--log-dir", str(folder), "--speed", "8")
    client = connect(vehicle)
    fly(client)
    # Onto the same log, as ArduPilot does, and another one behind a reboot.
    boots = client.parameter("STAT_BOOTCNT").param_value
    client.command(mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)
    deadline = time.monotonic() + 10
    while client.parameter("STAT_BOOTCNT").param_value != boots + 1:
        assert time.monotonic() < deadline, "no reboot"
    client.wait("SYSTEM_TIME", lambda message: message.time_boot_ms < 60_000)
    fly(client)
    vehicle.stop()
    assert (folder / "LASTLOG.TXT").read_text().strip() == "2"

    capfd.readouterr()
    log = DFReader.DFReader_binary(str(folder / "00000001.BIN"))
    seen, modes, heights, climbs = {}, [], [], []
    while (message := log.recv_msg()) is not None:
        kind = message.get_type()
        seen[kind] = seen.get(kind, 0) + 1
        if kind == "MODE":
            modes.append(message.ModeNum)
        if kind == "CTUN":
            heights.append(message.Alt)
            climbs.append(message.CRt)
        if kind == "ATT":
            assert abs(message.Roll) < 30 and 0 <= message.Yaw <= 360
    assert capfd.readouterr() == ("", ""), "the reader warns"
    assert log.mav_type == mavlink.MAV_TYPE_QUADROTOR and log.params["LOG_BITMASK"] == 176126
    assert log.percent > 99
    expected = ("FMT FMTU UNIT MULT PARM MSG MODE ATT RATE POS GPS GPA IMU BARO MAG BAT CTUN PSCN PSCE PSCD RCIN RCOU EV ARM ORGN "
                "XKF1 XKF2 XKF3 XKF4 VIBE MOTB SIM PM").split()
    assert not [name for name in expected if name not in seen], seen
    assert modes[-2:] == [GUIDED, LAND], "it stays in Land"
    assert 3.8 < max(heights) < 4.3 and max(climbs) > 50, "centimetres per second"
    assert log.formats[log.name_to_id["ATT"]].get_unit("Roll") == "deg"
    assert log.formats[log.name_to_id["MAG"]].get_unit("MagX") == "mGauss"


def test_logs_are_listed_and_downloaded_as_ardupilots(start, connect, tmp_path):
    folder = tmp_path / "logs"
    vehicle = start("--autopilot", "ardupilot", "--log-dir", str(folder), "--speed", "8", "--set", "LOG_FILE_DSRMROT=1")
    client = connect(vehicle)
    fly(client)
    # The log ends a second of simulation after the flight.
    end = client.wait("SYSTEM_TIME").time_boot_ms + 2000
    client.wait("SYSTEM_TIME", lambda message: message.time_boot_ms > end)
    client.mav.log_request_list_send(1, 1, 0, 0xffff)
    entry = client.wait("LOG_ENTRY")
    assert (entry.id, entry.num_logs, entry.last_log_num) == (1, 1, 1), "ArduPilot counts from 1, and LASTLOG.TXT is no log"
    client.mav.log_request_data_send(1, 1, 1, 0, 900)
    content = b""
    while len(content) < 900:
        piece = client.wait("LOG_DATA", lambda message: message.ofs == len(content))
        content += bytes(piece.data[:piece.count])
    assert content == (folder / "00000001.BIN").read_bytes()[:900]


def test_plans_survive_a_restart_and_a_record_replays_over_a_reboot(start, connect, program, tmp_path):
    parameters, record = tmp_path / "kept.params", tmp_path / "flight.record"
    options = ("--autopilot", "ardupilot", "--parameters", str(parameters), "--speed", "8")
    vehicle = start(*options, "--record", str(record))
    client = connect(vehicle)
    items = [(mavlink.MAV_CMD_NAV_WAYPOINT, 0), (mavlink.MAV_CMD_NAV_TAKEOFF, 5), (mavlink.MAV_CMD_NAV_WAYPOINT, 7)]
    client.mav.mission_count_send(*client.target, len(items))
    for number, (command, height) in enumerate(items):
        client.wait(["MISSION_REQUEST", "MISSION_REQUEST_INT"], lambda request: request.seq == number)
        client.mav.mission_item_int_send(*client.target, number, 3, command, 0, 1, 0, 0, 0, 0, 473977418, 85455939, height)
    assert client.wait("MISSION_ACK").type == mavlink.MAV_MISSION_ACCEPTED

    def count():
        client.mav.mission_request_list_send(*client.target)
        return client.wait("MISSION_COUNT").count

    client.command(mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1)
    client.wait("STATUSTEXT", lambda message: "simulated quadrotor" in message.text)
    assert count() == 3, "over a reboot"
    assert vehicle.stop() == 0
    client = connect(start(*options))
    assert count() == 3, "over a restart"
    replayed = subprocess.run([program, "--replay", record], capture_output=True, text=True, timeout=60)
    assert replayed.returncode == 0 and "the same flight" in replayed.stdout, replayed.stdout + replayed.stderr
