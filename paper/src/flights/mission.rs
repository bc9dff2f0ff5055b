//! What is flown.

use nalgebra::Vector3;
use quadrotor::{InputSignal, Inputs, PositionReference};

/// The paper's (5, 5, 10): 5 m north, 5 m east, 10 m up, in NED.
pub const GOAL_M: [f64; 3] = [5.0, 5.0, -10.0];
/// Heading at the goal, rad. The paper shows ψ and gives no goal for it; ours gives it something to follow.
pub const HEADING_RAD: f64 = 0.5;
/// Duration of the smooth time law, s; the paper gives none.
const DURATION_S: f64 = 10.0;

/// How the goal is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mission {
    /// On a smooth time law, with velocity and acceleration fed forward.
    Smooth,
    /// At once, and large errors are shortened by the cascade's governor.
    Step,
    /// At once, and the controllers see the whole error.
    BareStep,
}

impl Mission {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Smooth, Self::Step, Self::BareStep];

    /// Name in results.json.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Step => "step",
            Self::BareStep => "step without governor",
        }
    }

    /// Whether the governor is on.
    pub fn governor(self) -> bool {
        self != Self::BareStep
    }
}

impl InputSignal for Mission {
    fn at(&self, time_us: u64) -> Inputs {
        let reference = match self {
            Self::Smooth => smooth(time_us as f64 * 1e-6),
            Self::Step | Self::BareStep => PositionReference::goal(GOAL_M, HEADING_RAD),
        };
        Inputs { reference, ..Inputs::default() }
    }
}

/// 10 s³ − 15 s⁴ + 6 s⁵ with s = t/duration: at rest, and without acceleration, at both ends.
fn smooth(time_s: f64) -> PositionReference {
    let s = (time_s / DURATION_S).clamp(0.0, 1.0);
    let position = s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
    let velocity = 30.0 * s * s * (1.0 - s).powi(2) / DURATION_S;
    let acceleration = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / DURATION_S.powi(2);
    let way = Vector3::from(GOAL_M);
    PositionReference {
        position_m: way * position,
        velocity_m_s: way * velocity,
        acceleration_m_s2: way * acceleration,
        yaw_rad: HEADING_RAD * position,
        yaw_rate_rad_s: HEADING_RAD * velocity,
        ..PositionReference::goal([0.0; 3], 0.0)
    }
}
