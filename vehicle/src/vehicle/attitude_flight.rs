//! Attitudes that a program sets, as ArduPilot flies them: their thrust asks for a climb rate.

use nalgebra::{UnitQuaternion, Vector3};

use super::height_hold::HeightHold;
use super::proposal::Proposal;
use super::set_point::AttitudeSetPoint;
use super::situation::Situation;
use super::steering::SteeringKind;
use super::tick::TICK_S;

/// The thrust, 0 to 1, that holds the height.
const HOLDS: f64 = 0.5;

/// The height that is flown, and the heading where none is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct AttitudeFlight {
    height: Option<HeightHold>,
    heading_rad: Option<f64>,
}

impl AttitudeFlight {
    /// Something else is flown.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// One tick with what is asked for; without anything it stays level, at its height and heading.
    pub fn step(&mut self, asked: Option<&AttitudeSetPoint>, situation: &Situation, proposal: &mut Proposal) {
        let thrust = asked.map_or(HOLDS, |asked| asked.thrust);
        let climb_m_s = climb_m_s(thrust, situation);
        if situation.landed && climb_m_s <= 0.0 {
            self.forget();
            if proposal.steering().kind() != SteeringKind::Idle {
                proposal.idle(situation);
            }
            return;
        }
        let heading_rad = *self.heading_rad.get_or_insert(situation.outputs.attitude_rad.z);
        let level = AttitudeSetPoint {
            attitude: Some(UnitQuaternion::from_euler_angles(0.0, 0.0, heading_rad)),
            body_rate_rad_s: Vector3::zeros(),
            thrust,
        };
        if asked.is_some() {
            self.heading_rad = None;
        }
        let height = self.height.get_or_insert_with(|| HeightHold::begin(situation));
        let thrust = height.thrust(situation, climb_m_s, TICK_S);
        let set_point = asked.copied().unwrap_or(level);
        proposal.follow_attitude(situation, &AttitudeSetPoint { thrust, ..set_point });
    }
}

/// From the fastest descent over rest to the fastest climb, m/s.
fn climb_m_s(thrust: f64, situation: &Situation) -> f64 {
    let limits = situation.limits();
    let fastest = if thrust > HOLDS { limits.speed_up_m_s } else { limits.speed_down_m_s };
    (thrust - HOLDS) / HOLDS * fastest
}
