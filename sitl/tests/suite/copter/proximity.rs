//! What a companion computer measures around the vehicle.

use super::flier::*;
use mavlink::dialects::ardupilotmega::*;

const MAVLINK: f64 = 2.0;

/// Directions from the nose to the right.
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

/// DISTANCE_SENSOR of an instrument that looks in a direction, counted from the nose in steps of 45 degrees; cm.
fn measure(flier: &mut Flier, direction: usize, current_distance: u16) {
    flier.bench.send(MavMessage::DISTANCE_SENSOR(DISTANCE_SENSOR_DATA {
        min_distance: 10,
        max_distance: 500,
        current_distance,
        id: 21,
        orientation: DIRECTIONS[direction],
        covariance: 255,
        ..DISTANCE_SENSOR_DATA::default()
    }));
}

/// Whether SYS_STATUS shows the proximity sensor as present, enabled and healthy.
fn state(flier: &mut Flier) -> [bool; 3] {
    const PROXIMITY: MavSysStatusSensor = MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_PROXIMITY;
    match autopilot_status(flier) {
        Some(status) => [
            status.onboard_control_sensors_present,
            status.onboard_control_sensors_enabled,
            status.onboard_control_sensors_health,
        ]
        .map(|sensors| sensors.contains(PROXIMITY)),
        None => panic!("no SYS_STATUS"),
    }
}

fn autopilot_status(flier: &mut Flier) -> Option<SYS_STATUS_DATA> {
    let parameters = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters), ACCEPTED);
    flier.latest(|message| match message {
        MavMessage::SYS_STATUS(status) => Some(status.clone()),
        _ => None,
    })
}

/// The distance that the vehicle tells in a direction, cm.
fn told(flier: &Flier, direction: usize) -> Option<u16> {
    flier.latest(|message| match message {
        MavMessage::DISTANCE_SENSOR(sensor) if sensor.orientation == DIRECTIONS[direction] => {
            Some(sensor.current_distance)
        }
        _ => None,
    })
}

/// Suite: MAVProximity. It works while it is told something, and what it is told comes back.
#[test]
fn what_is_measured_around_comes_back() {
    let mut flier = Flier::new();
    assert_eq!(state(&mut flier), [false; 3]);
    flier.set("PRX1_TYPE", MAVLINK);
    assert_eq!(state(&mut flier), [true, true, false]);
    measure(&mut flier, 0, 20);
    flier.fly(0.1);
    assert_eq!(state(&mut flier), [true, true, true]);
    flier.fly(1.0);
    assert_eq!(state(&mut flier), [true, true, false]);
    let distances_cm = [30, 35, 20, 15, 70, 80, 10, 90];
    flier.bench.heard.clear();
    for _ in 0..20 {
        for (direction, distance_cm) in distances_cm.into_iter().enumerate() {
            measure(&mut flier, direction, distance_cm);
        }
        flier.fly(0.1);
    }
    assert_eq!([0, 1, 2, 3, 4, 5, 6, 7].map(|direction| told(&flier, direction)), distances_cm.map(Some));
}

/// Suite: OBSTACLE_DISTANCE_3D.
#[test]
fn a_point_is_told_in_its_direction() {
    let mut flier = Flier::new();
    flier.set("PRX1_TYPE", MAVLINK);
    for angle_deg in (0..360).step_by(17) {
        flier.fly(0.6);
        let (sin, cos) = f32::sin_cos((angle_deg as f32).to_radians());
        let direction = (angle_deg + 22) / 45 % 8;
        flier.bench.heard.clear();
        for _ in 0..12 {
            flier.bench.send(MavMessage::OBSTACLE_DISTANCE_3D(OBSTACLE_DISTANCE_3D_DATA {
                x: 15.0 * cos,
                y: 15.0 * sin,
                max_distance: 20.0,
                obstacle_id: u16::MAX,
                frame: MavFrame::MAV_FRAME_BODY_FRD,
                ..OBSTACLE_DISTANCE_3D_DATA::default()
            }));
            flier.fly(0.1);
        }
        let told = told(&flier, direction).expect("told");
        assert!(told.abs_diff(1500) <= 1, "{angle_deg}: {told}");
    }
}

/// Suite: AC_Avoidance_Proximity_AVOID_ALT_MIN. Something that is too near is backed away from, and low down not.
#[test]
fn something_near_is_backed_away_from_high_up() {
    let mut flier = Flier::new();
    flier.set_all(&[("PRX1_TYPE", MAVLINK), ("AVOID_ALT_MIN", 10.0)]);
    flier.take_off(15.0, LOITER);
    flier.wait("a stop", 30.0, |flier| flier.climb_m_s().abs() < 0.1);
    let back_m_s = |flier: &Flier| -flier.vehicle().outputs().body_velocity_m_s.x;
    for _ in 0..50 {
        measure(&mut flier, 0, 20);
        flier.fly(0.1);
    }
    assert!((0.7..0.9).contains(&back_m_s(&flier)), "{}", back_m_s(&flier));
    flier.rc(3, 1080);
    flier.wait("5 m", 30.0, |flier| flier.height_m() < 5.0);
    flier.rc(3, 1500);
    flier.wait("a stop", 30.0, |flier| flier.climb_m_s().abs() < 0.1 && flier.speed_m_s() < 0.1);
    for _ in 0..50 {
        measure(&mut flier, 0, 20);
        flier.fly(0.1);
        assert!(flier.speed_m_s() < 0.1, "{}", flier.speed_m_s());
    }
}
