//! Turns of the heading.

use core::f64::consts::TAU;

use quadrotor::Limits;

use super::motion::wrapped;
use crate::plan::step::{Turn, TurnDirection, TurnTo};

/// A turn that is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Heading now, rad.
    at_rad: f64,
    /// Left of it, rad, positive clockwise.
    left_rad: f64,
    /// Rate now, rad/s, positive clockwise.
    rate_rad_s: f64,
    fastest_rad_s: f64,
    acceleration_rad_s2: f64,
}

/// Share of the angular acceleration. The shaper, which knows no acceleration of what it follows, needs the rest to keep up.
pub const SHARE: f64 = 0.6;
/// So near to its angle, rad, a turn is done.
const TURNED_RAD: f64 = 0.05;

impl Turning {
    /// A turn from a heading, rad, and a rate, rad/s, within limits. What goes faster at once is lagged behind, and overtaken then.
    pub fn new(turn: &Turn, [from_rad, rate_rad_s]: [f64; 2], limits: &Limits) -> Self {
        let left_rad = match turn.to {
            TurnTo::By(angle_rad) => angle_rad,
            TurnTo::Heading(heading_rad, direction) => {
                let short_rad = wrapped(heading_rad - from_rad);
                match direction {
                    // The long way round if that is the direction.
                    TurnDirection::Clockwise if short_rad < 0.0 => short_rad + TAU,
                    TurnDirection::CounterClockwise if short_rad > 0.0 => short_rad - TAU,
                    _ => short_rad,
                }
            }
        };
        let most_rad_s = limits.yaw_rate_rad_s;
        Self {
            at_rad: from_rad,
            left_rad,
            rate_rad_s,
            fastest_rad_s: turn.rate_rad_s.map_or(most_rad_s, |asked_rad_s| asked_rad_s.min(most_rad_s)),
            acceleration_rad_s2: SHARE * limits.yaw_acceleration_rad_s2,
        }
    }

    /// Turns on: up to its rate, and down to rest at its end.
    pub fn step(&mut self, dt_s: f64) {
        let braked_rad_s = libm::sqrt(2.0 * self.acceleration_rad_s2 * self.left_rad.abs());
        let wanted_rad_s = libm::copysign(self.fastest_rad_s.min(braked_rad_s), self.left_rad);
        let most_rad_s = self.acceleration_rad_s2 * dt_s;
        self.rate_rad_s += (wanted_rad_s - self.rate_rad_s).clamp(-most_rad_s, most_rad_s);
        let step_rad = self.rate_rad_s * dt_s;
        if (self.left_rad - step_rad).abs() <= most_rad_s * dt_s && self.rate_rad_s.abs() <= 2.0 * most_rad_s
        {
            self.at_rad += self.left_rad;
            (self.left_rad, self.rate_rad_s) = (0.0, 0.0);
            return;
        }
        self.at_rad += step_rad;
        self.left_rad -= step_rad;
    }

    /// Heading now, rad, and its rate, rad/s.
    pub fn heading(&self) -> (f64, f64) {
        (self.at_rad, self.rate_rad_s)
    }

    /// Whether the vehicle with a heading, rad, has turned as far.
    pub fn is_done(&self, yaw_rad: f64) -> bool {
        self.left_rad == 0.0 && self.rate_rad_s == 0.0 && wrapped(yaw_rad - self.at_rad).abs() < TURNED_RAD
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use quadrotor::Limits;

    use super::{SHARE, Turning};
    use crate::plan::step::{Turn, TurnTo};

    /// Steps of a millisecond until it rests: how long that takes, s, and the largest rate and acceleration.
    fn turned(mut turning: Turning, end_rad: f64) -> [f64; 3] {
        let (mut rate_rad_s, mut most, mut hardest) = (turning.heading().1, 0.0_f64, 0.0_f64);
        for step in 1..100_000 {
            turning.step(0.001);
            let (at_rad, now_rad_s) = turning.heading();
            most = most.max(now_rad_s.abs());
            if now_rad_s == 0.0 && turning.left_rad == 0.0 {
                assert!((at_rad - end_rad).abs() < 1e-9, "{at_rad}");
                return [f64::from(step) * 0.001, most, hardest];
            }
            hardest = hardest.max((now_rad_s - rate_rad_s).abs() / 0.001);
            rate_rad_s = now_rad_s;
        }
        panic!("it does not rest: {turning:?}");
    }

    /// Half a turn at 0.5 rad/s and 0.3 rad/s²: π / 0.5 and, for both ramps together, 0.5 / 0.3 s. A short turn has no even part, and one
    /// that begins in the other direction turns back first.
    #[test]
    fn it_reaches_its_rate_and_rests_at_its_end_within_the_acceleration() {
        let limits =
            Limits { yaw_rate_rad_s: 0.8, yaw_acceleration_rad_s2: 0.3 / SHARE, ..Limits::default() };
        let turn = |angle_rad| Turn { to: TurnTo::By(angle_rad), rate_rad_s: Some(0.5) };
        for (angle_rad, rate_rad_s, expected_s, most_rad_s) in [
            (PI, 0.0, PI / 0.5 + 0.5 / 0.3, 0.5),
            (-PI, 0.0, PI / 0.5 + 0.5 / 0.3, 0.5),
            (0.3, 0.0, 2.0, 0.3),
            (0.3, -0.3, 1.0 + 2.0 * libm::sqrt(0.45 / 0.3), libm::sqrt(0.3 * 0.45)),
            (0.3, 0.5, 0.5 / 0.3 + 2.0 * libm::sqrt((0.5 * 0.5 / 0.6 - 0.3) / 0.3), 0.5),
        ] {
            let turning = Turning::new(&turn(angle_rad), [1.0, rate_rad_s], &limits);
            let [took_s, most, hardest] = turned(turning, 1.0 + angle_rad);
            assert!((took_s - expected_s).abs() < 0.1, "{angle_rad}: {took_s} s, not {expected_s} s");
            assert!(
                (most - most_rad_s).abs() < 2e-3 && hardest < 0.3 + 1e-9,
                "{angle_rad}: {most} {hardest}"
            );
        }
    }
}
