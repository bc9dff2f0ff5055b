//! By how much measured velocities and body rates are off.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::attitude::turned;
use crate::finite::are_finite;
use crate::{Measurement, RigidBody, Sensors};

/// Samples that are farther apart, s or rad, do not tell how the vehicle has moved between them.
const LONGEST_S: f64 = 0.25;
const FARTHEST_RAD: f64 = 1.0;

/// What velocity and body rates are off by, from how place and attitude change.
///
/// A law that foresees the motion integrates the measured rates. A gyroscope that is off would lead it beside its reference for as
/// long as it is.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct RateBias {
    /// The latest measurement, and when it was, µs; `None` before the first sample.
    latest: Option<(RigidBody, u64)>,
    /// Of the velocity, NED.
    velocity: Bias,
    /// Of the body rates, FRD.
    body_rate: Bias,
}

/// A complementary filter, as that of Mahony, Hamel and Pflimlin (2008, section IV-C) for small angles, on each axis: ε is how far a place is
/// from the integral of its rate v, and b the bias.
///
/// ```text
/// ε ← ε + x(k) − x(k−1) − ΔT ((v(k−1) + v(k))/2 − b) − 2ω ΔT ε
/// b ← b − ω² ΔT ε
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
struct Bias {
    /// ε, m or rad.
    away: Vector3<f64>,
    /// b, m/s or rad/s.
    rate: Vector3<f64>,
}

/// What is known of the biases of one kind of rate.
struct Kind {
    /// ω for an exact rate, rad/s.
    fastest_rad_s: f64,
    /// b may be off by so much under the noise of the rate, m/s or rad/s.
    unsure: f64,
    /// The largest b, m/s or rad/s, and ε, m or rad: a place that leaps says nothing of its rate.
    most: [f64; 2],
}

const VELOCITY: Kind = Kind { fastest_rad_s: 1.0, unsure: 1e-3, most: [0.2, 0.15] };
const BODY_RATE: Kind = Kind { fastest_rad_s: 0.55, unsure: 5e-4, most: [0.2, 0.1] };

impl Kind {
    /// ω under white noise of the rate of a deviation σ, sampled each ΔT: the deviation of b is σ √(ω ΔT)/2.
    fn bandwidth_rad_s(&self, deviation: f64, sample_time_s: f64) -> f64 {
        let slowest = self.unsure / deviation.max(self.unsure);
        self.fastest_rad_s.min(4.0 * slowest * slowest / sample_time_s)
    }
}

impl Bias {
    /// A sample in which the place has moved by `moved`, which its rate explains but for `b` of the mean `rate`.
    fn observe(
        &mut self,
        kind: &Kind,
        deviation: f64,
        (moved, rate): (&Vector3<f64>, &Vector3<f64>),
        sample_time_s: f64,
    ) {
        let rad_s = kind.bandwidth_rad_s(deviation, sample_time_s);
        let [most_rate, most_away] = kind.most;
        let away =
            self.away * (1.0 - 2.0 * rad_s * sample_time_s) + moved - (rate - self.rate) * sample_time_s;
        let away = away.map(|away| away.clamp(-most_away, most_away));
        let rate = self.rate - away * (rad_s * rad_s * sample_time_s);
        let rate = rate.map(|rate| rate.clamp(-most_rate, most_rate));
        if are_finite(away.as_slice()) && are_finite(rate.as_slice()) {
            *self = Self { away, rate };
        }
    }

    /// Whether it can have been found.
    fn is_possible(&self, kind: &Kind) -> bool {
        let within =
            |vector: &Vector3<f64>, most: f64| are_finite(vector.as_slice()) && vector.amax() <= most;
        within(&self.rate, kind.most[0]) && within(&self.away, kind.most[1])
    }
}

impl RateBias {
    /// Whether it can have been found: saved states may come from anywhere.
    pub(crate) fn is_possible(&self) -> bool {
        self.velocity.is_possible(&VELOCITY)
            && self.body_rate.is_possible(&BODY_RATE)
            && self.latest.is_none_or(|(measured, _)| measured.is_possible())
    }

    /// The origin of positions is elsewhere: they are by so much more, m.
    pub(crate) fn shift(&mut self, by_m: &Vector3<f64>) {
        if let Some((measured, _)) = &mut self.latest {
            measured.position_m += by_m;
        }
    }

    /// Looks at the next measurement, at a time, µs.
    pub(crate) fn observe(&mut self, sensors: &Sensors, measured: &RigidBody, time_us: u64) {
        let Some((before, before_us)) = self.latest.replace((*measured, time_us)) else { return };
        let elapsed_s = time_us.saturating_sub(before_us) as f64 / 1e6;
        if !(f64::MIN_POSITIVE..=LONGEST_S).contains(&elapsed_s) {
            return;
        }
        let moved_m = measured.position_m - before.position_m;
        let velocity_m_s = (before.velocity_m_s + measured.velocity_m_s) / 2.0;
        self.velocity.observe(&VELOCITY, sensors.velocity_noise_m_s, (&moved_m, &velocity_m_s), elapsed_s);
        let body_rate_rad_s = (before.body_rate_rad_s + measured.body_rate_rad_s) / 2.0;
        if body_rate_rad_s.norm() * elapsed_s < FARTHEST_RAD {
            let turned_rad = turned(&before.rotation(), &measured.rotation());
            let noise_rad_s = sensors.body_rate_noise_rad_s;
            self.body_rate.observe(&BODY_RATE, noise_rad_s, (&turned_rad, &body_rate_rad_s), elapsed_s);
        }
    }

    /// A measurement without it.
    pub(crate) fn corrected(&self, measurement: &Measurement) -> Measurement {
        let motion = RigidBody {
            velocity_m_s: measurement.motion.velocity_m_s - self.velocity.rate,
            body_rate_rad_s: measurement.motion.body_rate_rad_s - self.body_rate.rate,
            ..measurement.motion
        };
        Measurement { motion, ..*measurement }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::{BODY_RATE, Kind, RateBias, VELOCITY};
    use crate::sensors::NoiseState;
    use crate::{Configuration, Measurement, PlantState, RigidBody, Sensors};

    const STEP_US: u64 = 10_000;

    fn hover() -> Measurement {
        let Configuration { initial, airframe, .. } = Configuration::default();
        let state = PlantState::hovering(&initial, &airframe);
        Measurement { motion: state.body, rotor_speed_rad_s: state.rotor_speed_rad_s }
    }

    /// A vehicle that swings and turns, whose velocity and body rates are read with a bias.
    fn swinging(time_us: u64, velocity_m_s: &Vector3<f64>, body_rate_rad_s: &Vector3<f64>) -> RigidBody {
        let t = time_us as f64 / 1e6;
        RigidBody {
            position_m: Vector3::new(2.0 * t.sin(), 0.0, 0.3 * (3.0 * t).cos()),
            velocity_m_s: Vector3::new(2.0 * t.cos(), 0.0, -0.9 * (3.0 * t).sin()) + velocity_m_s,
            attitude: UnitQuaternion::from_euler_angles(0.4 * (2.0 * t).sin(), 0.0, 0.0).into_inner(),
            body_rate_rad_s: Vector3::x() * (0.8 * (2.0 * t).cos()) + body_rate_rad_s,
        }
    }

    fn found(velocity_m_s: &Vector3<f64>, body_rate_rad_s: &Vector3<f64>, end_us: u64) -> RateBias {
        let mut bias = RateBias::default();
        for time_us in (0..=end_us).step_by(STEP_US as usize) {
            let measured = swinging(time_us, velocity_m_s, body_rate_rad_s);
            bias.observe(&Sensors::default(), &measured, time_us);
        }
        bias
    }

    /// By b/β = ω²/(s + ω)² it is 1 − 2/e of the bias after 1/ω, and all of it at last, while the vehicle flies.
    #[test]
    fn a_bias_is_found_while_the_vehicle_flies() {
        let (velocity, rate) = (Vector3::new(0.1, -0.2, 0.05), Vector3::new(0.03, 0.0, -0.06));
        let part = 1.0 - 2.0 * (-1_f64).exp();
        let time_us = |kind: &Kind| (1e5 / kind.fastest_rad_s) as u64 * 10;
        let bias = found(&velocity, &rate, time_us(&VELOCITY));
        assert!((bias.velocity.rate - velocity * part).norm() < 2e-3, "{bias:?}");
        let bias = found(&velocity, &rate, time_us(&BODY_RATE));
        assert!((bias.body_rate.rate - rate * part).norm() < 1e-3, "{bias:?}");
        let end_us = 40_000_000;
        let bias = found(&velocity, &rate, end_us);
        let told = Measurement { motion: swinging(end_us, &velocity, &rate), ..hover() };
        let exact = swinging(end_us, &Vector3::zeros(), &Vector3::zeros());
        let corrected = bias.corrected(&told);
        assert!((corrected.motion.velocity_m_s - exact.velocity_m_s).norm() < 1e-4);
        assert!((corrected.motion.body_rate_rad_s - exact.body_rate_rad_s).norm() < 1e-4);
        assert_eq!(corrected.motion.position_m, told.motion.position_m);
    }

    /// Exact sensors have none: what is found is the error of the trapezoidal rule, ΔT²/12 of the second derivative.
    #[test]
    fn exact_sensors_have_none() {
        let bias = found(&Vector3::zeros(), &Vector3::zeros(), 20_000_000);
        assert!(bias.velocity.rate.norm() < 5e-5 && bias.body_rate.rate.norm() < 2e-5, "{bias:?}");
    }

    /// White noise of the rate moves what is found by the deviation that its bandwidth is chosen for, and noise of the places by less.
    #[test]
    fn noise_is_no_bias() {
        let sensors = Sensors { position_noise_m: 0.02, velocity_noise_m_s: 0.05, ..Sensors::default() };
        let (mut bias, mut noise) = (RateBias::default(), NoiseState::default());
        let (mut sum, mut count) = (0.0_f64, 0.0_f64);
        for step in 0..200_000 {
            let measured = noise.read(&sensors, &hover().motion);
            bias.observe(&sensors, &measured, step * STEP_US);
            if step > 20_000 {
                sum += bias.velocity.rate.x.powi(2);
                count += 1.0;
            }
        }
        let deviation = (sum / count).sqrt();
        assert!((0.7e-3..1.3e-3).contains(&deviation), "{deviation} m/s");
    }

    /// A place that leaps by metres is held for a bias of centimetres a second, and not for long; a known change of the origin, a gap and a
    /// spin that nobody can follow are not.
    #[test]
    fn leaps_gaps_and_spins_are_no_bias() {
        let sensors = Sensors::default();
        let hover = hover().motion;
        let far = RigidBody { position_m: Vector3::x() * 100.0, ..hover };
        let mut bias = RateBias::default();
        bias.observe(&sensors, &hover, 0);
        let mut most_m_s = 0.0_f64;
        for step in 1..1_000 {
            bias.observe(&sensors, &far, step * STEP_US);
            most_m_s = most_m_s.max(bias.velocity.rate.amax());
        }
        assert!(most_m_s < 0.4 * VELOCITY.most[1] && bias.velocity.rate.amax() < 1e-3, "{most_m_s} m/s");

        let mut bias = RateBias::default();
        bias.observe(&sensors, &hover, 0);
        bias.shift(&(Vector3::x() * 100.0));
        bias.observe(&sensors, &far, STEP_US);
        bias.observe(&sensors, &hover, 1_000_000);
        let spinning = RigidBody { body_rate_rad_s: Vector3::z() * 300.0, ..hover };
        bias.observe(&sensors, &spinning, 1_010_000);
        assert_eq!((bias.velocity, bias.body_rate), Default::default());
        assert!(bias.is_possible());
        bias.body_rate.rate.x = 2.0 * BODY_RATE.most[0];
        assert!(!bias.is_possible());
    }
}
