//! What is seen of a tick once it has been flown: contacts, rotors, the place, crashes and the ground.

use super::super::landed::LandedState;
use super::super::machines::Machines;
use super::super::proposal::Proposal;
use super::super::situation::Situation;
use super::Vehicle;
use super::decision::Shown;

impl Vehicle {
    /// Looks at what the tick has led to.
    pub(super) fn look_back(&mut self) {
        let lasted_s = self.lasted_s;
        self.consult_in_turn(&mut [
            &mut |parts, situation, proposal| {
                parts.obstacles.measure(situation);
                parts.obstacles.watch_contact(situation, proposal);
                Shown::still_if(parts.obstacles.surface() == situation.surface)
            },
            &mut |parts, situation, proposal| {
                parts.rotors.watch(situation, proposal, lasted_s);
                Shown::still_if(parts.rotors.lost_rotor() == situation.lost_rotor)
            },
            &mut |parts, situation, proposal| {
                parts.hold.watch(situation, proposal);
                Shown::Still
            },
            &mut |parts, situation, proposal| {
                parts.crash.watch(situation, proposal, lasted_s);
                Shown::Still
            },
            &mut |parts, situation, proposal| {
                watch_ground(parts, situation, proposal);
                Shown::Still
            },
        ]);
    }
}

/// Looks at touch-down and lift-off, and at what the pilot does about a landing.
fn watch_ground(parts: &mut Machines, situation: &Situation, proposal: &mut Proposal) {
    let comes_down = parts.landed_state(situation.mode, situation.armed) == LandedState::Landing;
    parts.landing.watch(situation, proposal);
    parts.landing.choose_speed(comes_down, situation, proposal);
    parts.landing_pilot.watch(situation, proposal);
    parts.flight_times.watch(situation);
}
