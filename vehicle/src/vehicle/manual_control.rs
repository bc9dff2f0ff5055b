//! The position mode: sticks command velocity.

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use super::steering::SteeringKind;
use super::sticks::Sticks;

/// The pilot's sticks.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ManualControl {
    /// The latest, and when they came, µs.
    latest: Option<(Sticks, u64)>,
}

impl ManualControl {
    /// Takes sticks that came at a time, µs.
    pub fn take(&mut self, sticks: Sticks, time_us: u64) {
        self.latest = Some((sticks, time_us));
    }

    /// One tick of the position mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let timeout_us = (situation.conduct.stick_timeout_s * 1e6) as u64;
        // Without sticks it holds; how it came here decides by what.
        let Some((sticks, taken_us)) = self.latest else { return };
        let sticks = if situation.time_us - taken_us <= timeout_us {
            sticks
        } else {
            self.latest = None;
            proposal.say(Severity::Warning, "Manual control lost: holding");
            Sticks::default()
        };
        let outputs = situation.outputs;
        let yaw_rate = situation.limits().yaw_rate_rad_s;
        let set_point = sticks.set_point(situation.conduct, outputs.attitude_rad.z, yaw_rate);
        let flies = proposal.steering().kind() != SteeringKind::Idle;
        if flies || set_point.leads_up(outputs.position_m.z) {
            proposal.follow(situation, &set_point);
        }
    }
}
