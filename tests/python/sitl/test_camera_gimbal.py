"""MAVSDK's camera and gimbal plugins, as its examples use them: photos, mode, storage, zoom; control, angles, rates and a region of interest."""

import math

import pytest
from mavsdk.plugins.camera import Camera, CameraError, Mode, Option, Setting
from mavsdk.plugins.gimbal import ControlMode, Gimbal, GimbalMode, SendMode
from mavsdk.plugins.gripper import Gripper
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mavsdk_vehicle import eventually


@pytest.mark.parametrize("arguments", [(), ("--equipment", "own"), ("--autopilot", "ardupilot")], ids=" ".join)
def test_photos(fly, arguments):
    camera = Camera(fly(*arguments))
    eventually("a camera", lambda: camera.camera_list().cameras)
    [found] = camera.camera_list().cameras
    assert found.model_name == "Simulated camera" and found.horizontal_resolution_px == 4000
    own = "own" in arguments
    assert found.component_id == (100 if own else 1)
    images = []
    camera.subscribe_capture_info(lambda image, _: images.append(image))
    camera.set_mode(found.component_id, Mode.PHOTO)
    camera.take_photo(found.component_id)
    eventually("an image", lambda: len(images) == 1)
    assert images[0].is_success and images[0].index == 0
    camera.start_photo_interval(found.component_id, 0.2)
    eventually("more images", lambda: len(images) >= 4)
    camera.stop_photo_interval(found.component_id)
    count = len(images)
    camera.set_mode(found.component_id, Mode.VIDEO)
    assert camera.get_mode(found.component_id) == Mode.VIDEO
    camera.start_video(found.component_id)
    camera.stop_video(found.component_id)
    camera.zoom_range(found.component_id, 30.0)
    camera.format_storage(found.component_id, 1)
    with pytest.raises(CameraError):
        camera.track_point(found.component_id, 0.5, 0.5, 0.1)
    assert len(images) <= count + 1
    camera.destroy()


@pytest.mark.parametrize("arguments", [(), ("--equipment", "own"), ("--autopilot", "ardupilot")], ids=" ".join)
def test_settings(fly, tmp_path, monkeypatch, arguments):
    """The steps of the example camera_params: settings and their ranges come from the camera definition, which MAVSDK downloads."""
    # Where MAVSDK keeps definitions: none is there.
    monkeypatch.setenv("HOME", str(tmp_path))
    camera = Camera(fly(*arguments))
    eventually("a camera", lambda: camera.camera_list().cameras)
    component = camera.camera_list().cameras[0].component_id

    def current():
        try:
            return {setting.setting_id: float(setting.option.option_id) for setting in camera.get_current_settings(component)}
        except CameraError:  # The definition is still on its way.
            return {}

    eventually("the settings", lambda: current() == {"CAM_ZOOM": 0, "CAM_FOCUS": 0})
    for setting in camera.get_possible_setting_options(component):
        assert setting.is_range and [float(option.option_id) for option in setting.options] == [0, 100, 1]
    camera.set_mode(component, Mode.VIDEO)
    camera.set_setting(component, Setting("CAM_ZOOM", "", Option("40.0", ""), True))
    eventually("the zoom", lambda: current() == {"CAM_ZOOM": 40, "CAM_FOCUS": 0})
    with pytest.raises(CameraError):
        camera.set_setting(component, Setting("CAM_FOCUS", "", Option("101.0", ""), True))
    assert camera.get_mode(component) == Mode.VIDEO
    camera.destroy()


def test_gimbal(fly):
    gimbal = Gimbal(fly())
    eventually("a gimbal", lambda: gimbal.gimbal_list().gimbals)
    [found] = gimbal.gimbal_list().gimbals
    gimbal_id = found.gimbal_id
    assert found.model_name == "Simulated gimbal"

    def points(what, pitch, yaw, frame="euler_angle_forward"):
        def there():
            angles = getattr(gimbal.get_attitude(gimbal_id), frame)
            return abs(angles.pitch_deg - pitch) < 1 and abs(angles.yaw_deg - yaw) < 1
        eventually(what, there)

    eventually("an attitude", lambda: not math.isnan(gimbal.get_attitude(gimbal_id).euler_angle_forward.pitch_deg))
    gimbal.take_control(gimbal_id, ControlMode.PRIMARY)
    eventually("control", lambda: gimbal.get_control_status(gimbal_id).control_mode == ControlMode.PRIMARY)
    gimbal.set_angles(gimbal_id, 0, -90, 0, GimbalMode.YAW_FOLLOW, SendMode.ONCE)
    points("down", -90, gimbal.get_attitude(gimbal_id).euler_angle_forward.yaw_deg)
    gimbal.set_angles(gimbal_id, 0, -30, 45, GimbalMode.YAW_FOLLOW, SendMode.ONCE)
    points("right", -30, 45)
    gimbal.set_angles(gimbal_id, 0, 0, -90, GimbalMode.YAW_LOCK, SendMode.ONCE)
    points("west", 0, -90, "euler_angle_north")
    gimbal.set_angular_rates(gimbal_id, 0, -20, 0, GimbalMode.YAW_FOLLOW, SendMode.ONCE)
    eventually("turning", lambda: gimbal.get_attitude(gimbal_id).euler_angle_forward.pitch_deg < -10)
    gimbal.set_angular_rates(gimbal_id, 0, 0, 0, GimbalMode.YAW_FOLLOW, SendMode.ONCE)
    # A place 100 m east.
    gimbal.set_roi_location(gimbal_id, 47.397742, 8.545594 + 100 / 75_350, 0.0)
    eventually("the place", lambda: abs(gimbal.get_attitude(gimbal_id).euler_angle_north.yaw_deg - 90) < 1)
    gimbal.release_control(gimbal_id)
    eventually("no control", lambda: gimbal.get_control_status(gimbal_id).control_mode == ControlMode.NONE)
    gimbal.destroy()


def test_gripper(fly):
    gripper = Gripper(fly())
    gripper.grab(1)
    gripper.release(1)
    gripper.destroy()


def test_heartbeats_of_components(start, connect):
    """A script that takes every heartbeat for the autopilot's is not misled, unless the components are asked to speak."""
    for arguments, expected in (((), {1}), (("--equipment", "own"), {1, 100, 154})):
        client = connect(start("--speed", "10", *arguments))
        # Five heartbeats of the autopilot: every other component would have sent some by then.
        heard = [client.wait("HEARTBEAT").get_srcComponent() for _ in range(5 * len(expected))]
        assert set(heard) == expected
        client.mav.command_long_send(1, 100, mavlink.MAV_CMD_IMAGE_START_CAPTURE, 0, 0, 0, 1, 1, 0, 0, 0)
        ack = client.wait("COMMAND_ACK", lambda ack: ack.command == mavlink.MAV_CMD_IMAGE_START_CAPTURE)
        assert (ack.result, ack.get_srcComponent()) == (0, 100)
