//! The way around a corner without stopping.
//!
//! ```text
//!            W      the velocity changes from v·into to v·out, by an acceleration in one direction
//!   entry ·──┐      that builds up, stays and ends with the jerk limit: no other way is as short in time.
//!       into │ out  Entry and exit are v T / 2 before and behind W, and the way is |Δv| x(T/2) beside W
//!            · exit at its nearest.
//! ```

use nalgebra::Vector3;
use quadrotor::{Limits, PositionReference};

use super::super::motion::at_rest;
use super::direction_limits::{change_time_s, limits_along};

/// A blend between two straight lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    /// The corner, NED, m.
    pub corner_m: Vector3<f64>,
    /// Velocity on the way in, NED, m/s.
    pub velocity_in_m_s: Vector3<f64>,
    /// Velocity on the way out, NED, m/s.
    pub velocity_out_m_s: Vector3<f64>,
    /// From entry to exit, s.
    pub duration_s: f64,
    /// How long the acceleration takes to build up, and to end, s.
    ramp_s: f64,
}

impl Blend {
    /// The fastest around a corner, NED, m, from one direction to another, unit vectors, at a speed, m/s.
    pub fn new(
        corner_m: Vector3<f64>,
        [into, out]: [Vector3<f64>; 2],
        speed_m_s: f64,
        limits: &Limits,
    ) -> Self {
        let (velocity_in_m_s, velocity_out_m_s) = (into * speed_m_s, out * speed_m_s);
        let change = velocity_out_m_s - velocity_in_m_s;
        let (duration_s, ramp_s) = match change.try_normalize(1e-6) {
            Some(direction) => change_time_s(change.norm(), &limits_along(&direction, limits)),
            None => (0.0, 0.0),
        };
        Self { corner_m, velocity_in_m_s, velocity_out_m_s, duration_s, ramp_s }
    }

    /// Length of each leg that it takes, m.
    pub fn cut_m(&self) -> f64 {
        self.velocity_in_m_s.norm() * self.duration_s / 2.0
    }

    /// The nearest that it comes to the corner, m.
    pub fn nearest_m(&self) -> f64 {
        let (_, _, way_s) = self.share(self.duration_s / 2.0);
        (self.velocity_out_m_s - self.velocity_in_m_s).norm() * way_s
    }

    /// Where it begins, NED, m.
    pub fn entry_m(&self) -> Vector3<f64> {
        self.corner_m - self.velocity_in_m_s * (self.duration_s / 2.0)
    }

    /// Where it ends, NED, m.
    pub fn exit_m(&self) -> Vector3<f64> {
        self.corner_m + self.velocity_out_m_s * (self.duration_s / 2.0)
    }

    /// Motion so many seconds after the entry; after the exit it goes on straight. The heading is zero.
    pub fn at(&self, time_s: f64) -> PositionReference {
        if time_s >= self.duration_s {
            let position_m = self.exit_m() + self.velocity_out_m_s * (time_s - self.duration_s);
            return PositionReference { velocity_m_s: self.velocity_out_m_s, ..at_rest(position_m, 0.0) };
        }
        let time_s = time_s.max(0.0);
        let change = self.velocity_out_m_s - self.velocity_in_m_s;
        let (rate, share, way_s) = self.share(time_s);
        PositionReference {
            velocity_m_s: self.velocity_in_m_s + change * share,
            acceleration_m_s2: change * rate,
            jerk_m_s3: change * self.rate_slope(time_s),
            ..at_rest(self.entry_m() + self.velocity_in_m_s * time_s + change * way_s, 0.0)
        }
    }

    /// How long after the entry a reference is, s, if it passes the entry or has just passed it, as the blend does.
    pub fn elapsed_s(&self, reference: &PositionReference) -> Option<f64> {
        const NEAR_M: f64 = 0.02;
        const NEAR_M_S: f64 = 0.02;
        const LATEST_S: f64 = 0.2;
        let speed_m_s = self.velocity_in_m_s.norm();
        let past_m = reference.position_m - self.entry_m();
        let elapsed_s = past_m.dot(&self.velocity_in_m_s) / (speed_m_s * speed_m_s);
        let beside_m = (past_m - self.velocity_in_m_s * elapsed_s).norm();
        let slip_m_s = (reference.velocity_m_s - self.velocity_in_m_s).norm();
        let passes = (0.0..LATEST_S).contains(&elapsed_s) && beside_m < NEAR_M && slip_m_s < NEAR_M_S;
        passes.then_some(elapsed_s)
    }

    /// The slope ẅ of the rate of the change, 1/s²: constant on either ramp.
    fn rate_slope(&self, time_s: f64) -> f64 {
        let slope = 1.0 / (self.ramp_s * (self.duration_s - self.ramp_s));
        match time_s {
            _ if time_s < self.ramp_s => slope,
            _ if time_s > self.duration_s - self.ramp_s => -slope,
            _ => 0.0,
        }
    }

    /// Share w of the change of velocity that is made after a time, its rate ẇ, 1/s, and its integral x, s: ẇ is a trapezoid.
    fn share(&self, time_s: f64) -> (f64, f64, f64) {
        let (end_s, ramp_s) = (self.duration_s, self.ramp_s);
        if end_s <= 0.0 {
            return (0.0, 0.0, 0.0);
        }
        if time_s > end_s / 2.0 {
            let (rate, share, way_s) = self.share(end_s - time_s);
            return (rate, 1.0 - share, time_s - end_s / 2.0 + way_s);
        }
        let most = 1.0 / (end_s - ramp_s);
        if time_s < ramp_s {
            let rate = most * time_s / ramp_s;
            return (rate, rate * time_s / 2.0, rate * time_s * time_s / 6.0);
        }
        let even_s = time_s - ramp_s;
        let way_s = ramp_s * ramp_s / 6.0 + even_s * (ramp_s + even_s) / 2.0;
        (most, most * (time_s - ramp_s / 2.0), most * way_s)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use quadrotor::Limits;

    use super::Blend;

    fn direction() -> impl Strategy<Value = Vector3<f64>> {
        let axis = || -1.0..1.0_f64;
        (axis(), axis(), axis())
            .prop_map(|(x, y, z)| Vector3::new(x, y, z))
            .prop_filter_map("a direction", |vector| vector.try_normalize(0.1))
    }

    proptest! {
        /// Integrated numerically, velocity follows from the acceleration and position from the velocity; limits are kept; the
        /// nearest place is as far from the corner as it says.
        #[test]
        fn it_is_a_motion_within_the_limits(into in direction(), out in direction(), speed in 0.1..3.0_f64) {
            let limits = Limits::default();
            let blend = Blend::new(Vector3::new(3.0, -2.0, -9.0), [into, out], speed, &limits);
            const STEP_S: f64 = 1e-3;
            let (mut position, mut velocity) = (blend.entry_m(), blend.velocity_in_m_s);
            let mut acceleration = Vector3::zeros();
            let mut nearest = f64::INFINITY;
            for step in 1..=(blend.duration_s / STEP_S) as usize {
                let before = blend.at((step as f64 - 0.5) * STEP_S);
                let now = blend.at(step as f64 * STEP_S);
                position += before.velocity_m_s * STEP_S;
                velocity += before.acceleration_m_s2 * STEP_S;
                prop_assert!((now.position_m - position).norm() < 1e-5, "{} {position}", now.position_m);
                prop_assert!((now.velocity_m_s - velocity).norm() < 1e-4, "{} {velocity}", now.velocity_m_s);
                let (a, jerk) = (now.acceleration_m_s2, (now.acceleration_m_s2 - acceleration) / STEP_S);
                acceleration = a;
                let since_s = (step as f64 - 0.5) * STEP_S;
                let ramps = [0.0, blend.ramp_s, blend.duration_s - blend.ramp_s, blend.duration_s];
                if ramps.iter().all(|ramp_s| (since_s - ramp_s).abs() > STEP_S) {
                    prop_assert!((before.jerk_m_s3 - jerk).norm() < 1e-6, "{} {jerk}", before.jerk_m_s3);
                }
                prop_assert!(a.xy().norm() <= limits.acceleration_horizontal_m_s2 * 1.0001);
                prop_assert!(a.z.abs() <= limits.acceleration_vertical_m_s2 * 1.0001);
                prop_assert!(jerk.xy().norm() <= limits.jerk_horizontal_m_s3 * 1.0001);
                prop_assert!(jerk.z.abs() <= limits.jerk_vertical_m_s3 * 1.0001);
                nearest = nearest.min((now.position_m - blend.corner_m).norm());
            }
            let end = blend.at(blend.duration_s);
            prop_assert!((end.velocity_m_s - blend.velocity_out_m_s).norm() < 1e-12);
            prop_assert!((end.position_m - position).norm() < 0.01);
            prop_assert!((nearest - blend.nearest_m()).abs() < 2e-3, "{nearest} {}", blend.nearest_m());
            prop_assert!(((blend.exit_m() - blend.corner_m).norm() - blend.cut_m()).abs() < 1e-9);
        }
    }
}
