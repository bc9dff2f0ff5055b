//! Where the nose points on a way that names no heading of its own: WP_YAW_BEHAVIOR, MPC_YAW_MODE.

use serde::{Deserialize, Serialize};

use super::situation::Situation;

/// A choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum HeadingPolicy {
    /// To the next place.
    #[default]
    NextPlace,
    /// To the next place, and a mission's legs begin when the nose is there.
    NextPlaceFirst,
    /// To the next place, and on the way home anywhere.
    NextPlaceExceptReturn,
    /// Anywhere: it is not turned.
    Hold,
    /// To home.
    Home,
    /// Away from home.
    AwayFromHome,
    /// Along the flight.
    Travel,
}

/// What a way is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A mission.
    Mission,
    /// The way home.
    Return,
}

/// Nearer than this, m, home has no direction, and slower than this, m/s, nor has the flight.
const TOO_NEAR_M: f64 = 1.0;
const TRAVELS_M_S: f64 = 1.0;

impl HeadingPolicy {
    /// The parameter's choice.
    pub fn of(situation: &Situation) -> Self {
        situation.conduct.heading_policy
    }

    /// The heading, rad, on a way whose next place lies in a direction, rad; `None`: it stays as it is.
    pub fn heading_rad(self, purpose: Purpose, next_rad: f64, situation: &Situation) -> Option<f64> {
        let reference = &situation.outputs.setpoint;
        let way = (situation.home.position_m - reference.position_m).xy();
        let v = reference.velocity_m_s.xy();
        let home_rad = (way.norm() > TOO_NEAR_M).then(|| libm::atan2(way.y, way.x));
        match self {
            Self::NextPlaceExceptReturn if purpose == Purpose::Return => None,
            Self::NextPlace | Self::NextPlaceFirst | Self::NextPlaceExceptReturn => Some(next_rad),
            Self::Hold => None,
            Self::Home => home_rad,
            Self::AwayFromHome => home_rad.map(|home_rad| home_rad + core::f64::consts::PI),
            Self::Travel => (v.norm() > TRAVELS_M_S).then(|| libm::atan2(v.y, v.x)),
        }
    }
}
