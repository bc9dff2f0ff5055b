//! ArduPilot's throw mode: the vehicle waits with its rotors at rest until it is thrown or dropped, and catches itself.

use quadrotor::GRAVITY_M_S2;
use serde::{Deserialize, Serialize};

use super::notice::Severity;
use super::proposal::Proposal;
use super::set_point::PositionSetPoint;
use super::situation::Situation;
use crate::mode::Mode;

/// Faster than this, m/s, or falling freely: with less than this share of its weight in its feet it may have been thrown.
const FAST_M_S: f64 = 5.0;
const FREE_OF_WEIGHT: f64 = 0.25;
/// A thrown vehicle rises, and a dropped one sinks, faster than this, m/s.
const CHANGING_M_S: f64 = 0.5;
/// It has been thrown when its climb rate falls by this, m/s, within a time, µs.
const FALL_M_S: f64 = 2.5;
const CONFIRMED_US: u64 = 500_000;
/// Leaning less than this, rad, it is upright; slower than this, m/s, it has its height.
const UPRIGHT_RAD: f64 = 0.5;
const SLOW_M_S: f64 = 0.5;

/// Parameters of the mode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ThrowSettings {
    /// Custom mode that follows; its own number stays (THROW_NEXTMODE).
    pub next_mode: u8,
    /// Whether it is dropped and not thrown up (THROW_TYPE).
    pub is_dropped: bool,
    /// Heights above home between which it may be thrown, m; 0: any (THROW_ALT_MIN, THROW_ALT_MAX).
    pub least_height_m: f64,
    #[allow(missing_docs)] // With the one above.
    pub most_height_m: f64,
}

impl Default for ThrowSettings {
    fn default() -> Self {
        Self { next_mode: 18, is_dropped: false, least_height_m: 0.0, most_height_m: 0.0 }
    }
}

/// How far the catch has come.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
enum Stage {
    /// The rotors rest.
    #[default]
    Waiting,
    /// They turn, and the vehicle comes upright.
    Uprighting,
    /// It comes to a height.
    Height,
    /// It holds its place.
    Place,
}

/// A throw.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Throw {
    stage: Stage,
    /// When it may have been thrown, µs, and how fast it climbed then, m/s.
    perhaps: Option<(u64, f64)>,
}

impl Throw {
    /// The mode begins.
    pub fn begin(&mut self) {
        *self = Self::default();
    }

    /// One tick of the mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let outputs = situation.outputs;
        let lean_rad = outputs.attitude_rad.x.abs().max(outputs.attitude_rad.y.abs());
        let thrown = self.stage == Stage::Waiting && self.is_thrown(situation);
        match self.stage {
            Stage::Waiting if thrown => {
                proposal.say(Severity::Info, "throw detected - spooling motors");
                proposal.say(Severity::Info, "throttle is unlimited - uprighting");
                // Its rotors rest: it is told to fly.
                proposal.follow(situation, &PositionSetPoint::HOLD);
                self.stage = Stage::Uprighting;
            }
            Stage::Uprighting if lean_rad < UPRIGHT_RAD => {
                proposal.say(Severity::Info, "uprighted - controlling height");
                self.stage = Stage::Height;
            }
            Stage::Height if outputs.velocity_m_s.z.abs() < SLOW_M_S => {
                proposal.say(Severity::Info, "height achieved - controlling position");
                self.stage = Stage::Place;
                let next = u32::from(situation.conduct.throw.next_mode);
                if let Some(mode) = situation.identity.mode(next).filter(|mode| *mode != Mode::Throw) {
                    proposal.enter(mode);
                }
            }
            _ => {}
        }
    }

    /// Whether it flies freely, and has done so for long enough to be sure.
    fn is_thrown(&mut self, situation: &Situation) -> bool {
        let (outputs, settings) = (situation.outputs, &situation.conduct.throw);
        let climb_m_s = -outputs.velocity_m_s.z;
        let changes = if settings.is_dropped { climb_m_s < -CHANGING_M_S } else { climb_m_s > CHANGING_M_S };
        let carried_m_s2 = GRAVITY_M_S2 - outputs.acceleration_m_s2.z;
        let free = carried_m_s2 < FREE_OF_WEIGHT * GRAVITY_M_S2;
        let fast = outputs.velocity_m_s.norm() > FAST_M_S;
        let height_m = situation.home.position_m.z - outputs.position_m.z;
        let inside = (settings.least_height_m <= 0.0 || height_m >= settings.least_height_m)
            && (settings.most_height_m <= 0.0 || height_m <= settings.most_height_m);
        let unhandled = carried_m_s2.abs() < GRAVITY_M_S2;
        if !situation.landed && (free || fast) && changes && unhandled && inside {
            let late = |(since_us, _): (u64, f64)| situation.time_us > since_us + CONFIRMED_US;
            if self.perhaps.is_none_or(late) {
                self.perhaps = Some((situation.time_us, climb_m_s));
            }
        }
        self.perhaps.is_some_and(|(since_us, climbed_m_s)| {
            situation.time_us <= since_us + CONFIRMED_US && climb_m_s < climbed_m_s - FALL_M_S
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{GRAVITY_M_S2, Mode, Throw};
    use crate::identity::Identity;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::pushes::Push;
    use crate::vehicle::scene::Scene;
    use crate::vehicle::steering::{Steering, SteeringKind};
    use crate::vehicle::{Conduct, Vehicle, VehicleSettings};

    /// Thrown up with 8 m/s it is caught a quarter of a second later; carried up as fast it is not.
    #[test]
    fn who_flies_freely_is_caught_and_who_is_carried_is_not() {
        for (free, caught) in [(true, true), (false, false)] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -3.0]);
            (scene.identity, scene.mode) = (Identity::ArduPilot, Mode::Throw);
            scene.steering = Steering::Idle { yaw_rad: 0.0 };
            scene.conduct.throw.next_mode = 6;
            let mut throw = Throw::default();
            let mut entered = None;
            for tick in 0..1000 {
                let climb_m_s = if free { 8.0 - GRAVITY_M_S2 * f64::from(tick) * 1e-3 } else { 8.0 };
                scene.outputs.velocity_m_s.z = -climb_m_s;
                scene.outputs.acceleration_m_s2.z = if free { GRAVITY_M_S2 } else { 0.0 };
                scene.wait_us(1_000);
                for request in scene.show(|situation, proposal| throw.step(situation, proposal)) {
                    if let Request::Enter(mode) = request {
                        entered = Some(mode);
                    }
                }
            }
            assert_eq!(scene.steering.kind() == SteeringKind::Position, caught, "{free}");
            assert_eq!(entered, caught.then_some(Mode::Return), "{free}");
        }
    }

    /// A vehicle that is armed in the mode, and pushed by accelerations, m/s², for a time, ms.
    fn pushed(push: [f64; 3], time_ms: u32, change: impl Fn(&mut Conduct)) -> Vehicle {
        let mut vehicle = Vehicle::new(&VehicleSettings::new(Identity::ArduPilot)).expect("valid settings");
        vehicle.set_mode(Mode::Throw).expect("on the ground");
        vehicle.arm(false).expect("in this mode");
        let mut conduct = *vehicle.conduct();
        conduct.simulated.pushes.shove = Push { acceleration: push.into(), time_ms };
        change(&mut conduct);
        vehicle.adopt(&vehicle.kept_configuration(), &conduct).expect("valid");
        vehicle
    }

    fn fly_until(vehicle: &mut Vehicle, seconds: u32, is_so: impl Fn(&Vehicle) -> bool) {
        for _ in 0..seconds * 1000 {
            if is_so(vehicle) {
                return;
            }
            vehicle.tick().expect("the flight goes on");
        }
        panic!("not within {seconds} s: {:?} {:?}", vehicle.mode(), vehicle.outputs().position_m);
    }

    /// ArduCopter's suite throws it so (ThrowMode): it is to return within 15 s, and to land at home.
    #[test]
    fn a_thrown_vehicle_returns() {
        let mut vehicle = pushed([-20.0, 0.0, -30.0], 500, |conduct| conduct.throw.next_mode = 6);
        fly_until(&mut vehicle, 15, |vehicle| vehicle.mode() == Mode::Return);
        assert!(vehicle.outputs().position_m.z < -1.0, "caught above the ground");
        fly_until(&mut vehicle, 120, |vehicle| !vehicle.is_armed());
        assert!(vehicle.outputs().position_m.norm() < 1.0, "{:?}", vehicle.outputs().position_m);
        assert_eq!(vehicle.conduct().simulated.pushes.shove.time_ms, 0);
    }

    /// And lets it fall so (ThrowDoubleDrop), after half a minute's lift, with these words.
    #[test]
    fn a_dropped_vehicle_says_how_it_catches_itself() {
        let mut vehicle = pushed([0.0, 0.0, -11.0], 30_000, |conduct| conduct.throw.is_dropped = true);
        fly_until(&mut vehicle, 100, |vehicle| vehicle.outputs().position_m.z < -100.0);
        let said: Vec<String> = (0..90_000)
            .flat_map(|_| {
                vehicle.tick().expect("the flight goes on");
                vehicle.take_notices().into_iter().map(|notice| notice.text)
            })
            .collect();
        let stages = [
            "throw detected - spooling motors",
            "throttle is unlimited - uprighting",
            "uprighted - controlling height",
            "height achieved - controlling position",
        ];
        assert!(stages.iter().all(|stage| said.iter().any(|text| text == stage)), "{said:?}");
        assert!(vehicle.outputs().velocity_m_s.norm() < 0.1 && vehicle.mode() == Mode::Throw);
    }
}
