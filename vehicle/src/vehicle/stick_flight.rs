//! Modes in which the pilot leans the vehicle, or turns it about its axes.

use nalgebra::{UnitQuaternion, Vector3};

use super::height_hold::HeightHold;
use super::motion::wrapped;
use super::proposal::Proposal;
use super::set_point::AttitudeSetPoint;
use super::situation::Situation;
use super::steering::SteeringKind;
use super::stick_climb::StickClimb;
use super::stick_settings::Trainer;
use super::sticks::Sticks;
use super::tick::TICK_S;
use crate::mode::Mode;

/// The heading that is asked for leads the vehicle by no more than this, rad.
const HEADING_LEAD_RAD: f64 = 0.3;
/// On the ground the rotors idle below this share of the hovering thrust.
const IDLE_OF_HOVER: f64 = 0.25;
/// A trainer's levelling looks at no more than this lean, rad.
const MOST_LEVELLED_RAD: f64 = 0.785;
/// How hard a trainer leads back from beyond the largest lean, 1/s.
const LIMITING_1_S: f64 = 4.5;

/// The references of the modes that lean.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct StickFlight {
    heading_rad: Option<f64>,
    height: Option<HeightHold>,
}

impl StickFlight {
    /// Another mode begins.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The sticks that are flown. Without a pilot they are centred in the air, and the throttle is low on the ground.
    fn sticks(situation: &Situation) -> Sticks {
        let nobody = || Sticks { up: if situation.landed { -1.0 } else { 0.0 }, ..Sticks::default() };
        situation.pilot.sticks.unwrap_or_else(nobody)
    }

    /// One tick of a mode in which the throttle is the thrust.
    pub fn step_by_thrust(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let sticks = Self::sticks(situation);
        let hover = situation.configuration.airframe.hover_thrust_share();
        let ardupilot = situation.identity.is_ardupilot();
        let thrust = sticks.thrust(situation.conduct, hover, ardupilot).clamp(0.0, 1.0);
        if situation.landed && (thrust < IDLE_OF_HOVER * hover || sticks.throttle() <= 0.0) {
            self.rest(situation, proposal);
        } else if situation.mode == Mode::Acro && !situation.landed {
            self.heading_rad = None;
            let body_rate_rad_s = body_rate_rad_s(situation, &sticks);
            proposal
                .follow_attitude(situation, &AttitudeSetPoint { attitude: None, body_rate_rad_s, thrust });
        } else {
            self.lean(situation, proposal, &sticks, thrust);
        }
    }

    /// One tick of a mode in which the throttle is the climb rate.
    pub fn step_by_height(&mut self, climb: &mut StickClimb, situation: &Situation, proposal: &mut Proposal) {
        let sticks = if climb.takes_off() {
            situation.pilot.sticks.unwrap_or_default()
        } else {
            Self::sticks(situation)
        };
        let climb_m_s = climb.climb_m_s(situation, sticks.climb_m_s(situation.conduct));
        if situation.landed && climb_m_s <= 0.0 {
            self.rest(situation, proposal);
            return;
        }
        let height = self.height.get_or_insert_with(|| HeightHold::begin(situation));
        let thrust = height.thrust(situation, climb_m_s, TICK_S);
        self.lean(situation, proposal, &sticks, thrust);
    }

    /// The rotors idle on the ground.
    fn rest(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.forget();
        if proposal.steering().kind() != SteeringKind::Idle {
            proposal.idle(situation);
        }
    }

    /// Leans as the sticks say, and turns.
    fn lean(&mut self, situation: &Situation, proposal: &mut Proposal, sticks: &Sticks, thrust: f64) {
        let (settings, limits) = (&situation.conduct.sticks, situation.limits());
        let now_rad = situation.outputs.attitude_rad.z;
        let largest_rad = settings.lean_rad.min(limits.tilt_rad);
        let (lean, turn_rad_s) = if situation.landed {
            // What stands does not lean against the ground.
            self.heading_rad = Some(now_rad);
            ([0.0; 2], 0.0)
        } else {
            (sticks.lean_rad(largest_rad), sticks.turn_rad_s(settings, limits.yaw_rate_rad_s))
        };
        let heading = self.heading_rad.get_or_insert(now_rad);
        let lead = wrapped(*heading + turn_rad_s * TICK_S - now_rad);
        *heading = now_rad + lead.clamp(-HEADING_LEAD_RAD, HEADING_LEAD_RAD);
        let [roll, pitch] = lean;
        proposal.follow_attitude(
            situation,
            &AttitudeSetPoint {
                attitude: Some(UnitQuaternion::from_euler_angles(roll, pitch, *heading)),
                body_rate_rad_s: Vector3::new(0.0, 0.0, turn_rad_s),
                thrust,
            },
        );
    }
}

/// Rates about the axes of the body that the sticks and the trainer ask for, rad/s.
fn body_rate_rad_s(situation: &Situation, sticks: &Sticks) -> Vector3<f64> {
    let settings = &situation.conduct.sticks;
    let curved = |stick: f64| {
        let stick = stick.clamp(-1.0, 1.0);
        (1.0 - settings.exponent) * stick + settings.exponent * stick * stick * stick
    };
    let mut rates = Vector3::new(
        curved(sticks.right) * settings.roll_rad_s,
        -curved(sticks.forward) * settings.pitch_rad_s,
        curved(sticks.turn) * settings.spin_rad_s,
    );
    if settings.trainer == Trainer::Off {
        return rates;
    }
    let lean = [situation.outputs.attitude_rad.x, situation.outputs.attitude_rad.y];
    for (rate, lean_rad) in rates.iter_mut().zip(lean) {
        *rate -= settings.levelling_1_s * lean_rad.clamp(-MOST_LEVELLED_RAD, MOST_LEVELLED_RAD);
        if settings.trainer == Trainer::LevelsAndLimits {
            let largest = settings.lean_rad;
            let inside = lean_rad.clamp(-largest, largest);
            let (least, most) =
                (-LIMITING_1_S * (largest + lean_rad).max(0.0), LIMITING_1_S * (largest - lean_rad).max(0.0));
            *rate = rate.clamp(least, most) + LIMITING_1_S * (inside - lean_rad);
        }
    }
    rates
}
