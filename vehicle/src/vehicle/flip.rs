//! ArduPilot's flip mode: one turn about the axis of roll or pitch, and back to the mode before.
//!
//! ```text
//!  Turning ──45°, 270°──► Recovering ──level as before──► mode before
//!     └────────── 2.5 s, or a stick at its end ──────────────▲
//! ```

use core::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::Outputs;

use super::notice::Refusal;
use super::proposal::Proposal;
use super::set_point::AttitudeSetPoint;
use super::situation::Situation;
use super::sticks::Sticks;
use super::tick::TICK_S;
use crate::mode::Mode;

/// Rate of the turn, rad/s.
const RATE_RAD_S: f64 = 400.0 * PI / 180.0;
/// Up to this angle, rad, it gains height.
const GAINS_UNTIL_RAD: f64 = PI / 4.0;
/// From this angle on, rad, it comes level again.
const RECOVERS_FROM_RAD: f64 = 1.5 * PI;
/// So near to the lean that it had, rad, it is done.
const DONE_RAD: f64 = 5.0 * PI / 180.0;
/// What is added to the pilot's thrust while it gains height, and taken from it while it turns over, as shares of the largest.
const MORE: f64 = 0.2;
const LESS: f64 = 0.24;
/// A turn that lasts longer is given up, µs.
const LONGEST_US: u64 = 2_500_000;
/// A stick that is farther out than this gives it up.
const GIVES_UP: f64 = 40.0 / 45.0;
/// A stick that is farther out than this chooses the direction.
const CHOOSES: f64 = 3.0 / 45.0;

/// The turn that is flown.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    /// The mode that it goes back to.
    back_to: Mode,
    began_us: u64,
    /// About the body's axes; of length 1.
    axis: Vector3<f64>,
    turned_rad: f64,
    /// The attitude that it comes back to.
    level: UnitQuaternion<f64>,
}

/// A flip.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Flip {
    turn: Option<Turn>,
}

impl Flip {
    /// Whether a user may choose the mode.
    ///
    /// # Errors
    /// [`Refusal::Failed`] on the ground, in modes that do not lean by sticks, and with sticks that would give it up.
    pub fn may_begin(situation: &Situation) -> Result<(), Refusal> {
        let refuse = |why: &str| Err(Refusal::Failed(format!("Flip mode rejected: {why}")));
        if !situation.flies() || situation.landed {
            return refuse("not flying");
        }
        if !matches!(situation.mode, Mode::Stabilize | Mode::Acro | Mode::Altitude) {
            return refuse("enter it from Stabilize, Acro or AltHold");
        }
        let sticks = situation.pilot.sticks.unwrap_or_default();
        if situation.mode.is_flown_by_thrust() && sticks.throttle() <= 0.0 {
            return refuse("throttle too low");
        }
        if sticks.right.abs() >= GIVES_UP {
            return refuse("roll stick at its end");
        }
        Ok(())
    }

    /// The mode begins in place of another one.
    pub fn begin(&mut self, before: Mode, situation: &Situation) {
        let sticks = situation.pilot.sticks.unwrap_or_default();
        let lean_rad = situation.limits().tilt_rad;
        let now = situation.outputs.attitude_rad;
        self.turn = Some(Turn {
            back_to: before,
            began_us: situation.time_us,
            axis: axis(&sticks),
            turned_rad: 0.0,
            level: UnitQuaternion::from_euler_angles(
                now.x.clamp(-lean_rad, lean_rad),
                now.y.clamp(-lean_rad, lean_rad),
                now.z,
            ),
        });
    }

    /// One tick of the mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(turn) = &mut self.turn else { return };
        let sticks = situation.pilot.sticks.unwrap_or_default();
        let late = situation.time_us - turn.began_us > LONGEST_US;
        let given_up = late || sticks.right.abs().max(sticks.forward.abs()) >= GIVES_UP;
        let recovers = turn.turned_rad >= RECOVERS_FROM_RAD;
        if given_up || recovers && turn.is_done(situation.outputs) {
            proposal.enter(turn.back_to);
            return;
        }
        turn.turned_rad += situation.outputs.body_rate_rad_s.dot(&turn.axis) * TICK_S;
        let hover = situation.configuration.airframe.hover_thrust_share();
        let asked = sticks.thrust(situation.conduct, hover, situation.identity.is_ardupilot());
        let gains = recovers || turn.turned_rad < GAINS_UNTIL_RAD;
        let thrust = (if gains { asked + MORE } else { asked - LESS }).clamp(0.0, 1.0);
        let set_point = if recovers {
            AttitudeSetPoint { attitude: Some(turn.level), body_rate_rad_s: Vector3::zeros(), thrust }
        } else {
            AttitudeSetPoint { attitude: None, body_rate_rad_s: turn.axis * RATE_RAD_S, thrust }
        };
        proposal.follow_attitude(situation, &set_point);
    }
}

impl Turn {
    /// Whether it leans about its axis as it did before.
    fn is_done(&self, outputs: &Outputs) -> bool {
        let left = (outputs.orientation().inverse() * self.level).scaled_axis();
        left.dot(&self.axis).abs() <= DONE_RAD
    }
}

/// To the right, unless the sticks say otherwise; pitch goes before roll.
fn axis(sticks: &Sticks) -> Vector3<f64> {
    if sticks.forward.abs() > CHOOSES {
        // A stick that is pulled turns the nose up.
        Vector3::new(0.0, -sticks.forward.signum(), 0.0)
    } else if sticks.right < 0.0 {
        -Vector3::x()
    } else {
        Vector3::x()
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::{Flip, Mode};
    use crate::identity::Identity;
    use crate::vehicle::scene::Scene;
    use crate::vehicle::sticks::Sticks;
    use crate::vehicle::{Vehicle, VehicleSettings};

    fn fly(vehicle: &mut Vehicle, seconds: f64) {
        for _ in 0..(seconds * 1000.0) as usize {
            vehicle.tick().expect("the flight goes on");
        }
    }

    /// It hovers by sticks, at 20 m or above.
    fn hovering(mode: Mode) -> Vehicle {
        let mut vehicle = Vehicle::new(&VehicleSettings::new(Identity::ArduPilot)).expect("valid settings");
        vehicle.receive_radio(pulses([1500, 1500, 1000, 1500]));
        fly(&mut vehicle, 0.5);
        vehicle.set_mode(Mode::Altitude).expect("on the ground");
        vehicle.arm(false).expect("in this mode");
        vehicle.receive_radio(pulses([1500, 1500, 2000, 1500]));
        while vehicle.outputs().position_m.z > -20.0 {
            fly(&mut vehicle, 0.1);
        }
        vehicle.receive_radio(pulses([1500, 1500, 1500, 1500]));
        fly(&mut vehicle, 3.0);
        vehicle.set_mode(mode).expect("in the air");
        vehicle
    }

    fn pulses(sticks: [u16; 4]) -> [u16; crate::radio::CHANNELS] {
        core::array::from_fn(|channel| sticks.get(channel).copied().unwrap_or(0))
    }

    /// ArduCopter's suite (ModeFlip) flips by a stick at 1700 µs, and sees these attitudes one after the other.
    #[test]
    fn it_turns_over_and_goes_on_as_before() {
        for (mode, sticks, axis, seen) in [
            (Mode::Altitude, [1700, 1500, 1500, 1500], 0, [FRAC_PI_4, FRAC_PI_2, -FRAC_PI_4, 0.0]),
            (Mode::Stabilize, [1300, 1500, 1500, 1500], 0, [-FRAC_PI_4, -FRAC_PI_2, FRAC_PI_4, 0.0]),
            (Mode::Altitude, [1500, 1700, 1500, 1500], 1, [FRAC_PI_4, FRAC_PI_2, -FRAC_PI_4, 0.0]),
        ] {
            let mut vehicle = hovering(mode);
            vehicle.receive_radio(pulses(sticks));
            fly(&mut vehicle, 0.05);
            vehicle.set_mode(Mode::Flip).expect("it flies by sticks");
            let mut left = seen.iter();
            let mut next = left.next();
            let mut upside_down = false;
            for _ in 0..2_500 {
                fly(&mut vehicle, 0.001);
                let attitude_rad = vehicle.outputs().attitude_rad;
                upside_down |= vehicle.outputs().orientation().euler_angles().0.abs() > 2.0;
                if next.is_some_and(|angle| (attitude_rad[axis] - angle).abs() < 0.1) {
                    next = left.next();
                    // The stick is let go on the way.
                    vehicle.receive_radio(pulses([1500; 4]));
                }
            }
            assert!(next.is_none() && upside_down, "{mode:?}: {next:?} {:?}", vehicle.outputs().attitude_rad);
            assert_eq!(vehicle.mode(), mode);
            assert!(vehicle.outputs().position_m.z < -10.0, "{:?}", vehicle.outputs().position_m);
            assert!(vehicle.is_armed());
        }
    }

    #[test]
    fn it_begins_in_the_air_in_modes_that_lean() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -20.0]);
        (scene.identity, scene.mode) = (Identity::ArduPilot, Mode::Altitude);
        let may = |scene: &Scene| Flip::may_begin(&scene.situation()).is_ok();
        assert!(may(&scene));
        scene.mode = Mode::Position;
        assert!(!may(&scene));
        (scene.mode, scene.landed) = (Mode::Stabilize, true);
        assert!(!may(&scene));
        scene.landed = false;
        scene.pilot.sticks = Some(Sticks { up: -1.0, ..Sticks::default() });
        assert!(!may(&scene), "without thrust");
        scene.pilot.sticks = Some(Sticks { right: 0.9, ..Sticks::default() });
        assert!(!may(&scene), "with a stick that would end it");
        scene.pilot.sticks = Some(Sticks { right: 0.5, ..Sticks::default() });
        assert!(may(&scene));
    }
}
