//! Turning single rotors on the ground, to see that each is where it should be.

use nalgebra::Vector3;
use quadrotor::{Outputs, RotorFault};

use super::notice::{Refusal, Severity};
use super::proposal::Proposal;
use super::set_point::AttitudeSetPoint;
use super::situation::Situation;
use super::steering::Steering;

/// Longest turn of a rotor, s.
const LONGEST_S: f64 = 600.0;
/// Between two rotors they rest for this share of the time that one turns.
const PAUSE: f64 = 0.5;
const ROTORS: usize = 4;

/// A test of rotors one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorTest {
    /// The first one: front (0), right, back or left (3).
    pub rotor: usize,
    /// How many, clockwise.
    pub count: usize,
    /// Speed as a share of the fastest.
    pub speed_share: f64,
    /// How long each turns, s.
    pub each_s: f64,
}

/// A test that is under way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Running {
    test: MotorTest,
    begun_us: u64,
}

/// The machine.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct MotorTests {
    running: Option<Running>,
}

impl MotorTests {
    /// Begins a test, or replaces the one that is under way.
    ///
    /// # Errors
    /// [`Refusal`] in the air, while armed, and for a rotor that there is not.
    pub fn begin(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        test: &MotorTest,
    ) -> Result<(), Refusal> {
        if test.rotor >= ROTORS {
            return Err(Refusal::denied(format!(
                "Motor Test: no motor {}; allowed 1–{ROTORS}",
                test.rotor + 1
            )));
        }
        if !(0.0..=1.0).contains(&test.speed_share) || test.each_s.is_nan() || test.each_s < 0.0 {
            return Err(Refusal::denied("Motor Test: throttle out of range or no duration"));
        }
        if !situation.landed {
            return Err(Refusal::Failed("Motor Test: vehicle not landed".to_owned()));
        }
        if situation.armed {
            return Err(Refusal::Failed("Motor Test: disarm first".to_owned()));
        }
        if self.running.is_none() {
            proposal.say(Severity::Info, "starting motor test");
        }
        let test = MotorTest { count: test.count.max(1), each_s: test.each_s.min(LONGEST_S), ..*test };
        self.running = Some(Running { test, begun_us: situation.time_us });
        Ok(())
    }

    /// Ends the test, if there is one.
    pub fn end(&mut self, proposal: &mut Proposal) {
        if self.running.take().is_some() {
            proposal.say(Severity::Info, "finished motor test");
        }
    }

    /// Whether there is a test.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Goes on with the test. It is over with its last rotor, and when the vehicle is armed.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(Running { test, begun_us }) = self.running else { return };
        let whole_s = test.each_s * (test.count as f64 * (1.0 + PAUSE) - PAUSE);
        let lasted_s = (situation.time_us - begun_us) as f64 / 1e6;
        if lasted_s >= whole_s || situation.armed || !situation.landed {
            self.end(proposal);
        }
    }

    /// How the closed loop is steered in a test, so that it keeps its attitude; and which rotors may not turn.
    pub fn steering(
        &self,
        now: &Outputs,
        faults: [Option<RotorFault>; ROTORS],
    ) -> Option<(Steering, [Option<RotorFault>; ROTORS])> {
        let Running { test, begun_us } = self.running?;
        let attitude = now.orientation();
        let lasted_s = (now.time_us - begun_us) as f64 / 1e6;
        let turns = lasted_s / (test.each_s * (1.0 + PAUSE)).max(f64::MIN_POSITIVE);
        let rests = turns.fract() * (1.0 + PAUSE) >= 1.0;
        let rotor = (!rests).then_some((test.rotor + turns as usize) % ROTORS);
        let set_point = AttitudeSetPoint {
            attitude: Some(attitude),
            body_rate_rad_s: Vector3::zeros(),
            thrust: test.speed_share * test.speed_share,
        };
        let mut rotors = faults;
        for (_, fault) in rotors.iter_mut().enumerate().filter(|(index, _)| Some(*index) != rotor) {
            *fault = Some(RotorFault::Off);
        }
        Some((Steering::Attitude { set_point, reference: attitude }, rotors))
    }
}

#[cfg(test)]
mod tests {
    use quadrotor::RotorFault;

    use super::{MotorTest, MotorTests};
    use crate::vehicle::notice::Refusal;
    use crate::vehicle::scene::Scene;

    const TEST: MotorTest = MotorTest { rotor: 3, count: 2, speed_share: 0.5, each_s: 1.0 };

    #[test]
    fn rotors_turn_one_after_the_other_with_a_rest_between_them() {
        let (mut scene, mut tests) = (Scene::on_the_ground(), MotorTests::default());
        scene.armed = false;
        scene.show(|situation, proposal| tests.begin(situation, proposal, &TEST).expect("begun"));
        let begun_us = scene.outputs.time_us;
        for (after_s, turning) in [(0.5, Some(3)), (1.2, None), (1.6, Some(0)), (2.4, Some(0))] {
            scene.outputs.time_us = begun_us + (after_s * 1e6) as u64;
            let (_, rotors) = tests.steering(&scene.outputs, [None; 4]).expect("running");
            let free = rotors.iter().position(|fault| *fault != Some(RotorFault::Off));
            assert_eq!(free, turning, "{after_s} s");
        }
        scene.outputs.time_us = begun_us + 2_499_000;
        scene.show(|situation, proposal| tests.step(situation, proposal));
        assert!(tests.running.is_some());
        scene.wait_us(2_000);
        scene.show(|situation, proposal| tests.step(situation, proposal));
        assert!(tests.running.is_none());
    }

    #[test]
    fn in_the_air_and_armed_nothing_is_tested() {
        let (mut scene, mut tests) = (Scene::hovering_at([0.0, 0.0, -5.0]), MotorTests::default());
        let mut begin = |scene: &mut Scene, test: MotorTest| {
            let mut result = Ok(());
            scene.show(|situation, proposal| result = tests.begin(situation, proposal, &test));
            result
        };
        assert!(matches!(begin(&mut scene, TEST), Err(Refusal::Failed(_))));
        let mut scene = Scene::on_the_ground();
        assert!(matches!(begin(&mut scene, TEST), Err(Refusal::Failed(_))));
        scene.armed = false;
        assert!(matches!(begin(&mut scene, MotorTest { rotor: 4, ..TEST }), Err(Refusal::Denied(_))));
        assert!(begin(&mut scene, TEST).is_ok());
    }
}
