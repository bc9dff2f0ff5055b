//! LANDING_TARGET: what a companion computer sees of the place to land at.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::LANDING_TARGET_DATA;
use nalgebra::Vector3;
use vehicle::Sighting;

use super::Service;
use crate::codec::{Frame, Payload};
use crate::context::Context;
use crate::envelope::Origin;

/// Frames of MAVLink.
const BODY_FRD: u8 = 12;
const LOCAL_FRD: u8 = 20;

/// Takes them where the vehicle lands by them.
#[derive(Clone, Copy, Debug)]
pub struct LandingTargets;

impl Service for LandingTargets {
    fn summary(&self) -> &'static str {
        "Landing targets seen by companion computers"
    }

    fn messages(&self) -> &'static [u32] {
        &[LANDING_TARGET_DATA::ID]
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        if let Some(sighting) = sighting(&frame.payload()) {
            context.vehicle.see_landing_target(sighting);
        }
    }
}

/// A position in one of two frames, or angles to the right and back with a distance or without.
fn sighting(payload: &Payload<'_>) -> Option<Sighting> {
    let [angle_x, angle_y, distance_m]: [f64; 3] = payload.reals(8);
    let place: [f64; 3] = payload.reals(30);
    let distance_m = Some(distance_m).filter(|distance_m| *distance_m > 0.0);
    let has_place = payload.u8(59) != 0;
    let numbers = [angle_x, angle_y].into_iter().chain(place.into_iter().filter(|_| has_place));
    if !numbers.into_iter().all(f64::is_finite) {
        return None;
    }
    let way_m = Vector3::from(place);
    match payload.u8(29) {
        _ if !has_place => {
            let direction = Vector3::new(-libm::tan(angle_y), libm::tan(angle_x), 1.0);
            Some(Sighting::Direction(direction.normalize(), distance_m))
        }
        LOCAL_FRD => Some(Sighting::Level(way_m)),
        BODY_FRD => way_m.try_normalize(1e-3).map(|along| Sighting::Direction(along, Some(way_m.norm()))),
        _ => None,
    }
}
