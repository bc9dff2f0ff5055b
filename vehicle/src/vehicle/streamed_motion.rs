//! Points of a trajectory that come without their acceleration.
//!
//! A program that streams positions and velocities leaves out what makes the vehicle lean. Flown as they are, such points run on
//! straight in between, and a curve is flown beside itself. The acceleration is that of the velocities so far.

use nalgebra::Vector3;
use quadrotor::{Limits, StreamedVelocity};

use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};

/// Points that come less often than this, µs, are not a stream.
const LONGEST_PERIOD_US: u64 = 300_000;

/// The stream so far.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct StreamedMotion {
    /// The latest point as it was given, and when, µs.
    latest: Option<(PositionSetPoint, u64)>,
    /// Mean time between points, µs; 0 if there is no stream yet.
    period_us: u64,
    velocities: StreamedVelocity,
    /// The latest point with the acceleration that was found for it, while that counts.
    bent: Option<PositionSetPoint>,
}

impl StreamedMotion {
    /// What to steer to for a set-point that comes at `time_us`: itself, or with the acceleration that it lacks. `None` if it is the
    /// latest one once more, sooner than the next one can come.
    pub fn take(
        &mut self,
        set_point: &PositionSetPoint,
        limits: &Limits,
        time_us: u64,
    ) -> Option<PositionSetPoint> {
        let Some(velocity_m_s) = velocity_without_acceleration(set_point) else {
            *self = Self::default();
            return Some(*set_point);
        };
        if let Some((latest, since_us)) = self.latest {
            let interval_us = time_us.saturating_sub(since_us);
            if *set_point == latest && interval_us < self.period_us / 2 {
                return None;
            }
            if interval_us > LONGEST_PERIOD_US {
                *self = Self::default();
            } else if self.period_us == 0 {
                self.period_us = interval_us;
            } else {
                // Late ones and those that then come together keep the mean.
                self.period_us = (3 * self.period_us + interval_us) / 4;
            }
        }
        self.latest = Some((*set_point, time_us));
        self.velocities.observe(&velocity_m_s, limits, time_us);
        let found = within(self.velocities.at(time_us).first, limits);
        self.bent = (found != Vector3::zeros()).then(|| with_acceleration(set_point, &found));
        Some(self.bent.unwrap_or(*set_point))
    }

    /// Whether an acceleration that was found has run on for longer than one lost point takes.
    pub fn is_overdue(&self, time_us: u64) -> bool {
        let patience_us = (2 * self.period_us + self.period_us / 2).min(LONGEST_PERIOD_US);
        self.bent.is_some() && self.latest.is_some_and(|(_, since_us)| time_us - since_us > patience_us)
    }

    /// Ends the acceleration that was found. Returns the point that was steered to with it, and as it was given, moved on until `time_us`.
    pub fn straighten(&mut self, time_us: u64) -> Option<(PositionSetPoint, PositionSetPoint)> {
        let (bent, (given, since_us)) = (self.bent.take()?, self.latest?);
        Some((bent, moved_on(&given, time_us.saturating_sub(since_us) as f64 / 1e6)))
    }
}

/// The velocity of a trajectory of which no acceleration is known, m/s.
fn velocity_without_acceleration(set_point: &PositionSetPoint) -> Option<Vector3<f64>> {
    let mut velocity_m_s = Vector3::zeros();
    let mut moves = false;
    for (velocity, axis) in velocity_m_s.iter_mut().zip(&set_point.axes) {
        match *axis {
            AxisTarget::Track { acceleration_m_s2, .. } if acceleration_m_s2 != 0.0 => return None,
            AxisTarget::Track { velocity_m_s, .. } => (*velocity, moves) = (velocity_m_s, true),
            _ => {}
        }
    }
    moves.then_some(velocity_m_s)
}

/// An acceleration within its limits, in its direction.
fn within(mut acceleration_m_s2: Vector3<f64>, limits: &Limits) -> Vector3<f64> {
    let strongest = limits.acceleration_vertical_m_s2;
    let horizontal = acceleration_m_s2.xy().cap_magnitude(limits.acceleration_horizontal_m_s2);
    acceleration_m_s2.fixed_rows_mut::<2>(0).copy_from(&horizontal);
    acceleration_m_s2.z = acceleration_m_s2.z.clamp(-strongest, strongest);
    acceleration_m_s2
}

fn with_acceleration(set_point: &PositionSetPoint, found_m_s2: &Vector3<f64>) -> PositionSetPoint {
    let mut bent = *set_point;
    for (axis, found) in bent.axes.iter_mut().zip(found_m_s2) {
        if let AxisTarget::Track { acceleration_m_s2, .. } = axis {
            *acceleration_m_s2 = *found;
        }
    }
    bent
}

/// A trajectory without acceleration `time_s` later.
fn moved_on(set_point: &PositionSetPoint, time_s: f64) -> PositionSetPoint {
    let mut moved = *set_point;
    for axis in &mut moved.axes {
        if let AxisTarget::Track { position_m, velocity_m_s, .. } = axis {
            *position_m += *velocity_m_s * time_s;
        }
    }
    if let YawTarget::Track(yaw_rad, rate_rad_s) = &mut moved.yaw {
        *yaw_rad += *rate_rad_s * time_s;
    }
    moved
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::Limits;

    use super::{AxisTarget, PositionSetPoint, StreamedMotion, YawTarget};

    const RADIUS_M: f64 = 5.0;
    const RATE_RAD_S: f64 = 0.5;

    fn point(position_m: Vector3<f64>, velocity_m_s: Vector3<f64>) -> PositionSetPoint {
        let axes = core::array::from_fn(|axis| AxisTarget::Track {
            position_m: position_m[axis],
            velocity_m_s: velocity_m_s[axis],
            acceleration_m_s2: 0.0,
            jerk_m_s3: 0.0,
        });
        PositionSetPoint { axes, yaw: YawTarget::Hold }
    }

    /// Derivative of an order of the circle.
    fn circle(order: i32, time_us: u64) -> Vector3<f64> {
        let angle = RATE_RAD_S * time_us as f64 / 1e6 + f64::from(order) * core::f64::consts::FRAC_PI_2;
        Vector3::new(angle.cos(), angle.sin(), 0.0) * (RADIUS_M * RATE_RAD_S.powi(order))
    }

    fn on_the_circle(time_us: u64) -> PositionSetPoint {
        point(circle(0, time_us), circle(1, time_us))
    }

    fn acceleration(set_point: &PositionSetPoint) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| match set_point.axes[axis] {
            AxisTarget::Track { acceleration_m_s2, .. } => acceleration_m_s2,
            _ => f64::NAN,
        })
    }

    /// The largest error of the acceleration after a second, m/s², of ten seconds of points that come so many µs late.
    fn worst(period_us: u64, late_us: impl Fn(u64) -> u64) -> f64 {
        let mut stream = StreamedMotion::default();
        let mut worst: f64 = 0.0;
        for number in 0..10_000_000 / period_us {
            let set_us = number * period_us;
            let time_us = set_us + late_us(number);
            assert!(!stream.is_overdue(time_us), "{set_us} µs");
            let taken =
                stream.take(&on_the_circle(set_us), &Limits::default(), time_us).expect("another point");
            if set_us > 1_000_000 {
                worst = worst.max((acceleration(&taken) - circle(2, set_us)).norm());
            }
        }
        worst
    }

    /// The oracle is the circle's own acceleration, 1.25 m/s².
    #[test]
    fn the_acceleration_of_a_circle_is_found_at_any_rate() {
        for period_us in [20_000, 50_000, 100_000] {
            let off = worst(period_us, |_| 0);
            assert!(off < 0.002, "each {period_us} µs: {off} m/s²");
        }
    }

    /// At 10 Hz a point so far off its time counts as another motion, whose acceleration is not known yet; none is made up.
    #[test]
    fn points_that_come_late_make_up_no_acceleration() {
        for (period_us, bar_m_s2) in [(20_000, 0.2), (50_000, 0.2), (100_000, 1.3)] {
            let off = worst(period_us, |number| number * 7 % 17 * period_us / 50);
            assert!(off < bar_m_s2, "each {period_us} µs: {off} m/s²");
        }
    }

    /// Lines, jumps to other velocities and places, points that are far apart or have an acceleration, places.
    #[test]
    fn what_is_no_curve_stays_as_it_is() {
        let given = {
            let mut given = on_the_circle(0);
            given.axes[0] = AxisTarget::Track {
                position_m: 1.0,
                velocity_m_s: 2.0,
                acceleration_m_s2: -0.3,
                jerk_m_s3: 0.0,
            };
            given
        };
        let place = PositionSetPoint { axes: [AxisTarget::Position(1.0); 3], yaw: YawTarget::Hold };
        let line = |number: u64| {
            let velocity = Vector3::new(1.5, -0.7, 0.2);
            point(velocity * (number as f64 * 0.05), velocity)
        };
        let corners = |number: u64| {
            let velocity = if (number / 10).is_multiple_of(2) { Vector3::x() } else { Vector3::y() };
            point(velocity * (number as f64), velocity)
        };
        let kinds: [(&dyn Fn(u64) -> PositionSetPoint, u64); 5] = [
            (&line, 50_000),
            (&corners, 50_000),
            (&|number| on_the_circle(number * 400_000), 400_000),
            (&|_| given, 50_000),
            (&|_| place, 50_000),
        ];
        for (kind, (at, period_us)) in kinds.into_iter().enumerate() {
            let mut stream = StreamedMotion::default();
            for number in 0..100 {
                let taken = stream.take(&at(number), &Limits::default(), number * period_us);
                assert_eq!(taken, Some(at(number)), "{kind} {number}");
            }
        }
    }

    #[test]
    fn what_is_found_is_within_the_limits() {
        let limits = Limits { acceleration_horizontal_m_s2: 0.8, ..Limits::default() };
        let mut stream = StreamedMotion::default();
        let taken = (0..40)
            .filter_map(|number| stream.take(&on_the_circle(number * 50_000), &limits, number * 50_000));
        let taken = acceleration(&taken.last().expect("points")).norm();
        assert!((taken - 0.8).abs() < 1e-9, "{taken}");
    }

    #[test]
    fn a_point_that_comes_twice_counts_once() {
        let mut stream = StreamedMotion::default();
        for number in 0..20 {
            let (point, time_us) = (on_the_circle(number * 50_000), number * 50_000);
            assert!(stream.take(&point, &Limits::default(), time_us).is_some());
            let before = stream;
            let again = stream.take(&point, &Limits::default(), time_us + 3_000);
            assert!(number == 0 || again.is_none() && stream == before, "{number}");
        }
    }

    /// One point may be lost; then the last one goes on straight, as it was given.
    #[test]
    fn a_stream_that_stops_goes_on_straight() {
        let mut stream = StreamedMotion::default();
        let mut taken = None;
        for number in 0..=20 {
            taken = stream.take(&on_the_circle(number * 50_000), &Limits::default(), number * 50_000);
        }
        assert!(!stream.is_overdue(1_120_000) && stream.is_overdue(1_126_000));
        let (bent, straight) = stream.straighten(1_200_000).expect("it was bent");
        assert_eq!(Some(bent), taken);
        let velocity = circle(1, 1_000_000);
        assert_eq!(straight, point(circle(0, 1_000_000) + velocity * 0.2, velocity));
        assert_eq!(stream.straighten(1_300_000), None);
        assert!(!stream.is_overdue(9_000_000));
    }
}
