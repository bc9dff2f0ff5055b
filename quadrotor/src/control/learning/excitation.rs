//! Whether a flight moves in a way that shows mass and drag.

use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::control::learning::coherence::Coherence;
use crate::control::learning::motion_equation::Terms;

/// Time over which what is steady is averaged, s.
pub(super) const STEADY_S: f64 = 3.0;
/// Changes of the thrust and of the acceleration that show a mass, m/s², and by how many deviations of the noise they exceed it.
const MASS_M_S2: f64 = 0.4;
const MASS_DEVIATIONS: f64 = 4.0;
/// How much of the horizontal acceleration goes with the thrust where that shows a mass, and the share of the averages that must be filled.
const COHERENCE: f64 = 0.99;
const FILLED: f64 = 0.6;
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
/// follow noise. A mass shows where the acceleration changes with the thrust; drag where the speed changes. On a level circle the thrust
/// stays as large as it is and turns, and the acceleration turns with it: a force that stood for an error of the mass would have to turn, too.
/// That is shown only if the two have gone together for seconds: a wind that swings leads the vehicle about as well.
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
    /// Of changes of the lean and of the horizontal acceleration.
    coherence: Coherence,
}

/// What changes in flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Moving {
    thrust_m_s2: f64,
    /// Along the thrust axis, m/s².
    acceleration_m_s2: f64,
    /// Horizontal part of the thrust per mass, less the drag that is believed in, m/s².
    lean_m_s2: Vector2<f64>,
    /// Horizontal acceleration, m/s².
    sideways_m_s2: Vector2<f64>,
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
        self.steady.map_or(Vector3::zeros(), |steady| terms.speed_m_s() - steady.motion.speed_m_s)
    }

    /// What the equation of an interval shows under noise of this deviation, m/s², if the vehicle has this drag per mass, 1/s.
    ///
    /// What is steady takes in this `share` of it, and begins anew when it is known twice as well. Of a filter that is hardly filled, noise
    /// is a large share.
    pub(crate) fn observe(
        &mut self,
        terms: &Terms,
        share: f64,
        (noise_m_s2, drag_1_s): (f64, &Vector3<f64>),
    ) -> Shown {
        let now = Moving::of(terms, drag_1_s);
        let deviation_m_s2 = noise_m_s2 / terms.filled.max(f64::EPSILON);
        let known = self.steady.filter(|steady| deviation_m_s2 > steady.deviation_m_s2 / 2.0);
        let known = self.steady.insert(known.unwrap_or(Steady {
            motion: now,
            deviation_m_s2,
            coherence: Coherence::new(),
        }));
        let least_m_s2 = MASS_M_S2 + MASS_DEVIATIONS * libm::hypot(deviation_m_s2, known.deviation_m_s2);
        let steady = &mut known.motion;
        steady.follow(&now, share);
        let along_m_s2 = libm::fabs(now.thrust_m_s2 - steady.thrust_m_s2)
            .min(libm::fabs(now.acceleration_m_s2 - steady.acceleration_m_s2));
        let lean_m_s2 = now.lean_m_s2 - steady.lean_m_s2;
        let sideways_m_s2 = now.sideways_m_s2 - steady.sideways_m_s2;
        let coherence = &mut known.coherence;
        coherence.see(&lean_m_s2, &sideways_m_s2, share);
        let goes_along = coherence.filled() > FILLED && coherence.squared() > COHERENCE;
        let turns_m_s2 = if goes_along { lean_m_s2.norm().min(sideways_m_s2.norm()) } else { 0.0 };
        let drag =
            core::array::from_fn(|axis| libm::fabs(now.speed_m_s[axis] - steady.speed_m_s[axis]) > DRAG_M_S);
        Shown { mass: along_m_s2.max(turns_m_s2) > least_m_s2, drag }
    }
}

impl Moving {
    /// Of a filter as far as it is filled.
    fn of(terms: &Terms, drag_1_s: &Vector3<f64>) -> Self {
        let scale = 1.0 / terms.filled.max(f64::EPSILON);
        let along = terms.in_body * terms.acceleration_m_s2 * (scale * scale);
        let thrust = terms.in_body.transpose() * Vector3::new(0.0, 0.0, -terms.thrust_m_s2) * (scale * scale);
        let speed_m_s = terms.speed_m_s();
        Self {
            thrust_m_s2: terms.thrust_m_s2 * scale,
            acceleration_m_s2: along.z,
            lean_m_s2: (thrust - speed_m_s.component_mul(drag_1_s)).xy(),
            sideways_m_s2: terms.acceleration_m_s2.xy() * scale,
            speed_m_s,
        }
    }

    /// Goes a share of the way to the present.
    fn follow(&mut self, now: &Self, share: f64) {
        self.thrust_m_s2 += (now.thrust_m_s2 - self.thrust_m_s2) * share;
        self.acceleration_m_s2 += (now.acceleration_m_s2 - self.acceleration_m_s2) * share;
        self.lean_m_s2 += (now.lean_m_s2 - self.lean_m_s2) * share;
        self.sideways_m_s2 += (now.sideways_m_s2 - self.sideways_m_s2) * share;
        self.speed_m_s += (now.speed_m_s - self.speed_m_s) * share;
    }
}
