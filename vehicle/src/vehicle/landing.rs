//! Touch-down, lift-off, and what follows on the ground: rotors that idle, and stop after a while.

use super::landed::{LandedDetector, UNLOADED};
use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use super::speeds::SpeedChange;
use super::steering::SteeringKind;
use crate::mode::{Leader, Mode};

/// How the vehicle stands, and since when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    detector: LandedDetector,
    /// Whether it has flown since it was armed.
    flown: bool,
    /// Since when it has been armed and on the ground, µs.
    grounded_since_us: u64,
    /// Largest sink rate of its own that the way down has asked for, m/s.
    sinks_m_s: Option<f64>,
}

impl Landing {
    /// A disarmed vehicle at a height, m.
    pub fn new(height_m: f64) -> Self {
        Self { detector: LandedDetector::new(height_m), flown: false, grounded_since_us: 0, sinks_m_s: None }
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

    /// Lets a vehicle that comes down to the ground sink with the speed that is set for that, and no longer than that.
    pub fn choose_speed(&mut self, comes_down: bool, situation: &Situation, proposal: &mut Proposal) {
        let speed_m_s = Some(situation.conduct.land_fast_m_s).filter(|speed| comes_down && *speed > 0.0);
        if speed_m_s != std::mem::replace(&mut self.sinks_m_s, speed_m_s) {
            proposal.change_speeds(SpeedChange::Landing(speed_m_s));
        }
    }

    /// Looks whether the vehicle has touched down or lifted off. One that stands, and is not led up, lets its rotors idle.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let weight_n = situation.configuration.airframe.weight_n();
        let controlled = proposal.steering().kind() == SteeringKind::Position;
        let stood = self.is_landed();
        let ground_z_m = situation.true_ground_z_m();
        self.detector.update(&situation.felt(), ground_z_m, weight_n, situation.armed, controlled);
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

    /// Stops the rotors of an armed vehicle that has idled on the ground for long enough, or has been led by attitudes that ask for
    /// next to no thrust.
    pub fn wait(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if !self.is_landed() {
            self.grounded_since_us = situation.time_us;
            return;
        }
        if situation.mission_goes_on || situation.mode == Mode::Throw {
            return;
        }
        match proposal.steering().kind() {
            SteeringKind::Idle => {}
            SteeringKind::Attitude if !is_loaded(situation) => {}
            // Who asks for thrust is about to take off.
            SteeringKind::Attitude => {
                self.grounded_since_us = situation.time_us;
                return;
            }
            SteeringKind::Position | SteeringKind::Descent => return,
        }
        let wait_s = self.wait_s(situation);
        let waited_s = (situation.time_us - self.grounded_since_us) as f64 / 1e6;
        if wait_s > 0.0 && waited_s >= wait_s {
            proposal.stop_rotors(if self.flown { "Disarmed after landing" } else { "Disarmed: no takeoff" });
        }
    }

    /// How long the rotors idle before they stop, s. With ArduPilot a pilot who has landed may take off again for as long as before the
    /// first takeoff.
    fn wait_s(&self, situation: &Situation) -> f64 {
        let conduct = situation.conduct;
        let stops = conduct.sticks.disarms_on_landing() && !situation.mode.is_flown_by_thrust();
        let by_hand = situation.identity.is_ardupilot() && situation.mode.leader() == Leader::Sticks;
        if self.flown && (stops || !by_hand) {
            conduct.disarm_after_landing_s
        } else {
            conduct.disarm_before_takeoff_s
        }
    }
}

/// Whether the rotors carry most of the weight.
fn is_loaded(situation: &Situation) -> bool {
    situation.outputs.thrust_n >= UNLOADED * situation.configuration.airframe.weight_n()
}

#[cfg(test)]
mod tests {
    use super::{Landing, Mode, SteeringKind};
    use crate::identity::Identity;
    use crate::vehicle::Conduct;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};
    use crate::vehicle::set_point::PositionSetPoint;

    fn watch(landing: &mut Landing, scene: &mut Scene) -> Vec<Request> {
        scene.wait_us(1_000);
        scene.landed = landing.is_landed();
        scene.show(|situation, proposal| landing.watch(situation, proposal))
    }

    fn wait(landing: &mut Landing, scene: &mut Scene) -> Vec<Request> {
        scene.landed = landing.is_landed();
        scene.show(|situation, proposal| landing.wait(situation, proposal))
    }

    /// A landing that has come down to the ground, pressed on by its reference.
    fn touch_down(scene: &mut Scene) {
        scene.come_to([0.0; 3], [0.0; 3]);
        scene.outputs.setpoint.position_m.z = 0.5;
        scene.outputs.thrust_n = 0.0;
    }

    #[test]
    fn a_flight_ends_on_the_ground_and_the_rotors_stop_after_a_while() {
        let mut scene = Scene::on_the_ground();
        let mut landing = Landing::new(0.0);
        landing.arm(scene.outputs.time_us);
        scene.come_to([0.0, 0.0, -5.0], [0.0; 3]);
        scene.outputs.thrust_n = scene.configuration.airframe.weight_n();
        assert!(watch(&mut landing, &mut scene).is_empty());
        assert!(landing.has_flown() && !landing.is_landed());
        scene.mode = Mode::Land;
        scene.show(|situation, proposal| {
            proposal.steer(crate::vehicle::steering::Steering::Goal(situation.outputs.setpoint))
        });
        touch_down(&mut scene);
        let requests: Vec<_> = (0..400).flat_map(|_| watch(&mut landing, &mut scene)).collect();
        assert_eq!(said(&requests), ["Landing detected"]);
        assert_eq!(scene.steering.kind(), SteeringKind::Idle);
        assert!(wait(&mut landing, &mut scene).is_empty());
        scene.wait_us(2_000_000);
        let stop = Request::StopRotors("Disarmed after landing".to_owned());
        assert_eq!(wait(&mut landing, &mut scene), [stop]);
        landing.disarm();
        assert!(!landing.has_flown());
    }

    /// A pilot of ArduPilot's waits for DISARM_DELAY, unless PILOT_THR_BHV says otherwise.
    #[test]
    fn a_pilot_may_take_off_again() {
        for (mode, options, delay_s, seconds) in [
            (Mode::Position, 0, 10.0, Some(10)),
            (Mode::Position, 0, 0.0, None),
            (Mode::Position, 4, 0.0, Some(2)),
            (Mode::Stabilize, 4, 10.0, Some(10)),
            (Mode::Land, 0, 0.0, Some(2)),
        ] {
            let mut scene = Scene::on_the_ground();
            (scene.identity, scene.conduct, scene.mode) = (Identity::ArduPilot, Conduct::new(true), mode);
            scene.conduct.disarm_before_takeoff_s = delay_s;
            scene.conduct.sticks.throttle_behaviour = options;
            let mut landing = Landing::new(0.0);
            (landing.flown, landing.grounded_since_us) = (true, scene.outputs.time_us);
            let stopped = (1..=20).find(|_| {
                scene.wait_us(1_000_000);
                !wait(&mut landing, &mut scene).is_empty()
            });
            assert_eq!(stopped, seconds, "{mode:?} {options} {delay_s}");
        }
    }

    #[test]
    fn who_does_not_take_off_is_disarmed_unless_the_mission_goes_on() {
        let mut scene = Scene::on_the_ground();
        let mut landing = Landing::new(0.0);
        landing.arm(scene.outputs.time_us);
        scene.wait_us(9_999_999);
        assert!(wait(&mut landing, &mut scene).is_empty());
        scene.wait_us(1);
        scene.mission_goes_on = true;
        assert!(wait(&mut landing, &mut scene).is_empty(), "the mission goes on");
        scene.mission_goes_on = false;
        let mut going_on = landing;
        let stop = Request::StopRotors("Disarmed: no takeoff".to_owned());
        assert_eq!(wait(&mut landing, &mut scene), [stop]);
        for never in [-1.0, 0.0] {
            scene.conduct.disarm_before_takeoff_s = never;
            assert!(wait(&mut going_on, &mut scene).is_empty(), "never");
        }
    }

    #[test]
    fn what_stands_idles_except_in_a_mission_or_a_takeoff() {
        for (mode, idles) in [(Mode::Hold, true), (Mode::Mission, false), (Mode::Takeoff, false)] {
            let mut scene = Scene::on_the_ground();
            let mut landing = Landing::new(0.0);
            scene.mode = mode;
            scene.show(|situation, proposal| proposal.follow(situation, &PositionSetPoint::HOLD));
            for _ in 0..400 {
                watch(&mut landing, &mut scene);
            }
            assert_eq!(scene.steering.kind() == SteeringKind::Idle, idles, "{mode:?}");
        }
    }
}
