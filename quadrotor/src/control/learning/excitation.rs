//! Whether a flight moves in a way that shows mass and drag.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::control::learning::motion_equation::Terms;

/// Time over which what is steady is averaged, s.
const STEADY_S: f64 = 3.0;
/// Changes of the thrust and of the acceleration that show a mass, m/s², and by how many deviations of the noise they exceed it.
const MASS_M_S2: f64 = 0.4;
const MASS_DEVIATIONS: f64 = 4.0;
/// Change of the velocity along an axis that shows drag, m/s.
const DRAG_M_S: f64 = 1.0;

/// What a flight shows at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shown {
    /// The mass.
    pub(crate) mass: bool,
    /// Drag along north, east and down.
    pub(crate) drag: [bool; 3],
}

/// The steady part of the motion.
///
/// Thrust that changes alone shows nothing: it may hold the vehicle against a changing force, which looks like a large mass, or
/// follow noise. A mass shows where the acceleration changes with the thrust; drag where the speed changes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Excitation {
    steady: Option<Steady>,
}

/// What is steady, and how well that is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Steady {
    motion: Moving,
    /// Deviation of the acceleration with which it began, m/s².
    deviation_m_s2: f64,
}

/// What changes in flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Moving {
    thrust_m_s2: f64,
    /// Along the thrust axis, m/s².
    acceleration_m_s2: f64,
    /// Along the world axes, m/s.
    speed_m_s: Vector3<f64>,
}

impl Excitation {
    /// Nothing has moved.
    pub(crate) fn new() -> Self {
        Self { steady: None }
    }

    /// By how much the velocity in the equation of an interval differs from the steady one, NED, m/s.
    pub(crate) fn change_of_speed_m_s(&self, terms: &Terms) -> Vector3<f64> {
        let now = Moving::of(terms);
        now.speed_m_s - self.steady.map_or(now, |steady| steady.motion).speed_m_s
    }

    /// What the equation of an interval shows under noise of this deviation, m/s².
    ///
    /// Of a filter that is hardly filled, noise is a large share. What is steady begins anew when it is known twice as well.
    pub(crate) fn observe(&mut self, terms: &Terms, interval_s: f64, noise_m_s2: f64) -> Shown {
        let now = Moving::of(terms);
        let deviation_m_s2 = noise_m_s2 / terms.filled.max(f64::EPSILON);
        let known = self.steady.filter(|steady| deviation_m_s2 > steady.deviation_m_s2 / 2.0);
        let known = self.steady.insert(known.unwrap_or(Steady { motion: now, deviation_m_s2 }));
        let least_m_s2 = MASS_M_S2 + MASS_DEVIATIONS * libm::hypot(deviation_m_s2, known.deviation_m_s2);
        let steady = &mut known.motion;
        let share = -libm::expm1(-interval_s / STEADY_S);
        steady.thrust_m_s2 += (now.thrust_m_s2 - steady.thrust_m_s2) * share;
        steady.acceleration_m_s2 += (now.acceleration_m_s2 - steady.acceleration_m_s2) * share;
        steady.speed_m_s += (now.speed_m_s - steady.speed_m_s) * share;
        let thrust_m_s2 = libm::fabs(now.thrust_m_s2 - steady.thrust_m_s2);
        let along_m_s2 = libm::fabs(now.acceleration_m_s2 - steady.acceleration_m_s2);
        let drag =
            core::array::from_fn(|axis| libm::fabs(now.speed_m_s[axis] - steady.speed_m_s[axis]) > DRAG_M_S);
        Shown { mass: thrust_m_s2.min(along_m_s2) > least_m_s2, drag }
    }
}

impl Moving {
    /// Of a filter as far as it is filled.
    fn of(terms: &Terms) -> Self {
        let scale = 1.0 / terms.filled.max(f64::EPSILON);
        let along = terms.in_body * terms.acceleration_m_s2 * (scale * scale);
        let speed = terms.in_body.transpose() * terms.velocity_m_s * (scale * scale);
        Self {
            thrust_m_s2: terms.thrust_m_s2 * scale,
            acceleration_m_s2: along.z,
            // R Rᵀ diag(v)
            speed_m_s: speed.diagonal(),
        }
    }
}
