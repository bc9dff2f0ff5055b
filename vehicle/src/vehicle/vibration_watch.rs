//! ArduCopter's words for an estimator that goes by the receiver, as the accelerometers say something else.

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;

/// It is over once the accelerometers have been believed for so long, µs.
const OVER_US: u64 = 15_000_000;

/// What has been told of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct VibrationWatch {
    /// When the estimator has started again last, µs, while that counts.
    since_us: Option<u64>,
}

impl VibrationWatch {
    /// Tells that the estimator has started again at a time, µs, and that it has not for a while.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal, restarted_us: u64) {
        let lasts = situation.time_us < restarted_us + OVER_US;
        if lasts == self.since_us.is_some() {
            return;
        }
        self.since_us = lasts.then_some(restarted_us);
        let (severity, state) = if lasts { (Severity::Critical, "ON") } else { (Severity::Warning, "OFF") };
        proposal.say(severity, format!("Vibration compensation {state}"));
    }
}

#[cfg(test)]
mod tests {
    use super::VibrationWatch;
    use crate::vehicle::scene::{Scene, said};

    #[test]
    fn it_is_told_once_and_is_over_after_a_while() {
        let (mut scene, mut watch) = (Scene::hovering_at([0.0, 0.0, -10.0]), VibrationWatch::default());
        let mut restarted_us = scene.outputs.time_us;
        let mut told = Vec::new();
        for _ in 0..25 {
            let requests = scene.show(|situation, proposal| watch.watch(situation, proposal, restarted_us));
            told.extend(said(&requests).into_iter().map(str::to_owned));
            if told.len() == 1 && scene.outputs.time_us < 105_000_000 {
                // Once more.
                restarted_us = scene.outputs.time_us;
            }
            scene.wait_us(1_000_000);
        }
        assert_eq!(told, ["Vibration compensation ON", "Vibration compensation OFF"]);
    }
}
