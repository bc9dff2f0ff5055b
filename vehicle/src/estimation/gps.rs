//! The GPS receiver, a u-blox NEO-M8N.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::noise::{Channel, Noise};
use super::true_motion::TrueMotion;
use super::wander::GaussMarkov;

// Figures of the NEO-M8N (u-blox UBX-15031086, table of GNSS performance), as far as not said otherwise.
/// Fixes per second: the 10 Hz of GPS alone; with GLONASS beside it, the receiver's default, it has 5 Hz.
pub const RATE_HZ: u8 = 10;
/// Time between these fixes, µs.
pub const PERIOD_US: u64 = 1_000_000 / RATE_HZ as u64;
/// Time from a fix to its message, µs. Assumed: the data sheet has none; PX4 counts with 110 ms (EKF2_GPS_DELAY).
pub const LATENCY_US: u64 = 100_000;
/// Time to the first fix of a hot start, µs: 1 s.
const FIRST_FIX_US: u64 = 1_000_000;

/// Standard deviation of a horizontal axis, m: 2.5 m circular error probable, of which a normal distribution has 1.1774
/// standard deviations.
pub const HORIZONTAL_M: f64 = 2.5 / 1.177_4;
/// Height is worse. Assumed: the data sheet is silent, a vertical dilution of 1.5 times the horizontal one is usual.
pub const VERTICAL_M: f64 = 1.5 * HORIZONTAL_M;
/// How long an error of the position lasts, s. Assumed: PX4's simulation in Gazebo Classic counts with the same.
pub const POSITION_CORRELATION_S: f64 = 60.0;
/// Standard deviation of an axis of the velocity, m/s: 0.05 m/s for half of all fixes, which of two normal axes is again
/// 1.1774 standard deviations.
pub const VELOCITY_M_S: f64 = 0.05 / 1.177_4;
/// How long an error of the velocity lasts, s: the median over logs of real receivers (fusion-nav's `Correlation`).
pub const VELOCITY_CORRELATION_S: f64 = 0.5;
/// Satellites of an open sky. Assumed.
const SATELLITES: u8 = 12;
/// Horizontal dilution of precision that the receiver tells. Assumed, for these satellites.
pub const HORIZONTAL_DILUTION: f64 = 0.7;
/// Vertical one.
pub const VERTICAL_DILUTION: f64 = 1.1;
/// A receiver whose last fix is older has none, µs.
const FRESH_US: u64 = 1_000_000;

/// Standard deviation of a height that a fix leaves out, m: nothing follows from it.
pub const UNKNOWN_M: f64 = 1e4;
/// The same of a velocity, m/s.
pub const UNKNOWN_M_S: f64 = 1e3;

/// A fix whose receiver takes itself to be further off than this, m, is not used. Assumed, several times what is usual.
const WORST_M: f64 = 20.0;

/// What the receiver says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GpsFix {
    /// When it was taken, µs.
    pub time_us: u64,
    /// Where, NED at the origin, m.
    pub position_m: Vector3<f64>,
    /// Velocity, NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Standard deviation of a horizontal axis, m.
    pub horizontal_accuracy_m: f64,
    /// Of the height, m.
    pub vertical_accuracy_m: f64,
    /// Of a horizontal axis of the velocity, m/s.
    pub velocity_accuracy_m_s: f64,
    /// Of the vertical velocity, m/s.
    pub climb_accuracy_m_s: f64,
    /// Satellites in use.
    pub satellites: u8,
}

impl GpsFix {
    /// Of a receiver that stands at the origin and errs as usual.
    #[cfg(test)]
    pub(super) fn still() -> Self {
        Self {
            time_us: 0,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            horizontal_accuracy_m: 2.0,
            vertical_accuracy_m: 3.0,
            velocity_accuracy_m_s: 0.05,
            climb_accuracy_m_s: 0.05,
            satellites: 12,
        }
    }

    /// A fix without errors.
    pub fn exact(motion: &TrueMotion) -> Self {
        Self {
            time_us: motion.time_us,
            position_m: motion.position_m,
            velocity_m_s: motion.velocity_m_s,
            horizontal_accuracy_m: 0.0,
            vertical_accuracy_m: 0.0,
            velocity_accuracy_m_s: 0.0,
            climb_accuracy_m_s: 0.0,
            satellites: SATELLITES,
        }
    }

    /// Whether the receiver takes itself to be near enough for its fix to be used.
    pub fn is_accurate(&self) -> bool {
        self.horizontal_accuracy_m <= WORST_M
    }

    /// Whether it tells where the vehicle is on the map.
    pub fn tells_place(&self) -> bool {
        self.horizontal_accuracy_m < UNKNOWN_M
    }

    /// Whether it tells how fast the vehicle is on the map.
    pub fn tells_velocity(&self) -> bool {
        self.velocity_accuracy_m_s < UNKNOWN_M_S
    }

    /// Whether it still tells where the vehicle is.
    pub fn is_fresh(&self, time_us: u64) -> bool {
        time_us.saturating_sub(self.time_us) <= FRESH_US
    }
}

/// The instrument.
#[derive(Clone, Debug)]
pub struct GpsReceiver {
    rate_hz: u8,
    latency_us: u64,
    noise: Noise,
    position_error: GaussMarkov,
    velocity_error: GaussMarkov,
    /// Periods since the start, once it has been looked at.
    periods: Option<u64>,
    /// Taken, but not yet told.
    underway: VecDeque<GpsFix>,
}

/// Most fixes that are on their way at once: those of 0.3 s at 50 Hz.
const MOST_UNDERWAY: usize = 16;

impl GpsReceiver {
    /// One that has just been switched on; a fix arrives so long after it was taken, µs.
    pub fn new(seed: u64, latency_us: u64) -> Self {
        let mut noise = Noise::new(seed, Channel::Gps);
        let position_error = GaussMarkov::new(POSITION_CORRELATION_S, &mut noise);
        let velocity_error = GaussMarkov::new(VELOCITY_CORRELATION_S, &mut noise);
        Self {
            rate_hz: RATE_HZ,
            latency_us,
            noise,
            position_error,
            velocity_error,
            periods: None,
            underway: VecDeque::with_capacity(MOST_UNDERWAY),
        }
    }

    /// Takes so many fixes per second from now on, and tells each so late, µs.
    pub fn set(&mut self, rate_hz: u8, latency_us: u64) {
        (self.rate_hz, self.latency_us) = (rate_hz, latency_us);
    }

    /// The fix that arrives now, if one does. To be called every tick.
    pub fn sample(&mut self, motion: &TrueMotion) -> Option<GpsFix> {
        let time_us = motion.time_us;
        let has_arrived = |fix: &GpsFix| fix.time_us + self.latency_us <= time_us;
        let arrived =
            if self.underway.front().is_some_and(has_arrived) { self.underway.pop_front() } else { None };
        let periods = time_us * u64::from(self.rate_hz) / 1_000_000;
        let is_due = self.periods.replace(periods).map_or(time_us == 0, |before| before != periods);
        if is_due {
            let dt_s = 1.0 / f64::from(self.rate_hz);
            let position_error = self.position_error.step(dt_s, &mut self.noise);
            let velocity_error = self.velocity_error.step(dt_s, &mut self.noise);
            let scale = Vector3::new(HORIZONTAL_M, HORIZONTAL_M, VERTICAL_M);
            if time_us >= FIRST_FIX_US {
                self.underway.truncate(MOST_UNDERWAY - 1);
                self.underway.push_back(GpsFix {
                    time_us,
                    position_m: motion.position_m + position_error.component_mul(&scale),
                    velocity_m_s: motion.velocity_m_s + velocity_error * VELOCITY_M_S,
                    horizontal_accuracy_m: HORIZONTAL_M,
                    vertical_accuracy_m: VERTICAL_M,
                    velocity_accuracy_m_s: VELOCITY_M_S,
                    climb_accuracy_m_s: VELOCITY_M_S,
                    satellites: SATELLITES,
                });
            }
        }
        arrived
    }
}
