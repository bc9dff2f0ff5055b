//! Numbers of a flight.

use nalgebra::Vector3;
use quadrotor::{Airframe, Limits};

use super::track::{Moment, Track};

/// Distance from the goal, m, within which a vehicle has settled.
pub const SETTLED_M: f64 = 0.02;

impl Track {
    /// The moments from a time on, s.
    pub fn since(&self, time_s: f64) -> &[Moment] {
        let first = self.moments.partition_point(|moment| moment.time_s < time_s - 1e-9);
        &self.moments[first..]
    }

    /// The last seconds.
    pub fn last(&self, duration_s: f64) -> &[Moment] {
        let end_s = self.moments.last().map_or(0.0, |moment| moment.time_s);
        self.since(end_s - duration_s)
    }

    /// The largest share of its step by which a coordinate goes beyond the goal of a step from the origin.
    pub fn overshoot(&self, goal_m: [f64; 3]) -> f64 {
        let beyond = |moment: &Moment, axis: usize| moment.position_m[axis] / goal_m[axis] - 1.0;
        let axes = (0..3).filter(|axis| goal_m[*axis] != 0.0);
        axes.map(|axis| largest(&self.moments, |moment| beyond(moment, axis))).fold(0.0, f64::max)
    }

    /// Largest distance of the axes that a step from the origin leaves alone, m.
    pub fn off_axis_m(&self, goal_m: [f64; 3]) -> f64 {
        let still = |moment: &Moment| {
            Vector3::from_fn(|axis, _| if goal_m[axis] == 0.0 { moment.position_m[axis] } else { 0.0 }).norm()
        };
        largest(&self.moments, still)
    }

    /// When the vehicle has come within 2 cm of its reference for good, s; infinite if it has not.
    pub fn settled_s(&self) -> f64 {
        let away = |moment: &Moment| moment.error_m().norm() > SETTLED_M;
        match self.moments.iter().rposition(away) {
            None => 0.0,
            Some(last) => self.moments.get(last + 1).map_or(f64::INFINITY, |moment| moment.time_s),
        }
    }

    /// Integral of the squared distance from the reference, m²·s, by the trapezoidal rule.
    pub fn squared_distance_m2_s(&self) -> f64 {
        let squared = |moment: &Moment| moment.error_m().norm_squared();
        let trapezoid = |pair: &[Moment]| match pair {
            [one, other] => (other.time_s - one.time_s) * f64::midpoint(squared(one), squared(other)),
            _ => 0.0,
        };
        self.moments.windows(2).map(trapezoid).sum()
    }

    /// The largest share by which tilt, speed or thrust leave their limits.
    pub fn limit_excess(&self, limits: &Limits, airframe: &Airframe) -> f64 {
        let strongest = airframe.thrust_range_n().1 / airframe.weight_n();
        let excess = |moment: &Moment| {
            let velocity = &moment.velocity_m_s;
            let thrust = moment.thrust_n / airframe.weight_n();
            [
                moment.tilt_rad() / limits.tilt_rad,
                velocity.xy().norm() / limits.speed_horizontal_m_s,
                -velocity.z / limits.speed_up_m_s,
                velocity.z / limits.speed_down_m_s,
                thrust / limits.thrust_max.min(strongest),
                // Below the least thrust by a share of it.
                2.0 - thrust / limits.thrust_min,
            ]
            .into_iter()
            .fold(0.0, f64::max)
        };
        largest(&self.moments, excess) - 1.0
    }
}

/// Largest value over some moments.
pub fn largest(moments: &[Moment], value: impl Fn(&Moment) -> f64) -> f64 {
    moments.iter().map(value).fold(f64::NEG_INFINITY, f64::max)
}

/// Largest minus smallest value over some moments.
pub fn swing(moments: &[Moment], value: impl Fn(&Moment) -> f64) -> f64 {
    largest(moments, &value) + largest(moments, |moment| -value(moment))
}

/// Root mean square over some moments.
pub fn rms(moments: &[Moment], value: impl Fn(&Moment) -> f64) -> f64 {
    let squares: f64 = moments.iter().map(|moment| value(moment).powi(2)).sum();
    (squares / moments.len() as f64).sqrt()
}

/// Mean over some moments.
pub fn mean(moments: &[Moment], value: impl Fn(&Moment) -> f64) -> f64 {
    moments.iter().map(value).sum::<f64>() / moments.len() as f64
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::{Airframe, Limits};

    use super::{mean, rms, swing};
    use crate::bars::track::{Moment, Track};

    /// North over time: 1 − e^(−t) (cos 3t + sin 3t / 3), a step of a loop with poles −1 ± 3i.
    fn track() -> Track {
        let moment = |step: u32| {
            let time_s = f64::from(step) * 0.01;
            let (sine, cosine) = (3.0 * time_s).sin_cos();
            Moment {
                time_s,
                position_m: Vector3::new(1.0 - (-time_s).exp() * (cosine + sine / 3.0), 0.0, 0.0),
                velocity_m_s: Vector3::new((-time_s).exp() * sine * 10.0 / 3.0, 0.0, 0.0),
                attitude_rad: Vector3::zeros(),
                body_rate_rad_s: Vector3::zeros(),
                thrust_n: Airframe::default().weight_n(),
                torque_n_m: Vector3::zeros(),
                reference_m: Vector3::x(),
            }
        };
        Track { moments: (0..=1000).map(moment).collect() }
    }

    /// It overshoots by e^(−π/3); what is left of it at 3t = 4π is e^(−4π/3) = 1.5 %, at 3π it is 4.3 %.
    #[test]
    fn overshoot_and_settling_are_those_of_a_known_step() {
        let track = track();
        assert!((track.overshoot([1.0, 0.0, 0.0]) - (-std::f64::consts::FRAC_PI_3).exp()).abs() < 1e-4);
        let settled_s = track.settled_s();
        assert!(
            (std::f64::consts::PI..4.0 * std::f64::consts::FRAC_PI_3).contains(&settled_s),
            "{settled_s}"
        );
        assert_eq!(track.off_axis_m([1.0, 0.0, 0.0]), 0.0);
        // ∫ e^(−2t) (cos 3t + sin 3t / 3)² dt from 0 to ∞: 1/18 · (10/2 + (8·2 + 6·6)/(4 + 36)).
        let (steady, wave) = (10.0 / 2.0, (8.0 * 2.0 + 6.0 * 6.0) / 40.0);
        assert!((track.squared_distance_m2_s() - (steady + wave) / 18.0).abs() < 1e-3);
        assert_eq!(Track { moments: track.moments[..100].to_vec() }.settled_s(), f64::INFINITY);
    }

    /// The fastest is 10/3 e^(−t) sin 3t at tan 3t = 3: 1.386 e^(−0.4163) … of a limit of 1 m/s.
    #[test]
    fn the_worst_limit_counts() {
        let peak_s = 3.0_f64.atan() / 3.0;
        let fastest = (-peak_s).exp() * (3.0 * peak_s).sin() * 10.0 / 3.0;
        let limits = Limits { speed_horizontal_m_s: 1.0, ..Limits::default() };
        let excess = track().limit_excess(&limits, &Airframe::default());
        assert!((excess - (fastest - 1.0)).abs() < 1e-3, "{excess}");
        assert!(track().limit_excess(&Limits::default(), &Airframe::default()) < 0.0);
    }

    #[test]
    fn statistics_are_over_the_moments_given() {
        let track = track();
        let last = track.last(0.02);
        assert_eq!(last.len(), 3);
        assert!((swing(last, |moment| moment.time_s) - 0.02).abs() < 1e-12);
        assert!((mean(last, |moment| moment.time_s) - 9.99).abs() < 1e-12);
        assert!((rms(last, |moment| moment.time_s - 9.99) - (2e-4_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(track.since(9.99).len(), 2);
    }
}
