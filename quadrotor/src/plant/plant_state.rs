//! What changes of the plant: x of f(x, u).

use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

use crate::plant::rigid_body::RigidBody;
use crate::{Airframe, InitialState};

/// Largest magnitude of the numbers of a vehicle in motion, SI units.
const LARGEST: f64 = 1e12;
/// Largest body rate, rad/s: ten radians in an integration step, whose result means nothing any more.
const FASTEST: f64 = 1e4;

/// Rigid body, rotor speeds and battery, or their time derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantState {
    /// The rigid body.
    pub body: RigidBody,
    /// Speeds of the rotors in the order of the airframe's layout, rad/s.
    pub rotor_speed_rad_s: [f64; 4],
    /// Drawn share of the battery's charge: 0 is full. Constant without [`BatteryPack::sag`](crate::BatteryPack::sag).
    #[serde(default)]
    pub discharge: f64,
}

impl PlantState {
    /// Where a flight begins, with rotors at rest.
    pub fn at_rest(initial: &InitialState) -> Self {
        let [phi, theta, psi] = initial.attitude_rad;
        Self {
            body: RigidBody {
                position_m: initial.position_m.into(),
                velocity_m_s: initial.velocity_m_s.into(),
                attitude: UnitQuaternion::from_euler_angles(phi, theta, psi).into_inner(),
                body_rate_rad_s: initial.body_rate_rad_s.into(),
            },
            rotor_speed_rad_s: [0.0; 4],
            discharge: initial.discharge,
        }
    }

    /// Where a flight begins, with rotors that carry the weight.
    pub fn hovering(initial: &InitialState, airframe: &Airframe) -> Self {
        Self { rotor_speed_rad_s: [airframe.hover_rotor_speed_rad_s(); 4], ..Self::at_rest(initial) }
    }

    /// self + h · derivative, each component for itself: what an explicit integrator adds up. The quaternion does not stay
    /// unit; see [`PlantState::normalized`].
    pub fn plus(&self, derivative: &Self, h_s: f64) -> Self {
        Self {
            body: self.body.plus(&derivative.body, h_s),
            rotor_speed_rad_s: core::array::from_fn(|rotor| {
                self.rotor_speed_rad_s[rotor] + derivative.rotor_speed_rad_s[rotor] * h_s
            }),
            discharge: self.discharge + derivative.discharge * h_s,
        }
    }

    /// The same with a unit quaternion: what ends a step of an integrator.
    pub fn normalized(&self) -> Self {
        let attitude = UnitQuaternion::new_normalize(self.body.attitude).into_inner();
        Self { body: RigidBody { attitude, ..self.body }, ..*self }
    }

    /// Whether a number is not finite or far beyond what any vehicle reaches, so that the motion that follows from it would
    /// soon not be finite either: 10⁴ rad/s of a body rate, 10¹² in SI units of all others.
    pub fn has_diverged(&self) -> bool {
        let RigidBody { position_m, velocity_m_s, attitude, body_rate_rad_s } = &self.body;
        let body = position_m.iter().chain(velocity_m_s).chain(&attitude.coords);
        let mut numbers = body.chain(&self.rotor_speed_rad_s).chain([&self.discharge]);
        // NaN is in no range.
        let within = |most: f64| move |number: &f64| (-most..=most).contains(number);
        !(numbers.all(within(LARGEST)) && body_rate_rad_s.iter().all(within(FASTEST)))
    }
}
