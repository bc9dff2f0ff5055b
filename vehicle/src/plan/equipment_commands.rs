//! Commands of missions for what the vehicle carries, and for what it does not carry: those are taken and passed by, as an autopilot
//! does that has nothing connected.

use core::f64::consts::{PI, TAU};

use super::command::*;
use super::mission_command::{LONGEST_S, MissionCommand, PlaceRule, Source};
use super::step::{Do, Step};
use crate::equipment::{CameraMode, Drive, GimbalMode, Oblique, Operation, ParachuteOrder, Pointing, Switch};
use crate::fence::FenceSwitch;
use crate::radio::Position;

/// Ranges of parameters, with their names.
type Ranges = &'static [(u8, &'static str, f64, f64)];

/// A command without a place.
const fn command(
    number: u16,
    needed: &'static [u8],
    ranges: Ranges,
    step: fn(&Source<'_>) -> Step,
) -> MissionCommand {
    MissionCommand { number, step, place: PlaceRule::None, needed, whole: &[], ranges }
}

/// A command whose parameters mean nothing here.
const fn absent(number: u16, step: fn(&Source<'_>) -> Step) -> MissionCommand {
    command(number, &[], &[], step)
}

/// An operation of the equipment.
fn operate(operation: Operation) -> Step {
    Step::Do(Do::Operate(operation))
}

/// Something that the vehicle does not carry.
const fn without(what: &'static str) -> Step {
    Step::Do(Do::Absent(what))
}

/// Longest distance between images, m, longest interval, ms, and the like.
const FAR: f64 = 1e5;
const LONG_MS: f64 = 8.64e7;
/// Highest number of something.
const MOST: f64 = 65_535.0;
/// An angle, degrees, and a rate, degrees per second.
const ANGLE: (f64, f64) = (-360.0, 360.0);
const RATE: (f64, f64) = (-3600.0, 3600.0);

#[rustfmt::skip] // A few lines per command read as the table that it is.
pub(super) static EQUIPMENT_COMMANDS: &[MissionCommand] = &[
    command(DO_SET_RELAY, &[1, 2], &[(1, "relay", 0.0, 15.0), (2, "state", -1.0, 1.0)], set_relay),
    command(DO_REPEAT_RELAY, &[1, 2, 3], &[(1, "relay", 0.0, 15.0), (2, "cycles", 0.0, MOST), (3, "period", 0.0, LONGEST_S)], |source| {
        operate(Operation::RepeatRelay { relay: source.value(1) as u8, cycles: source.value(2) as u32, period_s: source.value(3) })
    }),
    command(DO_SET_SERVO, &[1, 2], &[(1, "servo", 0.0, 32.0), (2, "pulse", 0.0, MOST)], |source| {
        operate(Operation::SetServo { channel: source.value(1) as u8, pulse_us: source.value(2) as u16 })
    }),
    command(DO_REPEAT_SERVO, &[1, 2, 3, 4], &[
        (1, "servo", 0.0, 32.0), (2, "pulse", 0.0, MOST), (3, "cycles", 0.0, MOST), (4, "period", 0.0, LONGEST_S)], repeat_servo),
    command(DO_SET_ACTUATOR, &[], &[
        (1, "value", -1.0, 1.0), (2, "value", -1.0, 1.0), (3, "value", -1.0, 1.0), (4, "value", -1.0, 1.0)], set_actuators),
    command(DO_GRIPPER, &[2], &[(2, "action", 0.0, 1.0)], |source| operate(Operation::Grip { grabs: source.value(2) > 0.5 })),
    absent(DO_DIGICAM_CONFIGURE, |_| without("settings of the camera")),
    absent(DO_DIGICAM_CONTROL, |source| if source.flags(5) > 0 { operate(Operation::Shoot) } else { Step::Do(Do::Mark) }),
    absent(DO_CONTROL_VIDEO, |_| without("old video control")),
    command(DO_SET_CAM_TRIGG_DIST, &[1], &[(1, "distance", 0.0, FAR)], trigger_by_distance),
    command(DO_SET_CAM_TRIGG_INTERVAL, &[1], &[(1, "interval", -1.0, LONG_MS)], trigger_by_time),
    command(OBLIQUE_SURVEY, &[1], &[
        (1, "distance", 0.0, FAR), (4, "positions", 0.0, 100.0), (5, "roll", -90.0, 90.0), (6, "pitch", -180.0, 180.0)], survey),
    command(SET_CAMERA_MODE, &[2], &[(2, "mode", 0.0, 2.0)], |source| operate(Operation::SetCameraMode(mode(source.value(2))))),
    command(SET_CAMERA_ZOOM, &[1, 2], &[(1, "kind of zoom", 0.0, 4.0), (2, "zoom", -1000.0, FAR)], |source| {
        operate(Operation::Zoom(zoom(source.value(1), source.value(2))))
    }),
    command(SET_CAMERA_FOCUS, &[1], &[(1, "kind of focus", 0.0, 6.0), (2, "focus", -1000.0, FAR)], |source| {
        operate(Operation::Focus(focus(source.value(1), source.value(2))))
    }),
    absent(SET_CAMERA_SOURCE, |_| without("second lens of the camera")),
    command(IMAGE_START_CAPTURE, &[], &[(2, "interval", 0.0, LONGEST_S), (3, "images", 0.0, 1e9)], |source| {
        operate(Operation::Capture { interval_s: source.value(2), count: source.value(3) as u32 })
    }),
    absent(IMAGE_STOP_CAPTURE, |_| operate(Operation::StopCapture)),
    command(DO_TRIGGER_CONTROL, &[], &[(1, "enable", -1.0, 1.0), (2, "reset", -1.0, 1.0), (3, "pause", -1.0, 1.0)], |source| {
        let told = |number| Some(source.item.parameter_or(number, -1.0)).filter(|value| *value >= 0.0).map(|value| value > 0.5);
        operate(Operation::ControlTrigger { enabled: told(1), paused: told(3), reset: told(2) == Some(true) })
    }),
    absent(VIDEO_START_CAPTURE, |_| operate(Operation::Record(true))),
    absent(VIDEO_STOP_CAPTURE, |_| operate(Operation::Record(false))),
    command(DO_MOUNT_CONFIGURE, &[], &[(1, "mode", 0.0, 6.0)], mount_mode),
    command(DO_MOUNT_CONTROL, &[], &[
        (1, "pitch", ANGLE.0, ANGLE.1), (2, "roll", ANGLE.0, ANGLE.1), (3, "yaw", ANGLE.0, ANGLE.1), (7, "mode", 0.0, 6.0)], mount),
    command(DO_GIMBAL_MANAGER_PITCHYAW, &[], &[
        (1, "pitch", ANGLE.0, ANGLE.1), (2, "yaw", ANGLE.0, ANGLE.1),
        (3, "pitch rate", RATE.0, RATE.1), (4, "yaw rate", RATE.0, RATE.1)], pitch_and_yaw),
    absent(DO_GIMBAL_MANAGER_CONFIGURE, |_| Step::Do(Do::Mark)),
    command(DO_FENCE_ENABLE, &[1], &[(1, "enable", 0.0, 2.0), (2, "parts", 0.0, 15.0)], switch_fence),
    command(DO_PARACHUTE, &[1], &[(1, "action", 0.0, 2.0)], parachute),
    command(AIRFRAME_CONFIGURATION, &[2], &[(2, "landing gear", 0.0, 1.0)], |source| {
        if !source.site.identity.is_ardupilot() {
            return without("landing gear");
        }
        operate(Operation::MoveLandingGear { down: source.value(2) < 0.5 })
    }),
    absent(DO_WINCH, |_| without("winch")),
    absent(DO_SPRAYER, |_| without("sprayer")),
    absent(DO_ENGINE_CONTROL, |_| without("combustion engine")),
    command(DO_AUX_FUNCTION, &[1, 2], &[(1, "function", 0.0, MOST), (2, "position", 0.0, 2.0)], move_switch),
    absent(DO_SEND_SCRIPT_MESSAGE, |_| without("scripts")),
    absent(DO_VTOL_TRANSITION, |_| without("wings")),
    absent(DO_SET_REVERSE, |_| without("reverse drive")),
    absent(DO_INVERTED_FLIGHT, |_| without("inverted flight")),
    absent(DO_AUTOTUNE_ENABLE, |_| without("automatic tuning")),
    absent(DO_GUIDED_LIMITS, |_| without("guided control within missions")),
    absent(DO_SET_RESUME_REPEAT_DIST, |_| without("rewinding of missions")),
    absent(DO_LAND_START, |_| Step::Do(Do::Mark)),
    absent(DO_RETURN_PATH_START, |_| Step::Do(Do::Mark)),
    command(JUMP_TAG, &[1], &[(1, "tag", 0.0, MOST)], |_| Step::Do(Do::Mark)),
];

impl Source<'_> {
    /// Flags. In a place that was scaled as a latitude they are tiny.
    fn flags(&self, number: usize) -> u32 {
        let value = self.value(number);
        let value = if value.abs() < 1.0 { value * 1e7 } else { value };
        value.round().clamp(0.0, f64::from(u32::MAX)) as u32
    }
}

fn set_relay(source: &Source<'_>) -> Step {
    let to = match source.value(2) {
        state if state < 0.0 => Switch::Toggle,
        state if state > 0.5 => Switch::On,
        _ => Switch::Off,
    };
    operate(Operation::SetRelay { relay: source.value(1) as u8, to })
}

/// ArduPilot's function of a switch, and the position that it comes to.
fn move_switch(source: &Source<'_>) -> Step {
    if !source.site.identity.is_ardupilot() {
        return without("auxiliary functions");
    }
    let position = match source.value(2) {
        position if position < 0.5 => Position::Low,
        position if position < 1.5 => Position::Middle,
        _ => Position::High,
    };
    Step::Do(Do::MoveSwitch { function: source.value(1) as u32, position })
}

fn repeat_servo(source: &Source<'_>) -> Step {
    operate(Operation::RepeatServo {
        channel: source.value(1) as u8,
        pulse_us: source.value(2) as u16,
        cycles: source.value(3) as u32,
        period_s: source.value(4),
    })
}

fn set_actuators(source: &Source<'_>) -> Step {
    let value = |number| Some(source.item.parameter(number)).filter(|value| value.is_finite());
    operate(Operation::SetActuators([value(1), value(2), value(3), value(4)]))
}

/// DO_SET_CAM_TRIGG_DIST: distance, shutter, whether one is taken at once; PX4 always takes one at once.
fn trigger_by_distance(source: &Source<'_>) -> Step {
    let at_once = source.value(3) > 0.5 || !source.site.identity.is_ardupilot();
    operate(Operation::TriggerByDistance { distance_m: source.value(1), at_once, oblique: None })
}

/// DO_SET_CAM_TRIGG_INTERVAL: ms; −1 keeps the one that there is.
fn trigger_by_time(source: &Source<'_>) -> Step {
    match source.value(1) {
        interval_ms if interval_ms < 0.0 => Step::Do(Do::Mark),
        interval_ms => operate(Operation::TriggerByTime { interval_s: interval_ms / 1e3 }),
    }
}

/// OBLIQUE_SURVEY: distance, shutter, least interval, positions, roll, pitch.
fn survey(source: &Source<'_>) -> Step {
    let positions = source.value(4) as u32;
    let oblique = (positions > 1).then(|| Oblique {
        positions,
        roll_rad: source.angle_rad(5).unwrap_or_default(),
        pitch_rad: source.angle_rad(6).unwrap_or_default(),
    });
    operate(Operation::TriggerByDistance { distance_m: source.value(1), at_once: true, oblique })
}

fn mode(number: f64) -> CameraMode {
    match number as u8 {
        0 => CameraMode::Image,
        1 => CameraMode::Video,
        _ => CameraMode::Survey,
    }
}

/// CAMERA_ZOOM_TYPE.
fn zoom(kind: f64, value: f64) -> Drive {
    match kind as u8 {
        0 => Drive::Step(value),
        1 => Drive::Continuous(value),
        3 => Drive::FocalLength(value),
        _ => Drive::Range(value),
    }
}

/// SET_FOCUS_TYPE.
fn focus(kind: f64, value: f64) -> Drive {
    match kind as u8 {
        0 => Drive::Step(value),
        1 => Drive::Continuous(value),
        2 => Drive::Range(value),
        3 => Drive::Distance(value.max(0.0)),
        _ => Drive::Automatic,
    }
}

/// PARACHUTE_ACTION; ArduPilot's only.
fn parachute(source: &Source<'_>) -> Step {
    if !source.site.identity.is_ardupilot() {
        return without("parachute");
    }
    operate(Operation::Parachute(match source.value(1) as u8 {
        0 => ParachuteOrder::Disable,
        1 => ParachuteOrder::Enable,
        _ => ParachuteOrder::Release,
    }))
}

fn switch_fence(source: &Source<'_>) -> Step {
    let is_ardupilot = source.site.identity.is_ardupilot();
    let parts = if is_ardupilot { libm::round(source.value(2)) } else { 0.0 };
    match FenceSwitch::of_numbers(libm::round(source.value(1)), parts) {
        Some(FenceSwitch::FloorOff) if !is_ardupilot => without("floor of the fence"),
        switch => Step::Do(switch.map_or(Do::Mark, Do::SwitchFence)),
    }
}

/// MAV_MOUNT_MODE of DO_MOUNT_CONFIGURE.
fn mount_mode(source: &Source<'_>) -> Step {
    match source.value(1) as u8 {
        0 => operate(Operation::RetractGimbal),
        1 => operate(Operation::CentreGimbal),
        // It is pointed by what follows.
        _ if !source.site.identity.is_ardupilot() => Step::Do(Do::Mark),
        2 => operate(Operation::SetGimbalMode(GimbalMode::Commands)),
        3 => operate(Operation::SetGimbalMode(GimbalMode::Radio)),
        6 => operate(Operation::SetGimbalMode(GimbalMode::Home)),
        _ => operate(Operation::SetGimbalMode(GimbalMode::Region)),
    }
}

/// DO_MOUNT_CONTROL: pitch, roll, yaw from the nose, and MAV_MOUNT_MODE, which ArduPilot's missions leave out.
fn mount(source: &Source<'_>) -> Step {
    let named = !source.site.identity.is_ardupilot();
    match source.value(7) as u8 {
        0 if named => operate(Operation::RetractGimbal),
        1 if named => operate(Operation::CentreGimbal),
        _ => operate(Operation::Point(Pointing {
            pitch_rad: source.angle_rad(1),
            roll_rad: source.angle_rad(2),
            yaw_rad: source.angle_rad(3).map(turned),
            ..Pointing::default()
        })),
    }
}

/// GIMBAL_MANAGER_FLAGS.
const RETRACT: u32 = 1;
const NEUTRAL: u32 = 2;
const YAW_LOCK: u32 = 16;
const YAW_IN_EARTH_FRAME: u32 = 64;

/// DO_GIMBAL_MANAGER_PITCHYAW: pitch, yaw and their rates in degrees, and flags.
fn pitch_and_yaw(source: &Source<'_>) -> Step {
    let flags = source.flags(5);
    if flags & RETRACT != 0 {
        return operate(Operation::RetractGimbal);
    }
    if flags & NEUTRAL != 0 {
        return operate(Operation::CentreGimbal);
    }
    operate(Operation::Point(Pointing {
        roll_rad: None,
        pitch_rad: source.angle_rad(1),
        yaw_rad: source.angle_rad(2).map(turned),
        pitch_rate_rad_s: source.angle_rad(3),
        yaw_rate_rad_s: source.angle_rad(4),
        yaw_lock: flags & (YAW_LOCK | YAW_IN_EARTH_FRAME) != 0,
    }))
}

/// An angle within half a turn, rad.
fn turned(angle_rad: f64) -> f64 {
    let angle_rad = angle_rad % TAU;
    if angle_rad > PI {
        angle_rad - TAU
    } else if angle_rad < -PI {
        angle_rad + TAU
    } else {
        angle_rad
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use nalgebra::Vector3;

    use super::*;
    use crate::identity::Identity;
    use crate::plan::mission_command::mission_command;
    use crate::plan::{MissionItem, PlanKind, Site, check, frame};
    use crate::world::{Geodetic, LocalFrame};

    const NAN: f64 = f64::NAN;

    fn step(identity: Identity, command: u16, [a, b, c, d, x, y, z]: [f64; 7]) -> Step {
        let origin = Geodetic { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 400.0 };
        let site = Site {
            identity,
            frame: LocalFrame::new(origin),
            home_m: Vector3::zeros(),
            terrain: crate::surroundings::Terrain::default(),
        };
        let (parameters, position) = ([a, b, c, d], [x, y, z]);
        let item = MissionItem { frame: frame::MISSION, command, parameters, position, autocontinue: true };
        let items = [MissionItem::home([47.0, 8.0, 400.0]), item];
        check::plan(PlanKind::Mission, &items, &site).unwrap();
        (mission_command(command).unwrap().step)(&Source { item: &item, items: &items, site: &site })
    }

    /// A command with parameters as a ground station sends them, and what it means by the specification of MAVLink.
    type Case = (u16, [f64; 7], Step);

    /// Outputs, gripper and camera.
    #[rustfmt::skip] // A line per case reads as the table that it is.
    fn outputs_and_camera() -> Vec<Case> {
        let by_distance = |distance_m, oblique| {
            operate(Operation::TriggerByDistance { distance_m, at_once: true, oblique })
        };
        vec![
            (DO_SET_RELAY, [2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::SetRelay { relay: 2, to: Switch::On })),
            (DO_SET_RELAY, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::SetRelay { relay: 2, to: Switch::Off })),
            (DO_SET_RELAY, [2.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::SetRelay { relay: 2, to: Switch::Toggle })),
            (DO_REPEAT_RELAY, [0.0, 5.0, 2.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::RepeatRelay { relay: 0, cycles: 5, period_s: 2.0 })),
            (DO_SET_SERVO, [9.0, 1900.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::SetServo { channel: 9, pulse_us: 1900 })),
            (DO_REPEAT_SERVO, [9.0, 1900.0, 3.0, 4.0, 0.0, 0.0, 0.0],
                operate(Operation::RepeatServo { channel: 9, pulse_us: 1900, cycles: 3, period_s: 4.0 })),
            (DO_SET_ACTUATOR, [0.5, NAN, -1.0, NAN, NAN, NAN, 0.0],
                operate(Operation::SetActuators([Some(0.5), None, Some(-1.0), None]))),
            (DO_GRIPPER, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::Grip { grabs: false })),
            (DO_GRIPPER, [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::Grip { grabs: true })),
            (DO_DIGICAM_CONFIGURE, [0.0; 7], without("settings of the camera")),
            (DO_DIGICAM_CONTROL, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0], operate(Operation::Shoot)),
            (DO_DIGICAM_CONTROL, [0.0; 7], Step::Do(Do::Mark)),
            (DO_CONTROL_VIDEO, [0.0; 7], without("old video control")),
            (DO_SET_CAM_TRIGG_DIST, [12.5, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0], by_distance(12.5, None)),
            (DO_SET_CAM_TRIGG_DIST, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], by_distance(0.0, None)),
            (DO_SET_CAM_TRIGG_INTERVAL, [1500.0, NAN, NAN, NAN, NAN, NAN, NAN], operate(Operation::TriggerByTime { interval_s: 1.5 })),
            (DO_SET_CAM_TRIGG_INTERVAL, [-1.0, NAN, NAN, NAN, NAN, NAN, NAN], Step::Do(Do::Mark)),
            (OBLIQUE_SURVEY, [20.0, 0.0, 1.0, 3.0, 90.0, -90.0, 0.0], by_distance(20.0, Some(Oblique {
                positions: 3, roll_rad: FRAC_PI_2, pitch_rad: -FRAC_PI_2 }))),
            (SET_CAMERA_MODE, [0.0, 2.0, NAN, NAN, NAN, NAN, NAN], operate(Operation::SetCameraMode(CameraMode::Survey))),
            (SET_CAMERA_ZOOM, [2.0, 40.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::Zoom(Drive::Range(40.0)))),
            (SET_CAMERA_ZOOM, [1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::Zoom(Drive::Continuous(-1.0)))),
            (SET_CAMERA_FOCUS, [3.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::Focus(Drive::Distance(5.0)))),
            (SET_CAMERA_FOCUS, [4.0, NAN, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::Focus(Drive::Automatic))),
            (SET_CAMERA_SOURCE, [0.0; 7], without("second lens of the camera")),
            (IMAGE_START_CAPTURE, [0.0, 2.0, 5.0, 1.0, NAN, NAN, NAN], operate(Operation::Capture { interval_s: 2.0, count: 5 })),
            (IMAGE_STOP_CAPTURE, [0.0, NAN, NAN, NAN, NAN, NAN, NAN], operate(Operation::StopCapture)),
            (DO_TRIGGER_CONTROL, [1.0, -1.0, 0.0, NAN, NAN, NAN, NAN],
                operate(Operation::ControlTrigger { enabled: Some(true), paused: Some(false), reset: false })),
            (VIDEO_START_CAPTURE, [0.0; 7], operate(Operation::Record(true))),
            (VIDEO_STOP_CAPTURE, [0.0; 7], operate(Operation::Record(false))),
        ]
    }

    /// The gimbal.
    #[rustfmt::skip] // A line per case reads as the table that it is.
    fn gimbal() -> Vec<Case> {
        let point = |pitch_rad, yaw_rad, yaw_lock| {
            operate(Operation::Point(Pointing { pitch_rad, yaw_rad, yaw_lock, ..Pointing::default() }))
        };
        vec![
            (DO_MOUNT_CONFIGURE, [0.0; 7], operate(Operation::RetractGimbal)),
            (DO_MOUNT_CONFIGURE, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], operate(Operation::CentreGimbal)),
            (DO_MOUNT_CONFIGURE, [2.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0], Step::Do(Do::Mark)),
            (DO_MOUNT_CONTROL, [-90.0, 0.0, 270.0, 0.0, 0.0, 0.0, 2.0], operate(Operation::Point(Pointing {
                roll_rad: Some(0.0), pitch_rad: Some(-FRAC_PI_2), yaw_rad: Some(-FRAC_PI_2), ..Pointing::default() }))),
            (DO_GIMBAL_MANAGER_PITCHYAW, [-90.0, 90.0, NAN, NAN, 0.0, 0.0, 0.0], point(Some(-FRAC_PI_2), Some(FRAC_PI_2), false)),
            (DO_GIMBAL_MANAGER_PITCHYAW, [-90.0, NAN, NAN, NAN, 28.0, 0.0, 0.0], point(Some(-FRAC_PI_2), None, true)),
            // As a MISSION_ITEM_INT scales it.
            (DO_GIMBAL_MANAGER_PITCHYAW, [NAN, NAN, NAN, NAN, 2e-7, 0.0, 0.0], operate(Operation::CentreGimbal)),
            (DO_GIMBAL_MANAGER_CONFIGURE, [0.0; 7], Step::Do(Do::Mark)),
        ]
    }

    /// What is for others to do, or is not there.
    #[rustfmt::skip] // A line per case reads as the table that it is.
    fn others() -> Vec<Case> {
        vec![
            (DO_FENCE_ENABLE, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], Step::Do(Do::SwitchFence(FenceSwitch::On))),
            (DO_FENCE_ENABLE, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], without("floor of the fence")),
            (DO_PARACHUTE, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], without("parachute")),
            (AIRFRAME_CONFIGURATION, [-1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], without("landing gear")),
            (DO_WINCH, [0.0; 7], without("winch")),
            (DO_SPRAYER, [0.0; 7], without("sprayer")),
            (DO_ENGINE_CONTROL, [0.0; 7], without("combustion engine")),
            (DO_AUX_FUNCTION, [0.0; 7], without("auxiliary functions")),
            (DO_SEND_SCRIPT_MESSAGE, [0.0; 7], without("scripts")),
            (DO_VTOL_TRANSITION, [0.0; 7], without("wings")),
            (DO_SET_REVERSE, [0.0; 7], without("reverse drive")),
            (DO_INVERTED_FLIGHT, [0.0; 7], without("inverted flight")),
            (DO_AUTOTUNE_ENABLE, [0.0; 7], without("automatic tuning")),
            (DO_GUIDED_LIMITS, [0.0; 7], without("guided control within missions")),
            (DO_SET_RESUME_REPEAT_DIST, [0.0; 7], without("rewinding of missions")),
            (DO_LAND_START, [0.0; 7], Step::Do(Do::Mark)),
            (DO_RETURN_PATH_START, [0.0; 7], Step::Do(Do::Mark)),
            (JUMP_TAG, [7.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], Step::Do(Do::Mark)),
        ]
    }

    #[test]
    fn every_command_becomes_its_operation() {
        let cases = [outputs_and_camera(), gimbal(), others()].concat();
        for (command, parameters, expected) in &cases {
            assert_eq!(step(Identity::Px4, *command, *parameters), *expected, "{command} {parameters:?}");
        }
        for command in EQUIPMENT_COMMANDS {
            assert!(
                cases.iter().any(|(number, ..)| *number == command.number),
                "{} has no case",
                command.number
            );
        }
    }

    #[test]
    fn ardupilot_has_a_landing_gear_and_a_parachute() {
        for (position, down) in [(0.0, true), (1.0, false)] {
            let parameters = [-1.0, position, 0.0, 0.0, 0.0, 0.0, 0.0];
            let asked = step(Identity::ArduPilot, AIRFRAME_CONFIGURATION, parameters);
            assert_eq!(asked, operate(Operation::MoveLandingGear { down }));
        }
        for (action, order) in
            [(0.0, ParachuteOrder::Disable), (1.0, ParachuteOrder::Enable), (2.0, ParachuteOrder::Release)]
        {
            let asked = step(Identity::ArduPilot, DO_PARACHUTE, [action, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            assert_eq!(asked, operate(Operation::Parachute(order)));
        }
    }

    #[test]
    fn ardupilot_counts_the_way_and_leaves_the_mode_of_the_mount_out() {
        let by_distance =
            step(Identity::ArduPilot, DO_SET_CAM_TRIGG_DIST, [5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let expected = Operation::TriggerByDistance { distance_m: 5.0, at_once: false, oblique: None };
        assert_eq!(by_distance, operate(expected));
        let switch = step(Identity::ArduPilot, DO_AUX_FUNCTION, [70.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(switch, Step::Do(Do::MoveSwitch { function: 70, position: Position::High }));
        for (mode, expected) in [
            (2.0, GimbalMode::Commands),
            (3.0, GimbalMode::Radio),
            (4.0, GimbalMode::Region),
            (5.0, GimbalMode::Region),
            (6.0, GimbalMode::Home),
        ] {
            let mount = step(Identity::ArduPilot, DO_MOUNT_CONFIGURE, [mode, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            assert_eq!(mount, operate(Operation::SetGimbalMode(expected)));
        }
        let mount = step(Identity::ArduPilot, DO_MOUNT_CONTROL, [-45.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(matches!(mount, Step::Do(Do::Operate(Operation::Point(_)))), "{mount:?}");
    }
}
