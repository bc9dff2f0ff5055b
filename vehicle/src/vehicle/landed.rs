//! Whether the vehicle stands on the ground.

use libm::cos;
use quadrotor::Outputs;

/// Whether the vehicle is on the ground, in the air or between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LandedState {
    /// On the ground.
    OnGround,
    /// Flying.
    InAir,
    /// Climbing from the ground.
    TakingOff,
    /// Descending to the ground.
    Landing,
}

/// Feet this high above the ground, m, or less touch it.
const CONTACT_HEIGHT_M: f64 = 0.03;
/// From this height on, m, it flies.
const FLYING_HEIGHT_M: f64 = 0.12;
/// Slower than this, m/s, it stands.
const STILL_M_S: f64 = 0.2;
/// It does not stand while it turns faster than this, rad/s, as it does having landed without one of its rotors.
const STILL_RAD_S: f64 = 0.3;
/// It stands when it has touched the ground, still, for this long, µs.
const SETTLED_US: u64 = 300_000;
/// What is held up by the ground for so long, µs, stands, even if it rocks and slides.
const HELD_US: u64 = 1_000_000;
/// A reference this far below the vehicle, m, presses it on the ground.
const PRESSED_M: f64 = 0.2;
/// Below this share of the weight the rotors do not carry it.
pub(super) const UNLOADED: f64 = 0.75;

/// Detects touch-down and lift-off on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LandedDetector {
    landed: bool,
    touching_since_us: Option<u64>,
    held_since_us: Option<u64>,
    settled: bool,
}

impl LandedDetector {
    /// A vehicle at a height, m.
    pub fn new(height_m: f64) -> Self {
        Self {
            landed: height_m < FLYING_HEIGHT_M,
            touching_since_us: None,
            held_since_us: None,
            settled: false,
        }
    }

    /// Whether it stands.
    pub fn is_landed(&self) -> bool {
        self.landed
    }

    /// Whether it has touched the ground, still and unloaded, for a while up to now.
    pub fn is_settled(&self) -> bool {
        self.settled
    }

    /// One look. `ground_z_m` is z of the ground below, `armed` tells whether rotors turn at all, `controlled` whether the reference is flown.
    pub fn update(
        &mut self,
        outputs: &Outputs,
        ground_z_m: f64,
        weight_n: f64,
        armed: bool,
        controlled: bool,
    ) {
        let height_m = ground_z_m - outputs.position_m.z;
        let pressed = controlled && outputs.setpoint.position_m.z > outputs.position_m.z + PRESSED_M;
        // A vehicle that has come to lie on its back is not carried either.
        let lift_n = outputs.thrust_n * cos(outputs.attitude_rad.x) * cos(outputs.attitude_rad.y);
        let weak = lift_n < UNLOADED * weight_n;
        let still = outputs.velocity_m_s.norm() < STILL_M_S && outputs.body_rate_rad_s.norm() < STILL_RAD_S;
        // What has not left the ground yet stands, whatever its rotors do.
        let on_its_feet = height_m < CONTACT_HEIGHT_M && (!armed || weak || pressed || self.landed);
        // What is held up by less than its weight and does not fall stands, be it on one edge, on which it may rock and slide.
        let on_an_edge = height_m < FLYING_HEIGHT_M && weak && pressed;
        let held = on_an_edge && outputs.velocity_m_s.z.abs() < STILL_M_S;
        let touching = still && (on_its_feet || on_an_edge);
        let since = |holds: bool, since_us: Option<u64>| holds.then(|| since_us.unwrap_or(outputs.time_us));
        self.touching_since_us = since(touching, self.touching_since_us);
        self.held_since_us = since(held, self.held_since_us);
        let lasts = |since_us: Option<u64>, long_us: u64| {
            since_us.is_some_and(|since_us| outputs.time_us - since_us >= long_us)
        };
        self.settled = lasts(self.touching_since_us, SETTLED_US) || lasts(self.held_since_us, HELD_US);
        self.landed = height_m <= FLYING_HEIGHT_M && (self.landed || self.settled);
    }
}
