//! The loss of a rotor: found by the rotors' measured speeds, told, and flown down without yaw control.

use nalgebra::Vector3;
use quadrotor::{PositionReference, RotorFault, RotorMonitor};

use super::failsafe::Action;
use super::motion::at_rest;
use super::notice::{Refusal, Severity};
use super::state::Vehicle;
use super::steering::Steering;

/// It keeps its height at first: until it spins it can neither brake nor stay upright.
const SETTLING_US: u64 = 2_000_000;
/// Then it descends where it is as slow as this, m/s, horizontally …
const SLOW_M_S: f64 = 0.5;
/// … or, in a wind, after this long.
const LONGEST_BRAKING_US: u64 = 15_000_000;
/// Largest sink rate, m/s, and how much slower it sinks with each metre towards the ground, 1/s.
const FASTEST_SINK_M_S: f64 = 1.5;
const SLOWING_PER_S: f64 = 0.4;
/// Lower than this, m, and sinking no faster than this, m/s, for this long, µs, its lowest foot stands.
const TOUCHING_M: f64 = 0.15;
const TOUCHING_M_S: f64 = 0.2;
const TOUCHED_US: u64 = 100_000;

/// A rotor that is known to be lost.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Loss {
    rotor: usize,
    since_us: u64,
    /// North and east, m, of where it descends.
    place_m: Option<[f64; 2]>,
    touching_since_us: Option<u64>,
    /// Whether another one is lost, too: then nothing can be held.
    falls: bool,
}

/// What is known of the rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorWatch {
    monitor: RotorMonitor,
    loss: Option<Loss>,
}

impl RotorWatch {
    /// Begins with rotors at these speeds, rad/s.
    pub fn new(measured_rad_s: [f64; 4]) -> Self {
        Self { monitor: RotorMonitor::new(measured_rad_s), loss: None }
    }
}

impl Vehicle {
    /// The rotor that is known to be lost: front (0), right, back or left (3). Until it is disarmed it only descends then.
    pub fn lost_rotor(&self) -> Option<usize> {
        self.rotors.loss.map(|loss| loss.rotor)
    }

    /// Looks at the rotors' speeds after a tick of `dt_s`.
    pub(super) fn watch_rotors(&mut self, dt_s: f64) {
        let measured = self.truth.rotor_speed_rad_s;
        if !self.armed {
            self.rotors = RotorWatch::new(measured);
            return;
        }
        let command = self.simulation.rotor_command_rad_s();
        let airframe = &self.simulation.configuration().airframe;
        let lost = self.rotors.monitor.update(airframe, &command, &measured, dt_s);
        if let (Some(rotor), None) = (lost, self.rotors.loss) {
            self.lose(rotor);
        }
        let Some(loss) = self.rotors.loss else { return };
        if !loss.falls && self.is_another_lost(loss.rotor) {
            self.rotors.loss = Some(Loss { falls: true, ..loss });
            self.say(Severity::Critical, "More than one rotor lost: it falls");
        }
    }

    fn is_another_lost(&self, rotor: usize) -> bool {
        (0..4).any(|other| other != rotor && self.rotors.monitor.is_lost(other))
    }

    fn lose(&mut self, rotor: usize) {
        let number = rotor + 1;
        if self.landed.is_landed() {
            self.stop_rotors(&format!("Disarmed: rotor {number} failed"));
            return;
        }
        let alone = !self.is_another_lost(rotor);
        let descends = alone && self.conduct.failsafe.rotor_failure == Action::Land;
        let what = if descends { ": descending without yaw control" } else { "" };
        self.say(Severity::Critical, format!("Rotor {number} lost{what}"));
        let since_us = self.time_us();
        // The failsafe sees it, and lands or terminates.
        self.rotors.loss =
            Some(Loss { rotor, since_us, place_m: None, touching_since_us: None, falls: false });
    }

    /// One tick of the descent on the rotors that are left.
    pub(super) fn descend_without_rotor(&mut self) {
        let Some(mut loss) = self.rotors.loss else { return };
        let (time_us, now) = (self.time_us(), self.outputs);
        let lasting_us = time_us - loss.since_us;
        let slow = now.velocity_m_s.xy().norm() < SLOW_M_S && lasting_us >= SETTLING_US;
        if loss.place_m.is_none() && (slow || lasting_us >= LONGEST_BRAKING_US) {
            loss.place_m = Some(now.position_m.xy().into());
        }
        let feet = self.felt();
        let touching = -feet.position_m.z < TOUCHING_M && feet.velocity_m_s.z < TOUCHING_M_S;
        loss.touching_since_us = if touching { loss.touching_since_us.or(Some(time_us)) } else { None };
        self.rotors.loss = Some(loss);
        if loss.touching_since_us.is_some_and(|since_us| time_us - since_us >= TOUCHED_US) {
            self.stop_rotors(&format!("Disarmed: landed without rotor {}", loss.rotor + 1));
            return;
        }
        let reference = match loss.place_m {
            Some([x, y]) => {
                let landing = self.conduct.land_speed_m_s;
                let sink = landing + SLOWING_PER_S * (-now.position_m.z - 2.0);
                let sink = sink.clamp(landing.min(FASTEST_SINK_M_S), FASTEST_SINK_M_S);
                PositionReference {
                    velocity_m_s: Vector3::new(0.0, 0.0, sink),
                    ..at_rest(Vector3::new(x, y, now.position_m.z), now.attitude_rad.z)
                }
            }
            None => at_rest(now.position_m, now.attitude_rad.z),
        };
        self.steering = Steering::Descent { lost_rotor: loss.rotor, reference };
    }

    /// Refuses what cannot be flown without a rotor.
    pub(super) fn refuse_without_rotor(&self) -> Result<(), Refusal> {
        match self.lost_rotor() {
            Some(rotor) => Err(Refusal::later(format!("Rotor {} is lost: it can only land", rotor + 1))),
            None => Ok(()),
        }
    }

    /// Rotors that do not answer on the ground.
    pub(super) fn rotor_obstacles(&self) -> impl Iterator<Item = String> {
        let silent = |fault: Option<RotorFault>| matches!(fault, Some(RotorFault::Off | RotorFault::Stuck));
        let faults = (1..).zip(self.faults.rotors());
        faults.filter(move |(_, fault)| silent(*fault)).map(|(number, _)| format!("rotor {number} failed"))
    }
}
