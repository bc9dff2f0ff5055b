//! The position mode: sticks command velocity.

use super::fence_keeping::keep_inside;
use super::proposal::Proposal;
use super::set_point::AxisTarget;
use super::situation::Situation;
use super::steering::SteeringKind;
use super::stick_climb::StickClimb;
use super::sticks::Sticks;

/// One tick of the position mode. Without a pilot it goes on with what it does: how it came here decides by what.
pub fn fly_by_velocity(climb: &mut StickClimb, situation: &Situation, proposal: &mut Proposal) {
    // Without a pilot a takeoff that was commanded goes on as with centred sticks.
    let released = (situation.pilot.released || climb.takes_off()).then(Sticks::default);
    let Some(sticks) = situation.pilot.sticks.or(released) else { return };
    let outputs = situation.outputs;
    let yaw_rate = situation.limits().yaw_rate_rad_s;
    let mut set_point = sticks.set_point(situation.conduct, outputs.attitude_rad.z, yaw_rate);
    let climb_m_s = climb.climb_m_s(situation, sticks.climb_m_s(situation.conduct));
    set_point.axes[2] = AxisTarget::Velocity(-climb_m_s);
    let set_point = keep_inside(situation, set_point);
    let flies = proposal.steering().kind() != SteeringKind::Idle;
    if flies || set_point.leads_up(outputs.position_m.z) {
        proposal.follow(situation, &set_point);
    }
}
