//! Rotors and rigid body together, and their integration: the vehicle without its controllers, stepped by rotor commands.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::plant::ground::contact;
use crate::plant::rigid_body::RigidBody;
use crate::{Configuration, Disturbance, Wrench, wrench_of_rotors};

/// State of the plant: rigid body and rotor speeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plant {
    /// The rigid body.
    pub body: RigidBody,
    /// Speeds of the front, right, back and left rotor, rad/s.
    pub rotor_speed_rad_s: [f64; 4],
}

impl Plant {
    /// The configured initial state; with rotors at hover speed if `armed`, else at rest.
    pub fn new(configuration: &Configuration, armed: bool) -> Self {
        let initial = &configuration.initial;
        let [phi, theta, psi] = initial.attitude_rad;
        let speed = if armed { configuration.airframe.hover_rotor_speed_rad_s() } else { 0.0 };
        Self {
            body: RigidBody {
                position_m: initial.position_m.into(),
                velocity_m_s: initial.velocity_m_s.into(),
                attitude: UnitQuaternion::from_euler_angles(phi, theta, psi).into_inner(),
                body_rate_rad_s: initial.body_rate_rad_s.into(),
            },
            rotor_speed_rad_s: [speed; 4],
        }
    }

    /// Thrust and torques that the rotors make now.
    pub fn wrench(&self, configuration: &Configuration) -> Wrench {
        wrench_of_rotors(&configuration.airframe, &self.rotor_speed_rad_s)
    }

    /// Acceleration in NED, m/s².
    pub fn acceleration_m_s2(
        &self,
        configuration: &Configuration,
        disturbance: &Disturbance,
    ) -> Vector3<f64> {
        self.derivative(configuration, &self.rotor_speed_rad_s, disturbance).body.velocity_m_s
    }

    /// Time derivative of the state, under commanded rotor speeds, rad/s.
    pub fn derivative(
        &self,
        configuration: &Configuration,
        command_rad_s: &[f64; 4],
        disturbance: &Disturbance,
    ) -> Self {
        let airframe = &configuration.airframe;
        let mut external = disturbance.external(airframe, &self.body.velocity_m_s);
        if configuration.environment.ground_plane {
            let ground = contact(airframe, &self.body);
            external.force_n += ground.force_n;
            external.torque_n_m += ground.torque_n_m;
        }
        let body = self.body.derivative(airframe, &self.wrench(configuration), &external);
        // ω̇ = (ω_command − ω) / τ
        let rotor_speed_rad_s = core::array::from_fn(|rotor| {
            (command_rad_s[rotor] - self.rotor_speed_rad_s[rotor]) / airframe.rotor_time_constant_s
        });
        Self { body, rotor_speed_rad_s }
    }

    /// One step of the classical fourth-order Runge–Kutta method over `h_s` seconds.
    pub fn step(
        &self,
        configuration: &Configuration,
        command_rad_s: &[f64; 4],
        disturbance: &Disturbance,
        h_s: f64,
    ) -> Self {
        let f = |state: &Self| state.derivative(configuration, command_rad_s, disturbance);
        let k1 = f(self);
        let k2 = f(&self.plus(&k1, h_s / 2.0));
        let k3 = f(&self.plus(&k2, h_s / 2.0));
        let k4 = f(&self.plus(&k3, h_s));
        // x + h/6 (k₁ + 2k₂ + 2k₃ + k₄)
        let mut next =
            self.plus(&k1, h_s / 6.0).plus(&k2, h_s / 3.0).plus(&k3, h_s / 3.0).plus(&k4, h_s / 6.0);
        next.body.attitude = UnitQuaternion::new_normalize(next.body.attitude).into_inner();
        next
    }

    fn plus(&self, derivative: &Self, h: f64) -> Self {
        Self {
            body: self.body.plus(&derivative.body, h),
            rotor_speed_rad_s: core::array::from_fn(|rotor| {
                self.rotor_speed_rad_s[rotor] + derivative.rotor_speed_rad_s[rotor] * h
            }),
        }
    }

    /// Whether it has stayed within the range of numbers.
    pub fn is_finite(&self) -> bool {
        self.body.is_finite() && self.rotor_speed_rad_s.iter().all(|speed| speed.is_finite())
    }
}
