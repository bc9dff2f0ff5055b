//! Touch-down, lift-off, and what follows on the ground: rotors that idle, and stop after a while.

use super::landed::LandedDetector;
use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use super::steering::SteeringKind;
use crate::mode::Mode;

/// How the vehicle stands, and since when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    detector: LandedDetector,
    /// Whether it has flown since it was armed.
    flown: bool,
    /// Since when it has been armed and on the ground, µs.
    grounded_since_us: u64,
}

impl Landing {
    /// A disarmed vehicle at a height, m.
    pub fn new(height_m: f64) -> Self {
        Self { detector: LandedDetector::new(height_m), flown: false, grounded_since_us: 0 }
    }

    /// Whether it stands.
    pub fn is_landed(&self) -> bool {
        self.detector.is_landed()
    }

    /// Whether it has touched the ground, still and unloaded, for a while up to now.
    pub fn is_settled(&self) -> bool {
        self.detector.is_settled()
    }

    /// Whether it has flown since it was armed.
    pub fn has_flown(&self) -> bool {
        self.flown
    }

    /// It is armed at a time, µs: in the air that is a flight.
    pub fn arm(&mut self, time_us: u64) {
        self.flown = !self.is_landed();
        self.grounded_since_us = time_us;
    }

    /// It is disarmed.
    pub fn disarm(&mut self) {
        self.flown = false;
    }

    /// Looks whether the vehicle has touched down or lifted off. One that stands, and is not led up, lets its rotors idle.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let weight_n = situation.configuration.airframe.weight_n();
        let controlled = proposal.steering().kind() == SteeringKind::Position;
        let stood = self.is_landed();
        self.detector.update(&situation.felt(), weight_n, situation.armed, controlled);
        if self.is_landed() && !stood {
            self.touch_down(situation, proposal);
        } else if stood && !self.is_landed() {
            self.flown |= situation.armed;
        }
        // A mission and a takeoff know what they do.
        let waits = !matches!(situation.mode, Mode::Mission | Mode::Takeoff);
        let z_m = situation.outputs.position_m.z;
        if waits && self.is_settled() && proposal.steering().stays_below(z_m) {
            proposal.idle(situation);
        }
    }

    fn touch_down(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.grounded_since_us = situation.time_us;
        if situation.armed && self.flown {
            proposal.say(Severity::Info, "Landing detected");
        }
        // An attitude is the pilot's own business.
        if proposal.steering().kind() == SteeringKind::Position {
            proposal.idle(situation);
        }
    }

    /// Stops the rotors of an armed vehicle that has idled on the ground for long enough.
    pub fn wait(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if !self.is_landed() {
            self.grounded_since_us = situation.time_us;
            return;
        }
        if proposal.steering().kind() != SteeringKind::Idle || situation.mission_goes_on {
            return;
        }
        let conduct = situation.conduct;
        let wait_s =
            if self.flown { conduct.disarm_after_landing_s } else { conduct.disarm_before_takeoff_s };
        let waited_s = (situation.time_us - self.grounded_since_us) as f64 / 1e6;
        if wait_s >= 0.0 && waited_s >= wait_s {
            proposal.stop_rotors(if self.flown { "Disarmed after landing" } else { "Disarmed: no takeoff" });
        }
    }
}
