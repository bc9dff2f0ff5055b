//! Ranges: what the vehicle's lidar and its downward rangefinder measure, and what companion computers send.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    DISTANCE_SENSOR_DATA, MavDistanceSensor, MavFrame, MavMessage, MavSensorOrientation,
    OBSTACLE_DISTANCE_3D_DATA, OBSTACLE_DISTANCE_DATA, RANGEFINDER_DATA,
};
use vehicle::surroundings::{FARTHEST_RANGE_M, NEAREST_RANGE_M, Reading, SECTOR_RAD, SECTORS};

use super::Service;
use crate::codec::{Frame, Payload, boot_ms};
use crate::context::Context;
use crate::envelope::Origin;
use crate::stream::{Build, Component, Group, Stream};

const STREAMS: &[Stream] = &[
    Stream::when(OBSTACLE_DISTANCE_DATA::ID, [1.0, 10.0], Build::Several(around)),
    Stream::when(DISTANCE_SENSOR_DATA::ID, [1.0, 10.0], Build::Several(distances)),
    Stream::when(RANGEFINDER_DATA::ID, [0.0, 0.0], Build::Several(below_in_metres)).of(Group::Extra3),
];

/// The vehicle looks around, and is told.
#[derive(Clone, Copy, Debug)]
pub struct Ranges;

impl Service for Ranges {
    fn summary(&self) -> &'static str {
        "Ranges to obstacles and to the ground"
    }

    fn messages(&self) -> &'static [u32] {
        &[OBSTACLE_DISTANCE_DATA::ID, DISTANCE_SENSOR_DATA::ID, OBSTACLE_DISTANCE_3D_DATA::ID]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            OBSTACLE_DISTANCE_DATA::ID => take_scan(context, &frame.payload()),
            OBSTACLE_DISTANCE_3D_DATA::ID => take_point(context, &frame.payload()),
            _ => take_direction(context, &frame.payload()),
        }
    }
}

/// A distance, cm, of an instrument that measures up to a maximum.
fn reading(distance_cm: u16, farthest_cm: u16) -> Reading {
    match distance_cm {
        u16::MAX => Reading::Unknown,
        far if far > farthest_cm => Reading::Free,
        near => Reading::At(f64::from(near) / 100.0),
    }
}

/// OBSTACLE_DISTANCE: in the frame of the nose (MAV_FRAME_BODY_FRD), or from north.
fn take_scan(context: &mut Context, payload: &Payload) {
    const BODY_FRD: u8 = 12;
    let whole_deg = f64::from(payload.u8(157));
    let exact_deg = f64::from(payload.f32(158));
    let step_deg = if exact_deg != 0.0 { exact_deg } else { whole_deg };
    let (offset_deg, farthest_cm) = (f64::from(payload.f32(162)), payload.u16(154));
    // Wider than all around is no step.
    if !(step_deg.abs() > 0.0 && step_deg.abs() <= 360.0 && offset_deg.is_finite()) {
        return;
    }
    let offset_deg = offset_deg.rem_euclid(360.0);
    let vehicle = &mut context.vehicle;
    let nose_rad = if payload.u8(166) == BODY_FRD { vehicle.outputs().attitude_rad.z } else { 0.0 };
    let mut sectors = [Reading::Unknown; SECTORS];
    for index in 0..SECTORS {
        let news = reading(payload.u16(8 + 2 * index), farthest_cm);
        // A step that is wider than a sector of ours covers several of them.
        let middle_deg = offset_deg + index as f64 * step_deg;
        let half = (step_deg.abs() / SECTOR_RAD.to_degrees() / 2.0 - 0.5).max(0.0).floor() as i64;
        let sector = (middle_deg / SECTOR_RAD.to_degrees()).round() as i64;
        for covered in sector - half..=sector + half {
            let place = covered.rem_euclid(SECTORS as i64) as usize;
            if let Some(known) = sectors.get_mut(place) {
                *known = known.nearer(news);
            }
        }
    }
    vehicle.see_around(nose_rad, sectors);
}

/// DISTANCE_SENSOR of an instrument that looks around (orientations 0 to 7: in steps of 45° from the nose).
fn take_direction(context: &mut Context, payload: &Payload) {
    const AROUND: u8 = 8;
    const STEP_RAD: f64 = core::f64::consts::FRAC_PI_4;
    let (orientation, width_rad) = (payload.u8(12), f64::from(payload.f32(14)));
    if orientation >= AROUND {
        return;
    }
    let width_rad = if width_rad > 0.0 { width_rad.min(core::f64::consts::TAU) } else { STEP_RAD };
    let reading = reading(payload.u16(8), payload.u16(6));
    context.vehicle.see_ahead(f64::from(orientation) * STEP_RAD, width_rad, reading);
}

/// OBSTACLE_DISTANCE_3D: a point in the frame of the body (MAV_FRAME_BODY_FRD), m.
fn take_point(context: &mut Context, payload: &Payload) {
    const BODY_FRD: u8 = 12;
    let [ahead, right, down, nearest, farthest] = [4, 8, 12, 16, 20].map(|at| f64::from(payload.f32(at)));
    let seen = seen_around([ahead, right, down], nearest, farthest).filter(|_| payload.u8(27) == BODY_FRD);
    if let Some((angle_rad, range_m)) = seen {
        context.vehicle.see_ahead(angle_rad, 0.0, Reading::At(range_m));
    }
}

/// Where a point lies around: its angle from the nose, rad, and its distance on the level, m. `None`: it is out of the range, or lies more
/// above or below than beside, as the ground does.
fn seen_around([ahead, right, down]: [f64; 3], nearest_m: f64, farthest_m: f64) -> Option<(f64, f64)> {
    let level_m = libm::hypot(ahead, right);
    // NaN is not within.
    let within = level_m >= nearest_m && libm::hypot(level_m, down) <= farthest_m && down.abs() <= level_m;
    within.then(|| (libm::atan2(right, ahead), level_m))
}

fn centimetres(range_m: f64) -> u16 {
    (range_m * 100.0).round().clamp(0.0, f64::from(u16::MAX - 1)) as u16
}

/// OBSTACLE_DISTANCE of our lidar.
fn around(component: &Component<'_>) -> Vec<MavMessage> {
    let message = |scan: &vehicle::surroundings::RangeScan| {
        let farthest = centimetres(FARTHEST_RANGE_M);
        let distance = |reading: Reading| match reading {
            Reading::Unknown => u16::MAX,
            Reading::Free => farthest + 1,
            Reading::At(range_m) => centimetres(range_m),
        };
        MavMessage::OBSTACLE_DISTANCE(OBSTACLE_DISTANCE_DATA {
            time_usec: scan.time_us,
            distances: scan.sectors.map(distance),
            min_distance: centimetres(NEAREST_RANGE_M),
            max_distance: farthest,
            sensor_type: MavDistanceSensor::MAV_DISTANCE_SENSOR_LASER,
            increment: SECTOR_RAD.to_degrees().round() as u8,
            increment_f: SECTOR_RAD.to_degrees() as f32,
            angle_offset: 0.0,
            frame: MavFrame::MAV_FRAME_BODY_FRD,
        })
    };
    component.vehicle.obstacles().lidar().map(message).into_iter().collect()
}

/// Directions around the vehicle in which ArduPilot tells a distance.
const DIRECTIONS: [MavSensorOrientation; 8] = [
    MavSensorOrientation::MAV_SENSOR_ROTATION_NONE,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_45,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_90,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_135,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_180,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_225,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_270,
    MavSensorOrientation::MAV_SENSOR_ROTATION_YAW_315,
];
/// What its first direction is numbered with.
const FIRST_DIRECTION: u8 = 10;

/// DISTANCE_SENSOR: around, as ArduPilot tells what a companion computer has told it, and below.
fn distances(component: &Component<'_>) -> Vec<MavMessage> {
    let vehicle = component.vehicle;
    let told = vehicle.obstacles().companion(vehicle.time_us());
    let told = told.filter(|_| vehicle.has_proximity() && vehicle.identity().is_ardupilot());
    let nose_rad = vehicle.outputs().attitude_rad.z;
    let nearest = told.map(|scan| scan.nearest_m::<{ DIRECTIONS.len() }>(nose_rad));
    let around = nearest.into_iter().flatten().zip(0..).zip(DIRECTIONS);
    let around = around.filter_map(|((range_m, number), orientation)| {
        Some(MavMessage::DISTANCE_SENSOR(DISTANCE_SENSOR_DATA {
            time_boot_ms: boot_ms(vehicle.time_us()),
            min_distance: centimetres(NEAREST_RANGE_M),
            max_distance: centimetres(FARTHEST_RANGE_M),
            current_distance: centimetres(range_m?),
            mavtype: MavDistanceSensor::MAV_DISTANCE_SENSOR_LASER,
            id: FIRST_DIRECTION + number,
            orientation,
            ..DISTANCE_SENSOR_DATA::default()
        }))
    });
    around.chain(below(component)).collect()
}

/// DISTANCE_SENSOR of the downward rangefinder; out of its range it shows a little more than that.
fn below(component: &Component<'_>) -> Vec<MavMessage> {
    let vehicle = component.vehicle;
    if !vehicle.has_rangefinder() {
        return Vec::new();
    }
    let settings = &vehicle.conduct().surroundings;
    let farthest = centimetres(settings.rangefinder_farthest_m);
    vec![MavMessage::DISTANCE_SENSOR(DISTANCE_SENSOR_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        min_distance: centimetres(settings.rangefinder_nearest_m),
        max_distance: farthest,
        current_distance: vehicle.obstacles().below_m().map_or(farthest + 1, centimetres),
        mavtype: MavDistanceSensor::MAV_DISTANCE_SENSOR_LASER,
        id: 0,
        orientation: MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270,
        covariance: u8::MAX,
        ..DISTANCE_SENSOR_DATA::default()
    })]
}

/// RANGEFINDER: the same, as ArduPilot's clients know it.
fn below_in_metres(component: &Component<'_>) -> Vec<MavMessage> {
    let vehicle = component.vehicle;
    if !vehicle.has_rangefinder() {
        return Vec::new();
    }
    let distance = vehicle.obstacles().below_m().unwrap_or(0.0) as f32;
    vec![MavMessage::RANGEFINDER(RANGEFINDER_DATA { distance, voltage: 0.0 })]
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::seen_around;

    #[test]
    fn a_point_counts_where_it_lies_around_and_not_above_or_below() {
        let seen = |point_m| seen_around(point_m, 0.5, 20.0);
        assert_eq!(seen([3.0, 0.0, -2.0]), Some((0.0, 3.0)));
        assert_eq!(seen([0.0, 4.0, 0.0]), Some((FRAC_PI_2, 4.0)));
        for point_m in
            [[0.0, 0.0, 5.0], [3.0, 0.0, 10.0], [0.4, 0.0, 0.4], [19.0, 0.0, 8.0], [f64::NAN, 1.0, 0.0]]
        {
            assert_eq!(seen(point_m), None, "{point_m:?}");
        }
    }
}
