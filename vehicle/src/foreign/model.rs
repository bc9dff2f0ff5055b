//! The model, as the vehicle flies it.

use std::fmt::Debug;

use nalgebra::{Quaternion, Vector3};
use quadrotor::{PositionReference, RigidBody, Wrench};
use serde::{Deserialize, Serialize};

use super::ForeignDescription;
use crate::FlightError;

/// What a model is told for a part of the flight. It takes what it can; SI units, NED and FRD.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// When it begins, µs.
    pub time_us: u64,
    /// How long it lasts, µs.
    pub duration_us: u64,
    /// Where a closed loop is to be, as its own motion.
    pub reference: PositionReference,
    /// Whether the rotors may turn.
    pub armed: bool,
    /// Speeds that our controllers ask of the rotors of a plant, in the order of the airframe's layout, rad/s.
    pub rotor_command_rad_s: [f64; 4],
    /// Thrust and torques of rotors that follow these speeds with the airframe's lag.
    pub wrench: Wrench,
    /// Velocity of the air, m/s.
    pub wind_m_s: Vector3<f64>,
    /// z of the ground below the vehicle, m.
    pub ground_z_m: f64,
}

/// How a model has moved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForeignMotion {
    /// Position, velocity, attitude and body rates.
    pub body: RigidBody,
    /// Acceleration in NED, m/s², if it shows it.
    pub acceleration_m_s2: Option<Vector3<f64>>,
    /// Speeds of its rotors, rad/s, if it shows them.
    pub rotor_speed_rad_s: Option<[f64; 4]>,
    /// Thrust of its rotors, N, if it shows it.
    pub thrust_n: Option<f64>,
}

impl ForeignMotion {
    /// All that it shows, in a fixed order.
    pub fn values(&self) -> Vec<f64> {
        let body = &self.body;
        let mut values = Vec::with_capacity(21);
        values.extend(body.position_m.iter().chain(body.velocity_m_s.iter()));
        values.extend([body.attitude.w, body.attitude.i, body.attitude.j, body.attitude.k]);
        values.extend(body.body_rate_rad_s.iter());
        values.extend(self.acceleration_m_s2.iter().flat_map(|acceleration| acceleration.iter()));
        values.extend(self.rotor_speed_rad_s.iter().flatten());
        values.extend(self.thrust_n);
        values
    }

    /// A motion that shows the same as this one, with other [`values`](Self::values); `None` if they are not as many.
    pub fn with_values(&self, values: &[f64]) -> Option<Self> {
        let mut rest = values.iter().copied();
        let mut vector = || Some(Vector3::new(rest.next()?, rest.next()?, rest.next()?));
        let (position_m, velocity_m_s) = (vector()?, vector()?);
        let attitude = Quaternion::new(rest.next()?, rest.next()?, rest.next()?, rest.next()?);
        let mut vector = || Some(Vector3::new(rest.next()?, rest.next()?, rest.next()?));
        let body = RigidBody { position_m, velocity_m_s, attitude, body_rate_rad_s: vector()? };
        let acceleration_m_s2 = if self.acceleration_m_s2.is_some() { Some(vector()?) } else { None };
        let rotor_speed_rad_s = match self.rotor_speed_rad_s {
            Some(_) => Some([rest.next()?, rest.next()?, rest.next()?, rest.next()?]),
            None => None,
        };
        let thrust_n = if self.thrust_n.is_some() { Some(rest.next()?) } else { None };
        let motion = Self { body, acceleration_m_s2, rotor_speed_rad_s, thrust_n };
        rest.next().is_none().then_some(motion)
    }
}

/// A closed loop or a plant from elsewhere.
pub trait ForeignModel: Debug + Send {
    /// What it is.
    fn description(&self) -> &ForeignDescription;

    /// Moves on as demanded.
    ///
    /// # Errors
    /// [`FlightError`]; the flight ends there.
    fn advance(&mut self, demand: &Demand) -> Result<ForeignMotion, FlightError>;
}

#[cfg(test)]
mod tests {
    use nalgebra::{Quaternion, Vector3};
    use quadrotor::RigidBody;

    use super::ForeignMotion;

    #[test]
    fn a_motion_is_its_values() {
        let body = RigidBody {
            position_m: Vector3::new(1.0, 2.0, 3.0),
            velocity_m_s: Vector3::new(4.0, 5.0, 6.0),
            attitude: Quaternion::new(0.5, -0.5, 0.5, -0.5),
            body_rate_rad_s: Vector3::new(7.0, 8.0, 9.0),
        };
        let all = ForeignMotion {
            body,
            acceleration_m_s2: Some(Vector3::new(10.0, 11.0, 12.0)),
            rotor_speed_rad_s: Some([13.0, 14.0, 15.0, 16.0]),
            thrust_n: Some(17.0),
        };
        let least = ForeignMotion { acceleration_m_s2: None, rotor_speed_rad_s: None, thrust_n: None, ..all };
        for (motion, count) in [(all, 21), (least, 13)] {
            let values = motion.values();
            assert_eq!(values.len(), count);
            assert_eq!(motion.with_values(&values), Some(motion));
            assert_eq!(motion.with_values(&values[1..]), None);
        }
        assert_eq!(least.with_values(&all.values()), None);
    }
}
