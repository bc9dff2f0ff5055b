//! Home by its old message, which ArduPilot still takes.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::SET_HOME_POSITION_DATA;
use vehicle::Severity;
use vehicle::world::Geodetic;

use super::Service;
use crate::codec::{Frame, degrees};
use crate::context::Context;
use crate::envelope::Origin;

/// Moves home.
#[derive(Clone, Copy, Debug)]
pub struct HomeMessages;

impl Service for HomeMessages {
    fn summary(&self) -> &'static str {
        "Home by its old message (ArduPilot)"
    }

    fn messages(&self) -> &'static [u32] {
        &[SET_HOME_POSITION_DATA::ID]
    }

    /// There is no answer: a refusal is said. Zeros are the present place.
    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        if !context.identity().is_ardupilot() {
            return;
        }
        let payload = frame.payload();
        let [latitude, longitude, altitude_mm] = [0, 4, 8].map(|at| payload.i32(at));
        let vehicle = &mut context.vehicle;
        let position_m = if [latitude, longitude, altitude_mm] == [0; 3] {
            vehicle.outputs().position_m
        } else {
            vehicle.frame().to_local_m(&Geodetic {
                latitude_deg: degrees(latitude),
                longitude_deg: degrees(longitude),
                altitude_m: f64::from(altitude_mm) / 1e3,
            })
        };
        if let Err(refusal) = vehicle.set_home(position_m, None) {
            context.say(Severity::Warning, &refusal.to_string());
        }
    }
}
