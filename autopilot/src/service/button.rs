//! BUTTON_CHANGE: buttons that are pressed and released, at once and then each second for a while.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{BUTTON_CHANGE_DATA, MavMessage};

use super::Service;
use crate::codec::boot_ms;
use crate::context::Context;
use crate::envelope::Destination;

/// Time between two messages, µs.
const PERIOD_US: u64 = 1_000_000;

/// What has been told of the buttons: the change, and when, µs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Buttons {
    told: Option<(u64, u64)>,
}

impl Service for Buttons {
    fn summary(&self) -> &'static str {
        "Buttons"
    }

    fn answers(&self) -> &'static [u32] {
        &[BUTTON_CHANGE_DATA::ID]
    }

    fn tick(&mut self, context: &mut Context) {
        let vehicle = &context.vehicle;
        let (state, Some(changed_us)) = vehicle.buttons() else { return };
        let (time_us, settings) = (vehicle.time_us(), &vehicle.conduct().radio.buttons);
        let news = self.told.is_none_or(|(told_us, _)| told_us != changed_us);
        let due = self.told.is_none_or(|(_, latest_us)| time_us >= latest_us + PERIOD_US);
        let lasts = time_us <= changed_us + (settings.told_s * 1e6) as u64;
        if !settings.enabled || !(news || due && lasts) {
            return;
        }
        self.told = Some((changed_us, time_us));
        let message =
            BUTTON_CHANGE_DATA { time_boot_ms: boot_ms(time_us), last_change_ms: boot_ms(changed_us), state };
        context.outbox.send(Destination::Everyone, MavMessage::BUTTON_CHANGE(message));
    }
}
