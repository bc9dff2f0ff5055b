//! GPS_INPUT: fixes of a receiver that a companion computer or a motion capture system stands for.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::GPS_INPUT_DATA;
use nalgebra::Vector3;
use vehicle::Severity;
use vehicle::estimation::gps::{GpsFix, HORIZONTAL_M, UNKNOWN_M, UNKNOWN_M_S, VELOCITY_M_S, VERTICAL_M};
use vehicle::world::Geodetic;

use super::Service;
use crate::codec::{Frame, Payload, degrees};
use crate::context::Context;
use crate::envelope::Origin;

/// What a message leaves out, by its flags.
const NO_ALTITUDE: u16 = 1;
const NO_HORIZONTAL_VELOCITY: u16 = 8;
const NO_VERTICAL_VELOCITY: u16 = 16;
const NO_SPEED_ACCURACY: u16 = 32;
const NO_HORIZONTAL_ACCURACY: u16 = 64;
const NO_VERTICAL_ACCURACY: u16 = 128;
/// The least kind of fix that is used: one with a height.
const THREE_DIMENSIONAL: u8 = 3;

/// Takes them where ArduPilot would.
#[derive(Clone, Copy, Debug, Default)]
pub struct GpsInput {
    /// Whether it has been said that they are not used.
    told: bool,
}

impl Service for GpsInput {
    fn summary(&self) -> &'static str {
        "GPS fixes from outside (ArduPilot, GPS1_TYPE = 14)"
    }

    fn messages(&self) -> &'static [u32] {
        &[GPS_INPUT_DATA::ID]
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        if !context.identity().is_ardupilot() {
            self.tell(context, "GPS_INPUT is ignored, as by PX4: it needs --autopilot ardupilot");
        } else if payload.u8(60) != 0 {
            self.tell(context, "GPS_INPUT is ignored: there is one receiver, so gps_id must be 0");
        } else if let Some(fix) = fix(context, &payload)
            && !context.vehicle.receive_fix(fix)
        {
            self.tell(context, "GPS_INPUT is ignored: set GPS1_TYPE to 14 to use it");
        }
    }
}

impl GpsInput {
    /// Says once why nothing comes of them.
    fn tell(&mut self, context: &mut Context, text: &str) {
        if !std::mem::replace(&mut self.told, true) {
            context.say(Severity::Warning, text);
        }
    }
}

/// The fix of a message, taken when it comes, if it is one.
fn fix(context: &Context, payload: &Payload<'_>) -> Option<GpsFix> {
    let flags = payload.u16(56);
    let without = |flag: u16| flags & flag != 0;
    let [altitude_m] = payload.reals(20);
    let [north, east, down, speed_accuracy, horizontal_accuracy, vertical_accuracy]: [f64; 6] =
        payload.reals(32);
    let place = Geodetic {
        latitude_deg: degrees(payload.i32(12)),
        longitude_deg: degrees(payload.i32(16)),
        altitude_m: if without(NO_ALTITUDE) {
            context.vehicle.frame().origin().altitude_m
        } else {
            altitude_m
        },
    };
    let unless = |left_out: bool, value: f64, otherwise: f64| if left_out { otherwise } else { value };
    let velocity_m_s = Vector3::new(
        unless(without(NO_HORIZONTAL_VELOCITY), north, 0.0),
        unless(without(NO_HORIZONTAL_VELOCITY), east, 0.0),
        unless(without(NO_VERTICAL_VELOCITY), down, 0.0),
    );
    let is_fix = payload.u8(61) >= THREE_DIMENSIONAL && place.is_valid();
    if !is_fix || !velocity_m_s.iter().all(|axis| axis.is_finite()) {
        return None;
    }
    // What is said to be exact is as good as the simulated receiver's.
    let accuracy = |left_out: bool, value: f64, usual: f64| {
        if left_out || !value.is_finite() || value <= 0.0 { usual } else { value }
    };
    let speed_m_s = accuracy(without(NO_SPEED_ACCURACY), speed_accuracy, VELOCITY_M_S);
    let height_m = accuracy(without(NO_VERTICAL_ACCURACY), vertical_accuracy, VERTICAL_M);
    Some(GpsFix {
        time_us: context.vehicle.time_us(),
        position_m: context.vehicle.frame().to_local_m(&place),
        velocity_m_s,
        horizontal_accuracy_m: accuracy(without(NO_HORIZONTAL_ACCURACY), horizontal_accuracy, HORIZONTAL_M),
        vertical_accuracy_m: unless(without(NO_ALTITUDE), height_m, UNKNOWN_M),
        velocity_accuracy_m_s: unless(without(NO_HORIZONTAL_VELOCITY), speed_m_s, UNKNOWN_M_S),
        climb_accuracy_m_s: unless(without(NO_VERTICAL_VELOCITY), speed_m_s, UNKNOWN_M_S),
        satellites: payload.u8(62),
    })
}
