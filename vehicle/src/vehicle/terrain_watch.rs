//! ArduCopter's failsafe of a mission above a ground that nothing tells it of.

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use crate::mode::Mode;

/// So long, µs, it flies on.
const PATIENCE_US: u64 = 5_000_000;

/// Since when the ground is not known, µs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct TerrainWatch {
    unknown_since_us: Option<u64>,
}

impl TerrainWatch {
    /// Returns, or lands, once it has flown for a while by a height above the ground that is not known.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal, is_unknown: bool) {
        if !is_unknown {
            self.unknown_since_us = None;
            return;
        }
        let since_us = *self.unknown_since_us.get_or_insert(situation.time_us);
        if situation.time_us < since_us + PATIENCE_US {
            return;
        }
        self.unknown_since_us = None;
        proposal.say(Severity::Critical, "Failsafe: Terrain data missing");
        proposal.enter(if situation.can_fly(Mode::Return) { Mode::Return } else { Mode::Land });
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, TerrainWatch};
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};

    #[test]
    fn it_returns_after_five_seconds_without_the_ground() {
        let (mut scene, mut watch) = (Scene::hovering_at([0.0, 0.0, -10.0]), TerrainWatch::default());
        let mut after_s = |seconds: u64, is_unknown: bool| {
            scene.wait_us(seconds * 1_000_000);
            scene.show(|situation, proposal| watch.watch(situation, proposal, is_unknown))
        };
        assert!(after_s(0, true).is_empty() && after_s(4, true).is_empty());
        assert!(
            after_s(1, false).is_empty() && after_s(4, true).is_empty(),
            "it is known again for a moment"
        );
        let requests = after_s(5, true);
        assert_eq!(said(&requests[..1]), ["Failsafe: Terrain data missing"]);
        assert_eq!(requests.last(), Some(&Request::Enter(Mode::Return)));
    }
}
