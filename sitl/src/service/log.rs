//! There are no logs on board to be downloaded: who asks is told so at once.

use mavlink::dialects::common::{LOG_ENTRY_DATA, MavMessage};

use super::{Destination, Origin};
use crate::autopilot::Autopilot;

/// An empty list.
pub fn answer(autopilot: &mut Autopilot, origin: &Origin) {
    autopilot.send(Destination::Peer(origin.peer), MavMessage::LOG_ENTRY(LOG_ENTRY_DATA::default()));
}
