//! The position mode: sticks command velocity.

use super::proposal::Proposal;
use super::situation::Situation;
use super::steering::SteeringKind;

/// One tick of the position mode. Without a pilot it goes on with what it does: how it came here decides by what.
pub fn fly_by_velocity(situation: &Situation, proposal: &mut Proposal) {
    let Some(sticks) = situation.pilot.sticks else { return };
    let outputs = situation.outputs;
    let yaw_rate = situation.limits().yaw_rate_rad_s;
    let set_point = sticks.set_point(situation.conduct, outputs.attitude_rad.z, yaw_rate);
    let flies = proposal.steering().kind() != SteeringKind::Idle;
    if flies || set_point.leads_up(outputs.position_m.z) {
        proposal.follow(situation, &set_point);
    }
}
