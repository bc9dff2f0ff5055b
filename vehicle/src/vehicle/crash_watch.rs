//! Whether the vehicle has crashed, has lost its attitude, or has too little thrust.
//!
//! ArduCopter's crash check: far from the attitude that is asked for, without moving much, for two seconds: it lies somewhere, and its
//! rotors stop. PX4's failure detector: a roll or pitch that no flight has stops the rotors shortly after arming, and ends the flight
//! later if the circuit breaker lets it. ArduCopter's thrust loss check: it sinks although it gives all it has.

use nalgebra::Vector3;

use super::crash_settings::CIRCUIT_BROKEN;
use super::lasting::Lasting;
use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use super::steering::SteeringKind;

/// The crash check: lean and error of the attitude, rad, acceleration, m/s², speed, m/s, and how long all must last, µs.
const LEAST_LEAN_RAD: f64 = 15.0 * DEGREE;
pub(super) const LEAST_ERROR_RAD: f64 = 30.0 * DEGREE;
const MOST_ACCELERATION_M_S2: f64 = 3.0;
const MOST_SPEED_M_S: f64 = 10.0;
const CRASHED_US: u64 = 2_000_000;
/// Corner frequency of the acceleration's filter, 1/s: 1 Hz.
const FILTER_RAD_S: f64 = core::f64::consts::TAU;
/// The thrust loss check: share of the strongest thrust, lean that is asked for, rad, and how long it must last, µs.
const FULL_THRUST: f64 = 0.9;
const MOST_LEAN_RAD: f64 = 15.0 * DEGREE;
const WEAK_US: u64 = 1_000_000;

const DEGREE: f64 = core::f64::consts::PI / 180.0;

/// What has been seen of an armed vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct CrashWatch {
    /// Acceleration, low-pass filtered, NED, m/s².
    acceleration_m_s2: Vector3<f64>,
    armed_since_us: Option<u64>,
    crashing: Lasting,
    rolling: Lasting,
    pitching: Lasting,
    weak: Lasting,
    /// What has been told already: a lost attitude, a lost thrust.
    told: [bool; 2],
    /// Whether the last flight has ended in a crash.
    crashed: bool,
}

impl CrashWatch {
    /// Looks at the motion after a tick of `dt_s`.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal, dt_s: f64) {
        if !situation.armed {
            *self = Self { crashed: self.crashed, ..Self::default() };
            return;
        }
        self.crashed &= self.armed_since_us.is_some();
        self.armed_since_us.get_or_insert(situation.time_us);
        let change = situation.outputs.acceleration_m_s2 - self.acceleration_m_s2;
        self.acceleration_m_s2 += change * (dt_s * FILTER_RAD_S).min(1.0);
        // On its way down without a rotor it spins and leans, and its own watch lets it down.
        if situation.descends_without_rotor().is_some() {
            (self.crashing, self.rolling, self.pitching, self.weak) = Default::default();
            return;
        }
        if !situation.identity.is_ardupilot() {
            self.detect_failure(situation, proposal);
        }
        self.check_crash(situation, proposal);
        if situation.identity.is_ardupilot() {
            self.check_thrust(situation, proposal);
        }
    }

    /// Whether the last flight has ended in a crash.
    pub fn has_crashed(&self) -> bool {
        self.crashed
    }

    fn check_crash(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let acceleration = self.acceleration_m_s2.norm();
        let lies = situation.conduct.crash.check
            && situation.flies()
            && keeps_a_lean(situation)
            && lean_rad(situation) > LEAST_LEAN_RAD
            && attitude_error_rad(situation) > LEAST_ERROR_RAD
            && acceleration < MOST_ACCELERATION_M_S2
            && situation.outputs.velocity_m_s.norm() < MOST_SPEED_M_S;
        if self.crashing.update(lies, situation.time_us, CRASHED_US) {
            self.crashed = true;
            let (error, least) = (attitude_error_rad(situation) / DEGREE, LEAST_ERROR_RAD / DEGREE);
            proposal.stop_rotors(format!(
                "Crash: Disarming: AngErr={error:.0}>{least:.0}, Accel={acceleration:.1}<{MOST_ACCELERATION_M_S2:.1}"
            ));
        }
    }

    /// PX4's failure detector.
    fn detect_failure(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let (settings, time_us) = (&situation.conduct.crash, situation.time_us);
        let attitude_rad = situation.outputs.attitude_rad;
        let watched = situation.flies() && keeps_a_lean(situation);
        let beyond = |angle_rad: f64, most_rad: f64| watched && most_rad > 0.0 && angle_rad.abs() > most_rad;
        let lasting_us = |seconds: f64| (seconds * 1e6) as u64;
        let rolls = beyond(attitude_rad.x, settings.roll_rad);
        let pitches = beyond(attitude_rad.y, settings.pitch_rad);
        let rolls = self.rolling.update(rolls, time_us, lasting_us(settings.roll_s));
        let pitches = self.pitching.update(pitches, time_us, lasting_us(settings.pitch_s));
        let failed = rolls || pitches;
        if failed && !self.told[0] {
            let armed_us = time_us - self.armed_since_us.unwrap_or(time_us);
            proposal.say(Severity::Critical, "Attitude failure detected");
            if (armed_us as f64) < settings.lockdown_s * 1e6 {
                proposal.stop_rotors("Critical failure detected: lockdown");
            } else if settings.circuit_breaker != CIRCUIT_BROKEN {
                proposal.say(Severity::Critical, "Critical failure detected: terminate flight");
                proposal.terminate();
            }
        }
        self.told[0] = failed;
    }

    fn check_thrust(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(command_rad_s) = situation.rotor_command_rad_s else { return };
        let airframe = &situation.configuration.airframe;
        let share = situation.outputs.thrust_n / airframe.thrust_range_n().1;
        let [roll, pitch] = situation.outputs.tilt_reference_rad;
        let weak = situation.flies()
            && !situation.landed
            && situation.steering.kind() == SteeringKind::Position
            && share >= FULL_THRUST
            && libm::hypot(roll, pitch) <= MOST_LEAN_RAD
            && situation.outputs.velocity_m_s.z > 0.0
            && attitude_error_rad(situation) < LEAST_ERROR_RAD;
        let weak = self.weak.update(weak, situation.time_us, WEAK_US);
        if weak && !self.told[1] {
            let fastest = (1..).zip(command_rad_s).max_by(|one, other| one.1.total_cmp(&other.1));
            let number = fastest.map_or(0, |(number, _)| number);
            proposal.say(Severity::Critical, format!("Potential Thrust Loss ({number})"));
        }
        self.told[1] = weak;
    }
}

/// Whether its attitude is kept for it: who flies by body rates may turn over.
pub(super) fn keeps_a_lean(situation: &Situation) -> bool {
    !situation.steering.is_by_rates()
}

/// Angle between the thrust axis and the vertical, rad.
fn lean_rad(situation: &Situation) -> f64 {
    let attitude_rad = situation.outputs.attitude_rad;
    libm::acos((libm::cos(attitude_rad.x) * libm::cos(attitude_rad.y)).clamp(-1.0, 1.0))
}

/// Angle between the thrust axis and the one that is asked for, rad.
pub(super) fn attitude_error_rad(situation: &Situation) -> f64 {
    let strongest_n = situation.configuration.airframe.thrust_range_n().1;
    let wanted = situation.steering.tracked_attitude(situation.outputs, strongest_n).attitude;
    let actual = situation.outputs.orientation();
    let down = Vector3::z();
    libm::acos((wanted * down).dot(&(actual * down)).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::{CrashWatch, DEGREE};
    use crate::identity::Identity;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};

    const TICK_S: f64 = 0.001;

    /// Leans the scene by a roll, degrees.
    fn roll(scene: &mut Scene, degrees: f64) {
        let half = degrees * DEGREE / 2.0;
        scene.outputs.attitude_rad.x = degrees * DEGREE;
        scene.outputs.quaternion = [half.cos(), half.sin(), 0.0, 0.0];
    }

    fn watch(watch: &mut CrashWatch, scene: &mut Scene, seconds: f64) -> Vec<Request> {
        (0..(seconds * 1000.0) as usize)
            .flat_map(|_| {
                scene.wait_us(1_000);
                scene.show(|situation, proposal| watch.watch(situation, proposal, TICK_S))
            })
            .collect()
    }

    fn lying() -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -0.1]);
        scene.identity = Identity::ArduPilot;
        roll(&mut scene, 100.0);
        scene
    }

    #[test]
    fn who_lies_tipped_over_for_two_seconds_is_disarmed_with_arducopters_words() {
        let (mut scene, mut crash) = (lying(), CrashWatch::default());
        assert!(watch(&mut crash, &mut scene, 1.99).is_empty());
        let requests = watch(&mut crash, &mut scene, 0.02);
        let text = "Crash: Disarming: AngErr=100>30, Accel=0.0<3.0";
        assert_eq!(requests.first(), Some(&Request::StopRotors(text.to_owned())));
    }

    #[test]
    fn who_leans_little_moves_or_need_not_be_checked_is_not() {
        type Change = fn(&mut Scene);
        let changes: [Change; 5] = [
            |scene| roll(scene, 25.0),
            |scene| scene.outputs.acceleration_m_s2.z = 9.8,
            |scene| scene.outputs.velocity_m_s.x = 11.0,
            |scene| scene.conduct.crash.check = false,
            |scene| scene.lost_rotor = Some(0),
        ];
        for (number, change) in changes.into_iter().enumerate() {
            let (mut scene, mut crash) = (lying(), CrashWatch::default());
            change(&mut scene);
            // The filter takes a while to know the acceleration.
            watch(&mut crash, &mut scene, 1.0);
            crash.crashing = Default::default();
            assert!(watch(&mut crash, &mut scene, 4.0).is_empty(), "change {number}");
        }
    }

    #[test]
    fn a_lost_attitude_locks_down_after_arming_and_terminates_later_if_it_may() {
        for (waits_s, breaker, expected) in [
            (
                1.0,
                super::CIRCUIT_BROKEN,
                Some(Request::StopRotors("Critical failure detected: lockdown".to_owned())),
            ),
            (4.0, super::CIRCUIT_BROKEN, None),
            (4.0, 0, Some(Request::Terminate)),
        ] {
            let (mut scene, mut crash) = (Scene::hovering_at([0.0, 0.0, -20.0]), CrashWatch::default());
            scene.conduct.crash.check = false;
            scene.conduct.crash.circuit_breaker = breaker;
            assert!(watch(&mut crash, &mut scene, waits_s).is_empty());
            roll(&mut scene, 61.0);
            assert!(watch(&mut crash, &mut scene, 0.29).is_empty());
            let requests = watch(&mut crash, &mut scene, 0.05);
            let told = requests.first().map(std::slice::from_ref).map(said);
            assert_eq!(told.as_deref(), Some(&["Attitude failure detected"][..]));
            let acts = requests.iter().find(|request| !matches!(request, Request::Say(_))).cloned();
            assert_eq!(acts, expected, "{waits_s} s, {breaker}");
        }
    }

    #[test]
    fn sinking_at_full_thrust_is_told_once() {
        let (mut scene, mut crash) = (Scene::hovering_at([0.0, 0.0, -20.0]), CrashWatch::default());
        scene.identity = Identity::ArduPilot;
        scene.outputs.thrust_n = scene.configuration.airframe.thrust_range_n().1;
        scene.outputs.velocity_m_s.z = 0.5;
        scene.rotor_command_rad_s[2] += 1.0;
        assert!(watch(&mut crash, &mut scene, 0.9).is_empty());
        assert_eq!(said(&watch(&mut crash, &mut scene, 3.0)), ["Potential Thrust Loss (3)"]);
    }
}
