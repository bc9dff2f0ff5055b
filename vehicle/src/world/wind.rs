//! Steady wind and gusts.

use libm::{cos, log, pow, sin, sqrt};
use nalgebra::Vector3;
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

/// The wind to simulate.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct WindSettings {
    /// Mean speed, m/s.
    pub speed_m_s: f64,
    /// Direction it comes from, rad from north through east.
    pub from_rad: f64,
    /// Standard deviation of the horizontal gusts, m/s.
    pub gusts_m_s: f64,
    /// Seed of the gusts.
    pub seed: u64,
}

/// How the wind changes with height and time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WindShape {
    /// How steeply it blows upwards, degrees.
    pub upwards_deg: f64,
    /// How its speed grows with height.
    pub profile: WindProfile,
    /// Height at which a growing wind has its full speed, m.
    pub full_m: f64,
    /// How much slower a linear one is per metre below that, 1/s.
    pub slope_per_s: f64,
    /// Time constant with which a change takes effect, s.
    pub change_s: f64,
}

/// How the speed of the wind grows with height.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum WindProfile {
    /// It is the same everywhere.
    #[default]
    Even,
    /// With the square root of the height.
    SquareRoot,
    /// Linearly.
    Linear,
}

impl Default for WindShape {
    fn default() -> Self {
        Self { upwards_deg: 0.0, profile: WindProfile::Even, full_m: 60.0, slope_per_s: 0.01, change_s: 5.0 }
    }
}

impl WindShape {
    /// The speed at a height, m, of a wind with a full speed, m/s.
    fn speed_m_s(&self, full_m_s: f64, height_m: f64) -> f64 {
        match self.profile {
            WindProfile::SquareRoot if height_m < self.full_m => {
                full_m_s * sqrt((height_m / self.full_m).max(0.0))
            }
            WindProfile::Linear if height_m < self.full_m => {
                (full_m_s - (self.full_m - height_m.max(0.0)) * self.slope_per_s).max(0.0)
            }
            _ => full_m_s,
        }
    }
}

/// A wind whose speed is so near to the one that is asked for, m/s, has it.
const SETTLED_M_S: f64 = 1e-3;
/// How often the gusts change, µs.
const PERIOD_US: u64 = 10_000;
/// Air speed with which a hovering vehicle meets the turbulence at least, m/s: it sets how fast gusts pass.
const LEAST_AIRSPEED_M_S: f64 = 3.0;

/// Wind with turbulence after Dryden (MIL-F-8785C, low altitude): white noise through
///
/// ```text
/// along:   σ √(2L/V) / (1 + L/V s)
/// across:  σ √(L/V) (1 + √3 L/V s) / (1 + L/V s)²       (and vertical)
/// ```
///
/// The same seed gives the same gusts at the same simulation times.
#[derive(Clone, Debug)]
pub struct Wind {
    settings: WindSettings,
    shape: WindShape,
    /// The mean speed of now, which follows that of the settings, m/s.
    speed_m_s: f64,
    time_us: u64,
    generator: Pcg64Mcg,
    along: f64,
    across: [f64; 2],
    vertical: [f64; 2],
}

impl Wind {
    /// Wind that begins without a gust.
    pub fn new(settings: WindSettings) -> Self {
        let generator = Pcg64Mcg::seed_from_u64(settings.seed);
        let (shape, speed_m_s) = (WindShape::default(), settings.speed_m_s);
        Self {
            settings,
            shape,
            speed_m_s,
            time_us: 0,
            generator,
            along: 0.0,
            across: [0.0; 2],
            vertical: [0.0; 2],
        }
    }

    /// Another wind from now on; the gusts go on.
    pub fn change(&mut self, settings: WindSettings, shape: WindShape) {
        (self.settings, self.shape) = (settings, shape);
    }

    /// Whether it neither changes with time nor with the height.
    pub fn is_steady(&self) -> bool {
        let speed_m_s = self.settings.speed_m_s;
        let is_even = self.shape.profile == WindProfile::Even || speed_m_s == 0.0;
        is_even && self.settings.gusts_m_s == 0.0 && self.speed_m_s == speed_m_s
    }

    /// Goes on with a change of the speed up to a time, µs.
    fn settle(&mut self, time_us: u64) {
        let dt_s = time_us.saturating_sub(self.time_us) as f64 / 1e6;
        self.time_us = time_us;
        let missing_m_s = self.settings.speed_m_s - self.speed_m_s;
        if missing_m_s.abs() <= SETTLED_M_S || dt_s + self.shape.change_s <= 0.0 {
            self.speed_m_s = self.settings.speed_m_s;
        } else {
            self.speed_m_s += missing_m_s * dt_s / (self.shape.change_s + dt_s);
        }
    }

    /// Velocity of the air, NED, m/s, at `time_us` and a height above the ground, m. To be asked at growing times.
    pub fn velocity_m_s(&mut self, time_us: u64, height_m: f64) -> Vector3<f64> {
        self.settle(time_us);
        if self.settings.gusts_m_s > 0.0 && time_us.is_multiple_of(PERIOD_US) {
            self.step(height_m);
        }
        // It blows towards the opposite of where it comes from.
        let (s, c) = (-sin(self.settings.from_rad), -cos(self.settings.from_rad));
        let mean = self.shape.speed_m_s(self.speed_m_s, height_m);
        let (along, across) = (mean + self.along, self.across[0]);
        if self.shape.upwards_deg == 0.0 {
            return Vector3::new(along * c - across * s, along * s + across * c, self.vertical[0]);
        }
        let upwards_rad = self.shape.upwards_deg.to_radians();
        let level = mean * cos(upwards_rad) + self.along;
        let down = self.vertical[0] - mean * sin(upwards_rad);
        Vector3::new(level * c - across * s, level * s + across * c, down)
    }

    fn step(&mut self, height_m: f64) {
        let height_ft = (height_m / 0.3048).clamp(10.0, 1000.0);
        // L_u = L_v = h / (0.177 + 0.000823 h)^1.2, L_w = h, in feet; σ_w = σ_u (0.177 + 0.000823 h)^0.4
        let shape = 0.177 + 0.000_823 * height_ft;
        let horizontal_m = 0.3048 * height_ft / pow(shape, 1.2);
        let vertical_m = 0.3048 * height_ft;
        let speed = self.settings.speed_m_s.max(LEAST_AIRSPEED_M_S);
        let sigma = self.settings.gusts_m_s;
        let sigma_vertical = sigma * pow(shape, 0.4);
        let dt_s = PERIOD_US as f64 / 1e6;

        let lag_s = horizontal_m / speed;
        let noise = self.normal() / sqrt(dt_s);
        self.along += dt_s * (sigma * sqrt(2.0 * lag_s) * noise - self.along) / lag_s;
        let noise = self.normal() / sqrt(dt_s);
        second_order(&mut self.across, lag_s, sigma, noise, dt_s);
        let noise = self.normal() / sqrt(dt_s);
        second_order(&mut self.vertical, vertical_m / speed, sigma_vertical, noise, dt_s);
    }

    /// A standard normal number (Box and Muller).
    fn normal(&mut self) -> f64 {
        // In (0, 1]: its logarithm is finite.
        let mut uniform = || ((self.generator.next_u64() >> 11) as f64 + 1.0) / (1u64 << 53) as f64;
        let (radius, angle) = (uniform(), uniform());
        sqrt(-2.0 * log(radius)) * cos(core::f64::consts::TAU * angle)
    }
}

/// One step of σ √T (1 + √3 T s) / (1 + T s)²; the output and an inner state.
fn second_order([output, inner]: &mut [f64; 2], lag_s: f64, sigma: f64, noise: f64, dt_s: f64) {
    // x = u/(1 + T s), y = (√3 x·… ) : √3 (1 + Ts) + (1 − √3) over (1 + Ts)² in two first-order parts.
    let drive = sigma * sqrt(lag_s) * noise;
    *inner += dt_s * (drive - *inner) / lag_s;
    let root = sqrt(3.0);
    // y + T ẏ = √3 u + (1 − √3) x
    *output += dt_s * (root * drive + (1.0 - root) * *inner - *output) / lag_s;
}

#[cfg(test)]
mod tests {
    use super::{Wind, WindSettings};

    fn statistics(settings: WindSettings) -> ([f64; 3], [f64; 3]) {
        let mut wind = Wind::new(settings);
        let samples = 400_000;
        let (mut sum, mut squares) = ([0.0; 3], [0.0; 3]);
        for tick in 1..=samples {
            let velocity = wind.velocity_m_s(tick * 10_000, 10.0);
            for axis in 0..3 {
                sum[axis] += velocity[axis];
                squares[axis] += velocity[axis] * velocity[axis];
            }
        }
        let mean = sum.map(|sum| sum / samples as f64);
        (mean, core::array::from_fn(|axis| (squares[axis] / samples as f64 - mean[axis] * mean[axis]).sqrt()))
    }

    #[test]
    fn gusts_have_the_asked_spread_around_the_mean_wind() {
        let settings = WindSettings { speed_m_s: 5.0, from_rad: 0.0, gusts_m_s: 1.5, seed: 7 };
        let (mean, spread) = statistics(settings);
        // From the north: it blows south.
        assert!((mean[0] + 5.0).abs() < 0.2 && mean[1].abs() < 0.2 && mean[2].abs() < 0.1, "{mean:?}");
        assert!((spread[0] - 1.5).abs() < 0.15 && (spread[1] - 1.5).abs() < 0.15, "{spread:?}");
        assert!(spread[2] > 0.5 && spread[2] < 1.2, "{spread:?}");
    }

    #[test]
    fn a_seed_repeats_and_another_does_not() {
        let gusts = |seed| {
            let mut wind = Wind::new(WindSettings { gusts_m_s: 1.0, seed, ..WindSettings::default() });
            (1..100).map(|tick| wind.velocity_m_s(tick * 10_000, 10.0).x).collect::<Vec<_>>()
        };
        assert_eq!(gusts(1), gusts(1));
        assert_ne!(gusts(1), gusts(2));
    }
}
