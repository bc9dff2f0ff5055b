//! Offboard set-points: frames and masks resolved by the conventions of the identity.
//!
//! | | PX4, generic | ArduPilot |
//! | --- | --- | --- |
//! | used | as a sign of life always, flown in Offboard | in Guided only |
//! | LOCAL_NED | per-axis masks | a masked bit drops its group |
//! | LOCAL_OFFSET_NED | position relative to the vehicle (an extension) | the same |
//! | BODY_NED | velocity and acceleration, turned by the heading | offset turned by the heading, yaw relative |
//! | BODY_OFFSET_NED | offset turned by the heading, yaw relative (an extension) | the same |
//! | other frames, FORCE_SET with an acceleration, nothing but yaw | refused | stop |
//! | NaN | the axis is ignored | stop |

use mavlink::dialects::ardupilotmega::MavProtocolCapability;
use nalgebra::{Quaternion, Rotation2, UnitQuaternion, Vector2, Vector3};
use vehicle::identity::Identity;
use vehicle::plan::{frame, is_above_ground, is_global};
use vehicle::world::{FARTHEST_M, Geodetic};
use vehicle::{
    AttitudeSetPoint, AxisTarget, PositionSetPoint, Refusal, SetPoint, Severity, Vehicle, YawTarget,
};

use super::Service;
use crate::codec::{Frame, SetAttitudeTarget, SetPositionTarget, TargetPosition, id};
use crate::context::Context;
use crate::envelope::Origin;

/// POSITION_TARGET_TYPEMASK.
const FORCE_SET: u16 = 1 << 9;
const YAW_IGNORE: u16 = 1 << 10;
const YAW_RATE_IGNORE: u16 = 1 << 11;

/// Beyond these a set-point is a mistake: the largest values that the limits of speed, acceleration and turning can be
/// given, m/s, m/s² and rad/s.
const FASTEST_M_S: f64 = 50.0;
const STRONGEST_M_S2: f64 = 20.0;
const QUICKEST_TURN_RAD_S: f64 = 10.0;
/// Body rates beyond this, rad/s, no gyroscope measures.
const QUICKEST_RATE_RAD_S: f64 = 35.0;

/// ATTITUDE_TARGET_TYPEMASK.
const ROLL_RATE_IGNORE: u8 = 1;
const PITCH_RATE_IGNORE: u8 = 2;
const YAW_RATE_IGNORE_ATTITUDE: u8 = 4;
const THRUST_IGNORE: u8 = 1 << 6;
const ATTITUDE_IGNORE: u8 = 1 << 7;

/// Hands set-points on to the vehicle.
#[derive(Clone, Copy, Debug)]
pub struct SetPoints;

impl Service for SetPoints {
    fn summary(&self) -> &'static str {
        "Set-points of position, velocity, acceleration and attitude"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::SET_ATTITUDE_TARGET, id::SET_POSITION_TARGET_LOCAL_NED, id::SET_POSITION_TARGET_GLOBAL_INT]
    }

    fn capabilities(&self, _identity: Identity) -> MavProtocolCapability {
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_SET_ATTITUDE_TARGET
            | MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED
            | MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::SET_ATTITUDE_TARGET => attitude(context, frame),
            _ => position(context, frame),
        }
    }
}

/// Takes SET_POSITION_TARGET_LOCAL_NED or SET_POSITION_TARGET_GLOBAL_INT.
fn position(context: &mut Context, frame: &Frame) {
    let Some(target) = SetPositionTarget::read(frame) else { return };
    let resolved = resolve(&target, &context.vehicle);
    let is_above_ground = is_above_ground(target.frame);
    let led = |position: PositionSetPoint| match position.place() {
        Some(_) if is_above_ground => SetPoint::AboveGround(position),
        _ => SetPoint::Position(position),
    };
    take(context, resolved.map(led));
}

/// Takes SET_ATTITUDE_TARGET.
fn attitude(context: &mut Context, frame: &Frame) {
    let Some(target) = SetAttitudeTarget::read(frame) else { return };
    let resolved = resolve_attitude(&target);
    take(context, resolved.map(SetPoint::Attitude));
}

fn take(context: &mut Context, resolved: Result<SetPoint, Refusal>) {
    let vehicle = &mut context.vehicle;
    let ardupilot = vehicle.identity().is_ardupilot();
    let result = match resolved {
        // ArduPilot stops where it cannot make sense of a set-point.
        Err(refusal) if ardupilot => {
            vehicle.set_point(SetPoint::Position(PositionSetPoint::HOLD)).and(Err(refusal))
        }
        resolved => resolved.and_then(|set_point| vehicle.set_point(set_point)),
    };
    if let Err(refusal) = result {
        context.say(Severity::Warning, &refusal.to_string());
    }
}

/// A set-point in the local frame.
fn resolve(target: &SetPositionTarget, vehicle: &Vehicle) -> Result<PositionSetPoint, Refusal> {
    let ardupilot = vehicle.identity().is_ardupilot();
    let mut given = Given::read(target, ardupilot);
    // Without an acceleration the bit says nothing.
    if target.type_mask & FORCE_SET != 0 && given.acceleration.contains(&true) {
        return Err(Refusal::denied(
            "Set-point rejected: force is not supported; send an acceleration, or ignore it",
        ));
    }
    let outputs = vehicle.outputs();
    let heading = outputs.attitude_rad.z;
    let mut position = match target.position {
        TargetPosition::Local(position_m) => local_position(target.frame, position_m, vehicle)?,
        TargetPosition::Global { .. } => match given.position.contains(&true) {
            true => global_position(target, vehicle)?,
            false => {
                known_global_frame(target.frame)?;
                Vector3::zeros()
            }
        },
    };
    let (mut velocity, mut acceleration) = (target.velocity_m_s, target.acceleration_m_s2);
    let mut yaw_rad = target.yaw_rad;
    if matches!(target.position, TargetPosition::Local(_)) {
        let body = matches!(target.frame, frame::BODY_NED | frame::BODY_OFFSET_NED);
        if body {
            // Turning mixes north and east: half of a pair is no vector.
            for pair in [&mut given.velocity, &mut given.acceleration, &mut given.position] {
                if pair[0] != pair[1] {
                    return Err(Refusal::denied(
                        "Set-point rejected: half a horizontal vector in a body frame",
                    ));
                }
            }
            velocity = turned(&velocity, heading);
            acceleration = turned(&acceleration, heading);
        }
        match target.frame {
            frame::BODY_NED if !ardupilot => given.position = [false; 3],
            frame::BODY_NED | frame::BODY_OFFSET_NED => {
                position = outputs.position_m + turned(&position, heading);
                yaw_rad += heading;
            }
            _ => {}
        }
    }
    compose(&given, &position, &velocity, &acceleration, yaw_rad, target.yaw_rate_rad_s, ardupilot)
}

/// Which values are there: neither masked nor, for PX4, NaN.
struct Given {
    position: [bool; 3],
    velocity: [bool; 3],
    acceleration: [bool; 3],
    yaw: bool,
    yaw_rate: bool,
    /// A value that is asked for is no number.
    nan: bool,
}

impl Given {
    fn read(target: &SetPositionTarget, ardupilot: bool) -> Self {
        let unmasked = |first: u16| -> [bool; 3] {
            let axes: [bool; 3] = core::array::from_fn(|axis| target.type_mask & (first << axis) == 0);
            // ArduPilot knows groups only.
            if ardupilot { [axes.iter().all(|axis| *axis); 3] } else { axes }
        };
        let position = match target.position {
            TargetPosition::Local(position_m) => position_m,
            TargetPosition::Global { altitude_m, .. } => Vector3::new(0.0, 0.0, altitude_m),
        };
        let mut nan = false;
        let mut finite = |asked: [bool; 3], values: &Vector3<f64>| {
            core::array::from_fn(|axis| {
                let number = values[axis].is_finite();
                nan |= asked[axis] && !number;
                asked[axis] && number
            })
        };
        Self {
            position: finite(unmasked(1), &position),
            velocity: finite(unmasked(1 << 3), &target.velocity_m_s),
            acceleration: finite(unmasked(1 << 6), &target.acceleration_m_s2),
            yaw: target.type_mask & YAW_IGNORE == 0 && target.yaw_rad.is_finite(),
            yaw_rate: target.type_mask & YAW_RATE_IGNORE == 0 && target.yaw_rate_rad_s.is_finite(),
            nan,
        }
    }
}

fn local_position(frame: u8, position_m: Vector3<f64>, vehicle: &Vehicle) -> Result<Vector3<f64>, Refusal> {
    match frame {
        frame::LOCAL_NED => Ok(meant_position(position_m, vehicle)),
        frame::BODY_NED | frame::BODY_OFFSET_NED => Ok(position_m),
        frame::LOCAL_OFFSET_NED => Ok(position_m + vehicle.outputs().position_m),
        other => Err(Refusal::denied(format!("Set-point rejected: frame {other} is not supported"))),
    }
}

/// A position of the local frame in which clients count. What is no number stays none; the others need a whole place.
fn meant_position(told_m: Vector3<f64>, vehicle: &Vehicle) -> Vector3<f64> {
    let present_m = vehicle.told_frame().told_m(&vehicle.outputs().position_m);
    let whole_m = told_m.zip_map(&present_m, |told, present| if told.is_finite() { told } else { present });
    let meant_m = vehicle.told_frame().meant_m(&whole_m);
    told_m.zip_map(&meant_m, |told, meant| if told.is_finite() { meant } else { told })
}

fn known_global_frame(frame: u8) -> Result<(), Refusal> {
    if is_global(frame) {
        return Ok(());
    }
    Err(Refusal::denied(format!("Set-point rejected: frame {frame} is not global")))
}

fn global_position(target: &SetPositionTarget, vehicle: &Vehicle) -> Result<Vector3<f64>, Refusal> {
    let TargetPosition::Global { latitude_deg, longitude_deg, altitude_m } = target.position else {
        return Ok(Vector3::zeros());
    };
    known_global_frame(target.frame)?;
    let place = Geodetic { latitude_deg, longitude_deg, altitude_m: vehicle.frame().origin().altitude_m };
    if !place.is_valid() {
        return Err(Refusal::denied(format!(
            "Set-point rejected: no place at latitude {latitude_deg}, longitude {longitude_deg}"
        )));
    }
    let mut position_m = vehicle.frame().to_local_m(&place);
    if vehicle.identity().is_ardupilot() {
        shorten(&mut position_m, &place, vehicle);
    }
    position_m.z = vehicle.site().down_m(target.frame, altitude_m, [position_m.x, position_m.y]);
    Ok(position_m)
}

/// ArduPilot flies towards places however far away they are: on the way to one beyond what can be flown here, to a nearer one. As there,
/// the way is straight on a plane map.
fn shorten(position_m: &mut Vector3<f64>, place: &Geodetic, vehicle: &Vehicle) {
    const REACH_M: f64 = FARTHEST_M / 2.0;
    let here_m = vehicle.outputs().position_m;
    if (*position_m - here_m).xy().norm() <= REACH_M {
        return;
    }
    let here = vehicle.place_of(&here_m);
    let middle_rad = ((here.latitude_deg + place.latitude_deg) / 2.0).to_radians();
    let north_deg = place.latitude_deg - here.latitude_deg;
    let east_deg = (place.longitude_deg - here.longitude_deg + 180.0).rem_euclid(360.0) - 180.0;
    let way = Vector2::new(north_deg, east_deg * libm::cos(middle_rad)).normalize() * REACH_M;
    (position_m.x, position_m.y) = (here_m.x + way.x, here_m.y + way.y);
}

/// A vector of the heading's frame in NED.
fn turned(vector: &Vector3<f64>, heading_rad: f64) -> Vector3<f64> {
    let horizontal = Rotation2::new(heading_rad) * Vector2::new(vector.x, vector.y);
    Vector3::new(horizontal.x, horizontal.y, vector.z)
}

/// Refuses what asks for nothing, or for more than the limits can be set to.
fn check(
    given: &Given,
    [position, velocity, acceleration]: [&Vector3<f64>; 3],
    yaw_rate_rad_s: f64,
) -> Result<(), Refusal> {
    let any = |axes: &[bool; 3]| axes.contains(&true);
    if !any(&given.position) && !any(&given.velocity) && !any(&given.acceleration) {
        return Err(Refusal::denied("Set-point rejected: it contains no target"));
    }
    for (name, axes, values, most, unit) in [
        ("position", &given.position, position, FARTHEST_M, "m"),
        ("velocity", &given.velocity, velocity, FASTEST_M_S, "m/s"),
        ("acceleration", &given.acceleration, acceleration, STRONGEST_M_S2, "m/s²"),
    ] {
        if let Some(axis) = (0..3).find(|axis| axes[*axis] && values[*axis].abs() > most) {
            return Err(beyond(name, values[axis], most, unit));
        }
    }
    if given.yaw_rate && yaw_rate_rad_s.abs() > QUICKEST_TURN_RAD_S {
        return Err(beyond("yaw rate", yaw_rate_rad_s, QUICKEST_TURN_RAD_S, "rad/s"));
    }
    Ok(())
}

/// A value is larger than any limit can be set to.
fn beyond(name: &str, value: f64, most: f64, unit: &str) -> Refusal {
    // Of what is far beyond, decimals tell nothing.
    let decimals = if value.abs() < 10.0 * most { 2 } else { 0 };
    Refusal::denied(format!(
        "Set-point rejected: {name} {value:.decimals$} {unit}; allowed -{most} to {most} {unit}"
    ))
}

fn compose(
    given: &Given,
    position: &Vector3<f64>,
    velocity: &Vector3<f64>,
    acceleration: &Vector3<f64>,
    yaw_rad: f64,
    yaw_rate_rad_s: f64,
    ardupilot: bool,
) -> Result<PositionSetPoint, Refusal> {
    if ardupilot && given.nan {
        return Err(Refusal::denied("Set-point rejected: a value is not a finite number"));
    }
    check(given, [position, velocity, acceleration], yaw_rate_rad_s)?;
    // A trajectory moves; a place with velocities of zero is a place.
    let moves = (0..3).any(|axis| {
        (given.velocity[axis] && velocity[axis] != 0.0)
            || (given.acceleration[axis] && acceleration[axis] != 0.0)
    });
    let axis = |axis: usize| {
        let v = if given.velocity[axis] { velocity[axis] } else { 0.0 };
        let a = if given.acceleration[axis] { acceleration[axis] } else { 0.0 };
        let fed_forward = given.velocity[axis] || given.acceleration[axis];
        if given.position[axis] && fed_forward && moves {
            AxisTarget::Track {
                position_m: position[axis],
                velocity_m_s: v,
                acceleration_m_s2: a,
                jerk_m_s3: 0.0,
            }
        } else if given.position[axis] {
            AxisTarget::Position(position[axis])
        } else if given.velocity[axis] {
            AxisTarget::Velocity(v)
        } else if given.acceleration[axis] {
            AxisTarget::Acceleration(a)
        } else {
            AxisTarget::HOLD
        }
    };
    let yaw = match (given.yaw, given.yaw_rate) {
        (true, true) if yaw_rate_rad_s != 0.0 => YawTarget::Track(yaw_rad, yaw_rate_rad_s),
        (true, _) => YawTarget::Angle(yaw_rad),
        (false, true) => YawTarget::Rate(yaw_rate_rad_s),
        (false, false) => YawTarget::Hold,
    };
    Ok(PositionSetPoint { axes: [axis(0), axis(1), axis(2)], yaw })
}

fn resolve_attitude(target: &SetAttitudeTarget) -> Result<AttitudeSetPoint, Refusal> {
    let ignored = |bit: u8| target.type_mask & bit != 0;
    if ignored(THRUST_IGNORE) {
        return Err(Refusal::denied("Attitude rejected: send thrust; clear mask bit 64"));
    }
    if !(0.0..=1.0).contains(&target.thrust) {
        return Err(Refusal::denied("Attitude rejected: thrust must be from 0 to 1"));
    }
    let rate_bits = [ROLL_RATE_IGNORE, PITCH_RATE_IGNORE, YAW_RATE_IGNORE_ATTITUDE];
    let rates =
        Vector3::from_fn(|axis, _| if ignored(rate_bits[axis]) { 0.0 } else { target.body_rate_rad_s[axis] });
    // NaN is not within.
    if !rates.iter().all(|rate| rate.abs() <= QUICKEST_RATE_RAD_S) {
        return Err(Refusal::denied(format!(
            "Attitude rejected: a body rate is not within {QUICKEST_RATE_RAD_S} rad/s"
        )));
    }
    let attitude = if ignored(ATTITUDE_IGNORE) {
        if rate_bits.iter().all(|bit| ignored(*bit)) {
            return Err(Refusal::denied("Attitude rejected: it has no attitude and no rate"));
        }
        None
    } else {
        let [w, x, y, z] = target.quaternion;
        let quaternion = Quaternion::new(w, x, y, z);
        // NaN is in no range.
        if !(0.9..=1.1).contains(&quaternion.norm()) {
            return Err(Refusal::denied("Attitude rejected: quaternion is not normalized"));
        }
        Some(UnitQuaternion::new_normalize(quaternion))
    };
    Ok(AttitudeSetPoint { attitude, body_rate_rad_s: rates, thrust: target.thrust })
}
