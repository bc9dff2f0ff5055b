//! What a random flight meets.

use std::f64::consts::PI;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::SeedableRng;
use nalgebra::Vector3;
use quadrotor::{Configuration, InitialState, Sensors};
use rand_distr::{Distribution, StandardUniform};

use super::gusts::Gusts;

/// Duration of a flight, s.
pub const DURATION_S: f64 = 20.0;
/// Linear drag of the airframe, N·s/m, that the controllers do not know of: the defaults have none, and wind would
/// not be felt.
pub const DRAG_N_S_M: f64 = 0.2;
/// Largest mean wind, m/s.
pub const WIND_M_S: f64 = 6.0;
/// Largest deviation of mass and inertia from what the controllers believe in, as a share.
const MASS_SHARE: f64 = 0.3;
/// Flight n has seed n after this one.
const SEED: u64 = 2015;

/// Half-widths of the start: position, m; velocity, m/s; roll and pitch, rad; body rates, rad/s. Any heading.
pub const START: [f64; 4] = [5.0, 1.0, 0.5, 1.0];
/// Deviations of the noise: position, m; velocity, m/s; attitude, rad; body rates, rad/s.
pub const NOISE: [f64; 4] = [0.02, 0.05, 0.005, 0.02];

/// One set of circumstances.
#[derive(Clone, Debug, PartialEq)]
pub struct Circumstances {
    initial: InitialState,
    /// True mass and inertia over what the controllers believe in.
    mass_share: f64,
    sensors: Sensors,
    gusts: Gusts,
}

impl Circumstances {
    /// Those of flight number `index`.
    pub fn new(index: u32) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(SEED + u64::from(index));
        let mut even = |half_width: f64| {
            let sample: f64 = StandardUniform.sample(&mut generator);
            half_width * (2.0 * sample - 1.0)
        };
        let [position, velocity, tilt, rate] = START;
        let initial = InitialState {
            position_m: [even(position), even(position), even(position)],
            velocity_m_s: [even(velocity), even(velocity), even(velocity)],
            attitude_rad: [even(tilt), even(tilt), even(PI)],
            body_rate_rad_s: [even(rate), even(rate), even(rate)],
            ..InitialState::default()
        };
        let mass_share = 1.0 + even(MASS_SHARE);
        let (direction, wind_m_s) = (even(PI), (WIND_M_S + even(WIND_M_S)) / 2.0);
        let mean_m_s = Vector3::new(wind_m_s * direction.cos(), wind_m_s * direction.sin(), 0.0);
        let [position_noise_m, velocity_noise_m_s, attitude_noise_rad, body_rate_noise_rad_s] = NOISE;
        let sensors = Sensors {
            output_feedback: false,
            position_noise_m,
            velocity_noise_m_s,
            attitude_noise_rad,
            body_rate_noise_rad_s,
            seed: index,
        };
        Self { initial, mass_share, sensors, gusts: Gusts::new(mean_m_s, DURATION_S, &mut generator) }
    }

    /// A configuration under them: the vehicle changes, and what the controllers believe stays.
    pub fn applied(&self, configuration: Configuration) -> Configuration {
        let mut configuration =
            Configuration { initial: self.initial, sensors: self.sensors, ..configuration };
        let airframe = &mut configuration.airframe;
        airframe.mass_kg *= self.mass_share;
        airframe.inertia_kg_m2 = airframe.inertia_kg_m2.map(|inertia| inertia * self.mass_share);
        airframe.drag_n_s_m = [DRAG_N_S_M; 3];
        configuration.controllers.mass_factor = 1.0 / self.mass_share;
        configuration
    }

    /// The wind, NED, m/s.
    pub fn wind_m_s(&self, time_us: u64) -> Vector3<f64> {
        self.gusts.at(time_us)
    }
}
