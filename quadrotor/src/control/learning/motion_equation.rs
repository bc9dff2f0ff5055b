//! The equation of motion of a flight, low-pass filtered.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::GRAVITY_M_S2;
use crate::control::learning::averaging::SampledAveraging;
use crate::finite::are_finite;

/// Time constant of each stage of the filter, s: short beside the manoeuvres that show a mass, long beside the sample time
/// of a sensor.
pub(super) const STAGE_S: f64 = 0.15;
/// Number of stages. Differentiating positions twice takes two; the third one rolls their noise off.
const STAGES: usize = 3;

/// What is measured of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum MeasuredMotion {
    /// Velocity, NED, m/s.
    Velocity(Vector3<f64>),
    /// Position alone, NED, m.
    Position(Vector3<f64>),
}

/// The terms of Rᵀ(a − g e₃) = −μ t e₃ − κ-weighted Rᵀ v + Rᵀ d in body axes, each filtered alike, so that the equation holds as
/// it does unfiltered. In body axes thrust is on one axis alone: an error of the attitude, which is small and first of all one of
/// the direction of the thrust, does not touch what is learned of its magnitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Terms {
    /// Rᵀ(a − g e₃), FRD, m/s²: what thrust, drag and other forces do.
    pub(crate) specific_force_m_s2: Vector3<f64>,
    /// t, modelled thrust per nominal mass, along −b₃, m/s².
    pub(crate) thrust_m_s2: f64,
    /// Rᵀ diag(v): what drag along each world axis acts by, m/s.
    pub(crate) velocity_m_s: Matrix3<f64>,
    /// Rᵀ: what a force along each world axis acts by.
    pub(crate) in_body: Matrix3<f64>,
    /// a, NED, m/s².
    pub(crate) acceleration_m_s2: Vector3<f64>,
    /// 1 unfiltered: how much of the filter's memory is filled.
    pub(crate) filled: f64,
}

/// Makes equations of motion of consecutive samples, with no derivative of a noisy signal: differences pass through a
/// third-order low-pass filter. The filter begins at rest on all terms, so that equations hold from the first sample on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MotionEquation {
    last: Option<Sampled>,
    /// Of the latest interval before a position.
    interval: Option<Interval>,
    stages: [Terms; STAGES],
}

/// An instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sampled {
    /// What is measured of the motion.
    pub(crate) motion: MeasuredMotion,
    /// The velocity as it is estimated, NED, m/s: positions begin with it, because the first difference of two noisy ones
    /// would be remembered for as long as the filter does.
    pub(crate) estimated_velocity_m_s: Vector3<f64>,
    /// FRD into NED.
    pub(crate) attitude: UnitQuaternion<f64>,
    /// Modelled thrust per nominal mass, m/s².
    pub(crate) thrust_m_s2: f64,
    /// When, µs.
    pub(crate) time_us: u64,
}

/// Means over the time between two instants.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Interval {
    velocity_m_s: Vector3<f64>,
    in_body: Matrix3<f64>,
    thrust_m_s2: f64,
    duration_s: f64,
}

impl Terms {
    fn zero() -> Self {
        Self {
            specific_force_m_s2: Vector3::zeros(),
            thrust_m_s2: 0.0,
            velocity_m_s: Matrix3::zeros(),
            in_body: Matrix3::zeros(),
            acceleration_m_s2: Vector3::zeros(),
            filled: 0.0,
        }
    }

    /// Of means over an interval.
    fn new(
        acceleration_m_s2: Vector3<f64>,
        velocity_m_s: &Vector3<f64>,
        in_body: Matrix3<f64>,
        thrust_m_s2: f64,
    ) -> Self {
        Self {
            specific_force_m_s2: in_body * (acceleration_m_s2 - Vector3::z() * GRAVITY_M_S2),
            thrust_m_s2,
            velocity_m_s: in_body * Matrix3::from_diagonal(velocity_m_s),
            in_body,
            acceleration_m_s2,
            filled: 1.0,
        }
    }

    /// Goes towards others by a share of the difference.
    pub(crate) fn approach(&mut self, others: &Self, share: f64) {
        self.specific_force_m_s2 += (others.specific_force_m_s2 - self.specific_force_m_s2) * share;
        self.thrust_m_s2 += (others.thrust_m_s2 - self.thrust_m_s2) * share;
        self.velocity_m_s += (others.velocity_m_s - self.velocity_m_s) * share;
        self.in_body += (others.in_body - self.in_body) * share;
        self.acceleration_m_s2 += (others.acceleration_m_s2 - self.acceleration_m_s2) * share;
        self.filled += (others.filled - self.filled) * share;
    }

    /// The thrust per mass, m/s², however far the filter is filled.
    pub(crate) fn present_thrust_m_s2(&self) -> f64 {
        self.thrust_m_s2 / self.filled
    }

    /// Velocity along the world axes, m/s, however far the filter is filled.
    pub(crate) fn speed_m_s(&self) -> Vector3<f64> {
        let scale = 1.0 / self.filled.max(f64::EPSILON);
        // R Rᵀ diag(v)
        (self.in_body.transpose() * self.velocity_m_s).diagonal() * (scale * scale)
    }

    /// Whether all of them are finite, and some of the filter is filled.
    pub(crate) fn is_finite(&self) -> bool {
        self.filled > 0.0
            && self.filled.is_finite()
            && self.thrust_m_s2.is_finite()
            && are_finite(self.specific_force_m_s2.as_slice())
            && are_finite(self.acceleration_m_s2.as_slice())
            && are_finite(self.velocity_m_s.as_slice())
            && are_finite(self.in_body.as_slice())
    }
}

impl MotionEquation {
    /// Without a past.
    pub(crate) fn new() -> Self {
        Self { last: None, interval: None, stages: [Terms::zero(); STAGES] }
    }

    /// The latest instant, µs.
    pub(crate) fn latest_us(&self) -> Option<u64> {
        self.last.map(|last| last.time_us)
    }

    /// The origin of positions is elsewhere: they are by so much more, m.
    pub(crate) fn shift(&mut self, by_m: &Vector3<f64>) {
        if let Some(Sampled { motion: MeasuredMotion::Position(position_m), .. }) = &mut self.last {
            *position_m += by_m;
        }
    }

    /// Takes in an instant and returns the filtered equation of the interval that ends, if a whole one does.
    pub(crate) fn observe(&mut self, now: Sampled, averaging: &SampledAveraging) -> Option<Terms> {
        let last = self.last.replace(now)?;
        let duration_s = now.time_us.checked_sub(last.time_us).filter(|us| *us > 0)? as f64 / 1e6;
        let thrust_m_s2 = (now.thrust_m_s2 + last.thrust_m_s2) / 2.0;
        let middle = last.attitude.nlerp(&now.attitude, 0.5);
        let in_body = *middle.to_rotation_matrix().transpose().matrix();
        let raw = match (now.motion, last.motion) {
            (MeasuredMotion::Velocity(now), MeasuredMotion::Velocity(before)) => {
                Terms::new((now - before) / duration_s, &((now + before) / 2.0), in_body, thrust_m_s2)
            }
            (MeasuredMotion::Position(now), MeasuredMotion::Position(before)) => {
                let velocity_m_s = (now - before) / duration_s;
                let interval = Interval { velocity_m_s, in_body, thrust_m_s2, duration_s };
                let start = Interval { velocity_m_s: last.estimated_velocity_m_s, ..interval };
                between(&self.interval.replace(interval).unwrap_or(start), &interval)
            }
            // The sensors have changed.
            _ => {
                *self = Self { last: self.last, ..Self::new() };
                return None;
            }
        };
        let share = averaging.over(duration_s, &mut None).stage;
        let mut input = raw;
        for stage in &mut self.stages {
            stage.approach(&input, share);
            input = *stage;
        }
        Some(input)
    }
}

/// The terms from the middle of one interval to the middle of the next one.
fn between(one: &Interval, next: &Interval) -> Terms {
    let both_s = one.duration_s + next.duration_s;
    let (before, after) = (one.duration_s / both_s, next.duration_s / both_s);
    let change = next.velocity_m_s - one.velocity_m_s;
    Terms::new(
        change / (both_s / 2.0),
        &(one.velocity_m_s * before + next.velocity_m_s * after),
        one.in_body * before + next.in_body * after,
        one.thrust_m_s2 * before + next.thrust_m_s2 * after,
    )
}

/// How long an equation remembers, s: the sum of the stages' time constants.
pub(crate) const MEMORY_S: f64 = STAGES as f64 * STAGE_S;

/// Deviation of a filtered acceleration per white noise of velocities, by the square root of their interval, s: the energy of
/// s/(τ s + 1)³ is 1/(16 τ³).
pub(crate) fn noise_of_velocities() -> f64 {
    libm::sqrt(1.0 / 16.0 / (STAGE_S * STAGE_S * STAGE_S))
}

/// The same per white noise of positions: the energy of s²/(τ s + 1)³ is 3/(16 τ⁵).
pub(crate) fn noise_of_positions() -> f64 {
    libm::sqrt(3.0 / 16.0 / (STAGE_S * STAGE_S * STAGE_S * STAGE_S * STAGE_S))
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::{MeasuredMotion, MotionEquation, Sampled, noise_of_positions};
    use crate::control::learning::averaging::SampledAveraging;
    use crate::{Configuration, GRAVITY_M_S2};

    fn averaging() -> SampledAveraging {
        SampledAveraging::new(&Configuration::default().controllers.attitude)
    }

    const MU: f64 = 1.3;
    const DRAG_1_S: f64 = 0.2;

    fn force() -> Vector3<f64> {
        Vector3::new(0.3, 0.1, -0.4)
    }

    /// Velocity v = A sin ωt about each axis, with the thrust and the attitude that make it under drag and a constant force.
    fn flight(time_us: u64, by_position: bool) -> Sampled {
        let time_s = time_us as f64 * 1e-6;
        let amplitude = Vector3::new(3.0, -2.0, 1.0);
        let omega = 1.7;
        let position = -amplitude * ((omega * time_s).cos() / omega);
        let velocity = amplitude * (omega * time_s).sin();
        let acceleration = amplitude * (omega * (omega * time_s).cos());
        let thrust = (Vector3::z() * GRAVITY_M_S2 + force() - acceleration - velocity * DRAG_1_S) / MU;
        let lean: UnitQuaternion<f64> = UnitQuaternion::rotation_between(&Vector3::z(), &thrust).unwrap();
        Sampled {
            motion: if by_position {
                MeasuredMotion::Position(position)
            } else {
                MeasuredMotion::Velocity(velocity)
            },
            attitude: lean * UnitQuaternion::from_euler_angles(0.0, 0.0, 0.4 * time_s),
            thrust_m_s2: thrust.norm(),
            estimated_velocity_m_s: velocity,
            time_us,
        }
    }

    /// The filtered terms keep the equation of the unfiltered ones: at once, and for sample times that change.
    #[test]
    fn the_filtered_equation_holds() {
        for by_position in [false, true] {
            let mut equation = MotionEquation::new();
            let (mut time_us, mut worst, mut count) = (0_u64, 0.0_f64, 0);
            for sample in 0..3_000_u64 {
                time_us += if sample < 1_500 { 2_000 } else { 1_000 + 1_000 * (sample % 3) };
                let Some(terms) = equation.observe(flight(time_us, by_position), &averaging()) else {
                    continue;
                };
                let residual = terms.specific_force_m_s2
                    + Vector3::z() * (terms.thrust_m_s2 * MU)
                    + terms.velocity_m_s * Vector3::repeat(DRAG_1_S)
                    - terms.in_body * force();
                worst = worst.max(residual.norm());
                count += 1;
            }
            assert!(count > 2_990 && worst < 2e-2, "{by_position}: {worst} m/s² in {count}");
        }
    }

    fn hover(motion: MeasuredMotion, time_us: u64) -> Sampled {
        let estimated_velocity_m_s = Vector3::zeros();
        let (attitude, thrust_m_s2) = (UnitQuaternion::identity(), GRAVITY_M_S2);
        Sampled { motion, estimated_velocity_m_s, attitude, thrust_m_s2, time_us }
    }

    /// Position noise of 2 cm at 100 Hz, of which differences make 490 m/s², leaves less than a decimetre per second squared.
    #[test]
    fn noise_of_positions_is_rolled_off() {
        let mut equation = MotionEquation::new();
        let mut sum = 0.0;
        for sample in 0..20_000_u64 {
            // White: a hash of the sample's number.
            let noise = |axis: u64| {
                let hash = (3 * sample + axis + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
                let hash = (hash ^ (hash >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
                ((hash >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * (12.0_f64).sqrt() * 0.02
            };
            let position = Vector3::new(noise(0), noise(1), noise(2));
            let terms =
                equation.observe(hover(MeasuredMotion::Position(position), 10_000 * sample), &averaging());
            sum += terms.map_or(0.0, |terms| terms.acceleration_m_s2.norm_squared() / 3.0);
        }
        let deviation = (sum / 20_000.0).sqrt();
        let expected = 0.02 * 0.1 * noise_of_positions();
        assert!((deviation / expected - 1.0).abs() < 0.1, "{deviation} and {expected} m/s²");
    }

    #[test]
    fn other_sensors_begin_anew() {
        let mut equation = MotionEquation::new();
        let zero = Vector3::zeros();
        assert!(equation.observe(hover(MeasuredMotion::Velocity(zero), 0), &averaging()).is_none());
        assert!(equation.observe(hover(MeasuredMotion::Velocity(zero), 10_000), &averaging()).is_some());
        for (sample, complete) in [false, true, true].into_iter().enumerate() {
            let time_us = 20_000 + 10_000 * sample as u64;
            let terms = equation.observe(hover(MeasuredMotion::Position(zero), time_us), &averaging());
            assert_eq!(terms.is_some(), complete, "{sample}");
        }
        let again = equation.observe(hover(MeasuredMotion::Position(zero), 40_000), &averaging());
        assert!(again.is_none(), "no time has passed");
    }
}
