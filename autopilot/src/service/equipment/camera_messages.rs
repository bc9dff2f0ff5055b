//! Messages of the camera.

use mavlink::dialects::ardupilotmega::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_FEEDBACK_DATA, CAMERA_IMAGE_CAPTURED_DATA, CAMERA_INFORMATION_DATA,
    CAMERA_SETTINGS_DATA, CAMERA_TRIGGER_DATA, CameraCapFlags, CameraFeedbackFlags,
    CameraMode as MavCameraMode, MavBool, MavMessage, STORAGE_INFORMATION_DATA, StorageStatus, StorageType,
    StorageUsageFlag,
};
use nalgebra::{UnitQuaternion, Vector3};
use vehicle::Vehicle;
use vehicle::equipment::{Camera, CameraMode, FOCAL_LENGTH_MM, Image, SENSOR_MM, STORAGE_MIB};
use vehicle::world::{Geodetic, heading_deg};

use super::camera_definition;
use super::gimbal_messages::device_id;
use crate::codec::{boot_ms, millimetres, scaled_degrees};
use crate::service::version;
use crate::stream::Component;

/// Pixels of an image.
const RESOLUTION: [u16; 2] = [4000, 3000];
/// Speed of the storage, MiB/s.
const READ_MIB_S: f32 = 80.0;
const WRITE_MIB_S: f32 = 40.0;

/// Text in a field of bytes.
fn bytes(text: &str) -> [u8; 32] {
    let mut field = [0; 32];
    for (byte, given) in field.iter_mut().zip(text.bytes()) {
        *byte = given;
    }
    field
}

/// CAMERA_INFORMATION. There is no video stream.
pub fn information(component: &Component<'_>) -> MavMessage {
    let [width_mm, height_mm] = SENSOR_MM;
    MavMessage::CAMERA_INFORMATION(CAMERA_INFORMATION_DATA {
        time_boot_ms: boot_ms(component.vehicle.time_us()),
        firmware_version: version().swap_bytes(),
        focal_length: FOCAL_LENGTH_MM as f32,
        sensor_size_h: width_mm as f32,
        sensor_size_v: height_mm as f32,
        flags: CameraCapFlags::CAMERA_CAP_FLAGS_CAPTURE_IMAGE
            | CameraCapFlags::CAMERA_CAP_FLAGS_CAPTURE_VIDEO
            | CameraCapFlags::CAMERA_CAP_FLAGS_HAS_MODES
            | CameraCapFlags::CAMERA_CAP_FLAGS_CAN_CAPTURE_IMAGE_IN_VIDEO_MODE
            | CameraCapFlags::CAMERA_CAP_FLAGS_CAN_CAPTURE_VIDEO_IN_IMAGE_MODE
            | CameraCapFlags::CAMERA_CAP_FLAGS_HAS_IMAGE_SURVEY_MODE
            | CameraCapFlags::CAMERA_CAP_FLAGS_HAS_BASIC_ZOOM
            | CameraCapFlags::CAMERA_CAP_FLAGS_HAS_BASIC_FOCUS,
        resolution_h: RESOLUTION[0],
        resolution_v: RESOLUTION[1],
        vendor_name: bytes(camera_definition::VENDOR),
        model_name: bytes(camera_definition::MODEL),
        cam_definition_version: camera_definition::VERSION,
        cam_definition_uri: camera_definition::URI.into(),
        gimbal_device_id: device_id(component),
        ..CAMERA_INFORMATION_DATA::default()
    })
}

/// CAMERA_MODE.
pub fn mode_id(camera: &Camera) -> MavCameraMode {
    match camera.mode() {
        CameraMode::Image => MavCameraMode::CAMERA_MODE_IMAGE,
        CameraMode::Video => MavCameraMode::CAMERA_MODE_VIDEO,
        CameraMode::Survey => MavCameraMode::CAMERA_MODE_IMAGE_SURVEY,
    }
}

/// CAMERA_SETTINGS.
pub fn settings(vehicle: &Vehicle) -> MavMessage {
    let camera = vehicle.equipment().camera();
    MavMessage::CAMERA_SETTINGS(CAMERA_SETTINGS_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        mode_id: mode_id(camera),
        zoomLevel: camera.zoom_percent() as f32,
        focusLevel: camera.focus_percent() as f32,
        ..CAMERA_SETTINGS_DATA::default()
    })
}

/// CAMERA_CAPTURE_STATUS.
pub fn capture_status(vehicle: &Vehicle) -> MavMessage {
    /// Idle, and images one after the other.
    const IDLE: u8 = 0;
    const INTERVAL: u8 = 3;
    let (camera, now_us) = (vehicle.equipment().camera(), vehicle.time_us());
    let interval_s = camera.interval_s();
    let recording_s = camera.recording_s(now_us);
    MavMessage::CAMERA_CAPTURE_STATUS(CAMERA_CAPTURE_STATUS_DATA {
        time_boot_ms: boot_ms(now_us),
        image_interval: interval_s.unwrap_or(0.0) as f32,
        recording_time_ms: (recording_s.unwrap_or(0.0) * 1e3) as u32,
        available_capacity: (STORAGE_MIB - camera.used_mib(now_us)) as f32,
        image_status: if interval_s.is_some() { INTERVAL } else { IDLE },
        video_status: u8::from(recording_s.is_some()),
        image_count: i32::try_from(camera.count()).unwrap_or(i32::MAX),
        ..CAMERA_CAPTURE_STATUS_DATA::default()
    })
}

/// STORAGE_INFORMATION: one storage.
pub fn storage(vehicle: &Vehicle) -> MavMessage {
    let used_mib = vehicle.equipment().camera().used_mib(vehicle.time_us());
    MavMessage::STORAGE_INFORMATION(STORAGE_INFORMATION_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        total_capacity: STORAGE_MIB as f32,
        used_capacity: used_mib as f32,
        available_capacity: (STORAGE_MIB - used_mib) as f32,
        read_speed: READ_MIB_S,
        write_speed: WRITE_MIB_S,
        storage_id: 1,
        storage_count: 1,
        status: StorageStatus::STORAGE_STATUS_READY,
        mavtype: StorageType::STORAGE_TYPE_SD,
        name: "SD card".into(),
        storage_usage: StorageUsageFlag::STORAGE_USAGE_FLAG_SET
            | StorageUsageFlag::STORAGE_USAGE_FLAG_PHOTO
            | StorageUsageFlag::STORAGE_USAGE_FLAG_VIDEO,
    })
}

/// CAMERA_IMAGE_CAPTURED of the image with a number from 0 on; one that there is not was not captured.
pub fn image_captured(vehicle: &Vehicle, number: u32) -> Vec<MavMessage> {
    let image = vehicle.equipment().camera().image(number.saturating_add(1));
    let missing = || {
        MavMessage::CAMERA_IMAGE_CAPTURED(CAMERA_IMAGE_CAPTURED_DATA {
            time_boot_ms: boot_ms(vehicle.time_us()),
            image_index: i32::try_from(number).unwrap_or(i32::MAX),
            capture_result: MavBool::empty(),
            ..CAMERA_IMAGE_CAPTURED_DATA::default()
        })
    };
    vec![image.map_or_else(missing, |image| of_image(vehicle, image))]
}

/// CAMERA_IMAGE_CAPTURED of an image, with the attitude of the camera.
pub fn of_image(vehicle: &Vehicle, image: &Image) -> MavMessage {
    let place = place(vehicle, image);
    let attitude = image.camera_attitude_rad;
    MavMessage::CAMERA_IMAGE_CAPTURED(CAMERA_IMAGE_CAPTURED_DATA {
        time_utc: vehicle.unix_start_us() + image.time_us,
        time_boot_ms: boot_ms(image.time_us),
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        alt: millimetres(place.altitude_m),
        relative_alt: millimetres(height_m(image)),
        q: quaternion(&attitude),
        image_index: i32::try_from(image.index - 1).unwrap_or(i32::MAX),
        capture_result: MavBool::MAV_BOOL_TRUE,
        ..CAMERA_IMAGE_CAPTURED_DATA::default()
    })
}

/// CAMERA_TRIGGER.
pub fn trigger(vehicle: &Vehicle, image: &Image) -> MavMessage {
    MavMessage::CAMERA_TRIGGER(CAMERA_TRIGGER_DATA {
        time_usec: vehicle.unix_start_us() + image.time_us,
        seq: image.trigger,
    })
}

/// CAMERA_FEEDBACK: the place, and the attitude of the vehicle.
pub fn feedback(vehicle: &Vehicle, image: &Image) -> MavMessage {
    let place = place(vehicle, image);
    let [roll, pitch, yaw] = image.attitude_rad.data.0[0];
    let number = |count: u32| (count & u32::from(u16::MAX)) as u16;
    MavMessage::CAMERA_FEEDBACK(CAMERA_FEEDBACK_DATA {
        time_usec: vehicle.unix_start_us() + image.time_us,
        lat: scaled_degrees(place.latitude_deg),
        lng: scaled_degrees(place.longitude_deg),
        alt_msl: place.altitude_m as f32,
        alt_rel: height_m(image) as f32,
        roll: roll.to_degrees() as f32,
        pitch: pitch.to_degrees() as f32,
        yaw: heading_deg(yaw) as f32,
        foc_len: FOCAL_LENGTH_MM as f32,
        img_idx: number(image.trigger),
        target_system: 0,
        cam_idx: 0,
        flags: CameraFeedbackFlags::CAMERA_FEEDBACK_PHOTO,
        completed_captures: number(image.trigger),
    })
}

/// Of Euler angles, rad.
pub fn quaternion(attitude_rad: &Vector3<f64>) -> [f32; 4] {
    let [roll, pitch, yaw] = attitude_rad.data.0[0];
    let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    [turn.w, turn.i, turn.j, turn.k].map(|value| value as f32)
}

fn place(vehicle: &Vehicle, image: &Image) -> Geodetic {
    vehicle.place_of(&image.position_m)
}

fn height_m(image: &Image) -> f64 {
    image.home_z_m - image.position_m.z
}
