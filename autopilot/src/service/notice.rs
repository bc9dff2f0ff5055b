//! The vehicle's notices, as lines for the pilot.

use super::Service;
use crate::context::Context;

/// Says what the vehicle has to say.
#[derive(Clone, Copy, Debug)]
pub struct Notices;

impl Service for Notices {
    fn announce(&mut self, context: &mut Context) {
        for notice in context.vehicle.take_notices() {
            context.say(notice.severity, &notice.text);
        }
    }
}
