"""Flights that are replayed in the live page, in a headless Chromium. The oracles are what was recorded, read by other programs."""

import math
import subprocess

import numpy as np
import pytest
from pictures import check, difference
from plans import waypoints

pytestmark = pytest.mark.browser


def test_a_table_is_replayed(start, look, tmp_path):
    table = tmp_path / "result.csv"
    times = np.arange(0, 10.001, 0.1)
    rows = [f"{time:.3f},{time},{-time / 2},{-2.0},0,0.1,0,5.0" for time in times]
    table.write_text("time,position.x,position.y,position.z,attitude.phi,attitude.theta,attitude.psi,thrust\n" + "\n".join(rows) + "\n")
    vehicle = start("--view-record", str(table), "--view", "127.0.0.1:0", links=())
    shown = look(vehicle.ready["view"])
    shown.wait("page.recording && page.frame")
    assert shown.page.locator("#recording-name").inner_text() == "result.csv"
    assert not shown.page.locator("#commands").is_visible()
    shown.page.keyboard.press(" ")
    shown.wait("page.recording.paused")
    # A slow browser leaves rows out; what is sought begins anew.
    jumped = shown.value("page.recording.time += 1")
    shown.page.keyboard.press(".")
    shown.wait(f"page.frame.time > {jumped}")
    shown.page.get_by_role("slider", name="Time in the recording").fill("6")
    shown.wait("page.frame.time === 6")
    assert shown.value("page.frame.vehicles[0].position") == pytest.approx((6, -3, -2))
    # The drawn line has every place once, in order: north is -z there.
    line = np.array(shown.value("(({ drawRange, attributes }) => [...attributes.position.array.slice(0, 3 * drawRange.count)])(view.crafts.trails.get(1).geometry)"))
    assert -line[2::3] == pytest.approx(np.arange(0, 6.001, 0.1), abs=1e-4)
    # What the table lacks is not made up.
    names = shown.page.locator("#state dt").all_inner_texts()
    assert "Height" in names and not {"Mode", "Faults", "Solver", "Active limits", "Wind", "Battery"} & set(names)
    assert shown.dark_pixels(shown.project((6, -3, -2))) > 25
    assert shown.value("page.histories.get(1).time.length") == 61


def test_a_record_is_flown_again_and_shown(start, connect, look, tmp_path):
    record = tmp_path / "flight.lmpc"
    vehicle = start("--record", str(record), "--speed", "10")
    client = connect(vehicle)
    client.take_off(height=2.5)
    highest = -client.wait("LOCAL_POSITION_NED").z
    client.land()
    assert vehicle.stop() == 0
    shown = look(start("--view-record", str(record), "--view", "127.0.0.1:0", links=()).ready["view"])
    shown.wait("page.recording && page.frame")
    assert shown.page.locator("#recording-name").inner_text() == "flight.lmpc"
    heights = shown.value("page.recording.states.get(1).map((state) => -state.position[2])")
    assert max(heights) == pytest.approx(highest, abs=0.1) and heights[0] == pytest.approx(0, abs=0.01) and heights[-1] == pytest.approx(0, abs=0.05)
    times = np.array(shown.value("page.recording.times"))
    assert np.diff(times) == pytest.approx(0.033)
    shown.page.get_by_role("slider", name="Time in the recording").fill(str(times[-1]))
    shown.page.get_by_text("Disarmed after landing").wait_for()
    assert "Land" in {news["mode"] for news in shown.value("page.recording.news")}
    # The page of a live flight has the program replay what is opened in it.
    live = look(start("--view", "127.0.0.1:0").ready["view"], expected=["422 (Unprocessable Entity)"])
    live.wait("page.isPilot && page.frame")
    live.page.set_input_files("#file", record)
    live.wait("page.recording?.name === 'flight.lmpc' && page.frame")
    assert live.value("page.recording.states.get(1).map((state) => -state.position[2])") == heights
    live.page.set_input_files("#file", {"name": "broken.lmpc", "mimeType": "application/octet-stream", "buffer": b"nothing"})
    live.page.get_by_text("broken.lmpc: is not a record: line 1").first.wait_for()


def test_the_picture_in_the_book_is_the_page(program, start, look, tmp_path):
    """A flight that nobody steers, so that it is always the same, at one of its instants."""
    record, plan = tmp_path / "survey.lmpc", waypoints(tmp_path, (20, 0, 8), (20, 20, 12), (0, 20, 8), (0, 0, 8))
    fence = ("--set", "GF_MAX_HOR_DIST=35", "--set", "GF_MAX_VER_DIST=15", "--set", "GF_ACTION=2")
    flags = ("--mission", plan, "--autostart", *fence, "--wind", "4", "--gusts", "1", "--speed", "max", "--duration", "25")
    subprocess.run([program, "--link", "udpin:0", *flags, "--record", record], check=True, timeout=60)
    shown = look(start("--view-record", str(record), "--view", "127.0.0.1:0", links=()).ready["view"], size=(1280, 860))
    shown.wait("page.recording && page.frame")
    shown.page.locator("#view").focus()
    shown.page.keyboard.press(" ")
    shown.wait("page.recording.paused")
    shown.page.get_by_role("button", name="Show all").click()
    for key in ("ArrowRight", "ArrowRight", "ArrowRight", "+", "+", "+"):
        shown.page.keyboard.press(key)
    seek = shown.page.get_by_role("slider", name="Time in the recording")
    pictures = {}
    for time in ("8", "19"):
        seek.fill(time)
        shown.wait(f"Math.abs(page.frame.time - {time}) < 0.04")
        shown.fine()
        # Numbers are written last.
        height = -shown.value("page.frame.vehicles[0].position[2]")
        shown.page.get_by_text(f"{height:.2f} m", exact=True).wait_for()
        shown.page.evaluate("() => document.activeElement.blur()")
        pictures[time] = tmp_path / f"{time}.png"
        shown.page.screenshot(path=pictures[time])
    check(pictures["19"], "live-page.png", 0.02)
    assert difference(*pictures.values()) > 0.02


def test_a_page_with_the_flight_in_it_opens_from_the_disk(program, look, tmp_path):
    table = tmp_path / "result <1>.csv"
    rows = [f"{time:.1f},{time:.1f},0,-2" for time in np.arange(0, 10.05, 0.1)]
    table.write_text("time,position.x,position.y,position.z\n" + "\n".join(rows) + "\n")
    page = tmp_path / "result.html"
    subprocess.run([program, "--view-record", table, "--view-page", page], check=True, timeout=60)
    shown = look(page.as_uri())
    shown.wait("page.recording && page.frame")
    assert shown.page.title() == "result <1>.csv"
    shown.page.keyboard.press(" ")
    shown.wait("page.recording.paused")
    shown.page.get_by_role("slider", name="Time in the recording").fill("6")
    shown.wait("page.frame.time === 6")
    assert shown.dark_pixels(shown.project((6, 0, -2))) > 25
    assert {url.split(":")[0] for url in shown.requests} <= {"file", "data"} and len([url for url in shown.requests if url.startswith("file")]) == 1


def test_a_log_is_opened_by_the_page_itself(start, connect, look, tmp_path):
    logs = tmp_path / "logs"
    vehicle = start("--log-dir", str(logs), "--speed", "10", "--view", "127.0.0.1:0")
    client = connect(vehicle)
    client.take_off(height=2.5)
    client.land()
    client.wait("HEARTBEAT")
    shown = look(vehicle.ready["view"])
    shown.wait("page.isPilot && page.frame")
    log, = list(logs.rglob("*.ulg"))
    shown.page.set_input_files("#file", log)
    shown.wait("page.recording && page.frame")
    heights = shown.value("page.recording.states.get(1).map((state) => -state.position[2])")
    pyulog = pytest.importorskip("pyulog", reason="pyulog is among the packages of `cargo xtask test`")
    topics = {topic.name: topic.data for topic in pyulog.ULog(str(log)).data_list}
    flown, asked, own = (topics[name] for name in ("vehicle_local_position_groundtruth", "vehicle_local_position_setpoint", "lmpc_status"))
    assert max(heights) == pytest.approx(-flown["z"].min(), abs=0.02)
    # Topics have other rates than the page: what moves is between the samples of each.
    rows = shown.value("page.recording.states.get(1).map((state, index) => [page.recording.times[index], state.tracks, state.setpoint[2], state.position[2]])")
    times, _, down, at = np.array([row for row in rows if row[1]], dtype=float).T
    assert len(times) > 100
    assert down == pytest.approx(np.interp(1e6 * times, asked["timestamp"], asked["z"]), abs=1e-4)
    assert at == pytest.approx(np.interp(1e6 * times, flown["timestamp"], flown["z"]), abs=1e-4)
    for name, columns in (("thrust", ["thrust_n"]), ("active", [f"{law}_active_constraints" for law in ("altitude", "position", "attitude")])):
        drawn = {value for value in shown.value(f"page.recording.states.get(1).flatMap((state) => state.{name})") if not math.isnan(value)}
        assert max(drawn) > 0 and drawn <= set(np.concatenate([own[column] for column in columns]).tolist()), name
    # The mode and the messages at the shown time.
    changes = shown.value("page.recording.news.slice(-4).map(({ time_s, mode }) => [time_s, mode])")
    assert [mode for _, mode in changes] == ["Takeoff", "Hold", "Land", "Hold"], changes
    for time, mode in changes:
        shown.value(f"page.recording.seek({time} + 0.1)")
        shown.page.locator("dt:text-is('Mode') + dd").get_by_text(mode, exact=True).wait_for()
    said = {(line.timestamp / 1e6, line.message) for line in pyulog.ULog(str(log)).logged_messages}
    assert {(time, text) for time, text in shown.value("page.recording.texts.map(({ time_s, text }) => [time_s, text])")} == said and said
    shown.page.get_by_role("button", name="Close the recording").click()
    shown.wait("!page.recording && page.frame")
    shown.page.set_input_files("#file", {"name": "broken.ulg", "mimeType": "application/octet-stream", "buffer": b"nothing"})
    shown.page.get_by_text("broken.ulg: The file is not a ULog.").first.wait_for()
