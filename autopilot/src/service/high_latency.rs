//! The high latency protocol: one small message in five seconds tells a satellite link the essentials.
//!
//! MAV_CMD_CONTROL_HIGH_LATENCY turns it on and off on the sender's link. The other messages of the link stay as they are:
//! who wants nothing else there stops them by MAV_CMD_SET_MESSAGE_INTERVAL. Everyone can ask for the message at any time.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, HIGH_LATENCY2_DATA, HlFailureFlag, MavCmd, MavMessage,
};
use vehicle::world::{atmospheric_temperature_degc, heading_deg};
use vehicle::{Cause, MissionState, Mode, Refusal, Severity, Vehicle};

use super::{CommandEntry, Outcome, Progress, Service, heartbeat};
use crate::codec::{Command, boot_ms, scaled_degrees};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::stream::{Build, Stream};

/// 0.2 Hz, as the protocol recommends.
const PERIOD_US: u64 = 5_000_000;

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_CONTROL_HIGH_LATENCY as u16)];

const STREAMS: &[Stream] = &[Stream::on_request(HIGH_LATENCY2_DATA::ID, Build::Vehicle(of_now))];

/// The largest values since the last message.
#[derive(Clone, Copy, Debug)]
struct Extremes {
    climb_rate_m_s: f64,
    /// Accuracies of the GPS receiver, if it had a fix; infinite if it lost it.
    horizontal_m: f64,
    vertical_m: f64,
}

impl Extremes {
    fn of(vehicle: &Vehicle) -> Self {
        let fix = vehicle.readings().gps.filter(|fix| fix.is_fresh(vehicle.time_us()));
        Self {
            climb_rate_m_s: vehicle.outputs().velocity_m_s.z.abs(),
            horizontal_m: fix.map_or(f64::INFINITY, |fix| fix.horizontal_accuracy_m),
            vertical_m: fix.map_or(f64::INFINITY, |fix| fix.vertical_accuracy_m),
        }
    }

    fn or(&self, other: &Self) -> Self {
        Self {
            climb_rate_m_s: self.climb_rate_m_s.max(other.climb_rate_m_s),
            horizontal_m: self.horizontal_m.max(other.horizontal_m),
            vertical_m: self.vertical_m.max(other.vertical_m),
        }
    }
}

/// A link on which it is on.
#[derive(Clone, Copy, Debug)]
struct Transmission {
    link: usize,
    due_us: u64,
    extremes: Option<Extremes>,
}

/// The links on which it is on.
#[derive(Clone, Debug, Default)]
pub struct HighLatency {
    transmissions: Vec<Transmission>,
}

impl Service for HighLatency {
    fn summary(&self) -> &'static str {
        "Telemetry for slow links"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn command(&mut self, context: &mut Context, origin: &Origin, command: &Command) -> Outcome {
        let link = origin.peer.link;
        let place = self.transmissions.iter().position(|transmission| transmission.link == link);
        match (command.parameter(1), place) {
            (1.0, None) => {
                let due_us = context.vehicle.time_us();
                self.transmissions.push(Transmission { link, due_us, extremes: None });
                context.say(Severity::Info, "High latency telemetry on");
            }
            (0.0, Some(place)) => {
                self.transmissions.remove(place);
                context.say(Severity::Info, "High latency telemetry off");
            }
            (0.0 | 1.0, _) => {}
            (other, _) => {
                return Err(Refusal::denied(format!(
                    "{other} neither enables (1) nor disables (0) high latency telemetry"
                )));
            }
        }
        Ok(Progress::Done)
    }

    fn stream(&mut self, context: &mut Context) {
        if self.transmissions.is_empty() {
            return;
        }
        let (time_us, now) = (context.vehicle.time_us(), Extremes::of(&context.vehicle));
        for transmission in &mut self.transmissions {
            let extremes = transmission.extremes.map_or(now, |extremes| extremes.or(&now));
            transmission.extremes = Some(extremes);
            if transmission.due_us <= time_us {
                transmission.due_us = time_us + PERIOD_US;
                transmission.extremes = None;
                context
                    .outbox
                    .send(Destination::Link(transmission.link), message(&context.vehicle, &extremes));
            }
        }
    }
}

/// HIGH_LATENCY2 with the values of now in place of the largest ones.
fn of_now(vehicle: &Vehicle) -> MavMessage {
    message(vehicle, &Extremes::of(vehicle))
}

/// HIGH_LATENCY2. What its small integers cannot hold stays at the end of their range.
fn message(vehicle: &Vehicle, extremes: &Extremes) -> MavMessage {
    let outputs = vehicle.outputs();
    let reference = &outputs.setpoint;
    let place = vehicle.place_of(&outputs.position_m);
    let altitude_m = |down_m: f64| (vehicle.frame().origin().altitude_m - down_m).round() as i16;
    let leg = vehicle.leg_errors().filter(|_| vehicle.mode() == Mode::Mission);
    let target_m = leg.map_or(reference.position_m, |(target_m, _)| target_m);
    let (_, strongest_n) = vehicle.simulation().configuration().airframe.thrust_range_n();
    let wind_m_s = vehicle.wind_m_s();
    let half_degrees = |angle_rad: f64| (heading_deg(angle_rad) / 2.0).floor() as u8;
    let fifths = |speed_m_s: f64| (5.0 * speed_m_s).round() as u8;
    let tenths = |metres: f64| (10.0 * metres).round() as u8;
    let mission = vehicle.mission_status();
    let heartbeat = heartbeat::data(vehicle);
    let (custom_mode, base_mode) = mode(vehicle, &heartbeat);
    MavMessage::HIGH_LATENCY2(HIGH_LATENCY2_DATA {
        timestamp: boot_ms(outputs.time_us),
        latitude: scaled_degrees(place.latitude_deg),
        longitude: scaled_degrees(place.longitude_deg),
        custom_mode,
        altitude: altitude_m(outputs.position_m.z),
        target_altitude: altitude_m(reference.position_m.z),
        target_distance: ((target_m - outputs.position_m).xy().norm() / 10.0).round() as u16,
        wp_num: match mission.state {
            MissionState::None => u16::MAX,
            _ => u16::try_from(mission.current).unwrap_or(u16::MAX),
        },
        failure_flags: failures(vehicle),
        mavtype: heartbeat.mavtype,
        autopilot: heartbeat.autopilot,
        heading: half_degrees(outputs.attitude_rad.z),
        target_heading: half_degrees(reference.yaw_rad),
        throttle: (100.0 * outputs.thrust_n / strongest_n).round() as u8,
        airspeed: fifths((outputs.velocity_m_s - wind_m_s).norm()),
        // It is not steered by airspeed.
        airspeed_sp: 0,
        groundspeed: fifths(outputs.velocity_m_s.xy().norm()),
        windspeed: fifths(wind_m_s.xy().norm()),
        // Where it blows to, as PX4 has it.
        wind_heading: half_degrees(libm::atan2(wind_m_s.y, wind_m_s.x)),
        eph: tenths(extremes.horizontal_m),
        epv: tenths(extremes.vertical_m),
        temperature_air: atmospheric_temperature_degc(place.altitude_m).round() as i8,
        climb_rate: (10.0 * extremes.climb_rate_m_s).round() as i8,
        battery: (100.0 * vehicle.battery_remaining()).ceil() as i8,
        custom0: base_mode,
        custom1: 0,
        custom2: 0,
    })
}

/// The mode in 16 bits, and what stands in the first custom field: PX4 leaves the empty half of its mode out; ArduPilot's
/// mode is small, and its clients look for the flags of the heartbeat in the field.
fn mode(vehicle: &Vehicle, heartbeat: &HEARTBEAT_DATA) -> (u16, i8) {
    if vehicle.identity().is_ardupilot() {
        (heartbeat.custom_mode as u16, heartbeat.base_mode.bits() as i8)
    } else {
        ((heartbeat.custom_mode >> 16) as u16, 0)
    }
}

fn failures(vehicle: &Vehicle) -> HlFailureFlag {
    let (works, validity) = (vehicle.instrument_health(), vehicle.validity());
    let charged = vehicle.battery_remaining() >= vehicle.conduct().failsafe.battery_critical;
    let failures = [
        (!works.gps, HlFailureFlag::HL_FAILURE_FLAG_GPS),
        (!works.barometer, HlFailureFlag::HL_FAILURE_FLAG_ABSOLUTE_PRESSURE),
        (!works.accelerometer, HlFailureFlag::HL_FAILURE_FLAG_3D_ACCEL),
        (!works.gyroscope, HlFailureFlag::HL_FAILURE_FLAG_3D_GYRO),
        (!works.magnetometer, HlFailureFlag::HL_FAILURE_FLAG_3D_MAG),
        (!charged, HlFailureFlag::HL_FAILURE_FLAG_BATTERY),
        (vehicle.failsafe().is_present(Cause::SetPointsLost), HlFailureFlag::HL_FAILURE_FLAG_OFFBOARD_LINK),
        (vehicle.lost_rotor().is_some(), HlFailureFlag::HL_FAILURE_FLAG_ENGINE),
        (vehicle.fence_record().now.is_some(), HlFailureFlag::HL_FAILURE_FLAG_GEOFENCE),
        (!validity.all(), HlFailureFlag::HL_FAILURE_FLAG_ESTIMATOR),
    ];
    // The crate's default of flags is the first of them, not none.
    let none = HlFailureFlag::empty();
    failures.into_iter().filter(|(failed, _)| *failed).fold(none, |flags, (_, flag)| flags | flag)
}
